#include "apps/edgesplat/scene_options.h"

#include <fmt/format.h>

#include "apps/edgesplat/option_values.h"
#include "engine/error.h"
#include "engine/scene/label_fade.h"
#include "engine/scene/ladder.h"
#include "engine/scene/scene_presets.h"

namespace {

using edgesplat::SceneDocument;

std::vector<edgesplat::Light> parse_light(const std::string& text) {
    if (text == "headlight") return {edgesplat::Light{}};
    if (text == "none") return {};
    const std::optional<glm::dvec3> direction = parse_vector(text);
    if (!direction || glm::length(*direction) == 0)
        throw CLI::ValidationError(
            "--light", fmt::format("'{}' is not headlight, none or a direction X,Y,Z towards the light", text));
    return {edgesplat::directional_light(*direction)};
}

/// Resizes the materials to `given` entries, one per iso-value. Throws edgesplat::Error if the document has another
/// number of iso-values or materials; if it has none, the number is checked once the volume is known.
std::vector<edgesplat::MaterialChoice>& materials_for(SceneDocument& document, const char* option, std::size_t given) {
    const std::size_t expected = document.iso_values.empty() ? document.materials.size() : document.iso_values.size();
    if (expected > 0 && given != expected)
        edgesplat::fail("{} is given {} times; expected once per iso-value, {} times", option, given, expected);
    document.materials.resize(given);
    return document.materials;
}

}  // namespace

