// Faces against the reference: surfels, fitted quadrics, and pictures of both.
#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/reference/faces.h"
#include "engine/reference/reference_renderer.h"
#include "tests/passes/traced_scenes.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kFacesSize{72, 64};
constexpr std::size_t kFacesPixels = static_cast<std::size_t>(kFacesSize.x) * kFacesSize.y;

PassScene with_faces(PassScene s, EdgeEstimator edges = EdgeEstimator::Cubic) {
    s.settings.warp = WarpFamily::Face;
    s.settings.edges = edges;
    return s;
}

/// The position of a record's voxel.
glm::dvec3 place_of(std::uint32_t voxel, const glm::ivec3& dims) {
    return reference::Field{dims, {}, {}}.voxel(voxel);
}

class Surfels : public testing::TestWithParam<EdgeEstimator> {};

TEST_P(Surfels, AgreeWithTheReference) {
    for (const PassScene& plain : pass_scenes()) {
        PassScene s = with_faces(plain, GetParam());
        s.settings.cull_buried = false;
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto values = scaled_field(s.volume);
        const auto coefficients = bspline_coefficients(values, s.volume.geometry.dims);
        const reference::Field field{s.volume.geometry.dims, values, coefficients};
        const auto scaled = s.scaled();
        const auto got = device_field(state);
        std::size_t surfels = 0, differ = 0;
        for (std::size_t i = 0; i < got.size(); ++i) {
            const auto want = reference::quantise(
                reference::find_surfel(field, scaled, field.voxel(i), GetParam() == EdgeEstimator::Cubic));
            surfels += want.has_edge ? 1U : 0U;
            differ += same_edge(got[i], want) ? 0U : 1U;
        }
        EXPECT_GT(surfels, got.size() / 50);
        // At the limits of distance and slant, only one side may find a surfel. Where the surface bends within a voxel,
        // Newton's method does not converge.
        EXPECT_LE(static_cast<double>(differ), 0.03 * static_cast<double>(surfels)) << differ << " of " << surfels;
    }
}

std::string estimator_of(const testing::TestParamInfo<EdgeEstimator>& test) {
    return std::string(name_of(test.param));
}

INSTANTIATE_TEST_SUITE_P(All, Surfels, testing::Values(EdgeEstimator::March, EdgeEstimator::Cubic), estimator_of);

class FaceRecords : public testing::TestWithParam<EdgeEstimator> {};

TEST_P(FaceRecords, StoreTheFittedQuadrics) {
    std::vector<PassScene> scenes = pass_scenes();
    scenes.push_back(scenes[0]);
    scenes.back().name = "cube with a hole";
    scenes.back().volume = sample(resized(analytic_scene("cube-hole"), glm::ivec3(20)));
    scenes.back().scene.iso_values = {0.5};
    for (const PassScene& plain : scenes) {
        PassScene s = with_faces(plain, GetParam());
        SCOPED_TRACE(s.name);
        const bool is_wall = s.name == "wall from inside";
        // In thinner walls one quadric often fits both faces; in thicker ones a voxel sees only one.
        if (is_wall) s.volume = sample(slab_scene({24, 24, 24}, {0.3, 1, 0.2}, {11.5, 13, 11.5}, 2.5));
        DeviceUnderTest& state = prepared(s);
        const auto values = scaled_field(s.volume);
        std::vector<float> coefficients;
        if (GetParam() == EdgeEstimator::Cubic) coefficients = bspline_coefficients(values, s.volume.geometry.dims);
        const reference::Field field{s.volume.geometry.dims, values, coefficients};
        const auto surfels = device_field(state);
        std::size_t faces = 0, walls = 0, differ = 0;
        double most_bent = 0;
        for (const auto& record : device_records(state)) {
            const glm::ivec3 voxel = field.voxel(record.voxel);
            const auto want = reference::quantise(reference::finished_face(field, s.scaled(), s.settings, surfels,
                                                                           voxel, static_cast<int>(record.material)));
            const double d = std::abs((record.edge.D > -4 ? record.edge : want).D);
            if (std::abs(d - kKernelRadius) < 1e-3 || std::abs(d - edge_reach(s.settings)) < 1e-3) continue;
            ASSERT_EQ(record.edge.has_edge, want.has_edge) << d;
            if (!want.has_edge) continue;
            ++faces;
            walls += want.D2 < 4 ? 1U : 0U;
            double bending = 0;
            for (int k = 0; k < 3; ++k) {
                bending = std::max(bending, glm::length(record.edge.bending[k] - want.bending[k]));
                most_bent = std::max(most_bent, glm::length(want.bending[k]));
            }
            const auto &a = record.edge.crease, &b = want.crease;
            const bool same_crease = a.D < 3 ? std::abs(a.D - b.D) + glm::length(a.n - b.n) < 0.01 : !(b.D < 3);
            const auto &third = record.edge.corner, &wanted = want.corner;
            const bool same_corner =
                third.D < 3 ? std::abs(third.D - wanted.D) + glm::length(third.n - wanted.n) < 0.01 : !(wanted.D < 3);
            differ += same_edge(record.edge, want) && bending <= 0.02 && same_crease && same_corner ? 0U : 1U;
        }
        EXPECT_GT(faces, 500U);
        EXPECT_GT(most_bent, is_wall ? 1e-4 : 0.1);
        if (is_wall) std::printf("%zu of %zu are walls\n", walls, faces);
        // On the trilinear field one quadric fits both faces.
        EXPECT_TRUE(!is_wall || GetParam() == EdgeEstimator::March || 2 * walls > faces);
        // Rounding may decide which of two surfels is nearer, or which of two quadrics fits better.
        EXPECT_LE(static_cast<double>(differ), 0.01 * static_cast<double>(faces)) << differ << " of " << faces;
    }
}

