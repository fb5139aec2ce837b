// TIFF stacks. Internal to engine/volume/io.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// Whether a file begins as TIFF or BigTIFF do.
bool begins_as_tiff(std::string_view head);
/// Reads one file with all its slices, or several with one each, in this order. `name` is the user's path.
Volume load_tiff(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options);

}  // namespace edgesplat::detail
