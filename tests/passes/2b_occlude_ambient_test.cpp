// Pass 2b against the reference, and against closed forms for planes, corners, boxes and haze.
#include <cmath>

#include "engine/reference/2b_occlude_ambient.h"

#include "footprints/kernel.h"
#include "tests/passes/pass_fixture.h"
#include "tests/properties/measuring.h"

namespace edgesplat::test {
namespace {

/// First: the face that the normal points out of. Second: the other face.
Reaches device_reaches(const PassScene& s) {
    return reaches_of(s, &SplatLists::occlusion);
}

double band(const Settings& settings) {
    return edge_reach(settings);
}

/// A volume of f(index) with two materials: transparent below 1/2, `extinction` above.
PassScene scene_of(const glm::ivec3& dims, const std::function<double(const glm::dvec3&)>& f, double extinction,
                   double radius) {
    PassScene s;
    s.volume = *sampled(dims, f);
    s.scene.iso_values = {0.5};
    s.scene.materials = {{{0, 0, 0}, 0}, {{1, 1, 1}, extinction}};
    s.scene.effects.occlusion = AmbientOcclusion{.strength = 1, .radius = radius};
    return s;
}

double ramp(double inside) {
    return std::clamp(0.5 + inside, 0.0, 1.0);
}

TEST(OccludeAmbient, EqualsTheReference) {
    for (PassScene s : pass_scenes()) {
        SCOPED_TRACE(s.name);
        s.scene.effects.occlusion = AmbientOcclusion{.strength = 0.5, .radius = 6};
        const Reaches got = device_reaches(s);
        const auto values = scaled_field(s.volume);
        const reference::Field field{s.volume.geometry.dims, values, {}};
        std::size_t off = 0, walls = 0;
        double sum = 0, low = 1, high = 0;
        for (std::size_t i = 0; i < got.records.size(); ++i) {
            const auto& record = got.records[i];
            for (const bool turned : {false, true}) {
                if (turned && !reference::is_wall(record.edge, band(s.settings))) continue;
                walls += turned ? 1U : 0U;
                const double want = reference::ambient_reach(record, field, s.scaled(), s.scene, s.volume.geometry,
                                                             band(s.settings), 6, turned);
                const double difference = std::abs((turned ? got.second[i] : got.first[i]) - want);
                // A sample on the border of two voxels, to seven digits, may belong to either.
                off += difference > 1e-3 ? 1U : 0U;
                EXPECT_LE(difference, 0.04);
                sum += difference;
                low = std::min(low, want);
                high = std::max(high, want);
            }
        }
        EXPECT_LE(off, got.records.size() / 200);
        EXPECT_LE(sum / static_cast<double>(got.records.size()), 1e-4);
        EXPECT_TRUE(low < 0.7 || s.name == "wall from inside") << "nothing is occluded";
        EXPECT_GT(high, 0.9);
        EXPECT_TRUE(walls > 0 || s.name != "wall from inside") << walls;
    }
}

TEST(OccludeAmbient, LeavesAFlatPlaneUnoccluded) {
    for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), glm::dvec3(0.3, -0.5, 0.8), glm::dvec3(-1, 1, 0.02)}) {
        const glm::dvec3 n = glm::normalize(normal), middle(11.5);
        const PassScene s = scene_of(
            glm::ivec3(24), [&](const glm::dvec3& p) { return ramp(glm::dot(middle - p, n)); }, 5, 8);
        const Reaches got = device_reaches(s);
        std::size_t surface = 0;
        for (std::size_t i = 0; i < got.records.size(); ++i) {
            const auto v = static_cast<int>(got.records[i].voxel);
            const glm::ivec3 at(v % 24, v / 24 % 24, v / 576);
            // The spline is mirrored at the border, which bends a plane there.
            if (!got.records[i].edge.has_edge || at != glm::clamp(at, 3, 20)) continue;
            ++surface;
            // The 16-bit maximum is exactly 1.
            EXPECT_GT(got.first[i], 0.99999);
        }
        EXPECT_GT(surface, 300U);
    }
}

/// Share of the sky seen at `height` from an infinite wall at right angles, if occluders count up to `radius`: the
/// cosine-weighted share of directions with a longer distance to the wall.
double open_beside_wall(double height, double radius) {
    double open = 0;
    const int n = 400;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double across = std::sqrt((i + 0.5) / n), angle = 2 * M_PI * (j + 0.5) / n;
            const double towards = across * std::cos(angle);
            open += towards > 0 && height / towards < radius ? 0 : 1;
        }
    return open / n / n;
}

TEST(OccludeAmbient, MatchesTheFormFactorInAnInnerCorner) {
    // A floor z < 9.25 and a wall x < 9.25, both opaque.
    const double radius = 8;
    const PassScene s = scene_of(
        {28, 28, 28}, [](const glm::dvec3& p) { return std::max(ramp(9.25 - p.z), ramp(9.25 - p.x)); }, 20, radius);
    const Reaches got = device_reaches(s);
    double worst = 0, sum = 0, count = 0;
    for (std::size_t i = 0; i < got.records.size(); ++i) {
        const auto& e = got.records[i].edge;
        const int v = static_cast<int>(got.records[i].voxel), x = v % 28, y = v / 28 % 28, z = v / 784;
        if (!e.has_edge || z > 9 || x < 12 || x > 20 || y < 10 || y > 17 || e.n.z < 0.99) continue;
        const double want = open_beside_wall(x - 9.25, radius);
        worst = std::max(worst, std::abs(got.first[i] - want));
        sum += got.first[i] - want;
        ++count;
    }
    ASSERT_GT(count, 60);
    EXPECT_LE(worst, 0.05) << "bound of method.md for this number of rays";
    EXPECT_LE(std::abs(sum / count), 0.02);
}

