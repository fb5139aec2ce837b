// Tables of label names that other programs write.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// The labels of a text: lines "NUMBER NAME R G B [A]" (Slicer colour tables, FreeSurfer lookup tables) or "NUMBER R G
/// B A VIS MESH "NAME"" (ITK-SNAP label descriptions), colours 0 to 255; or lines of values between commas, semicolons
/// or tabs under a header that names a column of numbers (id, label, value, ...) and one of names, as in the Allen
/// ontology. Lines that begin with # are ignored; of a number that occurs again the first line counts. `source` is
/// named in errors. Throws Error with the line if a line has another form, or if there is no label.
std::vector<Label> parse_label_names(std::string_view text, std::string_view source);

/// The labels of a file (at most 16 MiB).
std::vector<Label> read_label_names(const std::filesystem::path& path);

/// The table with the names and colours of `named`; numbers that it does not have keep theirs.
LabelTable with_names(LabelTable table, const std::vector<Label>& named);

}  // namespace edgesplat
