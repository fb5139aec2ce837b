// Extra outputs: for each the frame is drawn once more, with another quantity instead of colour.
#include <utility>

#include "engine/forecast/effect_rows.h"
#include "shaders/shared/limits.h"

namespace edgesplat {
namespace {

template <std::size_t number>
Effect output_effect() {
    const Aov& aov = aovs()[number];
    static const std::string name = "output " + std::string(aov.name);
    static const std::string call =
        "output.aovs contains \"" + std::string(aov.name) + "\"; --aov " + std::string(aov.name);
    return {.name = name,
            .help = aov.help,
            .call = call,
            .reason = [](const FrameRequest& r) -> std::string {
                return r.outputs.*aovs()[number].wanted ? "it is requested" : "";
            },
            .turn_on = [](FrameRequest& r) { r.outputs.*aovs()[number].wanted = true; },
            .constants = {{shader::SPEC_PAYLOAD, "SPEC_PAYLOAD"}}};
}

template <std::size_t... numbers>
std::vector<Effect> effects_of(std::index_sequence<numbers...>) {
    return {output_effect<numbers>()...};
}

}  // namespace

std::vector<Effect> output_effects() {
    return effects_of(std::make_index_sequence<kAovCount>());
}

}  // namespace edgesplat
