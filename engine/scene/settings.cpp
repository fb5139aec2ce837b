#include "engine/scene/settings.h"

#include <algorithm>
#include <array>
#include <string>

#include "engine/error.h"
#include "engine/scene/scene.h"
#include "footprints/face.h"

namespace edgesplat {

namespace {

// In the order of the enums, which is from cheapest to best.
constexpr std::array<std::string_view, 5> kEdgeEstimators{"off", "taylor", "quadratic", "march", "cubic"};
constexpr std::array<std::string_view, 5> kFootprintModes{"isotropic", "warp2d", "table", "table-lerp", "procedural"};
constexpr std::array<std::string_view, 3> kWarpFamilies{"edge", "paper", "face"};
constexpr std::array<std::string_view, 2> kEdgeShapes{"plane", "curved"};
constexpr std::array<std::string_view, 3> kNormalisations{"off", "edge", "voxel"};
constexpr std::array<std::string_view, 3> kTableSizes{"coarse", "medium", "fine"};
constexpr std::array<std::string_view, 2> kSheetCuts{"whole", "sliced"};
constexpr std::array<std::string_view, 3> kSheetFormats{"half", "float", "tiles"};
constexpr std::array<std::string_view, 2> kPixelChoices{"refined", "every"};

template <typename Enum>
Enum named(std::string_view name, const char* what, std::span<const std::string_view> names) {
    std::string known;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i] == name) return static_cast<Enum>(i);
        known += (i == 0 ? "" : ", ") + std::string(names[i]);
    }
    fail("unknown {} '{}', expected one of: {}", what, name, known);
}

template <typename Enum>
std::string_view spelled(Enum value, std::span<const std::string_view> names) {
    return names[static_cast<std::size_t>(value)];
}

void check(const char* field, double value, bool in_range, const char* range) {
    if (!in_range) fail("settings {}: {} is outside {}", field, value, range);
}

}  // namespace

EdgeEstimator edge_estimator_named(std::string_view name) {
    return named<EdgeEstimator>(name, "edge estimator", kEdgeEstimators);
}
FootprintMode footprint_mode_named(std::string_view name) {
    return named<FootprintMode>(name, "footprint mode", kFootprintModes);
}
WarpFamily warp_family_named(std::string_view name) {
    return named<WarpFamily>(name, "warp family", kWarpFamilies);
}
EdgeShape edge_shape_named(std::string_view name) {
    return named<EdgeShape>(name, "edge shape", kEdgeShapes);
}
Normalisation normalisation_named(std::string_view name) {
    return named<Normalisation>(name, "normalisation", kNormalisations);
}
TableSize table_size_named(std::string_view name) {
    return named<TableSize>(name, "table size", kTableSizes);
}
SheetCut sheet_cut_named(std::string_view name) {
    return named<SheetCut>(name, "kind of sheets", kSheetCuts);
}
SheetFormat sheet_format_named(std::string_view name) {
    return named<SheetFormat>(name, "sheet format", kSheetFormats);
}
PixelChoice pixel_choice_named(std::string_view name) {
    return named<PixelChoice>(name, "choice of pixels", kPixelChoices);
}

std::string_view name_of(EdgeEstimator value) {
    return spelled(value, kEdgeEstimators);
}
std::string_view name_of(FootprintMode value) {
    return spelled(value, kFootprintModes);
}
std::string_view name_of(WarpFamily value) {
    return spelled(value, kWarpFamilies);
}
std::string_view name_of(EdgeShape value) {
    return spelled(value, kEdgeShapes);
}
std::string_view name_of(Normalisation value) {
    return spelled(value, kNormalisations);
}
std::string_view name_of(TableSize value) {
    return spelled(value, kTableSizes);
}
std::string_view name_of(SheetCut value) {
    return spelled(value, kSheetCuts);
}
std::string_view name_of(SheetFormat value) {
    return spelled(value, kSheetFormats);
}
std::string_view name_of(PixelChoice value) {
    return spelled(value, kPixelChoices);
}

