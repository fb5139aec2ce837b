// Pass 5: adds up the splats of one sheet (docs/method/5_draw.md).
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/reference/3_select_footprints.h"
#include "engine/reference/footprints.h"
#include "engine/reference/outlines.h"
#include "engine/reference/shading.h"
#include "engine/scene/clip_planes.h"

namespace edgesplat::reference {

/// The quantity that splats carry.
enum class Payload { Color, Depth, Distance, Normal };

/// The payload where a ray enters the splat's matter through a clip plane at `entry` (index space): colour lit by the
/// plane's normal, depth of the entry, or the plane's normal. Distance is that of the splat. `face`: the plane's
/// normal, index space; `own`: payload_of the splat.
glm::dvec3 cap_payload(const SplatRecord& record, const glm::dvec3& own, const glm::dvec3& face,
                       const glm::dvec3& entry, const Scene& scene, const View& view, Payload payload);

/// Depth range that a kernel is cut to, mm along the view axis from the eye.
struct DepthRange {
    double near = 0;
    double far = 0;
};

/// The payload of a splat at its voxel's centre: lit colour (linear), z in mm (first component), signed distance to the
/// edge in voxels (first component, negative inside) or unit world normal. Depth is clamped to `cut`.
glm::dvec3 payload_of(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                      const Settings& settings, Payload payload, const std::optional<DepthRange>& cut = {});

/// The payload where a ray p + z u (index space; p relative to the voxel centre) meets the face that cuts the kernel;
/// where it passes the voxel, if no face cuts it. `plain`: the kernel is widened and not cut, but keeps its face's
/// normal.
glm::dvec3 face_payload(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                        const Settings& settings, Payload payload, const Footprints& footprints, const glm::dvec3& p,
                        const glm::dvec3& u, const Slice& slice = {}, bool plain = false);

/// Draws the sheets of one frame. Referenced objects must outlive it.
class SplatDrawer {
  public:
    /// `ends`: where each pixel's ray ends, voxels from the eye; empty: nowhere.
    SplatDrawer(std::span<const SplatRecord> records, std::span<const Selected> selected, const Field& field,
                const Scene& scene, const View& view, const Settings& settings, const Footprints& footprints,
                std::span<const double> ends = {});

    /// Adds the splats (indices into the records) to `sheet`: (sum of tau * quantity, sum of tau) per pixel. Skips
    /// saturated pixels, whose `closed` is not 0; an empty `closed` skips none. `cut`: only this depth range counts.
    void draw(std::span<const std::uint32_t> splats, Payload payload, std::span<const char> closed,
              std::span<glm::dvec4> sheet, const std::optional<DepthRange>& cut = {}) const;

    /// Finds where the splats' outlines pass pixels whose opacity in `frame` is below OUTLINE_OPEN, and keeps the
    /// outermost outline of each pixel. `cut` as in draw().
    void outline(std::span<const std::uint32_t> splats, std::span<const glm::dvec4> frame,
                 std::span<std::optional<Outline>> outlines, const std::optional<DepthRange>& cut = {}) const;

    /// tau of one splat at the centre of pixel (x, y).
    double tau(std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut = {}) const;

  private:
    const glm::dvec4& ray_of(int x, int y) const;
    /// Integral of the splat's kernel along the ray of pixel (x, y), or along `slice` of it, widened to the pixel.
    double footprint(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p, const glm::dvec3& u,
                     const std::optional<Slice>& slice) const;
    /// Where the pixel's ray ends, from the point at distance `ahead` from the eye; infinity unless it cuts a kernel
    /// there.
    double end_of(int x, int y, double ahead) const;
    /// Where the ray reaches the voxel's depth, voxels from p.
    double depth_on_ray(const glm::dvec3& p, const glm::dvec3& u) const;
    /// Whether the ray's point z lies in the splat's matter.
    bool in_matter(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p, const glm::dvec3& u,
                   double z) const;
    /// (tau * quantity, tau) of the splat at pixel (x, y). `own`: its quantity if no cut shows.
    glm::dvec4 contribution(std::uint32_t splat, int x, int y, const glm::dvec3& own, Payload payload,
                            const std::optional<DepthRange>& cut) const;

    std::span<const SplatRecord> records_;
    std::span<const Selected> selected_;
    const Field& field_;
    const Scene& scene_;
    const View& view_;
    const Settings& settings_;
    const Footprints& footprints_;
    std::span<const double> ends_;
    IndexClip clip_;
    std::vector<glm::dvec4> rays_;  ///< per pixel: unit direction in index space, mm per voxel along it
};

}  // namespace edgesplat::reference
