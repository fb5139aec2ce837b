// How accurately, and at what price: each approximation is one knob with named steps, cheapest first.
#pragma once

#include <span>
#include <string_view>

namespace edgesplat {

struct Scene;

enum class EdgeEstimator { Off, Taylor, Quadratic, March, Cubic };
/// Whether edges are walked to: then voxels without one adopt a neighbour's, and splats are smoothed along the surface.
constexpr bool marches(EdgeEstimator estimator) {
    return estimator == EdgeEstimator::March || estimator == EdgeEstimator::Cubic;
}
enum class FootprintMode { Isotropic, Warp2d, Table, TableLerp, Procedural };
/// How a kernel ends at an edge: cut at a face, or warped in a band around a plane, by the distance to it or as in the
/// paper.
enum class WarpFamily { Edge, Paper, Face };
enum class EdgeShape { Plane, Curved };  ///< what an edge is within a kernel's reach: its tangent plane or a sphere
/// How kernels are weighted: not at all, by their distance to the edge so that each of its sides has its volume, or so
/// that they sum to one at each voxel.
enum class Normalisation { Off, Edge, Voxel };
enum class TableSize { Coarse, Medium, Fine };
enum class SheetCut { Whole, Sliced };  ///< a kernel lies in one sheet whole, or is cut at the sheets' planes
/// Where sheets are summed: in layers of 16 or 32 bit a channel, or in registers, tile of pixels by tile.
enum class SheetFormat { Half, Float, Tiles };
/// Which pixels are drawn: where a picture is smooth some, between which the others follow, or every one.
enum class PixelChoice { Refined, Every };

struct Settings {
    EdgeEstimator edges = EdgeEstimator::March;
    FootprintMode footprints = FootprintMode::Procedural;
    WarpFamily warp = WarpFamily::Edge;
    double edge_half_width = 1.6;  ///< a, voxels, (0, 3]
    double edge_strength = 16;     ///< k, slope of the warp at the edge, [1, 64]; 1 is no warp
    EdgeShape edge_shape = EdgeShape::Plane;
    Normalisation normalisation = Normalisation::Off;
    TableSize table_size = TableSize::Medium;  ///< footprints `table` and `table-lerp`
    SheetCut sheets = SheetCut::Whole;
    double sheet_spacing = 0.25;  ///< voxels along the view axis, [0.05, 16]
    SheetFormat sheet_format = SheetFormat::Tiles;
    SheetFormat accumulation = SheetFormat::Float;  ///< of the picture that layers are composited into; not Tiles
    PixelChoice pixels = PixelChoice::Refined;      ///< of sheets that are summed tile by tile
    double saturation = 0.999;  ///< opacity at which a pixel takes no more splats, (0, 1]; 1 = never
    double detail = 0;          ///< pixels that voxels of a coarser level may be wide, [0, 8]; 0: never coarser
    bool cull_buried = true;    ///< drop voxels that opaque ones hide from every side
    bool operator==(const Settings&) const = default;
};

/// The estimator, mode, ... of a name as the command line spells it ("table-lerp"); throws Error listing the names.
EdgeEstimator edge_estimator_named(std::string_view name);
FootprintMode footprint_mode_named(std::string_view name);
WarpFamily warp_family_named(std::string_view name);
EdgeShape edge_shape_named(std::string_view name);
Normalisation normalisation_named(std::string_view name);
TableSize table_size_named(std::string_view name);
SheetCut sheet_cut_named(std::string_view name);
SheetFormat sheet_format_named(std::string_view name);
PixelChoice pixel_choice_named(std::string_view name);
std::string_view name_of(EdgeEstimator value);
std::string_view name_of(FootprintMode value);
std::string_view name_of(WarpFamily value);
std::string_view name_of(EdgeShape value);
std::string_view name_of(Normalisation value);
std::string_view name_of(TableSize value);
std::string_view name_of(SheetCut value);
std::string_view name_of(SheetFormat value);
std::string_view name_of(PixelChoice value);
std::span<const std::string_view> edge_estimator_names();
std::span<const std::string_view> footprint_mode_names();
std::span<const std::string_view> warp_family_names();
std::span<const std::string_view> edge_shape_names();
std::span<const std::string_view> normalisation_names();
std::span<const std::string_view> table_size_names();
std::span<const std::string_view> sheet_cut_names();
std::span<const std::string_view> sheet_format_names();
std::span<const std::string_view> pixel_choice_names();
std::span<const std::string_view> accumulation_names();

/// Whether any kernel is warped: otherwise edges are not estimated and footprints are the plain ones.
bool draws_warped(const Settings& settings);

/// Whether kernels are cut at faces: surfaces are found as quadrics, and light falls where rays meet them.
bool draws_faces(const Settings& settings);

/// How far from its voxel an edge may be and still matter to its kernel, voxels.
double edge_reach(const Settings& settings);

/// Whether footprints are asked for from a table. `drawn_as` says whether they are taken from it.
bool asks_for_table(const Settings& settings);

/// The largest curvature that is drawn, 1/voxel: the band must not reach a sphere's centre.
double most_curved(const Settings& settings);

/// What the paper did, where `base` says nothing else: Taylor estimates, its own curve, warped in two dimensions.
Settings papers_own(Settings base = {});

/// The same picture with every knob that has no say in it at its default, and with the footprints that are really
/// evaluated: tables hold whole footprints of plane edges of the family `edge`; what is sliced, curved or of the
/// paper's family is integrated, and so is everything where `clipped`: the scene has clip planes.
Settings drawn_as(const Settings& settings, bool clipped = false);

/// Likewise for a scene: without iso-values there are no edges.
Settings drawn_as(const Settings& settings, const Scene& scene);

/// Checks every range above. Throws Error naming the field, the value and the range.
void validate(const Settings& settings);

}  // namespace edgesplat
