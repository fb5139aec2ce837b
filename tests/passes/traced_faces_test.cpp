// Faces that rays find: pictures against rays through the whole field, tiles against layers, and no cost where quadrics
// fit. faces_test.cpp compares sheets with the reference.
#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/reference/traced_face.h"
#include "tests/passes/traced_scenes.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kTracedSize{80, 72};
constexpr std::size_t kTracedPixels = static_cast<std::size_t>(kTracedSize.x) * kTracedSize.y;

std::vector<glm::vec4> picture(DeviceUnderTest& state, const PassScene& s, const Settings& settings) {
    state.draw(s.scene, s.camera, settings, kTracedSize, shader::PAYLOAD_COLOR);
    const auto pixels = state.targets().output.mapped<glm::vec4>(kTracedPixels);
    return {pixels.begin(), pixels.end()};
}

Settings all_drawn(Settings settings) {
    settings.pixels = PixelChoice::Every;
    return settings;
}

/// A field with its samples and coefficients.
struct WholeField {
    explicit WholeField(const PassScene& s)
        : values(scaled_field(s.volume)),
          coefficients(bspline_coefficients(values, s.volume.geometry.dims)),
          field{s.volume.geometry.dims, values, coefficients},
          interval{s.scaled().lower(1), s.scaled().upper(1)} {}
    std::vector<float> values, coefficients;
    reference::Field field;
    reference::VoxelEdge::Interval interval;
};

/// Number of wrong pixels: more than half opaque although the ray meets no matter, or clearly translucent although the
/// ray passes a voxel of matter. Rays with less matter, and rays that nearly meet matter, are ignored.
std::size_t wrong_pixels(const PassScene& s, std::span<const glm::vec4> pixels) {
    const WholeField whole(s);
    const reference::View view(s.camera, s.volume.geometry, kTracedSize.x, kTracedSize.y);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const glm::dvec3 u = view.ray(static_cast<int>(i) % kTracedSize.x, static_cast<int>(i) / kTracedSize.x);
        double most = -1e9, way = 0;
        for (double z = 0; z < 60; z += 0.05) {
            const glm::dvec3 x = view.eye_index + z * u;
            if (x != glm::clamp(x, glm::dvec3(0), glm::dvec3(whole.field.dims - 1))) continue;
            const double f = reference::sample(whole.field, x, true);
            most = std::max(most, f);
            way += whole.interval.holds(f) ? 0.05 : 0;
        }
        const double alpha = static_cast<double>(pixels[i].a);
        if (most < whole.interval.low - 0.03) wrong += alpha > 0.5 ? 1U : 0U;
        if (way > 1) wrong += alpha < 0.75 ? 1U : 0U;
    }
    return wrong;
}

TEST(TracedFaces, KeepOpeningsAsWideAsTheFields) {
    const PassScene s = traced_scenes()[0];
    DeviceUnderTest& state = prepared(s);
    const auto pixels = picture(state, s, all_drawn(s.settings));
    ASSERT_TRUE(state.plan().variant.traced);
    EXPECT_EQ(wrong_pixels(s, pixels), 0U);
    // The opening is visible; quadrics alone close it.
    PassScene fitted = s;
    fitted.settings.edges = EdgeEstimator::March;
    DeviceUnderTest& same = prepared(fitted);
    const auto closed = picture(same, fitted, all_drawn(fitted.settings));
    EXPECT_FALSE(same.plan().variant.traced);
    EXPECT_GT(wrong_pixels(s, closed), 15U);
}

TEST(TracedFaces, AreTheSameInTilesAndLayers) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    for (const PassScene& s : traced_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        for (const PixelChoice choice : {PixelChoice::Every, PixelChoice::Refined}) {
            Settings settings = all_drawn(s.settings);
            const auto layers = picture(state, s, layered(settings));
            settings.pixels = choice;
            const auto tiles = picture(state, s, settings);
            double squares = 0;
            for (std::size_t i = 0; i < kTracedPixels; ++i)
                for (int c = 0; c < 4; ++c)
                    squares += std::pow(static_cast<double>(tiles[i][c] - layers[i][c]), 2);
            EXPECT_GT(-10 * std::log10(squares / (4.0 * kTracedPixels) + 1e-30),
                      choice == PixelChoice::Every ? 60 : 45);
        }
    }
}

class TracedRays : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Of, TracedRays, testing::Values(1, 2),
                         [](const auto& test) { return traced_scenes()[test.param].name; });

