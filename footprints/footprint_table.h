// Pre-integrated footprints of one edge band: the file the `table` and `table-lerp` modes look up.
//
// What is tabulated is the *correction* to a warped two-dimensional footprint: F = g(base) + T. The base is exact for
// edges seen edge-on, where F is sharpest, and follows the edge with the mean slope that a ray sees otherwise; what is
// left is smooth, so few texels hold it. See README.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "footprints/edge_warp.h"
#include "footprints/footprint_integral.h"

namespace edgesplat {

/// Texels per layer and layers: by default 6.1 MB. distances * directions <= 2048 (what every Vulkan device has as
/// array layers).
struct FootprintTableSize {
    int width = 64;              ///< along the projected normal, base coordinate X in [-extent, extent]
    int height = 24;             ///< across it, y in [0, R]
    int distances = 57;          ///< d in [0, R + a]
    int directions = 35;         ///< |cos theta| in [0, 1], denser towards 0
    std::size_t texels() const;  ///< of all layers together
    bool operator==(const FootprintTableSize&) const = default;
};

/// Throws std::invalid_argument naming what is out of range: half_width (0, 3], strength [1, 64], the sizes above.
void validate(const EdgeBand& band, const FootprintTableSize& size);

/// The layers: half-float texels [distance][direction][y][x], ready for a `sampler2DArray` of R16_SFLOAT with linear
/// filter and clamp to edge; layer = distance index * directions + direction index.
class FootprintTable {
  public:
    /// Integrates every texel; `threads` 0 means one a core. Throws std::invalid_argument for sizes or bands out of
    /// range.
    static FootprintTable build(const EdgeBand& band, const FootprintTableSize& size = {}, int threads = 0);

    /// Wraps texels from elsewhere (the cache); their number must be that of `size`.
    FootprintTable(const EdgeBand& band, const FootprintTableSize& size, std::vector<std::uint16_t> texels);

    const EdgeBand& band() const { return band_; }
    const FootprintTableSize& size() const { return size_; }
    double extent() const { return extent_; }  ///< layers cover X in [-extent, extent] and y in [0, R], voxels
    std::span<const std::uint16_t> texels() const { return texels_; }

    /// F for an edge at signed `distance` (|d| >= R + a: the plain footprint), by the layer nearest to it or blended
    /// between the four around it, both bilinear within a layer; what footprint.glsl computes.
    double nearest(const Ray& ray, double distance) const;
    double lerp(const Ray& ray, double distance) const;

  private:
    double sample(int distance_index, int direction_index, double X, double y) const;

    EdgeBand band_;
    FootprintTableSize size_;
    double extent_ = 0;
    std::vector<std::uint16_t> texels_;
};

/// IEEE half precision, round to nearest even.
std::uint16_t half_from_float(float value);
float float_from_half(std::uint16_t half);

}  // namespace edgesplat
