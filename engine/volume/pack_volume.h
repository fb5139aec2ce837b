// Writes packed volumes (packed_volume.h).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "engine/volume/load_volume.h"

namespace edgesplat {

struct PackOptions {
    bool compress = false;  ///< shuffle and deflate: smaller file, slower to write and read
    /// Bits per sample, 8 or 16: if samples are not exactly representable as integers of this size, they are rounded to
    /// equally spaced values. 0: every sample is stored exactly.
    int quantise = 0;
    /// Progress callback on the calling thread with a fraction in [0, 1] and the current step. If it returns false,
    /// packing stops and leaves no file.
    std::function<bool(double fraction, std::string_view what)> progress;
};

/// Properties of the written file.
struct PackSummary {
    VolumeGeometry geometry;
    int levels = 0;
    std::string sample_type;        ///< uint8, int16, uint16 or float32
    double quantisation_error = 0;  ///< largest difference between a sample and its stored value, in the volume's unit
    std::uint64_t bytes = 0;        ///< file size
    bool streamed = false;          ///< true: the source was never in memory as a whole
};

/// Packs a volume that is in memory. Throws Error, also when it is stopped; then no new file is left, and an existing
/// `output` is unchanged.
PackSummary pack_volume(const Volume& volume, const std::string& output, const PackOptions& options = {});

/// Packs any volume that `load_volume` can read. builtin:NAME, raw files and uncompressed NRRD and MetaImage files are
/// read piece by piece: at most about 100 MB are in memory at any time.
PackSummary pack_file(const std::string& path, const LoadOptions& load, const std::string& output,
                      const PackOptions& options = {});

}  // namespace edgesplat
