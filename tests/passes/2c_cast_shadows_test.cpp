// Pass 2c against the reference, and against closed forms for slabs, balls and cones of light.
#include <cmath>

#include "engine/reference/2c_cast_shadows.h"

#include "footprints/kernel.h"
#include "tests/passes/pass_fixture.h"
#include "tests/properties/measuring.h"

namespace edgesplat::test {
namespace {

/// First and second light with shadows.
Reaches shadow_reaches(const PassScene& s) {
    return reaches_of(s, &SplatLists::shadows);
}

Light sun(const glm::dvec3& towards) {
    Light light = directional_light(towards);
    light.shadows = true;
    return light;
}

Light lamp(const glm::dvec3& position) {
    Light light;
    light.kind = Light::Kind::Point;
    light.position = position;
    light.shadows = true;
    return light;
}

/// A volume of f(index) in [0, 1]: transparent below 1/4, haze of `haze` per mm up to 3/4, opaque above.
PassScene scene_of(const glm::ivec3& dims, const std::function<double(const glm::dvec3&)>& f, double haze) {
    PassScene s;
    s.volume = *sampled(dims, f);
    s.scene.iso_values = {0.25, 0.75};
    s.scene.materials = {{{0, 0, 0}, 0}, {{1, 1, 1}, haze}, {{1, 1, 1}, 5}};
    s.settings.opaque = OpaqueMatter::Kernels;
    return s;
}

/// 0 outside, 1 inside, linear over one voxel across the surface.
double shadow_ramp(double inside) {
    return std::clamp(0.5 + inside, 0.0, 1.0);
}

glm::dvec3 place_of(const reference::SplatRecord& record, const glm::ivec3& dims) {
    const auto v = static_cast<int>(record.voxel);
    return {v % dims.x, v / dims.x % dims.y, v / dims.x / dims.y};
}

TEST(CastShadows, MatchesTheReference) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.settings.opaque = OpaqueMatter::Kernels;
        const VolumeGeometry& geometry = s.volume.geometry;
        const glm::dvec3 middle = geometry.to_world(0.5 * glm::dvec3(geometry.dims - 1));
        s.scene.lights = {sun({0.4, 0.5, 0.8}), lamp(middle + glm::dvec3(10, -35, 20))};
        const Reaches got = shadow_reaches(s);
        const auto values = scaled_field(s.volume);
        const reference::Field field{geometry.dims, values, {}};
        const reference::ScaledScene scaled = reference::scale_scene(s.scene, s.volume);
        const double band = edge_reach(s.settings);
        for (const bool second : {false, true}) {
            const Light& light = s.scene.lights[second ? 1 : 0];
            double sum = 0, count = 0, far_off = 0, low = 1, high = 0;
            for (std::size_t i = 0; i < got.records.size(); i += 11) {
                const auto& record = got.records[i];
                const auto point = reference::lit_point(record, field, geometry, band, light);
                const double want = reference::light_reach(point, field.voxel(record.voxel), geometry,
                                                           {field, scaled, s.scene, geometry}, light);
                const double difference = std::abs((second ? got.second[i] : got.first[i]) - want);
                low = std::min(low, want);
                high = std::max(high, want);
                sum += difference;
                far_off += difference > 0.01 ? 1 : 0;
                ++count;
            }
            std::printf("%s: mean error %.6f, %.0f of %.0f above .01\n", s.name.c_str(), sum / count, far_off, count);
            EXPECT_TRUE(low < 0.5 || s.name == "wall from inside");
            EXPECT_GT(high, 0.95);
            EXPECT_LE(sum / count, 0.001);
            EXPECT_LE(far_off / count, 0.01);
        }
    }
}

