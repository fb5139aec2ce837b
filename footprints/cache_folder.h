// The folder for files that are kept between runs.
#pragma once

#include <filesystem>

namespace edgesplat {

/// $EDGESPLAT_CACHE, else $XDG_CACHE_HOME/edgesplat, else ~/.cache/edgesplat; empty if none of them is set.
std::filesystem::path cache_folder();

}  // namespace edgesplat