std::span<const std::string_view> edge_estimator_names() {
    return kEdgeEstimators;
}
std::span<const std::string_view> footprint_mode_names() {
    return kFootprintModes;
}
std::span<const std::string_view> warp_family_names() {
    return kWarpFamilies;
}
std::span<const std::string_view> edge_shape_names() {
    return kEdgeShapes;
}
std::span<const std::string_view> normalisation_names() {
    return kNormalisations;
}
std::span<const std::string_view> table_size_names() {
    return kTableSizes;
}
std::span<const std::string_view> sheet_cut_names() {
    return kSheetCuts;
}
std::span<const std::string_view> sheet_format_names() {
    return kSheetFormats;
}
std::span<const std::string_view> pixel_choice_names() {
    return kPixelChoices;
}
std::span<const std::string_view> accumulation_names() {
    return std::span(kSheetFormats).first(2);
}

bool draws_warped(const Settings& settings) {
    return settings.edges != EdgeEstimator::Off && settings.footprints != FootprintMode::Isotropic;
}

bool draws_faces(const Settings& settings) {
    return draws_warped(settings) && settings.warp == WarpFamily::Face;
}

double edge_reach(const Settings& settings) {
    return kKernelRadius + (settings.warp == WarpFamily::Face ? kFaceDepth : settings.edge_half_width);
}

bool asks_for_table(const Settings& settings) {
    return settings.footprints == FootprintMode::Table || settings.footprints == FootprintMode::TableLerp;
}

double most_curved(const Settings& settings) {
    return std::min(0.5, 0.9 / settings.edge_half_width);
}

Settings papers_own(Settings base) {
    base.edges = EdgeEstimator::Taylor;
    base.warp = WarpFamily::Paper;
    base.footprints = FootprintMode::Warp2d;
    base.edge_shape = EdgeShape::Plane;
    return base;
}

Settings drawn_as(const Settings& settings, bool clipped) {
    const Settings usual;
    Settings s = settings;
    if (!draws_warped(s)) {
        s.edges = EdgeEstimator::Off;
        s.footprints = FootprintMode::Isotropic;
        s.warp = usual.warp;
    }
    const bool edge_family = s.edges != EdgeEstimator::Off && s.warp == WarpFamily::Edge;
    if (!edge_family) {
        s.edge_half_width = usual.edge_half_width;
        s.edge_strength = usual.edge_strength;
        s.edge_shape = EdgeShape::Plane;
        s.normalisation = usual.normalisation;
    }
    if (draws_faces(s)) s.footprints = FootprintMode::Procedural;
    if (s.footprints == FootprintMode::Warp2d) s.edge_shape = EdgeShape::Plane;
    // Kernels of curved edges sum to one as they are; one side alone is another matter.
    if (s.edge_shape == EdgeShape::Curved && s.normalisation == Normalisation::Voxel)
        s.normalisation = Normalisation::Off;
    if (asks_for_table(s) &&
        (!edge_family || clipped || s.sheets == SheetCut::Sliced || s.edge_shape == EdgeShape::Curved)) {
        s.footprints = FootprintMode::Procedural;
    }
    if (!asks_for_table(s)) s.table_size = usual.table_size;
    if (s.sheet_format != SheetFormat::Tiles) s.pixels = usual.pixels;
    // Registers hold floats.
    if (s.sheet_format == SheetFormat::Tiles) s.accumulation = usual.accumulation;
    return s;
}

Settings drawn_as(const Settings& settings, const Scene& scene) {
    Settings s = settings;
    if (scene.iso_values.empty()) s.edges = EdgeEstimator::Off;
    return drawn_as(s, !scene.effects.clip.empty());
}

void validate(const Settings& settings) {
    // Comparisons are written so that NaN fails them.
    const auto in = [](double v, double low, double high) { return v >= low && v <= high; };
    const double a = settings.edge_half_width;
    const double full = settings.saturation;
    check("edge_half_width", a, a > 0 && a <= 3, "(0, 3] voxels");
    check("edge_strength", settings.edge_strength, in(settings.edge_strength, 1, 64), "[1, 64]");
    check("sheet_spacing", settings.sheet_spacing, in(settings.sheet_spacing, 0.05, 16), "[0.05, 16] voxels");
    check("detail", settings.detail, in(settings.detail, 0, 8), "[0, 8] pixels");
    check("saturation", full, full > 0 && full <= 1, "(0, 1]");
    if (settings.accumulation == SheetFormat::Tiles) fail("accumulation: tiles, expected half or float");
}

}  // namespace edgesplat