TEST_P(FaceRecords, TurnLikeTheFieldBelowTheFace) {
    // Below a plane surface the gradient turns by up to 5 degrees; light inside translucent matter follows it.
    constexpr double kTurn = 0.02;
    const glm::dvec3 center(11.5);
    AnalyticScene scene;
    scene.dims = glm::ivec3(24);
    scene.iso_values = {0};
    scene.value = [&](const glm::dvec3& x) { return (x.z - center.z) * (1 + kTurn * (x.x - center.x)); };
    PassScene s = with_faces(pass_scenes()[0], GetParam());
    s.volume = sample(scene);
    s.scene.iso_values = {0};
    s.settings.cull_buried = false;
    DeviceUnderTest& state = prepared(s);
    int deep = 0;
    for (const auto& record : device_records(state)) {
        const auto& edge = record.edge;
        const glm::dvec3 x = place_of(record.voxel, scene.dims);
        const glm::dvec3 of_border = glm::min(x + 0.5, 23.5 - x);
        if (!edge.has_edge || edge.D < 1 || std::min({of_border.x, of_border.y, of_border.z}) < 4) continue;
        const glm::dvec3 g(-kTurn * (x.z - center.z), 0, -1 - kTurn * (x.x - center.x));
        const glm::dvec3 slope = edge.n - edge.D * (edge.bending * edge.n);
        const auto off = [&](const glm::dvec3& n) {
            return glm::length(glm::cross(n, g)) / glm::length(n) / glm::length(g);
        };
        EXPECT_LE(off(slope), 0.35 * off(edge.n) + 2e-3) << "D " << edge.D;
        ++deep;
    }
    EXPECT_GT(deep, 500);
}

TEST(Faces, FitBothFacesOfAWedge) {
    // The matter lies between two planes, 25 degrees off parallel and 3.4 voxels apart in the middle.
    const glm::dvec3 center(11.5), a(0, 0.216440, 0.976296), b(0, 0.216440, -0.976296);
    const auto inside_of = [&](const glm::dvec3& n, const glm::dvec3& x) { return 1.66 - glm::dot(n, x - center); };
    AnalyticScene scene;
    scene.dims = glm::ivec3(24);
    scene.iso_values = {0};
    scene.value = [&](const glm::dvec3& x) {
        return std::clamp(std::min(inside_of(a, x), inside_of(b, x)), -2.0, 2.0);
    };
    PassScene s = with_faces(pass_scenes()[0]);
    s.volume = sample(scene);
    s.scene.iso_values = {0};
    s.settings.cull_buried = false;
    DeviceUnderTest& state = prepared(s);
    int walls = 0, all = 0;
    std::vector<double> off, turned;
    for (const auto& record : device_records(state)) {
        const auto& edge = record.edge;
        const glm::dvec3 x = place_of(record.voxel, scene.dims), from = glm::abs(x - center);
        if (!edge.has_edge || edge.D < 0 || from.x > 7 || from.y > 1) continue;
        ++all;
        if (!(edge.D2 < 4)) continue;
        ++walls;
        const glm::dvec3 other = edge.n.z > 0 ? b : a, at = x - edge.D2 * edge.n;
        off.push_back(std::abs(inside_of(other, at)));
        const glm::dvec3 slope = edge.n - (edge.D + edge.D2) * (edge.bending * edge.n);
        turned.push_back(glm::length(glm::cross(glm::normalize(slope), other)));
    }
    ASSERT_GT(all, 100);
    EXPECT_GT(walls, all * 9 / 10);
    std::ranges::sort(off);
    std::ranges::sort(turned);
    EXPECT_LE(off[off.size() * 9 / 10], 0.1);
    // With parallel faces it would be .42.
    EXPECT_LE(turned[turned.size() * 9 / 10], 0.05);
}

