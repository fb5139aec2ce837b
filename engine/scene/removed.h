// Knobs and steps of them that scenes, pictures and scripts of before may name, and what to write instead.
#pragma once

#include <string>
#include <string_view>

namespace edgesplat {

/// "is no more: ..." of a knob, spelled as an option or as a key ("edge-half-width", "quality.edge_half_width"), or of
/// a value of one; empty: there never was such a thing, or it is there.
std::string removed_knob(std::string_view name);
std::string removed_step(std::string_view knob, std::string_view value);

}  // namespace edgesplat