/// A haze slab over an opaque floor, both perpendicular to z, lit from several directions.
TEST(CastShadows, MatchesTheClosedFormBehindASlab) {
    const glm::ivec3 dims(48, 48, 40);
    const double haze = 0.12, thickness = 8;
    for (const glm::dvec3 spacing : {glm::dvec3(1), glm::dvec3(1, 0.8, 1.7)}) {
        PassScene s = scene_of(
            dims,
            [&](const glm::dvec3& p) {
                return std::max(0.5 * shadow_ramp(0.5 * thickness - std::abs(p.z - 22.2)), shadow_ramp(8.3 - p.z));
            },
            haze);
        s.volume.geometry.index_to_world_axes =
            glm::dmat3(glm::dvec3(spacing.x, 0, 0), glm::dvec3(0, spacing.y, 0), glm::dvec3(0, 0, spacing.z));
        finish_volume(s.volume);
        for (const glm::dvec3 towards :
             {glm::dvec3(0, 0, 1), glm::dvec3(0.3, 0, 1), glm::dvec3(-0.3, 0.45, 1), glm::dvec3(0.6, 0.5, 1)}) {
            s.scene.lights = {sun(towards)};
            const Reaches got = shadow_reaches(s);
            const double cosine = glm::normalize(towards).z;
            // The edge between 0 and 1/2 is at 1/4: half a voxel's shadow_ramp on either side.
            const double want = std::exp(-haze * thickness * spacing.z / cosine);
            double worst = 0, count = 0;
            for (std::size_t i = 0; i < got.records.size(); ++i) {
                const glm::dvec3 p = place_of(got.records[i], dims);
                if (got.records[i].material != 2 || !got.records[i].edge.has_edge || p.z < 4) continue;
                // Far enough from the border that the ray to the light passes through the slab.
                const glm::dvec3 at_slab = p + towards / spacing * ((27.0 - p.z) * spacing.z);
                if (std::max(std::abs(p.x - 23.5), std::abs(p.y - 23.5)) > 21) continue;
                if (std::max(std::abs(at_slab.x - 23.5), std::abs(at_slab.y - 23.5)) > 20) continue;
                worst = std::max(worst, std::abs(got.first[i] - want));
                ++count;
            }
            EXPECT_GT(count, 100);
            EXPECT_LE(worst, 0.02 * want);
        }
    }
}

/// Visits the splats of an opaque floor z < `top` on the lit side.
template <typename Visit>
void for_floor(const Reaches& got, const glm::ivec3& dims, double top, const Visit& visit) {
    for (std::size_t i = 0; i < got.records.size(); ++i) {
        const glm::dvec3 p = place_of(got.records[i], dims);
        const auto& e = got.records[i].edge;
        if (!e.has_edge || e.n.z < 0.99 || p.z > top + 1) continue;
        if (std::min({p.x, p.y, dims.x - 1 - p.x, dims.y - 1 - p.y}) < 3) continue;
        visit(p, i);
    }
}

TEST(CastShadows, CastsABallsShadowAtTheRightPlaceWithoutAcne) {
    const glm::ivec3 dims(48, 48, 40);
    const glm::dvec3 ball(20, 24, 26);
    const double r = 7, top = 6.4;
    PassScene s = scene_of(
        dims, [&](const glm::dvec3& p) { return shadow_ramp(std::max(r - glm::length(p - ball), top - p.z)); }, 0);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{{0, 0, 0}, 0}, {{1, 1, 1}, 5}};
    for (const glm::dvec3 towards : {glm::dvec3(0, 0, 1), glm::dvec3(-0.4, 0.2, 1), glm::dvec3(-0.9, 0, 1)}) {
        s.scene.lights = {sun(towards)};
        const Reaches got = shadow_reaches(s);
        const glm::dvec3 l = glm::normalize(towards);
        double lit = 0, dark = 0, border = 0;
        for_floor(got, dims, top, [&](const glm::dvec3& p, std::size_t i) {
            // Light is evaluated 1.5 voxels above the plate.
            const glm::dvec3 v = ball - glm::dvec3(p.x, p.y, top + 1.5);
            const double from_axis = glm::length(v - glm::dot(v, l) * l) - r;
            if (from_axis > 1.5) {
                ++lit;
                EXPECT_GT(got.first[i], 0.98) << p.x << ' ' << p.y;
            } else if (from_axis < -1.5) {
                ++dark;
                EXPECT_LT(got.first[i], 0.02) << p.x << ' ' << p.y;
            } else {
                ++border;
            }
        });
        EXPECT_GT(lit, 500);
        EXPECT_GT(dark, 60);
        // The ball's lit side is not in its own shadow.
        std::size_t sunny = 0;
        for (std::size_t i = 0; i < got.records.size(); ++i) {
            const auto& e = got.records[i].edge;
            if (!e.has_edge || glm::length(place_of(got.records[i], dims) - ball) > r + 1 || glm::dot(e.n, l) < 0.15)
                continue;
            ++sunny;
            EXPECT_GT(got.first[i], 0.97);
        }
        EXPECT_GT(sunny, 150U);
    }
}

