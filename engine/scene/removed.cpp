#include "engine/scene/removed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace edgesplat {
namespace {

struct Removed {
    std::string_view knob, step, instead;
};

constexpr std::string_view kNoBand = "kernels are cut at faces, which have no band: leave it out";
constexpr std::array kRemoved{
    Removed{"edge-half-width", "", kNoBand},
    Removed{"edge-strength", "", kNoBand},
    Removed{"edge-shape", "", "faces are as curved as the surface: leave it out"},
    Removed{"normalise", "", "kernels cut at faces have no weights: leave it out"},
    Removed{"table-size", "", "the table of footprints has one size: leave it out"},
    Removed{"accumulation", "", "pictures are accumulated in 32 bits per channel: leave it out"},
    Removed{"sheet-format", "half", "write layers"},
    Removed{"sheet-format", "float", "write layers"},
    Removed{"warp", "edge", "write face"},
    Removed{"edges", "quadratic", "write march"},
    Removed{"footprints", "table-lerp", "write table"},
    Removed{"renderer", "raycast-warped", "write raycast, with the filter cubic for more accurate surfaces"},
};

std::string instead_of(std::string_view name, std::string_view step) {
    std::string knob(name.substr(name.rfind('.') + 1));
    std::replace(knob.begin(), knob.end(), '_', '-');
    const auto* found =
        std::ranges::find_if(kRemoved, [&](const Removed& r) { return r.knob == knob && r.step == step; });
    return found == kRemoved.end() ? "" : fmt::format("was removed; {}", found->instead);
}

}  // namespace

std::string removed_knob(std::string_view name) {
    return instead_of(name, "");
}

std::string removed_step(std::string_view knob, std::string_view value) {
    return value.empty() ? "" : instead_of(knob, value);
}

}  // namespace edgesplat
