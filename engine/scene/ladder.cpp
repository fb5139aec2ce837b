#include "engine/scene/ladder.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "engine/error.h"

namespace edgesplat {
namespace {

using View = std::string_view;

std::vector<View> all(std::span<const View> names) {
    return {names.begin(), names.end()};
}

template <auto Member>
std::string get_name(const Settings& s) {
    return std::string(name_of(s.*Member));
}

template <auto Member>
std::string get_number(const Settings& s) {
    return fmt::format("{}", s.*Member);
}

/// Parses the whole text as a number in the knob's range and sets it.
template <auto Member>
void set_number(Settings& s, const Knob& knob, View text) {
    View digits = text;
    if (digits.size() > 1 && digits.front() == '+') digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const bool whole = error == std::errc() && end == digits.data() + digits.size();
    if (!whole || !(knob.above_low ? value > knob.low : value >= knob.low) || !(value <= knob.high)) {
        fail("'{}' is not a number {} {} {} {}", text, knob.above_low ? "above" : "from", knob.low,
             knob.above_low ? "and at most" : "to", knob.high);
    }
    s.*Member = value;
}

std::vector<Knob> make_ladder() {
    std::vector<Knob> knobs;
    knobs.push_back({.name = "edges",
                     .help = "Edge estimator; off: conventional splatting, taylor: as in the paper",
                     .kind = KnobKind::Model,
                     .steps = {"off", "march", "cubic"},
                     .others = {"taylor"},
                     .get = get_name<&Settings::edges>,
                     .assign = [](Settings& s, const Knob&, View v) { s.edges = edge_estimator_named(v); }});
    knobs.push_back({.name = "warp",
                     .help = "How kernels end at edges: warped by the paper's curve, or cut at faces (quadrics fitted "
                             "to the surface, lit where rays intersect them)",
                     .kind = KnobKind::Model,
                     .steps = {"face"},
                     .others = {"paper"},
                     .get = get_name<&Settings::warp>,
                     .assign = [](Settings& s, const Knob&, View v) { s.warp = warp_family_named(v); },
                     .matters = draws_warped});
    knobs.push_back({.name = "footprints",
                     .help = "How footprints are evaluated at an edge: from a table of whole kernels cut at plane "
                             "faces, or integrated; warp2d is the paper's, for warp = paper",
                     .kind = KnobKind::Method,
                     .steps = {"isotropic", "table", "procedural"},
                     .others = {"warp2d"},
                     .get = get_name<&Settings::footprints>,
                     .assign = [](Settings& s, const Knob&, View v) { s.footprints = footprint_mode_named(v); },
                     .matters = [](const Settings& s) { return s.edges != EdgeEstimator::Off; }});
    knobs.push_back({.name = "sheets",
                     .help = "Whether a kernel lies in one sheet as a whole, or is cut at the planes between sheets",
                     .kind = KnobKind::Method,
                     .steps = all(sheet_cut_names()),
                     .others = {},
                     .get = get_name<&Settings::sheets>,
                     .assign = [](Settings& s, const Knob&, View v) { s.sheets = sheet_cut_named(v); }});
    knobs.push_back(
        {.name = "sheet-spacing",
         .help = "Distance between sheets in voxels; with whole kernels, more than 0.25 is neither better nor faster",
         .kind = KnobKind::Method,
         .steps = {"0.5", "0.25", "0.125"},
         .others = {},
         .from = [](Settings& s) { s.sheets = SheetCut::Sliced; },
         .number = true,
         .low = 0.05,
         .high = 16,
         .get = get_number<&Settings::sheet_spacing>,
         .assign = set_number<&Settings::sheet_spacing>});
    knobs.push_back({.name = "sheet-format",
                     .help = "Buffer in which sheets are accumulated: layers of images, or registers, tile by tile",
                     .kind = KnobKind::Method,
                     .steps = all(sheet_format_names()),
                     .others = {},
                     .get = get_name<&Settings::sheet_format>,
                     .assign = [](Settings& s, const Knob&, View v) { s.sheet_format = sheet_format_named(v); }});
    knobs.push_back({.name = "opaque",
                     .help =
                         "How opaque matter is drawn: by kernels cut at faces, or by surface splats that vote where "
                         "a ray enters it",
                     .kind = KnobKind::Model,
                     .steps = all(opaque_matter_names()),
                     .others = {},
                     .get = get_name<&Settings::opaque>,
                     .assign = [](Settings& s, const Knob&, View v) { s.opaque = opaque_matter_named(v); },
                     .matters = allows_surfaces});
    knobs.push_back({.name = "detail",
                     .help = "Maximum voxel size of a coarser level, in pixels; 0: never coarser",
                     .kind = KnobKind::Method,
                     .steps = {"2", "1", "0"},
                     .others = {},
                     .number = true,
                     .low = 0,
                     .high = 8,
                     .get = get_number<&Settings::detail>,
                     .assign = set_number<&Settings::detail>});
    knobs.push_back(
        {.name = "pixels",
         .help = "Which pixels are drawn: in smooth regions only some, with the others interpolated; or every one",
         .kind = KnobKind::Method,
         .steps = all(pixel_choice_names()),
         .others = {},
         .get = get_name<&Settings::pixels>,
         .assign = [](Settings& s, const Knob&, View v) { s.pixels = pixel_choice_named(v); }});
    knobs.push_back({.name = "saturation",
                     .help = "Opacity at which a pixel is saturated; 1: never",
                     .kind = KnobKind::Method,
                     .steps = {"0.999", "0.9999"},
                     .others = {},
                     .number = true,
                     .low = 0,
                     .high = 1,
                     .above_low = true,
                     .get = get_number<&Settings::saturation>,
                     .assign = set_number<&Settings::saturation>});
    return knobs;
}

template <typename Row>
const Row& row_named(View name, std::span<const Row> rows, const char* what) {
    std::string known;
    for (const Row& row : rows) {
        if (row.name == name) return row;
        known += (known.empty() ? "" : ", ") + std::string(row.name);
    }
    fail("unknown {} '{}', expected one of: {}", what, name, known);
}

}  // namespace

std::span<const Knob> ladder() {
    static const std::vector<Knob> knobs = make_ladder();
    return knobs;
}

const Knob& knob_named(View name) {
    return row_named(name, ladder(), "knob");
}

std::span<const Preset> presets() {
    static const std::vector<Preset> rows = [] {
        Settings draft;
        draft.edges = EdgeEstimator::March;
        Settings accurate;
        accurate.sheets = SheetCut::Sliced;
        accurate.sheet_spacing = 0.5;
        accurate.saturation = 0.9999;
        accurate.pixels = PixelChoice::Every;
        return std::vector<Preset>{{"draft", "edges by march: faster to estimate, as fast to draw", draft},
                                   {"accurate", "slices of half a voxel, every pixel drawn", accurate}};
    }();
    return rows;
}

const Preset& preset_named(View name) {
    return row_named(name, presets(), "preset");
}

std::string difference(const Settings& settings, const Settings& from) {
    std::string text;
    for (const Knob& knob : ladder()) {
        const std::string value = knob.get(settings);
        if (value != knob.get(from)) text += fmt::format("{}{}={}", text.empty() ? "" : " ", knob.name, value);
    }
    return text;
}

}  // namespace edgesplat
