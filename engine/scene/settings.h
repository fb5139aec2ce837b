// How accurately, and at what price: each approximation is one knob with named steps, cheapest first.
#pragma once

#include <span>
#include <string_view>

namespace edgesplat {

struct Scene;

/// Where the surface next to a voxel is: nowhere, a step along the voxel's own gradient away, or found by going there
/// on the trilinear field or on the cubic B-spline.
enum class EdgeEstimator { Off, Taylor, March, Cubic };
enum class FootprintMode { Isotropic, Warp2d, Procedural, Table };
/// How a kernel ends at an edge: warped around its plane as in the paper, or cut at a face.
enum class WarpFamily { Paper, Face };
enum class SheetCut { Whole, Sliced };  ///< a kernel lies in one sheet whole, or is cut at the sheets' planes
/// Where sheets are summed: in layers of images, or in registers, tile of pixels by tile.
enum class SheetFormat { Layers, Tiles };
/// Which pixels are drawn: where a picture is smooth some, between which the others follow, or every one.
enum class PixelChoice { Refined, Every };

struct Settings {
    EdgeEstimator edges = EdgeEstimator::Cubic;
    FootprintMode footprints = FootprintMode::Procedural;
    WarpFamily warp = WarpFamily::Face;
    SheetCut sheets = SheetCut::Whole;
    double sheet_spacing = 0.25;  ///< voxels along the view axis, [0.05, 16]
    SheetFormat sheet_format = SheetFormat::Tiles;
    PixelChoice pixels = PixelChoice::Refined;  ///< of sheets that are summed tile by tile
    double saturation = 0.999;                  ///< opacity at which a pixel takes no more splats, (0, 1]; 1 = never
    double detail = 0;        ///< pixels that voxels of a coarser level may be wide, [0, 8]; 0: never coarser
    bool cull_buried = true;  ///< drop voxels that opaque ones hide from every side
    bool operator==(const Settings&) const = default;
};

/// The estimator, mode, ... of a name as the command line spells it ("warp2d"); throws Error listing the names.
EdgeEstimator edge_estimator_named(std::string_view name);
FootprintMode footprint_mode_named(std::string_view name);
WarpFamily warp_family_named(std::string_view name);
SheetCut sheet_cut_named(std::string_view name);
SheetFormat sheet_format_named(std::string_view name);
PixelChoice pixel_choice_named(std::string_view name);
std::string_view name_of(EdgeEstimator value);
std::string_view name_of(FootprintMode value);
std::string_view name_of(WarpFamily value);
std::string_view name_of(SheetCut value);
std::string_view name_of(SheetFormat value);
std::string_view name_of(PixelChoice value);
std::span<const std::string_view> edge_estimator_names();
std::span<const std::string_view> footprint_mode_names();
std::span<const std::string_view> warp_family_names();
std::span<const std::string_view> sheet_cut_names();
std::span<const std::string_view> sheet_format_names();
std::span<const std::string_view> pixel_choice_names();

/// Whether any kernel is warped: otherwise edges are not estimated and footprints are the plain ones.
bool draws_warped(const Settings& settings);

/// Whether kernels are cut at faces: surfaces are found as quadrics, and light falls where rays meet them.
bool draws_faces(const Settings& settings);

/// How far from its voxel an edge may be and still matter to its kernel, voxels.
double edge_reach(const Settings& settings);

/// How far from its voxel a kernel can be anything but 0, voxels.
double kernel_reach(const Settings& settings);

/// What the paper did, where `base` says nothing else: Taylor estimates, its own curve, warped in two dimensions.
Settings papers_own(Settings base = {});

/// Whether footprints come from a table: of kernels that a plane face cuts, whole ones.
bool draws_table(const Settings& settings);

/// The same picture with every knob that has no say in it at its default, and with the footprints that are really
/// evaluated: what a face cuts is integrated, but for whole kernels from a table.
Settings drawn_as(const Settings& settings);

/// Likewise for a scene: without iso-values there are no edges.
Settings drawn_as(const Settings& settings, const Scene& scene);

/// Whether pixels that outlines pass show both sides: with several samples they do so anyway, and only faces know.
bool smooths_outlines(const Settings& settings, const Scene& scene);

/// Checks every range above. Throws Error naming the field, the value and the range.
void validate(const Settings& settings);

}  // namespace edgesplat