TEST(OccludeAmbient, OccludesTheInsideOfAClosedBox) {
    const PassScene s = scene_of(
        glm::ivec3(24),
        [](const glm::dvec3& p) {
            const glm::dvec3 q = glm::abs(p - 11.5);
            return ramp(std::max({q.x, q.y, q.z}) - 5.75);
        },
        20, 25);
    const Reaches got = device_reaches(s);
    std::size_t inner = 0;
    for (std::size_t i = 0; i < got.records.size(); ++i) {
        const int v = static_cast<int>(got.records[i].voxel);
        const glm::dvec3 q = glm::abs(glm::dvec3(v % 24, v / 24 % 24, v / 576) - 11.5);
        if (!got.records[i].edge.has_edge || std::max({q.x, q.y, q.z}) > 7) continue;
        ++inner;
        EXPECT_LE(got.first[i], 1e-3);
    }
    EXPECT_GT(inner, 300U);
}

TEST(OccludeAmbient, PassesOnlyGrazingRaysBetweenTwoPlanes) {
    // Planes 8 apart, rays of length 16: rays within 60 degrees of the normal meet the other plane, so cos^2 60 = 1/4
    // remains.
    const PassScene s = scene_of(
        glm::ivec3(40, 40, 24), [](const glm::dvec3& p) { return ramp(std::abs(p.z - 11.5) - 4.0); }, 20, 16);
    const Reaches got = device_reaches(s);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < got.records.size(); ++i) {
        const int v = static_cast<int>(got.records[i].voxel), x = v % 40, y = v / 40 % 40, z = v / 1600;
        // Splats further out see the sky beyond the border.
        if (!got.records[i].edge.has_edge || z < 5 || z > 18 || x < 15 || x > 24 || y < 15 || y > 24) continue;
        EXPECT_NEAR(got.first[i], 0.25, 0.08);
        sum += got.first[i];
        ++count;
    }
    ASSERT_GT(count, 60);
    // From a little above the surface the other plane is nearer: with 16 - 1.25 as distance, cos^2 is .19 to .25.
    EXPECT_NEAR(sum / count, 0.21, 0.04);
}

TEST(OccludeAmbient, MatchesTheClosedFormInHaze) {
    // Uniform matter except for one voxel, so that no splat far from it has a normal.
    const double radius = 6;
    for (const double extinction : {0.02, 0.1, 0.3}) {
        PassScene s = scene_of(
            glm::ivec3(24), [](const glm::dvec3& p) { return p == glm::dvec3(0) ? 0.9 : 1; }, extinction, radius);
        const Reaches got = device_reaches(s);
        std::size_t deep = 0;
        for (std::size_t i = 0; i < got.records.size(); ++i) {
            const int v = static_cast<int>(got.records[i].voxel);
            const glm::ivec3 p(v % 24, v / 24 % 24, v / 576);
            if (glm::any(glm::lessThan(p, glm::ivec3(7))) || glm::any(glm::greaterThan(p, glm::ivec3(16)))) continue;
            ++deep;
            EXPECT_NEAR(got.first[i], std::exp(-extinction * radius), 1e-4);
        }
        EXPECT_EQ(deep, 1000U);
    }
}

TEST(OccludeAmbient, IgnoresMatterThatIsCutAway) {
    PassScene s = scene_of(
        {28, 28, 28}, [](const glm::dvec3& p) { return std::max(ramp(9.25 - p.z), ramp(9.25 - p.x)); }, 20, 8);
    const auto mean_beside_wall = [&] {
        const Reaches got = device_reaches(s);
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < got.records.size(); ++i) {
            const int v = static_cast<int>(got.records[i].voxel), x = v % 28, y = v / 28 % 28, z = v / 784;
            if (!got.records[i].edge.has_edge || z > 9 || z < 7 || x < 12 || x > 14 || y < 10 || y > 17) continue;
            sum += got.first[i];
            ++count;
        }
        EXPECT_GT(count, 20);
        return sum / count;
    };
    EXPECT_LT(mean_beside_wall(), 0.85);
    s.scene.effects.clip.keep = {Plane{{10, 0, 0}, {-1, 0, 0}}};
    EXPECT_GT(mean_beside_wall(), 0.999);
    s.scene.effects.clip = {};
    s.scene.effects.clip.remove = {Plane{{10, 0, 0}, {1, 0, 0}}, Plane{{0, 0, 11}, {0, 0, -1}}};
    EXPECT_GT(mean_beside_wall(), 0.97);
}

TEST(OccludeAmbient, CostsNothingWhenOff) {
    PassScene s = pass_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    EXPECT_FALSE(state.lists().occlusion);
    for (const PassTime& time : state.cost.times)
        EXPECT_NE(time.name, "2b_occlude_ambient");
    s.scene.effects.occlusion = AmbientOcclusion{};
    state.collect(s.scene, s.settings, false);
    EXPECT_EQ(state.lists().occlusion.bytes(), 4 * state.lists().splat_count);
    s.scene.effects.occlusion->strength = 0.25;
    EXPECT_FALSE(state.collect(s.scene, s.settings, false)) << "the strength only changes colours";
    s.scene.effects.occlusion->radius = 3;
    EXPECT_TRUE(state.collect(s.scene, s.settings, false));
    s.scene.lights.clear();
    state.collect(s.scene, s.settings, false);
    EXPECT_FALSE(state.lists().occlusion) << "colours are unlit without lights";
}

}  // namespace
}  // namespace edgesplat::test
