#include "apps/edgesplat/renderer_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/edgesplat/option_values.h"
#include "engine/error.h"

namespace {

constexpr std::array<std::string_view, 3> kNames{"splat", "reference", "truth"};

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

std::string_view name_of(RendererKind kind) {
    return kNames[static_cast<std::size_t>(kind)];
}

void add_renderer_options(CLI::App& command, RendererOptions& options) {
    constexpr const char* kGroup = "Renderer";
    add_choice(command, "--renderer", options.kind, renderer_named, kNames, name_of(options.kind),
               "reference: the sum of all kernels itself, to --tolerance; truth: a builtin volume's exact surfaces. "
               "Both take the processor and seconds to minutes")
        ->group(kGroup);
    add_number(command, "--tolerance", options.tolerance, {0, 0.1, true},
               "Largest error of a pixel, of full scale 1 (reference, truth)")
        ->group(kGroup);
}
