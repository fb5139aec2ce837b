#include "apps/edgesplat/renderer_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"

using edgesplat::SceneDocument;

namespace {

/// Converts the name `text` to its value. The error calls the value `what`.
template <typename Kind, std::size_t count>
Kind named(const std::array<std::string_view, count>& names, const std::string& option, std::string_view what,
           const std::string& text) {
    const auto found = std::ranges::find(names, text);
    if (found == names.end())
        throw CLI::ValidationError(
            option, fmt::format("unknown {} '{}'; expected one of {}", what, text, fmt::join(names, ", ")));
    return static_cast<Kind>(found - names.begin());
}

}  // namespace

edgesplat::RaycastSettings raycast_settings(const edgesplat::OutputChoice& output) {
    return {.step = output.raycast_step, .filter = output.raycast_filter};
}

void add_renderer_options(CLI::App& command, DocumentEdits& edits) {
    constexpr const char* kGroup = "Renderer";
    const edgesplat::OutputChoice usual;
    command
        .add_option_function<std::string>(
            "--renderer",
            [&edits](const std::string& text) {
                const auto kind =
                    named<edgesplat::RendererKind>(edgesplat::kRendererNames, "--renderer", "renderer", text);
                edits.add([kind](SceneDocument& d) { d.output.renderer = kind; });
            },
            "raycast: ray casting of the interpolated samples (--raycast-filter). reference: the exact sum of all "
            "kernels, to --tolerance. truth: the exact surfaces of a builtin volume. reference and truth run on the "
            "processor and take seconds to minutes")
        ->type_name(fmt::format("{}", fmt::join(edgesplat::kRendererNames, "|")))
        ->default_str(std::string(name_of(usual.renderer)))
        ->group(kGroup);
    add_number_edit(command, edits, "--raycast-step", {0.01, 4, true},
                    "Distance between samples along a ray, voxels (raycast)",
                    [](SceneDocument& d, double value) { d.output.raycast_step = value; })
        ->default_str(fmt::format("{}", usual.raycast_step))
        ->group(kGroup);
    command
        .add_option_function<std::string>(
            "--raycast-filter",
            [&edits](const std::string& text) {
                const auto filter =
                    named<edgesplat::RaycastFilter>(edgesplat::kRaycastFilterNames, "--raycast-filter", "filter", text);
                edits.add([filter](SceneDocument& d) { d.output.raycast_filter = filter; });
            },
            "Interpolation of the samples (raycast): trilinear, or the cubic B-spline through them. Cubic surfaces are "
            "more accurate and take several times as long")
        ->type_name(fmt::format("{}", fmt::join(edgesplat::kRaycastFilterNames, "|")))
        ->default_str(std::string(edgesplat::kRaycastFilterNames.at(static_cast<std::size_t>(usual.raycast_filter))))
        ->group(kGroup);
    add_number_edit(command, edits, "--tolerance", {0, 0.1, true},
                    "Largest error of a pixel; full scale is 1 (reference, truth)",
                    [](SceneDocument& d, double value) { d.output.tolerance = value; })
        ->default_str(fmt::format("{}", usual.tolerance))
        ->group(kGroup);
}
