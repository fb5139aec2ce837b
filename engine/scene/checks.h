// Range checks that several parts of a scene share.
#pragma once

#include <glm/glm.hpp>
#include <string_view>

#include "engine/error.h"

namespace edgesplat {

/// Throws Error naming the field if a component is not within 0..1.
inline void check_color(std::string_view field, const glm::dvec3& color) {
    for (int c = 0; c < 3; ++c) {
        if (!(color[c] >= 0 && color[c] <= 1)) {
            fail("scene {}: ({}, {}, {}) has a component outside 0..1", field, color.x, color.y, color.z);
        }
    }
}

}  // namespace edgesplat