TEST_P(TracedRays, MatchRaysWithSmallSteps) {
    const PassScene s = traced_scenes()[GetParam()];
    const WholeField whole(s);
    const reference::View view(s.camera, s.volume.geometry, kTracedSize.x, kTracedSize.y);
    const glm::dvec3 middle = glm::dvec3(s.volume.geometry.dims) / 2.0;
    std::size_t rays = 0, pieces = 0, at_borders = 0, differ = 0;
    for (int y = 2; y < kTracedSize.y; y += 5) {
        for (int x = 2; x < kTracedSize.x; x += 5) {
            const glm::dvec3 u = view.ray(x, y);
            const auto ray = reference::trace_ray(whole.field, view.eye_index, u, 5, 60, whole.interval);
            ++rays;
            pieces += ray.pieces.size();
            for (const reference::TracedPiece& piece : ray.pieces) {
                // Ends lie on the surface, or where the ray enters the volume; between them is matter.
                const auto value = [&](double z) {
                    return reference::sample(whole.field, view.eye_index + z * u, true);
                };
                const glm::dvec3 begin = glm::abs(view.eye_index + piece.begin * u + 0.5 - middle);
                const glm::dvec3 at_border(glm::greaterThan(begin, middle - 1e-6));
                const bool enters = std::isfinite(piece.begin) && at_border != glm::dvec3(0);
                if (enters) {
                    ++at_borders;
                    EXPECT_TRUE(whole.interval.holds(value(piece.begin)));
                    EXPECT_EQ(glm::abs(piece.n), at_border);
                } else if (std::isfinite(piece.begin)) {
                    EXPECT_NEAR(value(piece.begin), whole.interval.low, 1e-6);
                }
                if (std::isfinite(piece.begin)) {
                    EXPECT_LE(glm::dot(piece.n, u), 1e-6);
                }
                // Nothing is found beyond the volume's end, half a voxel beyond its outermost samples.
                for (const double found : {piece.begin, piece.end}) {
                    if (!std::isfinite(found)) continue;
                    const glm::dvec3 off = glm::abs(view.eye_index + found * u + 0.5 - middle) - middle;
                    EXPECT_LE(std::max({off.x, off.y, off.z}), 1e-6);
                }
                const double end = std::isfinite(piece.end) ? piece.end : piece.begin + 1;
                for (double z = piece.begin + 1e-3; z < end - 1e-3; z += 0.02)
                    differ += whole.interval.holds(value(z)) ? 0U : 1U;
            }
            // In the volume, the ray before the first piece is empty.
            const double first = ray.pieces.empty() ? ray.last : ray.pieces[0].begin;
            std::size_t missed = 0;
            for (double z = 5; z < first - 1e-3; z += 0.02) {
                const glm::dvec3 place = view.eye_index + z * u;
                if (glm::any(glm::greaterThan(glm::abs(place + 0.5 - middle), middle))) continue;
                missed += whole.interval.holds(reference::sample(whole.field, place, true)) ? 1U : 0U;
            }
            EXPECT_LE(missed, 20U) << "missed more than .4 voxels of matter at " << x << ' ' << y;
        }
    }
    EXPECT_GT(pieces, rays / 8);
    EXPECT_EQ(at_borders > 5, s.name == "cut");
    EXPECT_LE(differ, pieces);
}

TEST(TracedFaces, RaysOfTheDeviceEndOnTheSurface) {
    for (const PassScene& s : traced_scenes()) {
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        picture(state, s, all_drawn(s.settings));
        state.commands().run([&] {
            state.commands().fill(state.targets().traced_rays, 0);
            state.commands().barrier();
        });
        picture(state, s, all_drawn(s.settings));
        const WholeField whole(s);
        const reference::View view(s.camera, s.volume.geometry, kTracedSize.x, kTracedSize.y);
        const auto texels = download<glm::vec4>(state, state.targets().traced_rays, 2 * kTracedPixels);
        std::size_t ends = 0;
        double worst = 0, turned = 0;
        for (std::size_t i = 0; i < kTracedPixels; ++i) {
            const glm::vec4 pieces = texels[2 * i], codes = texels[2 * i + 1];
            if (codes.z <= 0) continue;  // no traced splat reaches the pixel
            const glm::dvec3 u = view.ray(static_cast<int>(i) % kTracedSize.x, static_cast<int>(i) / kTracedSize.x);
            for (const int piece : {0, 1}) {
                const double z = static_cast<double>(pieces[2 * piece]);
                if (std::abs(z) > 1e8) continue;
                const glm::dvec3 x = view.eye_index + z * u, g = reference::spline_gradient(whole.field, x);
                const double off = (reference::sample(whole.field, x, true) - whole.interval.low) / glm::length(g);
                const glm::dvec3 n =
                    decode_edge(std::bit_cast<std::uint32_t>(codes[piece]), shader::EDGE_LOWER << 26U).n;
                ++ends;
                // The ray enters the volume in matter.
                const glm::dvec3 middle = glm::dvec3(s.volume.geometry.dims - 1) / 2.0;
                const glm::dvec3 at_border(glm::greaterThan(glm::abs(x - middle), middle + 0.5 - 1e-4));
                const bool enters = at_border != glm::dvec3(0) && off > 1e-3;
                worst = std::max(worst, enters ? 0 : std::abs(off));
                turned = std::max(turned,
                                  enters ? glm::length(glm::abs(n) - at_border) : glm::length(n + glm::normalize(g)));
            }
        }
        EXPECT_GT(ends, kTracedPixels / 20);
        EXPECT_LE(worst, 1e-3);
        EXPECT_LE(turned, 5e-3);
    }
}

TEST(TracedFaces, CostNothingWhereQuadricsFit) {
    // A ball, and a translucent gyroid.
    PassScene ball = traced_scenes()[1];
    ball.volume = sample(sphere_scene({26, 24, 25}, {12.4, 12.2, 12.1}, 7.3));
    ball.scene.iso_values = {0.5};
    PassScene haze = traced_scenes()[1];
    haze.scene.materials[1].extinction = 0.2;
    for (const PassScene& s : {ball, haze}) {
        DeviceUnderTest& state = prepared(s);
        state.session.pipelines().forget_used();
        picture(state, s, s.settings);
        EXPECT_FALSE(state.plan().variant.traced);
        EXPECT_FALSE(state.targets().traced_rays);
        EXPECT_FALSE(state.targets().traced_entries);
        for (const gpu::PipelineVariant& variant : state.session.pipelines().used())
            EXPECT_STRNE(variant.shaders[0], "5_trace_faces.comp");
    }
    const PassScene s = traced_scenes()[1];
    DeviceUnderTest& state = prepared(s);
    picture(state, s, s.settings);
    EXPECT_TRUE(state.plan().variant.traced);
    EXPECT_TRUE(state.targets().traced_rays);
}

}  // namespace
}  // namespace edgesplat::test
