#include "apps/edgesplat/renderer_option.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"

using edgesplat::SceneDocument;

edgesplat::RaycastSettings raycast_settings(const edgesplat::OutputChoice& output) {
    return {.step = output.raycast_step, .warped = output.renderer == edgesplat::RendererKind::RaycastWarped};
}

void add_renderer_options(CLI::App& command, DocumentEdits& edits) {
    constexpr const char* kGroup = "Renderer";
    const auto& names = edgesplat::kRendererNames;
    const edgesplat::OutputChoice usual;
    command
        .add_option_function<std::string>(
            "--renderer",
            [&edits, &names](const std::string& text) {
                const auto found = std::find(names.begin(), names.end(), text);
                if (found == names.end())
                    throw CLI::ValidationError("--renderer", fmt::format("no renderer is called '{}'; there are {}",
                                                                         text, fmt::join(names, ", ")));
                const auto kind = static_cast<edgesplat::RendererKind>(found - names.begin());
                edits.add([kind](SceneDocument& d) { d.output.renderer = kind; });
            },
            "raycast: rays through the interpolated volume; raycast-warped: through the voxels' materials, sharpened "
            "by the same edges as splats. reference: the sum of all kernels itself, to --tolerance; truth: a builtin "
            "volume's exact surfaces. These two take the processor and seconds to minutes")
        ->type_name(fmt::format("{}", fmt::join(names, "|")))
        ->default_str(std::string(name_of(usual.renderer)))
        ->group(kGroup);
    add_number_edit(command, edits, "--raycast-step", {0.01, 4, true},
                    "Between samples, in voxels (raycast, raycast-warped)",
                    [](SceneDocument& d, double value) { d.output.raycast_step = value; })
        ->default_str(fmt::format("{}", usual.raycast_step))
        ->group(kGroup);
    add_number_edit(command, edits, "--tolerance", {0, 0.1, true},
                    "Largest error of a pixel, of full scale 1 (reference, truth)",
                    [](SceneDocument& d, double value) { d.output.tolerance = value; })
        ->default_str(fmt::format("{}", usual.tolerance))
        ->group(kGroup);
}