INSTANTIATE_TEST_SUITE_P(All, FaceRecords, testing::Values(EdgeEstimator::March, EdgeEstimator::Cubic), estimator_of);

TEST(Faces, FitASphereExactly) {
    // The samples of a ball, up to the errors of the spline: distances to .01 voxel, curvature to a tenth.
    PassScene s = with_faces(pass_scenes()[0]);
    const glm::dvec3 center(13.3, 12.6, 9.4);
    s.volume = sample(sphere_scene({28, 26, 20}, center, 6.3));
    DeviceUnderTest& state = prepared(s);
    double worst = 0, sum2 = 0, bent = 0;
    int count = 0;
    for (const auto& record : device_records(state)) {
        if (!record.edge.has_edge) continue;
        const glm::dvec3 x = place_of(record.voxel, s.volume.geometry.dims);
        const double error = record.edge.D - (6.3 - glm::length(x - center));
        worst = std::max(worst, std::abs(error));
        sum2 += error * error;
        // Perpendicular to the normal at the foot point, every direction has the curvature 1 / radius.
        const glm::dvec3 n = record.edge.n, across = glm::normalize(glm::cross(n, glm::dvec3(0.3, 0.9, 0.2)));
        bent += glm::dot(across, record.edge.bending * across);
        ++count;
    }
    ASSERT_GT(count, 500);
    EXPECT_LE(std::sqrt(sum2 / count), 0.01);
    EXPECT_LE(worst, 0.05);
    EXPECT_NEAR(bent / count * 6.3, 1, 0.1);
}

TEST(Faces, FitTheEdgesOfABox) {
    // For a voxel of a mask near an edge, both planes are faces of the box, half a voxel beyond its outermost voxels.
    constexpr int kFirst = 6, kLast = 17;
    PassScene s = with_faces(pass_scenes()[0]);
    Volume box;
    box.geometry.dims = glm::ivec3(24);
    const auto inside = [](const glm::ivec3& p) {
        return glm::all(glm::greaterThanEqual(p, glm::ivec3(kFirst))) &&
               glm::all(glm::lessThanEqual(p, glm::ivec3(kLast)));
    };
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
                box.values.push_back(inside({x, y, z}) ? 1.0F : 0.0F);
    finish_volume(box);
    s.volume = std::move(box);
    s.scene.iso_values = {0.5};
    s.settings.cull_buried = false;
    DeviceUnderTest& state = prepared(s);
    std::size_t found = 0;
    for (const auto& record : device_records(state)) {
        const auto& edge = record.edge;
        if (!edge.has_edge || !(edge.crease.D < 2)) continue;
        const glm::dvec3 x = place_of(record.voxel, s.volume.geometry.dims);
        for (const auto& [n, distance] : {std::pair(edge.n, edge.D), std::pair(edge.crease.n, edge.crease.D)}) {
            const glm::dvec3 away = glm::abs(n);
            const int axis = away.x > 0.9 ? 0 : away.y > 0.9 ? 1 : 2;
            EXPECT_GT(away[axis], 0.99);
            const double face = n[axis] > 0 ? kLast + 0.5 : kFirst - 0.5;
            EXPECT_NEAR(x[axis] + n[axis] * distance, face, 0.1);
        }
        ++found;
    }
    // The voxels beside the edges that are not at corners.
    EXPECT_GE(found, 12U * 9U * 4U);
}

