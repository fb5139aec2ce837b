// Finds the volumes among files and folders.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace edgesplat {

struct FoundVolumes {
    /// Paths for load_volume(), sorted within each folder: files, and folders whose slices or series are one path.
    std::vector<std::string> paths;
    std::size_t ignored = 0;  ///< other files
};

/// Searches files and, with all folders inside, folders. A folder of DICOM files is one path, and so is one of at least
/// two image slices and a Zarr folder. Data files that belong to a header beside them are not listed on their own.
/// Files given by name are always listed. Hidden files are skipped. Throws Error for a folder that cannot be read.
FoundVolumes find_volumes(const std::vector<std::string>& paths);

}  // namespace edgesplat
