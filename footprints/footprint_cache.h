// Footprint tables on disk: built once per band and size, then read.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "footprints/footprint_table.h"

namespace edgesplat {

/// A table and how it was come by.
struct LoadedFootprintTable {
    FootprintTable table;
    bool from_cache = false;
    std::string warning;  ///< why the cache was not usable or not written; empty if all is well
};

/// $EDGESPLAT_CACHE, else $XDG_CACHE_HOME/edgesplat, else ~/.cache/edgesplat; empty if none of them is set.
std::filesystem::path footprint_cache_folder();

/// The cache file of a table in `folder`: named by its parameters and the format's version.
std::filesystem::path footprint_cache_file(const std::filesystem::path& folder, const EdgeBand& band,
                                           const FootprintTableSize& size);

/// The table in a cache file; nothing, and `problem` set, where the file is damaged, truncated, too long, of other
/// parameters, or not an ordinary file. A missing file is no problem. Takes no more memory than the table.
std::optional<FootprintTable> read_footprint_table(const std::filesystem::path& file, const EdgeBand& band,
                                                   const FootprintTableSize& size, std::string& problem);

/// The table from the cache, or built and then cached (written beside and renamed: safe for several processes at once).
/// A damaged, truncated or foreign file is rebuilt; a folder that cannot be written gives a warning. Empty folder: no
/// cache. Throws std::invalid_argument for sizes or bands out of range.
LoadedFootprintTable load_footprint_table(const EdgeBand& band, const FootprintTableSize& size = {},
                                          const std::filesystem::path& folder = footprint_cache_folder());

}  // namespace edgesplat
