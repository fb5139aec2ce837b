#include "engine/accuracy/heat_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/error.h"
#include "engine/image/srgb.h"

namespace edgesplat::accuracy {
namespace {

/// Every eighth of Viridis (van der Walt and Smith, CC0).
constexpr std::array<glm::dvec3, 9> kColors{{{0.267, 0.005, 0.329},
                                             {0.279, 0.175, 0.483},
                                             {0.230, 0.322, 0.546},
                                             {0.173, 0.449, 0.558},
                                             {0.128, 0.567, 0.551},
                                             {0.158, 0.684, 0.502},
                                             {0.369, 0.789, 0.383},
                                             {0.678, 0.864, 0.190},
                                             {0.993, 0.906, 0.144}}};

}  // namespace

glm::dvec3 heat_color(double share) {
    const double at = std::clamp(share, 0.0, 1.0) * (kColors.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), kColors.size() - 2);
    return glm::mix(kColors[i], kColors[i + 1], at - static_cast<double>(i));
}

Image heat_map(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height || a.channels != b.channels)
        fail("heat map: pictures of {}x{} and {}x{} pixels, expected the same size", a.width, a.height, b.width,
             b.height);
    Image out(a.width, a.height, 3);
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width; ++x) {
            double most = 0;
            for (int c = 0; c < std::min(a.channels, 3); ++c)
                most =
                    std::max(most, std::abs(static_cast<double>(a.at(x, y, c)) - static_cast<double>(b.at(x, y, c))));
            const double share = std::log(std::max(most, kHeatLow) / kHeatLow) / std::log(kHeatHigh / kHeatLow);
            const glm::dvec3 color = heat_color(share);
            for (int c = 0; c < 3; ++c)
                out.at(x, y, c) = static_cast<float>(to_linear(color[c]));
        }
    }
    return out;
}

std::string heat_gradient() {
    std::string stops;
    for (const glm::dvec3& c : kColors)
        stops += fmt::format(", rgb({:.0f} {:.0f} {:.0f})", 255 * c.x, 255 * c.y, 255 * c.z);
    return "linear-gradient(90deg" + stops + ")";
}

}  // namespace edgesplat::accuracy
