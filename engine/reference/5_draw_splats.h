// Pass 5: the splats of one sheet, added up (method.md, 5_draw_splats).
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

/// What stands in the place of colour.
enum class Payload { Color, Depth, Distance, Normal };

/// What stands in the place of a splat of material `number` where a ray enters its matter at `entry` (index space) by a
/// clip plane: colour lit by the cut's normal, depth of the entry, the cut's normal. `face` is that normal in index
/// space, `own` payload_of the splat.
glm::dvec3 cap_payload(std::uint32_t number, const glm::dvec3& own, const glm::dvec3& face, const glm::dvec3& entry,
                       const Scene& scene, const View& view, Payload payload);

/// Depths, mm along the view axis from the eye, that a kernel is cut to.
struct DepthRange {
    double near = 0;
    double far = 0;
};

/// The quantity a splat carries: lit colour (linear), z in mm (first component), signed distance to the edge in voxels
/// (first component, negative inside) or unit world normal. Depths are moved into `cut`.
glm::dvec3 payload_of(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                      const Settings& settings, Payload payload, const std::optional<DepthRange>& cut = {},
                      const Reach& reach = {});

/// The same where a ray p + z u (index space; p relative to the voxel centre) meets the face that cuts the kernel, or
/// of a plain kernel (also one that is `plain` for being widened, whose normal is still the face's) where it passes the
/// voxel: light falls on the surface there.
glm::dvec3 face_payload(const SplatRecord& record, const Field& field, const Scene& scene, const View& view,
                        const Settings& settings, Payload payload, const Footprints& footprints, const glm::dvec3& p,
                        const glm::dvec3& u, const Slice& slice = {}, bool plain = false);

/// Everything the sheets of a frame have in common. Referenced objects must outlive it.
class SplatDrawer {
  public:
    SplatDrawer(std::span<const SplatRecord> records, std::span<const Selected> selected, const Field& field,
                const Scene& scene, const View& view, const Settings& settings, const Footprints& footprints);

    /// Adds the splats (indices into the records) to `sheet`, one (sum of tau * quantity, sum of tau) per pixel.
    /// Pixels of `closed` that are non-zero are skipped; empty: none is. With `cut`, only what lies between.
    void draw(std::span<const std::uint32_t> splats, Payload payload, std::span<const char> closed,
              std::span<glm::dvec4> sheet, const std::optional<DepthRange>& cut = {}) const;

    /// Where the splats' outlines pass pixels that are open enough in `frame`: of each the outermost. `cut` as in
    /// draw().
    void outline(std::span<const std::uint32_t> splats, std::span<const glm::dvec4> frame,
                 std::span<std::optional<Outline>> outlines, const std::optional<DepthRange>& cut = {}) const;

    /// tau of one splat at the centre of pixel (x, y).
    double tau(std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut = {}) const;

  private:
    const glm::dvec4& ray_of(int x, int y) const;
    /// A splat as a ray meets it.
    struct MetSplat {
        SplatRecord record;
        bool matter = true;  ///< some of it is on the ray
    };
    MetSplat met(std::uint32_t splat, const glm::dvec3& p, const glm::dvec3& u) const;
    /// tau(), of what the ray of pixel (x, y) meets.
    double tau(const MetSplat& met, std::uint32_t splat, int x, int y, const std::optional<DepthRange>& cut) const;
    /// The splat's kernel along the ray of pixel (x, y), or along a piece of it, as wide as the pixel asks for; `edge`
    /// as the ray meets it.
    double footprint(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p, const glm::dvec3& u,
                     const std::optional<Slice>& slice) const;
    /// Where the ray passes the voxel's depth, voxels from p.
    double depth_on_ray(const glm::dvec3& p, const glm::dvec3& u) const;
    /// Whether the ray is in the splat's matter at z.
    bool in_matter(std::uint32_t splat, const VoxelEdge& edge, int x, int y, const glm::dvec3& p, const glm::dvec3& u,
                   double z) const;
    /// tau times the quantity, and tau; `own` is the splat's quantity where no cut shows.
    glm::dvec4 contribution(std::uint32_t splat, int x, int y, const glm::dvec3& own, Payload payload,
                            const std::optional<DepthRange>& cut) const;

    std::span<const SplatRecord> records_;
    std::span<const Selected> selected_;
    const Field& field_;
    const Scene& scene_;
    const View& view_;
    const Settings& settings_;
    const Footprints& footprints_;
    IndexClip clip_;
    std::vector<glm::dvec4> rays_;  ///< per pixel: unit direction in index space, mm per voxel along it
};

}  // namespace edgesplat::reference
