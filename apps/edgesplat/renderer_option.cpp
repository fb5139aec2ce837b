#include "apps/edgesplat/renderer_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/edgesplat/option_values.h"
#include "engine/error.h"

namespace {

constexpr std::array<std::string_view, 5> kNames{"splat", "raycast", "raycast-warped", "reference", "truth"};

RendererKind renderer_named(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end())
        edgesplat::fail("no renderer is called '{}'; there are {}", name, fmt::join(kNames, ", "));
    return static_cast<RendererKind>(found - kNames.begin());
}

}  // namespace

bool on_processor(RendererKind kind) {
    return kind == RendererKind::Reference || kind == RendererKind::Truth;
}

bool casts_rays(RendererKind kind) {
    return kind == RendererKind::Raycast || kind == RendererKind::RaycastWarped;
}

edgesplat::RaycastSettings raycast_settings(const RendererOptions& options) {
    return {.step = options.raycast_step, .warped = options.kind == RendererKind::RaycastWarped};
}

std::string_view name_of(RendererKind kind) {
    return kNames[static_cast<std::size_t>(kind)];
}

void add_renderer_options(CLI::App& command, RendererOptions& options) {
    constexpr const char* kGroup = "Renderer";
    add_choice(
        command, "--renderer", options.kind, renderer_named, kNames, name_of(options.kind),
        "raycast: rays through the interpolated volume; raycast-warped: through the voxels' materials, sharpened "
        "by the same edges as splats. reference: the sum of all kernels itself, to --tolerance; truth: a builtin "
        "volume's exact surfaces. These two take the processor and seconds to minutes")
        ->group(kGroup);
    add_number(command, "--raycast-step", options.raycast_step, {0.01, 4, true},
               "Between samples, in voxels (raycast, raycast-warped)")
        ->group(kGroup);
    add_number(command, "--tolerance", options.tolerance, {0, 0.1, true},
               "Largest error of a pixel, of full scale 1 (reference, truth)")
        ->group(kGroup);
}