void add_scene_options(CLI::App& command, DocumentEdits& edits) {
    constexpr const char* kGroup = "Scene";
    const auto add_each = [&](const char* option, const char* type, const char* help, const auto& read,
                              const auto& set) {
        command
            .add_option_function<std::vector<std::string>>(
                option,
                [&edits, option, read, set](const std::vector<std::string>& texts) {
                    std::vector<decltype(read(std::string(), std::string()))> values;
                    for (const std::string& text : texts)
                        values.push_back(read(option, text));
                    edits.add([option, values, set](SceneDocument& document) {
                        auto& materials = materials_for(document, option, values.size());
                        for (std::size_t i = 0; i < values.size(); ++i)
                            set(materials[i], values[i]);
                    });
                },
                help)
            ->type_name(type)
            ->allow_extra_args(false)
            ->group(kGroup);
        return command.get_option(option);
    };
    const auto add_named = [&](const char* option, const char* help, const auto& use) {
        command
            .add_option_function<std::string>(
                option,
                [&edits, option, use](const std::string& name) {
                    try {
                        SceneDocument scratch;
                        use(scratch, name);
                    } catch (const edgesplat::Error& error) {
                        throw CLI::ValidationError(option, error.what());
                    }
                    edits.add([name, use](SceneDocument& document) { use(document, name); });
                },
                help)
            ->type_name("NAME")
            ->group(kGroup);
    };
    // Added first, so that the other options override it in any order of the command line.
    add_named(
        "--look",
        "Preset of surfaces, colours and light, by name (`edgesplat scene presets`); the options below override it",
        [](SceneDocument& document, const std::string& name) { edgesplat::apply_look(document, name); });
    add_named("--transfer", "Transfer function by name (`edgesplat scene presets`), instead of materials",
              [](SceneDocument& document, const std::string& name) {
                  const edgesplat::ScenePreset preset = edgesplat::scene_preset(name);
                  if (!preset.is_transfer()) edgesplat::fail("\"{}\" is not a transfer function; use --look", name);
                  document.transfer_preset = name;
                  document.transfer.clear();
                  document.iso_values.clear();
                  document.iso_sigmas.clear();
                  document.materials.clear();
              });
    command
        .add_option_function<std::vector<std::string>>(
            "--iso",
            [&edits](const std::vector<std::string>& texts) {
                std::vector<double> values;
                for (const std::string& text : texts)
                    values.push_back(read_number("--iso", text, {}));
                edits.add([values](SceneDocument& document) {
                    // The scene's materials do not fit another number of surfaces.
                    if (values.size() != document.materials.size()) document.materials.clear();
                    document.iso_values = values;
                    document.iso_sigmas.clear();
                });
            },
            "Iso-value of a surface, in the volume's unit; repeatable. Default: a builtin volume's own, otherwise the "
            "first suggestion of `edgesplat info`")
        ->type_name("NUMBER")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->group(kGroup);
    add_each(
        "--material", "PRESET", "Material above an iso-value, by name (`edgesplat scene presets`); once per --iso",
        [](const std::string& option, const std::string& name) {
            try {
                return edgesplat::scene_preset(name).name;
            } catch (const edgesplat::Error& error) {
                throw CLI::ValidationError(option, error.what());
            }
        },
        [](edgesplat::MaterialChoice& material, const std::string& name) { material = {.preset = name}; });
    add_each(
        "--color", "R,G,B", "Colour above an iso-value, linear 0..1; once per --iso",
        [](const std::string& option, const std::string& text) { return read_vector(option, text, "R,G,B"); },
        [](edgesplat::MaterialChoice& material, const glm::dvec3& color) { material.color = color; });
    add_each(
        "--extinction", "NUMBER",
        "Extinction above an iso-value, per mm; once per --iso. Default: 8 per voxel for the highest, 0.15 per voxel "
        "for the others",
        [](const std::string& option, const std::string& text) { return read_number(option, text, {0}); },
        [](edgesplat::MaterialChoice& material, double extinction) { material.extinction = extinction; })
        ->delimiter(',');
    add_vector_edit(command, edits, "--background", "R,G,B", "Background colour, linear 0..1; default 0,0,0",
                    [](SceneDocument& d, const glm::dvec3& color) { d.background = color; })
        ->group(kGroup);
    command
        .add_option_function<std::string>(
            "--light",
            [&edits](const std::string& text) {
                edits.add([lights = parse_light(text)](SceneDocument& d) { d.lights = lights; });
            },
            "Light at the eye, no light, or a distant light in the direction X,Y,Z (towards the light, world axes)")
        ->type_name("headlight|none|X,Y,Z")
        ->default_str("headlight")
        ->group(kGroup);
    add_number_edit(command, edits, "--ambient", {0}, "Ambient light",
                    [](SceneDocument& d, double value) { d.ambient = value; })
        ->default_str(fmt::format("{}", SceneDocument{}.ambient))
        ->group(kGroup);
    add_number_edit(command, edits, "--threshold", {},
                    "Make the volume binary first: 1 from this value up, otherwise 0",
                    [](SceneDocument& d, double value) { d.volume.threshold = value; })
        ->group(kGroup);
    add_flag_edit(command, edits, "--box-filter", "Smooth the volume first: mean of 3x3x3 voxels (after --threshold)",
                  [](SceneDocument& d) { d.volume.box_filter = true; })
        ->group(kGroup);
    command
        .add_option_function<std::string>(
            "--labels",
            [&edits](const std::string& text) {
                if (text != "on" && text != "off")
                    throw CLI::ValidationError("--labels", fmt::format("'{}' is neither on nor off", text));
                edits.add([on = text == "on"](SceneDocument& d) { d.volume.labels = on; });
            },
            "Whether samples are labels, each drawn in its own colour. Default: detected, unless surfaces are given")
        ->type_name("on|off")
        ->group(kGroup);
    const auto add_labels = [&](const char* option, const char* help, auto list) {
        command
            .add_option_function<std::vector<std::string>>(
                option,
                [&edits, list](const std::vector<std::string>& entries) {
                    edits.add([entries, list](SceneDocument& d) { list(d) = entries; });
                },
                help)
            ->type_name("LABEL,...")
            ->allow_extra_args(false)
            ->group(kGroup);
    };
    add_labels(
        "--only", "Labels to show, by number, name, or name with * for any letters; repeatable. Default: all",
        [](SceneDocument & d) -> auto& { return d.volume.only; });
    add_labels(
        "--hide", "Labels to hide, in the same way", [](SceneDocument & d) -> auto& { return d.volume.hide; });
    command
        .add_option_function<std::vector<std::string>>(
            "--fade",
            [&edits](const std::vector<std::string>& entries) {
                for (const std::string& entry : entries) {
                    const std::size_t end = entry.rfind('=');
                    if (end == 0 || end == std::string::npos)
                        throw CLI::ValidationError("--fade", fmt::format("'{}': expected LABEL=OPACITY", entry));
                    const double opacity =
                        read_number("--fade", entry.substr(end + 1), {.low = 0, .high = 1, .above_low = true});
                    edits.add([labels = entry.substr(0, end), opacity](SceneDocument& d) {
                        edgesplat::fade_labels(d, labels, opacity);
                    });
                }
            },
            "Draw labels translucent, in the mean with this opacity: by number, name, or name with *. Repeatable")
        ->type_name("LABEL=OPACITY")
        ->allow_extra_args(false)
        ->group(kGroup);
}

void add_settings_options(CLI::App& command, DocumentEdits& edits) {
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
    // Added first, so that single settings override it in any order of the command line.
    command
        .add_option_function<std::string>(
            "--preset",
            [&edits, assign](const std::string& name) {
                assign("--preset", [&] {
                    edits.add([preset = edgesplat::preset_named(name)](SceneDocument& d) {
                        d.quality.preset = preset.name;
                        d.quality.settings = preset.settings;
                    });
                });
            },
            "Preset of the settings below; the options below override single settings")
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
                [&edits, &knob, option, assign](const std::string& text) {
                    edgesplat::Settings scratch;
                    assign(option, [&] { knob.set(scratch, text); });
                    edits.add([&knob, text](SceneDocument& d) { knob.set(d.quality.settings, text); });
                },
                std::string(knob.help))
            ->type_name(choices)
            ->default_str(knob.get(edgesplat::Settings{}))
            ->group(kGroup);
    }
    add_flag_edit(command, edits, "--keep-buried", "Also draw voxels that opaque voxels enclose on every side",
                  [](SceneDocument& d) { d.quality.settings.cull_buried = false; })
        ->group(kGroup);
}
