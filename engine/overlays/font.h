// The font of overlays and of the navigation app.
#pragma once

#include <optional>
#include <string>

namespace edgesplat {

/// Path of DejaVu Sans; none if it is in no folder that distributions use for it.
std::optional<std::string> font_file();

}  // namespace edgesplat
