// Accuracy settings: each approximation is one knob with named steps, cheapest first.
#pragma once

#include <span>
#include <string_view>

namespace edgesplat {

struct Scene;

/// How the surface next to a voxel is found: not at all; by one step along the voxel's gradient; by Newton steps on the
/// trilinear field; by Newton steps on the cubic B-spline.
enum class EdgeEstimator { Off, Taylor, March, Cubic };
enum class FootprintMode { Isotropic, Warp2d, Procedural, Table };
/// How a kernel ends at an edge: warped at the edge plane as in the paper, or cut at a face.
enum class WarpFamily { Paper, Face };
enum class SheetCut { Whole, Sliced };  ///< a kernel lies in one sheet as a whole, or is cut at the sheets' planes
/// Buffer in which sheets are accumulated: layers of images, or registers, tile by tile.
enum class SheetFormat { Layers, Tiles };
/// How opaque matter is drawn: by kernels cut at faces, or by surface splats, which vote where a ray enters it.
enum class OpaqueMatter { Kernels, Surfaces };
/// Which pixels are drawn: in smooth regions only some, with the others interpolated; or all.
enum class PixelChoice { Refined, Every };

struct Settings {
    EdgeEstimator edges = EdgeEstimator::Cubic;
    FootprintMode footprints = FootprintMode::Procedural;
    WarpFamily warp = WarpFamily::Face;
    SheetCut sheets = SheetCut::Whole;
    double sheet_spacing = 0.25;  ///< voxels along the view axis, [0.05, 16]
    SheetFormat sheet_format = SheetFormat::Tiles;
    OpaqueMatter opaque = OpaqueMatter::Surfaces;
    PixelChoice pixels = PixelChoice::Refined;  ///< for tiles only
    double saturation = 0.999;                  ///< opacity at which a pixel is saturated, (0, 1]; 1: never
    double detail = 0;        ///< maximum voxel size of a coarser level in pixels, [0, 8]; 0: never coarser
    bool cull_buried = true;  ///< culls voxels that opaque voxels enclose
    bool operator==(const Settings&) const = default;
};

/// The value with this name as on the command line ("warp2d"); throws Error listing the names.
EdgeEstimator edge_estimator_named(std::string_view name);
FootprintMode footprint_mode_named(std::string_view name);
WarpFamily warp_family_named(std::string_view name);
SheetCut sheet_cut_named(std::string_view name);
SheetFormat sheet_format_named(std::string_view name);
OpaqueMatter opaque_matter_named(std::string_view name);
PixelChoice pixel_choice_named(std::string_view name);
std::string_view name_of(EdgeEstimator value);
std::string_view name_of(FootprintMode value);
std::string_view name_of(WarpFamily value);
std::string_view name_of(SheetCut value);
std::string_view name_of(SheetFormat value);
std::string_view name_of(OpaqueMatter value);
std::string_view name_of(PixelChoice value);
std::span<const std::string_view> edge_estimator_names();
std::span<const std::string_view> footprint_mode_names();
std::span<const std::string_view> warp_family_names();
std::span<const std::string_view> sheet_cut_names();
std::span<const std::string_view> sheet_format_names();
std::span<const std::string_view> opaque_matter_names();
std::span<const std::string_view> pixel_choice_names();

/// Whether kernels are modified at edges. Otherwise edges are not estimated and footprints are isotropic.
bool draws_warped(const Settings& settings);

/// Whether kernels are cut at faces: surfaces fitted as quadrics and lit at their intersections with rays.
bool draws_faces(const Settings& settings);

/// Maximum distance of an edge from its voxel that affects the voxel's kernel, voxels.
double edge_reach(const Settings& settings);

/// Maximum distance from its voxel at which a kernel is not 0, voxels.
double kernel_reach(const Settings& settings);

/// `base` with the paper's method: Taylor estimates, its own curve, 2-D warp.
Settings paper_settings(Settings base = {});

/// Whether footprints come from the table: whole kernels cut at plane faces.
bool draws_table(const Settings& settings);

/// Whether surface splats can draw with these settings: faces on the spline, and whole splats in tiles.
bool allows_surfaces(const Settings& settings);

/// Equivalent settings: settings without effect on the picture are reset to their defaults, and `footprints` is the
/// mode that is evaluated. Kernels cut at faces are integrated, except whole kernels from the table.
Settings canonical_settings(const Settings& settings);

/// The same for a scene: without iso-values there are no edges.
Settings canonical_settings(const Settings& settings, const Scene& scene);

/// Whether outlines are smoothed: only faces have outlines, and with several samples per pixel smoothing is not needed.
bool smooths_outlines(const Settings& settings, const Scene& scene);

/// Checks every range above. Throws Error naming the field, the value and the range.
void validate(const Settings& settings);

}  // namespace edgesplat
