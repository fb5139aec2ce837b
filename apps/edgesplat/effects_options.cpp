#include "apps/edgesplat/effects_options.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <sstream>

#include "engine/error.h"

namespace {

using edgesplat::Light;
using edgesplat::Plane;
using edgesplat::SceneDocument;

/// Six finite numbers, comma-separated.
std::array<glm::dvec3, 2> read_two_vectors(const std::string& option, const std::string& text, const char* type) {
    std::array<double, 6> v{};
    std::istringstream in(text);
    std::string part;
    std::size_t count = 0;
    bool good = true;
    while (std::getline(in, part, ',')) {
        const auto number = parse_number(part);
        good = good && number && count < v.size();
        if (good) v[count] = *number;
        ++count;
    }
    if (!good || count != v.size() || text.ends_with(','))
        throw CLI::ValidationError(
            option, fmt::format("'{}' is not six numbers {}, comma-separated without spaces", text, type));
    return {glm::dvec3(v[0], v[1], v[2]), glm::dvec3(v[3], v[4], v[5])};
}

Plane read_plane(const std::string& option, const std::string& text) {
    const auto [point, normal] = read_two_vectors(option, text, "PX,PY,PZ,NX,NY,NZ");
    if (normal == glm::dvec3(0))
        throw CLI::ValidationError(option, fmt::format("'{}': the normal NX,NY,NZ must not be 0,0,0", text));
    return {point, normal};
}

edgesplat::ClipBox read_box(const std::string& option, const std::string& text) {
    const auto [low, high] = read_two_vectors(option, text, "X0,Y0,Z0,X1,Y1,Z1");
    if (!glm::all(glm::lessThan(low, high)))
        throw CLI::ValidationError(option,
                                   fmt::format("'{}': X1,Y1,Z1 must be greater than X0,Y0,Z0 along each axis", text));
    return {low, high};
}

void add_clip_options(CLI::App& command, DocumentEdits& edits, const char* group) {
    command
        .add_option_function<std::vector<std::string>>(
            "--clip-plane",
            [&edits](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    edits.add([plane = read_plane("--clip-plane", text)](SceneDocument& d) {
                        d.effects.clip.keep.push_back(plane);
                    });
            },
            "Clip at the plane through a point (world mm): removes the side that its normal points to; repeatable")
        ->type_name("PX,PY,PZ,NX,NY,NZ")
        ->allow_extra_args(false)
        ->group(group);
    command
        .add_option_function<std::string>(
            "--clip-box",
            [&edits](const std::string& text) {
                edits.add([box = read_box("--clip-box", text)](SceneDocument& d) { d.keep_box = box; });
            },
            "Keep only the inside of the box, world mm")
        ->type_name("X0,Y0,Z0,X1,Y1,Z1")
        ->group(group);
    command
        .add_option_function<std::string>(
            "--cut-box",
            [&edits](const std::string& text) {
                edits.add([box = read_box("--cut-box", text)](SceneDocument& d) {
                    d.effects.clip.remove.clear();
                    d.remove_box = box;
                });
            },
            "Remove the inside of the box, world mm")
        ->type_name("X0,Y0,Z0,X1,Y1,Z1")
        ->group(group);
}

void cast_shadows(SceneDocument& document) {
    bool any = false;
    for (Light& light : document.lights) {
        light.shadows = light.kind != Light::Kind::Headlight;
        any = any || light.shadows;
    }
    if (!any) edgesplat::fail("--shadows: the eye cannot see the shadows of a headlight; give --light X,Y,Z");
}

}  // namespace

void add_effects_options(CLI::App& command, DocumentEdits& edits) {
    constexpr const char* kGroup = "Effects (an unused effect costs nothing)";
    add_number_edit(command, edits, "--fog", {0}, "Fog over the distance: density per mm",
                    [](SceneDocument& d, double density) {
                        if (!d.effects.fog) d.effects.fog.emplace();
                        d.effects.fog->density = density;
                    })
        ->group(kGroup);
    add_flag_edit(command, edits, "--silhouette", "Draw lines where surfaces turn away from the eye",
                  [](SceneDocument& d) {
                      if (!d.effects.silhouette) d.effects.silhouette.emplace();
                  })
        ->group(kGroup);
    add_number_edit(command, edits, "--occlusion", {0, std::numeric_limits<double>::infinity(), true},
                    "Ambient occlusion darkens hollows: radius in mm; matter farther away does not occlude",
                    [](SceneDocument& d, double radius) {
                        if (!d.effects.occlusion) d.effects.occlusion.emplace();
                        d.effects.occlusion->radius = radius;
                    })
        ->group(kGroup);
    add_flag_edit(command, edits, "--shadows", "Lights other than a headlight cast shadows", cast_shadows)
        ->group(kGroup);
    add_clip_options(command, edits, kGroup);
    add_flag_edit(command, edits, "--antialias", "Widen footprints to at least one pixel", [](SceneDocument& d) {
        d.effects.antialias = true;
    })->group(kGroup);
    add_flag_edit(command, edits, "--smooth-outlines", "Pixels on an outline blend both of its sides",
                  [](SceneDocument& d) { d.effects.smooth_outlines = true; })
        ->group(kGroup);
    command
        .add_option_function<std::string>(
            "--samples",
            [&edits](const std::string& text) {
                const double n = read_number("--samples", text, {1, edgesplat::kMaxSamples});
                if (n != std::trunc(n))
                    throw CLI::ValidationError("--samples", fmt::format("'{}' is not a whole number", text));
                edits.add([n](SceneDocument& d) { d.effects.samples = static_cast<int>(n); });
            },
            "N x N rays per pixel")
        ->type_name("N")
        ->default_str("1")
        ->group(kGroup);
    add_vector_edit(command, edits, "--background-top", "R,G,B",
                    "Background colour at the top; --background is the colour at the bottom",
                    [](SceneDocument& d, const glm::dvec3& color) { d.effects.background_top = color; })
        ->group(kGroup);
    command
        .add_option_function<std::vector<std::string>>(
            "--overlay",
            [&edits](const std::vector<std::string>& names) {
                edits.add([names](SceneDocument& d) {
                    for (const std::string& name : names) {
                        d.effects.overlays.orientation = d.effects.overlays.orientation || name == "orientation";
                        d.effects.overlays.scale_bar = d.effects.overlays.scale_bar || name == "scale-bar";
                        d.effects.overlays.legend = d.effects.overlays.legend || name == "legend";
                    }
                });
            },
            "Overlays on the picture, comma-separated")
        ->type_name("orientation,scale-bar,legend")
        ->delimiter(',')
        ->allow_extra_args(false)
        ->check(CLI::IsMember(std::vector<std::string>{"orientation", "scale-bar", "legend"}).description(""))
        ->group(kGroup);
}
