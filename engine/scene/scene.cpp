#include "engine/scene/scene.h"

#include <cmath>
#include <string>

#include "engine/error.h"

namespace edgesplat {

namespace {

void check_color(const std::string& field, const glm::dvec3& color) {
    for (int c = 0; c < 3; ++c) {
        if (!(color[c] >= 0 && color[c] <= 1)) {
            fail("scene {}: ({}, {}, {}) has a component outside 0..1", field, color.x, color.y, color.z);
        }
    }
}

void check_share(const char* field, double value) {
    if (!(value >= 0) || !std::isfinite(value)) fail("scene light {}: {} is not a finite number >= 0", field, value);
}

}  // namespace

void validate(const Scene& scene) {
    const std::size_t count = scene.iso_values.size();
    if (count < 1 || count > 15) fail("scene iso_values: {} of them, expected 1 to 15", count);
    for (std::size_t i = 0; i < count; ++i) {
        const double value = scene.iso_values[i];
        if (!std::isfinite(value)) fail("scene iso_values[{}]: {} is not finite", i, value);
        if (i > 0 && !(value > scene.iso_values[i - 1])) {
            fail("scene iso_values[{}]: {} is not above the one before ({})", i, value, scene.iso_values[i - 1]);
        }
    }
    if (scene.materials.size() != count + 1) {
        fail("scene materials: {} of them, expected {} (one more than iso-values)", scene.materials.size(), count + 1);
    }
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        const Material& material = scene.materials[m];
        check_color(fmt::format("materials[{}].color", m), material.color);
        if (!(material.extinction >= 0) || !std::isfinite(material.extinction)) {
            fail("scene materials[{}].extinction: {} is not a finite number >= 0 (per mm)", m, material.extinction);
        }
    }
    check_color("background", scene.background);
    check_share("ambient", scene.light.ambient);
    check_share("diffuse", scene.light.diffuse);
    if (scene.light.kind == Light::Kind::Directional) {
        const glm::dvec3& d = scene.light.direction;
        const double length = glm::length(d);
        if (!(length > 0) || !std::isfinite(length)) {
            fail("scene light direction: ({}, {}, {}) is not a finite vector other than 0", d.x, d.y, d.z);
        }
    }
}

}  // namespace edgesplat
