#include "engine/reference/6_composite_sheet.h"

#include <cmath>

namespace edgesplat::reference {

void composite_sheet(std::span<glm::dvec4> frame, std::span<const glm::dvec4> sheet, std::span<const char> closed) {
    for (std::size_t i = 0; i < frame.size(); ++i) {
        const double tau = sheet[i].w;
        if (!(tau > 0) || (!closed.empty() && closed[i] != 0)) continue;
        const double alpha = -std::expm1(-tau);
        const double through = 1 - frame[i].w;
        frame[i] += through * alpha * glm::dvec4(glm::dvec3(sheet[i]) / tau, 1);
    }
}

}  // namespace edgesplat::reference
