#include "engine/scene/settings.h"

#include <array>
#include <string>

#include "engine/error.h"
#include "engine/scene/scene.h"
#include "footprints/face.h"
#include "footprints/paper_warp.h"

namespace edgesplat {

namespace {

// In the order of the enums.
constexpr std::array<std::string_view, 4> kEdgeEstimators{"off", "taylor", "march", "cubic"};
constexpr std::array<std::string_view, 4> kFootprintModes{"isotropic", "warp2d", "procedural", "table"};
constexpr std::array<std::string_view, 2> kWarpFamilies{"paper", "face"};
constexpr std::array<std::string_view, 2> kSheetCuts{"whole", "sliced"};
constexpr std::array<std::string_view, 2> kSheetFormats{"layers", "tiles"};
constexpr std::array<std::string_view, 2> kOpaqueMatter{"kernels", "surfaces"};
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
SheetCut sheet_cut_named(std::string_view name) {
    return named<SheetCut>(name, "kind of sheets", kSheetCuts);
}
SheetFormat sheet_format_named(std::string_view name) {
    return named<SheetFormat>(name, "sheet format", kSheetFormats);
}
OpaqueMatter opaque_matter_named(std::string_view name) {
    return named<OpaqueMatter>(name, "way to draw opaque matter", kOpaqueMatter);
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
std::string_view name_of(SheetCut value) {
    return spelled(value, kSheetCuts);
}
std::string_view name_of(SheetFormat value) {
    return spelled(value, kSheetFormats);
}
std::string_view name_of(OpaqueMatter value) {
    return spelled(value, kOpaqueMatter);
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
std::span<const std::string_view> sheet_cut_names() {
    return kSheetCuts;
}
std::span<const std::string_view> sheet_format_names() {
    return kSheetFormats;
}
std::span<const std::string_view> opaque_matter_names() {
    return kOpaqueMatter;
}
std::span<const std::string_view> pixel_choice_names() {
    return kPixelChoices;
}

bool draws_warped(const Settings& settings) {
    return settings.edges != EdgeEstimator::Off && settings.footprints != FootprintMode::Isotropic;
}

bool draws_faces(const Settings& settings) {
    return draws_warped(settings) && settings.warp == WarpFamily::Face;
}

bool draws_table(const Settings& settings) {
    return settings.footprints == FootprintMode::Table && draws_faces(settings) && settings.sheets == SheetCut::Whole;
}

double edge_reach(const Settings& settings) {
    return settings.warp == WarpFamily::Face ? FACE_FARTHEST : kKernelRadius;
}

double kernel_reach(const Settings& settings) {
    if (!draws_warped(settings)) return kKernelRadius;
    return settings.warp == WarpFamily::Face ? FACE_FARTHEST : kPaperReach;
}

Settings paper_settings(Settings base) {
    base.edges = EdgeEstimator::Taylor;
    base.warp = WarpFamily::Paper;
    base.footprints = FootprintMode::Warp2d;
    return base;
}

bool allows_surfaces(const Settings& settings) {
    return draws_faces(settings) && settings.edges == EdgeEstimator::Cubic && !draws_table(settings) &&
           settings.sheets == SheetCut::Whole && settings.sheet_format == SheetFormat::Tiles;
}

Settings canonical_settings(const Settings& settings) {
    const Settings usual;
    Settings s = settings;
    if (!draws_warped(s)) {
        s.edges = EdgeEstimator::Off;
        s.footprints = FootprintMode::Isotropic;
        s.warp = usual.warp;
    }
    const bool short_cut = s.footprints == FootprintMode::Warp2d && s.warp == WarpFamily::Paper;
    if (draws_warped(s) && !short_cut && !draws_table(s)) s.footprints = FootprintMode::Procedural;
    if (s.sheet_format != SheetFormat::Tiles) s.pixels = usual.pixels;
    if (!allows_surfaces(s)) s.opaque = usual.opaque;
    return s;
}

Settings canonical_settings(const Settings& settings, const Scene& scene) {
    Settings s = settings;
    if (scene.iso_values.empty()) s.edges = EdgeEstimator::Off;
    return canonical_settings(s);
}

bool smooths_outlines(const Settings& settings, const Scene& scene) {
    return scene.effects.smooth_outlines && scene.effects.samples == 1 && draws_faces(settings);
}

void validate(const Settings& settings) {
    // Written so that NaN fails.
    const auto in = [](double v, double low, double high) { return v >= low && v <= high; };
    const double full = settings.saturation;
    check("sheet_spacing", settings.sheet_spacing, in(settings.sheet_spacing, 0.05, 16), "[0.05, 16] voxels");
    check("detail", settings.detail, in(settings.detail, 0, 8), "[0, 8] pixels");
    check("saturation", full, full > 0 && full <= 1, "(0, 1]");
}

}  // namespace edgesplat
