// The checksum and axis checks that `finish_volume` and the packer share. Internal to engine/volume, not installed.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "engine/volume/volume.h"

namespace edgesplat::detail {

/// Incremental checksum of a volume's samples. FNV-1a on 32-bit words instead of bytes: four times as fast, and only
/// compared with checksums of the same kind.
class VolumeChecksum {
  public:
    explicit VolumeChecksum(const VolumeGeometry& geometry);
    /// Adds the next samples, x fastest; of ranks in `ranks`, the numbers.
    void add(std::span<const float> samples, const LabelTable* ranks);
    /// Adds the position of a sample without data.
    void add_missing(std::size_t sample) {
        add(static_cast<std::uint32_t>(sample));
        add(static_cast<std::uint32_t>(std::uint64_t{sample} >> 32));
    }
    void add_scale(double value_scale) { add(value_scale); }
    void add(std::span<const std::uint32_t> labels) {
        for (const std::uint32_t label : labels)
            add(label);
    }
    std::uint64_t value() const { return hash_; }

  private:
    void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ULL; }
    void add(double value);
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

/// Throws Error unless the volume's axes and origin are finite and the axes are linearly independent.
void check_axes(const Volume& volume);

}  // namespace edgesplat::detail
