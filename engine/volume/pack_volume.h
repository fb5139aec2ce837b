// Writing packed volumes (packed_volume.h).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "engine/volume/load_volume.h"

namespace edgesplat {

struct PackOptions {
    bool compress = false;  ///< shuffle and deflate: smaller, slower to write and read
    /// 8 or 16: where samples do not fit into integers of so many bits exactly, the nearest of equally spaced values
    /// is stored instead; 0: every sample is kept exactly.
    int quantise = 0;
    /// Called on the calling thread with a fraction in [0, 1] and what is being done; false: stop, leaving nothing.
    std::function<bool(double fraction, std::string_view what)> progress;
};

/// What was written.
struct PackSummary {
    VolumeGeometry geometry;
    int levels = 0;
    std::string sample_type;        ///< uint8, int16, uint16 or float32
    double quantisation_error = 0;  ///< largest difference between a sample and what is stored, the volume's unit
    std::uint64_t bytes = 0;        ///< of the file
    bool streamed = false;          ///< the source was never in memory as a whole
};

/// Packs a volume in memory. Throws Error, also when it is stopped; then nothing is left and what stood under the name
/// of `output` is as it was.
PackSummary pack_volume(const Volume& volume, const std::string& output, const PackOptions& options = {});

/// Packs what `load_volume` reads. builtin:NAME, raw files and uncompressed NRRD and MetaImage files are read piece by
/// piece: however large the volume, no more than about 100 MB of it are in memory at any time.
PackSummary pack_file(const std::string& path, const LoadOptions& load, const std::string& output,
                      const PackOptions& options = {});

}  // namespace edgesplat
