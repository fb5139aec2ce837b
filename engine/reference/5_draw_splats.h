// Pass 5: the splats of one sheet, added up (method.md, 5_draw_splats).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/reference/3_select_footprints.h"
#include "engine/reference/footprints.h"

namespace edgesplat::reference {

/// What stands in the place of colour.
enum class Payload { Color, Depth, Distance, Normal };

/// Light on one splat, before its material's colour. `n_index` is the splat's normal in index space, 0 for none;
/// `position` is the voxel centre in world mm.
double light_on(const Light& light, const VolumeGeometry& geometry, const glm::dvec3& n_index,
                const glm::dvec3& position, const glm::dvec3& eye);

/// The quantity a splat carries: lit colour (linear), z in mm (first component), signed distance to the edge in voxels
/// (first component, negative inside) or unit world normal.
glm::dvec3 payload_of(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                      const Settings& settings, Payload payload);

/// Depths, mm along the view axis from the eye, that a kernel is cut to.
struct DepthRange {
    double near = 0;
    double far = 0;
};

/// Everything the sheets of a frame have in common. Referenced objects must outlive it.
class SplatDrawer {
  public:
    SplatDrawer(std::span<const SplatRecord> records, std::span<const Selected> selected, const Field& field,
                const Scene& scene, const View& view, const Settings& settings, const Footprints& footprints);

    /// Adds the splats (indices into the records) to `sheet`, one (sum of tau * quantity, sum of tau) per pixel.
    /// Pixels of `closed` that are non-zero are skipped; empty: none is. With `cut`, only what lies between.
    void draw(std::span<const std::uint32_t> splats, Payload payload, std::span<const char> closed,
              std::span<glm::dvec4> sheet, const std::optional<DepthRange>& cut = {}) const;

    /// tau of one splat at the centre of pixel (x, y).
    double tau(std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut = {}) const;

  private:
    std::span<const SplatRecord> records_;
    std::span<const Selected> selected_;
    const Field& field_;
    const Scene& scene_;
    const View& view_;
    const Settings& settings_;
    const Footprints& footprints_;
    std::vector<glm::dvec4> rays_;  ///< per pixel: unit direction in index space, mm per voxel along it
};

}  // namespace edgesplat::reference
