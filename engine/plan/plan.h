// Plans of passes: scene, camera and settings -> pipeline variants and parameters.
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

/// Whether splats need normals even without edges.
bool needs_normals(const Scene& scene);

/// SPEC_LABELS: how the volume's labels are drawn in the scene's colours.
std::uint32_t labels_drawn(const Scene& scene, const Volume& volume);

/// Scene::label_colors for the device.
std::vector<glm::vec3> label_colors(const Scene& scene);

/// The ray casters' light, the scene's first: 0 without lights, else 1 + Light::Kind.
std::uint32_t light_code(const Scene& scene);

/// Plan of passes 1 and 2 for one volume, scene and set of edge settings.
struct CollectionPlan {
    glm::ivec3 dims{0};
    EdgeEstimator estimator = EdgeEstimator::Cubic;
    bool blocks = false;     ///< one block of the volume is on the device at a time (engine/store/blocks.h)
    bool edge_field = true;  ///< edges are preserved, or lighting needs normals
    bool buried = true;      ///< some material is opaque enough to occlude: buried voxels are culled
    /// Skips edges of buried voxels. Only with one opaque material: then no buried voxel has an edge in reach of a
    /// visible one. With several, a visible voxel's face may be fitted to an edge between two buried ones.
    bool skip_buried = true;
    bool faces = false;       ///< edges are faces: estimated on both sides, with second derivatives stored per splat
    bool two_values = false;  ///< Volume::two_values; only with faces
    bool surfaces = false;    ///< only voxels beside a surface become splats, with faces that agree with the field
    /// Whether edges are estimated on the B-spline through the samples.
    bool takes_coefficients() const { return edge_field && estimator == EdgeEstimator::Cubic; }
    /// Whether passes 1b and 2 process a list of bricks (BrickRanges): if surfels are searched in the volume as a
    /// whole.
    bool lists_bricks() const {
        return !blocks && edge_field && (estimator == EdgeEstimator::Cubic || estimator == EdgeEstimator::March);
    }
    std::uint32_t labels = 0;  ///< SPEC_LABELS; every splat gets the label of its voxel (Volume::shown_labels)
    /// Clip planes; none unless `buried`. With `buried`, clipped voxels occlude nothing and are culled. Otherwise the
    /// splat list does not depend on the planes: they move without a new collection.
    passes::ClipCount clip{};
    std::vector<shader::TransferRow> transfer;  ///< TRANSFER_ROWS + 1; empty without a transfer function
    shader::SceneParams params{};               ///< addresses unset

    /// Whether both plans are equal: they produce the same splats, classified alike.
    bool operator==(const CollectionPlan& other) const;
};

/// What a plan must compute again, given the results of another one.
struct StaleResults {
    bool mask = true;   ///< the mask of buried voxels
    bool edges = true;  ///< the edge field
    bool lists = true;  ///< the splat lists; they depend on mask and edges
    /// The transfer function on the device. Passes that draw read it; the lists depend only on where it is above 0.
    bool transfer = true;
};

/// What `wanted` must compute again if the results of `held` exist.
StaleResults stale_results(const CollectionPlan& held, const CollectionPlan& wanted);

/// `keep_buried`: buried voxels stay, and kernels draw (the output is optical depth, or the eye is inside opaque matter
/// that kernels draw). `whole`: all matter, if the scene is the translucent part of a mixture, else null.
CollectionPlan plan_collection(const Volume& volume, const Scene& scene, const Settings& settings, bool keep_buried,
                               const Scene* whole = nullptr);

/// SceneParams::iso and the like: iso-values, scaled; beyond them +3e38.
void place_iso_values(const Volume& volume, std::span<const double> values, float (&iso)[16]);

/// Material of a scaled sample.
std::uint32_t material_of(std::span<const float> iso, float scaled);

/// The bit of a face of the volume's border: the low or high one along an axis.
constexpr std::uint32_t face_of_volume(int axis, bool high) {
    return 1U << (2 * axis + (high ? 1 : 0));
}

/// The faces where matter of the visible materials may lie, half a voxel beyond the outermost samples. To there the
/// field continues linearly.
std::uint32_t faces_with_matter(const Volume& volume, const shader::SceneParams& params);

/// The faces through which rays from `eye` (index space) may enter the volume; 0 if the eye is in it.
std::uint32_t faces_in_sight(const glm::ivec3& dims, const glm::dvec3& eye);

/// Whether the voxel nearest to the eye is of an opaque material and not clipped. Buried voxels are then visible.
bool eye_in_opaque(const Volume& volume, const Scene& scene, const Camera& camera);