TEST(CastShadows, EnlargesAPointLightsShadowWithDistance) {
    const glm::ivec3 dims(56, 56, 40);
    const glm::dvec3 ball(27.5, 27.5, 22);
    const double r = 4, top = 5.4;
    PassScene s = scene_of(
        dims, [&](const glm::dvec3& p) { return shadow_ramp(std::max(r - glm::length(p - ball), top - p.z)); }, 0);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{{0, 0, 0}, 0}, {{1, 1, 1}, 5}};
    // Outside the volume, nearby, and inside the box.
    for (const glm::dvec3 at : {glm::dvec3(27.5, 27.5, 90), glm::dvec3(30, 25, 48), glm::dvec3(27.5, 29, 36)}) {
        s.scene.lights = {lamp(at)};
        const Reaches got = shadow_reaches(s);
        double lit = 0, dark = 0;
        for_floor(got, dims, top, [&](const glm::dvec3& p, std::size_t i) {
            const glm::dvec3 place(p.x, p.y, top + 1.5), l = glm::normalize(at - place), v = ball - place;
            const double from_axis = glm::length(v - glm::dot(v, l) * l) - r;
            // At the shadow's border, a voxel of the floor corresponds to this length at the ball.
            const double shrunk = glm::length(at - ball) / glm::length(at - place);
            if (from_axis > 1.5 * shrunk) {
                ++lit;
                EXPECT_GT(got.first[i], 0.98) << at.z << ": " << p.x << ' ' << p.y;
            } else if (from_axis < -1.5 * shrunk) {
                ++dark;
                EXPECT_LT(got.first[i], 0.03) << at.z << ": " << p.x << ' ' << p.y;
            }
        });
        const double radius = r * glm::length(at - glm::dvec3(27.5, 27.5, top)) / glm::length(at - ball);
        EXPECT_GT(lit, 300);
        EXPECT_GT(dark, 0.6 * M_PI * (radius - 2) * (radius - 2));
    }
}

TEST(CastShadows, TracesEachLightIndependentlyOfColour) {
    PassScene s = pass_scenes()[0];
    const Light a = sun({0.3, -0.4, 1}), b = lamp(s.volume.geometry.to_world({-20, 5, 30}));
    s.scene.lights = {a};
    const auto first = shadow_reaches(s).first;
    s.scene.lights = {b};
    const auto second = shadow_reaches(s).first;
    s.scene.lights = {Light{}, a, b};
    const Reaches both = shadow_reaches(s);
    EXPECT_EQ(both.first, first);
    EXPECT_EQ(both.second, second);
    EXPECT_NE(first, second);
    DeviceUnderTest& state = device_under_test();
    s.scene.lights[1].color = {1, 0.5, 0.25};
    s.scene.lights[2].intensity = 0.3;
    s.scene.lights.erase(s.scene.lights.begin());
    EXPECT_FALSE(state.collect(s.scene, s.settings, false));
    s.scene.lights[0].direction.x = 0.5;
    EXPECT_TRUE(state.collect(s.scene, s.settings, false));
}

TEST(CastShadows, CostsNothingWhenOff) {
    PassScene s = pass_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    EXPECT_FALSE(state.lists().shadows);
    s.scene.lights = {sun({0, 0, 1})};
    state.collect(s.scene, s.settings, false);
    EXPECT_EQ(state.lists().shadows.bytes(), 4 * state.lists().splat_count);
    ASSERT_EQ(state.cost.times.size(), 1U);
    EXPECT_EQ(state.cost.times[0].name, "2c_cast_shadows");
    s.scene.lights[0].shadows = false;
    state.collect(s.scene, s.settings, false);
    EXPECT_FALSE(state.lists().shadows);
}

TEST(CastShadows, GivesFiniteSharesForLightsAnywhere) {
    PassScene s = pass_scenes()[1];
    const VolumeGeometry& geometry = s.volume.geometry;
    const glm::dvec3 middle = geometry.to_world(0.5 * glm::dvec3(geometry.dims - 1));
    for (const Light& light : {lamp(middle), lamp(geometry.to_world({0, 0, 0})), lamp(middle + glm::dvec3(1e7, 0, 3)),
                               lamp(geometry.to_world({10, 9, 11})), sun({1e-9, 0, 0}), sun({0, 0, -1e9})}) {
        s.scene.lights = {light};
        const Reaches got = shadow_reaches(s);
        double sum = 0;
        for (const double reach : got.first)
            sum += reach;
        const double mean = sum / static_cast<double>(got.first.size());
        EXPECT_GT(mean, 0.05);
        EXPECT_LT(mean, 1);
    }
}

}  // namespace
}  // namespace edgesplat::test
