#include "apps/edgesplat/scene_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "apps/edgesplat/option_values.h"
#include "engine/error.h"
#include "engine/scene/ladder.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"

namespace {

constexpr double kOpaquePerVoxel = 8;          ///< default extinction of the highest material
constexpr double kTranslucentPerVoxel = 0.15;  ///< and of those below it

/// Default colours, lowest iso-value first; linear light.
constexpr std::array<glm::dvec3, 6> kPalette{{{1.0, 0.85, 0.75},
                                              {0.45, 0.70, 1.0},
                                              {1.0, 0.72, 0.25},
                                              {0.50, 0.90, 0.50},
                                              {0.90, 0.50, 0.85},
                                              {0.95, 0.40, 0.30}}};

std::vector<double> default_iso_values(const SceneOptions& options, const edgesplat::Volume& volume) {
    if (options.threshold) return {0.5};
    if (edgesplat::is_builtin(volume.name)) {
        std::string name = volume.name.substr(volume.name.find(':') + 1);
        return edgesplat::analytic_scene(name.substr(0, name.find(':'))).iso_values;
    }
    const auto suggestions = edgesplat::suggest_iso_values(volume, 1);
    if (suggestions.empty())
        edgesplat::fail("{}: every voxel has the value {}, so there is no surface to show", volume.name,
                        volume.min_value);
    return {suggestions.front().value};
}

void check_iso_values(const std::vector<double>& iso, const edgesplat::Volume& volume) {
    const double low = volume.min_value;
    const double high = volume.max_value;
    for (const double value : iso)
        if (!(value > low && value <= high))
            edgesplat::fail("--iso {}: no surface has this value; the values of {} lie between {} and {}", value,
                            volume.name, volume.min_value, volume.max_value);
}

template <typename T>
void check_count(const char* option, const std::vector<T>& given, std::size_t expected) {
    if (!given.empty() && given.size() != expected)
        edgesplat::fail("{} is given {} times; expected once per iso-value, {} times", option, given.size(), expected);
}

edgesplat::Light parse_light(const std::string& text) {
    edgesplat::Light light;
    if (text == "headlight") return light;
    if (text == "none") {
        light.kind = edgesplat::Light::Kind::None;
        return light;
    }
    const std::optional<glm::dvec3> direction = parse_vector(text);
    if (!direction || glm::length(*direction) == 0)
        throw CLI::ValidationError(
            "--light", fmt::format("'{}' is not headlight, none or a direction X,Y,Z towards the light", text));
    light.kind = edgesplat::Light::Kind::Directional;
    light.direction = *direction;
    return light;
}

}  // namespace

void add_scene_options(CLI::App& command, SceneOptions& options) {
    constexpr const char* kGroup = "Scene";
    add_numbers(command, "--iso", options.iso, {},
                "A surface's value, in the volume's unit; repeatable. Default: a builtin's own, else the strongest "
                "suggestion of `info`")
        ->group(kGroup);
    add_vectors(command, "--color", options.color, "R,G,B", "Colour from that value up, linear 0..1; once per --iso")
        ->group(kGroup);
    add_numbers(command, "--extinction", options.extinction, {0},
                "Extinction from that value up, per mm; once per --iso. Default: 8 per voxel for the highest, 0.15 for "
                "those below")
        ->group(kGroup);
    add_vector(command, "--background", options.background, "R,G,B", "Linear 0..1; default 0,0,0")->group(kGroup);
    command
        .add_option_function<std::string>(
            "--light", [&options](const std::string& text) { options.light = parse_light(text); },
            "X,Y,Z points towards the light, world axes")
        ->type_name("headlight|none|X,Y,Z")
        ->default_str("headlight")
        ->group(kGroup);
    add_number(command, "--threshold", options.threshold, {},
               "First make the volume binary: 1 from this value up, else 0")
        ->group(kGroup);
    command.add_flag("--box-filter", options.box_filter, "First take the mean over 3x3x3 voxels (after --threshold)")
        ->group(kGroup);
}

void add_settings_options(CLI::App& command, edgesplat::Settings& s) {
    constexpr const char* kGroup = "Accuracy and cost (steps from cheap to accurate)";
    const auto assign = [](const std::string& option, const auto& work) {
        try {
            work();
        } catch (const edgesplat::Error& error) {
            throw CLI::ValidationError(option, error.what());
        }
    };
    std::string rows;
    for (const edgesplat::Preset& preset : edgesplat::presets())
        rows += (rows.empty() ? "" : "|") + std::string(preset.name);
    // The first of them, so that whatever the order on the command line a knob has the last word.
    command
        .add_option_function<std::string>(
            "--preset",
            [&s, assign](const std::string& name) {
                assign("--preset", [&] { s = edgesplat::preset_named(name).settings; });
            },
            "A row of the ladder; the options below change single steps of it")
        ->type_name(rows)
        ->group(kGroup);
    for (const edgesplat::Knob& knob : edgesplat::ladder()) {
        const std::string option = "--" + std::string(knob.name);
        std::string choices = knob.number ? "NUMBER" : "";
        for (const auto* names : {&knob.steps, &knob.others})
            for (const std::string_view name : *names)
                if (!knob.number) choices += (choices.empty() ? "" : "|") + std::string(name);
        command
            .add_option_function<std::string>(
                option,
                [&s, &knob, option, assign](const std::string& text) { assign(option, [&] { knob.set(s, text); }); },
                std::string(knob.help))
            ->type_name(choices)
            ->default_str(knob.get(edgesplat::Settings{}))
            ->group(kGroup);
    }
    command
        .add_flag_callback(
            "--keep-buried", [&s] { s.cull_buried = false; }, "Draw also voxels that opaque ones hide from every side")
        ->group(kGroup);
}

void preprocess(const SceneOptions& options, edgesplat::Volume& volume) {
    if (options.threshold) volume = edgesplat::threshold(volume, *options.threshold);
    if (options.box_filter) volume = edgesplat::box_filter(volume);
}

edgesplat::Scene scene_from_options(const SceneOptions& options, const edgesplat::Volume& volume) {
    const std::vector<double> iso = options.iso.empty() ? default_iso_values(options, volume) : options.iso;
    check_iso_values(iso, volume);
    check_count("--color", options.color, iso.size());
    check_count("--extinction", options.extinction, iso.size());

    std::vector<std::size_t> order(iso.size());  // of the options, by rising iso-value
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return iso[a] < iso[b]; });

    const glm::dvec3 spacing = volume.geometry.spacing();
    const double voxel = (spacing.x + spacing.y + spacing.z) / 3;
    edgesplat::Scene scene;
    scene.materials.push_back({glm::dvec3(0), 0});
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const std::size_t i = order[rank];
        const bool highest = rank + 1 == order.size();
        scene.iso_values.push_back(iso[i]);
        scene.materials.push_back({options.color.empty() ? kPalette[rank % kPalette.size()] : options.color[i],
                                   options.extinction.empty()
                                       ? (highest ? kOpaquePerVoxel : kTranslucentPerVoxel) / voxel
                                       : options.extinction[i]});
    }
    scene.light = options.light;
    scene.background = options.background.value_or(glm::dvec3(0));
    edgesplat::validate(scene);
    return scene;
}