/// Thickness of a picture's sheets along the view direction, mm.
double sheet_thickness(const VolumeGeometry& geometry, const Camera& camera, const Settings& settings);

/// Where splats lie along the view axis, mm from the eye.
struct SplatDepths {
    double nearest = 0, farthest = 0;  ///< of their voxels; in sliced views of their kernels
    double anchor = 0;                 ///< VolumeParams::anchor
    double reach = 0;                  ///< how far a kernel reaches from its voxel
    double thickness = 0;              ///< of a sheet
    /// The thinnest sheets that a picture of these depths can have.
    double least_thickness() const;
};

/// Plan of passes 3 to 7 for one picture.
struct FramePlan {
    passes::DrawVariant variant{};
    bool gradient = false;                       ///< the background has two colours
    bool wide_marks = false;                     ///< a mark covers 4 x 2 pixels (4_mark_pixels)
    bool refined = false;                        ///< some pixels are drawn, others interpolated (5_refine_pixels)
    bool may_refine = false;                     ///< `refined` before the splats' sizes are known
    bool first = true;                           ///< of the parts of a picture that are drawn one after another
    std::uint32_t sheets_per_splat = 1;          ///< upper bound of a splat's entries in the sorted order
    std::uint32_t sort_segments = 1;             ///< number of segments of each of the sort's blocks
    double reach = 0;                            ///< farthest reach of any kernel, voxels
    std::vector<std::uint32_t> bricks;           ///< numbers of the bricks in view; empty without culling
    std::vector<glm::vec3> label_colors;         ///< FrameParams::label_colors; empty without labels
    std::vector<glm::uvec2> batches;             ///< FrameParams::batches; empty without culling
    std::uint64_t splats_examined = 0;           ///< splats examined
    shader::FrameParams params{};                ///< addresses unset
    shader::VolumeParams volume{};               ///< likewise
    std::vector<shader::VolumeParams> together;  ///< other volumes whose kernels are drawn with these (plan_together)
    SplatDepths depths;
};

/// Restricts the picture to the first `splats` of the list and turns brick culling off.
void draw_first(FramePlan& plan, std::uint32_t splats);

/// Culls the splats of bricks out of view; no-op unless sheets are summed tile by tile.
void cull_bricks(FramePlan& plan, const SplatBricks& bricks, const ViewVolume& view);

/// Restricts the picture to the splats of these bricks (ascending numbers), unless their batches cover the whole list.
void draw_bricks(FramePlan& plan, const SplatBricks& bricks, std::span<const std::uint32_t> numbers);

/// Restricts the picture to batches of splats: the first number of each, and how many, at most SPLAT_BATCH.
void draw_batches(FramePlan& plan, std::vector<glm::uvec2> batches);

/// Number, bounding box and kinds of a list's splats.
struct SplatExtent {
    std::uint64_t count = 0;
    glm::ivec3 low{0}, high{0};  ///< inclusive bounding box of their voxels
    bool creases = true;         ///< some may have a crease: a plane beside their face
    bool traced = true;          ///< some may have a face that rays must find
    bool surfaces = false;       ///< they are surface splats
    std::uint32_t border = ~0U;  ///< faces_with_matter
};

/// Throws Error if the view has more sheets than the sort allows. `farthest_reach`: upper bound of the kernels' reach,
/// voxels. `refines`: whether pixels may be interpolated on this device.
FramePlan plan_frame(const Volume& volume, const Scene& scene, const Camera& camera, const Settings& settings,
                     const glm::ivec2& size, std::uint32_t payload, const SplatExtent& splats,
                     double farthest_reach = 0, bool refines = true);

/// Divides the picture's depths into sheets, from FramePlan::depths and the picture's size. Throws Error likewise.
void place_sheets(FramePlan& plan);

/// Writes a scene's clip planes in the shaders' form, relative to the index-space point `origin`.
passes::ClipCount place_clip(const Clip& clip, const VolumeGeometry& geometry, const glm::dvec3& origin,
                             glm::vec4 (&keep)[shader::MAX_CLIP_PLANES], glm::vec4 (&remove)[shader::MAX_CLIP_PLANES]);

/// The plan of kernels of several volumes as one list, each volume's from its own plan. `plans`: from one camera, with
/// one payload; 2 to MAX_TOGETHER. Their splats are numbered one after another.
FramePlan plan_together(std::span<const FramePlan> plans);

/// Shifts the rays of a plan: pixel (x, y) gets the ray through (x + offset.x, y + offset.y), in pixels.
void shift_rays(FramePlan& plan, const glm::dvec2& offset);

}  // namespace edgesplat
