// Reads MINC1 (netCDF) and MINC2 (HDF5) through ITK.
#include <mutex>

#include "engine/volume/io/hdf5.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

Volume load_minc(const std::string& path, const LoadOptions& options) {
    check_netcdf_is_whole(path);
    const std::lock_guard lock(hdf5_mutex());
    return load_through_itk({.format = ItkFormat::Minc, .path = path, .stored_bytes = std::filesystem::file_size(path)},
                            options);
}

}  // namespace edgesplat::detail