struct FacesCase {
    const char* name;
    std::size_t scene;
    SheetCut sheets = SheetCut::Whole;
    bool clip = false;
};

class DrawFaces : public NeedsLayers<testing::TestWithParam<FacesCase>> {};

TEST_P(DrawFaces, SheetsAgreeWithTheReference) {
    std::vector<PassScene> scenes = pass_scenes();
    for (const PassScene& rough : traced_scenes())
        scenes.push_back(rough);
    PassScene s = with_faces(scenes[GetParam().scene]);
    s.settings.sheet_spacing = 6;
    s.settings.sheets = GetParam().sheets;
    s.settings.saturation = 1;
    if (GetParam().clip) {
        const glm::dvec3 middle = s.volume.geometry.to_world(glm::dvec3(s.volume.geometry.dims) * 0.5);
        s.scene.effects.clip.keep = {{middle, {0.3, -1, 0.4}}};
    }
    s.settings = canonical_settings(s.settings, s.scene);
    DeviceUnderTest& state = prepared(s);
    const auto [records, sheets, rect] = drawn_sheets(state, s, kFacesSize);
    ASSERT_EQ(state.plan().params.group_count, 1U);
    EXPECT_FALSE(state.plan().variant.traced);
    const Oracle oracle(s, records, kFacesSize);
    const auto sheet_of = download<std::uint32_t>(state, state.targets().sheet_of, records.size());
    const double thickness = reference::sheet_thickness(oracle.view, s.settings);
    const int base = reference::sheets_of(records, oracle.field, oracle.view, s.settings, oracle.footprints).first();
    const bool sliced = s.settings.sheets == SheetCut::Sliced;
    double peak = 0;
    std::size_t compared = 0, differ = 0;
    for (std::uint32_t sheet = 0; sheet < state.plan().params.sheet_count; ++sheet) {
        const int place = static_cast<int>(sheet) + state.plan().params.sheet_base;
        std::vector<std::uint32_t> splats;
        for (std::uint32_t i = 0; i < records.size(); ++i) {
            const reference::Selected& selected = oracle.selected[i];
            const bool touches = selected.sheet <= place - base && place - base <= selected.last_sheet;
            const bool there = sliced ? touches && sheet_of[i] != shader::SHEET_NONE : sheet_of[i] == sheet;
            if (there) splats.push_back(i);
        }
        std::vector<glm::dvec4> want(kFacesPixels, glm::dvec4(0));
        std::optional<reference::DepthRange> cut;
        if (sliced) cut = {thickness * place, thickness * (place + 1)};
        oracle.drawer.draw(splats, reference::Payload::Color, {}, want, cut);
        for (std::size_t i = 0; i < kFacesPixels; ++i) {
            const int x = static_cast<int>(i) % kFacesSize.x, y = static_cast<int>(i) / kFacesSize.x;
            const bool inside = x >= rect.x && x < rect.z && y >= rect.y && y < rect.w;
            const glm::dvec4 got = inside ? glm::dvec4(sheets[sheet * kFacesPixels + i]) : glm::dvec4(0);
            peak = std::max(peak, want[i].a);
            double worst = 0;
            for (int c = 0; c < 4; ++c)
                worst = std::max(worst, std::abs(got[c] - want[i][c]));
            compared += want[i].a > 0 ? 1U : 0U;
            differ += worst > 2e-3 * std::max(want[i].a, 0.5) ? 1U : 0U;
        }
    }
    EXPECT_GT(peak, 0.5);
    ASSERT_GT(compared, kFacesPixels / 10);
    // A ray that barely touches a face may meet it on one side only: few pixels, along outlines.
    EXPECT_LE(static_cast<double>(differ), 0.003 * static_cast<double>(compared)) << differ << " of " << compared;
}

INSTANTIATE_TEST_SUITE_P(All, DrawFaces,
                         testing::Values(FacesCase{"torus", 0}, FacesCase{"orbital", 1}, FacesCase{"wall", 2},
                                         FacesCase{"torus_sliced", 0, SheetCut::Sliced},
                                         FacesCase{"orbital_clipped", 1, SheetCut::Whole, true},
                                         FacesCase{"opening", 3}, FacesCase{"gyroid", 4},
                                         FacesCase{"gyroid_sliced", 4, SheetCut::Sliced}, FacesCase{"cut", 5}),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace edgesplat::test
