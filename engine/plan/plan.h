// From scene, camera and settings to what must run: the numbers every pass is given.
#pragma once

#include "engine/culling/bricks.h"
#include "engine/passes/5_draw_splats.h"
#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/scene/settings.h"
#include "shaders/drivers/iterations.h"
#include "shaders/shared/frame_params.h"
#include "shaders/shared/transfer_rows.h"

namespace edgesplat {

/// Whether splats need normals, whatever becomes of edges.
bool wants_normals(const Scene& scene);

/// The one light that the ray casters know: 0 without light, else 1 + Light::Kind.
std::uint32_t light_code(const Scene& scene);

/// Passes 1 and 2 for one volume, scene and set of edge settings.
struct CollectionPlan {
    glm::ivec3 dims{0};
    EdgeEstimator estimator = EdgeEstimator::Cubic;
    bool blocks = false;     ///< the device holds a block of the volume at a time (engine/store/blocks.h)
    bool edge_field = true;  ///< edges are preserved, or a light wants normals
    bool buried = true;      ///< some material is opaque enough to hide what lies behind it
    /// Buried voxels need no edge. With one opaque material they have none in reach either; with several, a visible
    /// voxel's face may be fitted to what two of them share.
    bool skip_buried = true;
    bool faces = false;  ///< edges are faces, found on both sides, and splats carry their second derivatives
    /// Whether edges are found with the spline through the samples.
    bool takes_coefficients() const { return edge_field && estimator == EdgeEstimator::Cubic; }
    /// Where something is buried, what is cut away hides nothing and is dropped. Elsewhere the splat list does not
    /// depend on the planes: they move without a new collection.
    passes::ClipCount clip{};
    std::vector<shader::TransferRow> transfer;  ///< TRANSFER_ROWS + 1; empty without a transfer function
    shader::SceneParams params{};               ///< without addresses

    /// Whether the same splats come out of it.
    bool operator==(const CollectionPlan& other) const;
};

/// `keep_buried`: nothing may be dropped (optical depth is asked for, or the eye is inside opaque matter).
CollectionPlan plan_collection(const Volume& volume, const Scene& scene, const Settings& settings, bool keep_buried);

/// Whether the voxel nearest to the eye belongs to an opaque material and the eye is not in what is cut away: what is
/// buried from outside is in front of it.
bool eye_in_opaque(const Volume& volume, const Scene& scene, const Camera& camera);

/// Of a picture's sheets along the view, mm.
double sheet_thickness(const VolumeGeometry& geometry, const Camera& camera, const Settings& settings);

/// Passes 3 to 7 for one picture.
struct FramePlan {
    passes::DrawVariant variant{};
    bool gradient = false;               ///< colour over a background of two colours
    bool wide_marks = false;             ///< of tiles' entries, for 4 x 2 pixels at once (4_mark_pixels)
    bool refined = false;                ///< some pixels are drawn, others follow (5_refine_pixels)
    bool may_refine = false;             ///< `refined` before the splats' sizes were known
    std::uint32_t sheets_per_splat = 1;  ///< at most: entries of the sorted order
    std::uint32_t sort_segments = 1;     ///< into which the sort's blocks are divided
    double reach = 0;                    ///< no kernel reaches further, voxels
    std::vector<std::uint32_t> bricks;   ///< numbers of those in view, where bricks are culled
    std::vector<glm::uvec2> batches;     ///< FrameParams::batches, likewise
    std::uint64_t looked_at = 0;         ///< splats that were gone through, and are
    shader::FrameParams params{};        ///< without addresses
};

/// The picture is then of the first `splats` of the list alone, none of its bricks being culled.
void draw_first(FramePlan& plan, std::uint32_t splats);

/// Leaves out what no brick in view holds, if that is something and sheets are summed tile by tile.
void cull_bricks(FramePlan& plan, const SplatBricks& bricks, const ViewVolume& view);

/// The picture is then of the splats of these bricks, which ascend, if those are fewer than all.
void draw_bricks(FramePlan& plan, const SplatBricks& bricks, std::span<const std::uint32_t> numbers);

/// The splats of a list.
struct SplatExtent {
    std::uint64_t count = 0;
    glm::ivec3 low{0}, high{0};  ///< inclusive box of voxels that holds them
    bool creases = true;         ///< some may have a plane beside their face
    bool traced = true;          ///< of some rays may have to find it
};

/// Throws Error when the scene has more sheets than the sort can hold. No kernel reaches further than `farthest_reach`
/// voxels. `refines`: whether the device may draw some pixels first.
FramePlan plan_frame(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                     const glm::ivec2& size, std::uint32_t payload, const SplatExtent& splats,
                     double farthest_reach = 0, bool refines = true);

/// Writes a scene's planes, counted from the index-space point `origin`, as the shaders have them.
passes::ClipCount place_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin,
                             glm::vec4 (&keep)[shader::MAX_CLIP_PLANES], glm::vec4 (&remove)[shader::MAX_CLIP_PLANES]);

/// Moves the rays of a plan: pixel (x, y) is then of the ray through (x + offset.x, y + offset.y), in pixels.
void shift_rays(FramePlan& plan, const glm::dvec2& offset);

}  // namespace edgesplat
