#include "engine/scene/effects.h"

#include <cmath>
#include <string>

#include "engine/scene/checks.h"

namespace edgesplat {

namespace {

// Callers write comparisons so that NaN fails.
void check(const std::string& field, double value, bool in_range, const char* range) {
    if (!in_range || !std::isfinite(value)) fail("scene {}: {} is outside {}", field, value, range);
}

void check_planes(const char* field, const std::vector<Plane>& planes) {
    if (planes.size() > kMaxClipPlanes) {
        fail("scene clip.{}: {} planes, expected at most {}", field, planes.size(), kMaxClipPlanes);
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const auto& [p, n] = planes[i];
        const double length = glm::length(n);
        if (!(length > 0) || !std::isfinite(length)) {
            fail("scene clip.{}[{}].normal: ({}, {}, {}) is not a finite vector other than 0", field, i, n.x, n.y, n.z);
        }
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
            fail("scene clip.{}[{}].point: ({}, {}, {}) is not finite", field, i, p.x, p.y, p.z);
        }
    }
}

}  // namespace

void validate(const Effects& effects) {
    if (const auto& fog = effects.fog) {
        check_color("fog.color", fog->color);
        check("fog.density", fog->density, fog->density >= 0, "[0, inf) per mm");
        check("fog.start", fog->start, fog->start >= 0, "[0, inf) mm");
    }
    if (const auto& silhouette = effects.silhouette) {
        const double strength = silhouette->strength, sharpness = silhouette->sharpness;
        check_color("silhouette.color", silhouette->color);
        check("silhouette.strength", strength, strength >= 0 && strength <= 1, "[0, 1]");
        check("silhouette.sharpness", sharpness, sharpness >= 0.25 && sharpness <= 64, "[0.25, 64]");
    }
    if (const auto& occlusion = effects.occlusion) {
        const double strength = occlusion->strength;
        check("occlusion.strength", strength, strength >= 0 && strength <= 1, "[0, 1]");
        check("occlusion.radius", occlusion->radius, occlusion->radius > 0, "(0, inf) mm");
    }
    check_planes("keep", effects.clip.keep);
    check_planes("remove", effects.clip.remove);
    if (effects.background_top) check_color("background_top", *effects.background_top);
    check("samples", effects.samples, effects.samples >= 1 && effects.samples <= kMaxSamples, "[1, 8]");
}

}  // namespace edgesplat
