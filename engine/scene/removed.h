// Names of removed knobs and steps, with their replacements, for old scenes, pictures and scripts.
#pragma once

#include <string>
#include <string_view>

namespace edgesplat {

/// "was removed; ..." for a removed knob, spelled as option or key ("edge-half-width", "quality.edge_half_width"), or
/// for a removed value of a knob. Empty if the name was never valid or still is.
std::string removed_knob(std::string_view name);
std::string removed_step(std::string_view knob, std::string_view value);

}  // namespace edgesplat
