// What finishing a volume and packing one have in common. Internal to engine/volume; nothing here is installed.
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "engine/volume/volume.h"

namespace edgesplat::detail {

/// The checksum of a volume, for samples that come a few at a time: FNV-1a on 32-bit words instead of bytes, four times
/// as fast, and only ever compared with itself.
class VolumeChecksum {
  public:
    explicit VolumeChecksum(const VolumeGeometry& geometry);
    /// The next samples, x fastest.
    void add(std::span<const float> samples) {
        for (const float value : samples)
            add(std::bit_cast<std::uint32_t>(value));
    }
    std::uint64_t value() const { return hash_; }

  private:
    void add(std::uint32_t word) { hash_ = (hash_ ^ word) * 0x100000001b3ULL; }
    void add(double value);
    std::uint64_t hash_ = 0xcbf29ce484222325ULL;
};

/// Throws Error unless the volume's axes and origin are finite and the axes span space.
void check_axes(const Volume& volume);

}  // namespace edgesplat::detail
