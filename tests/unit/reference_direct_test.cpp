// Direct evaluation of the model, compared with closed forms and with plain steps along the ray.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/reference/direct_evaluation.h"
#include "footprints/kernel.h"
#include "tests/unit/reference_volumes.h"

namespace edgesplat::reference {
namespace {

using namespace testing_volumes;  // NOLINT: everything below comes from there

double largest_difference(const Image& a, const Image& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        largest = std::max(largest, std::abs(static_cast<double>(a.pixels[i]) - static_cast<double>(b.pixels[i])));
    return largest;
}

DirectResult evaluated(const PreparedVolume& prepared, const Camera& camera, int size, double tolerance,
                       Output output = Output::Color) {
    DirectOptions options;
    options.tolerance = tolerance;
    return direct_evaluation(prepared, camera, size, size, output, options);
}

/// The same sum in equal steps (voxels), each a slab of constant density; every step evaluates every near voxel.
Image stepped(const PreparedVolume& prepared, const Camera& camera, int size, double step) {
    const Field field = prepared.field();
    const Scene& scene = prepared.scene();
    const VolumeGeometry& geometry = prepared.volume().geometry;
    const View view(camera, geometry, size, size);
    const Footprints& footprints = prepared.footprints();
    const glm::dvec3 center = glm::dvec3(field.dims - 1) / 2.0;
    const double bound = glm::length(center) + 4;
    const std::vector<SplatRecord> records =
        collect_splats(field, prepared.scaled_scene(), prepared.edges(), scene, geometry, prepared.settings(),
                       camera.eye, true, prepared.classified(), prepared.carried());
    Image image(size, size, 4);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const glm::dvec3 u = view.ray(x, y);
            const double mm = glm::length(geometry.index_to_world_axes * u);
            const double middle = glm::dot(center - view.eye_index, u);
            // Only voxels that the ray can touch.
            std::vector<std::pair<SplatRecord, glm::dvec4>> near;
            for (const SplatRecord& record : records) {
                const glm::dvec3 v = glm::dvec3(field.voxel(record.voxel)) - view.eye_index;
                const bool nothing = record.edge.has_edge && record.edge.D <= -kKernelRadius;
                if (nothing || glm::length(v - glm::dot(v, u) * u) > 3) continue;
                const glm::dvec3 color = face_payload(record, field, scene, view, prepared.settings(), Payload::Color,
                                                      footprints, glm::dot(v, u) * u - v, u);
                near.push_back({record, record.extinction(scene) * glm::dvec4(color, 1)});
            }
            glm::dvec4 seen(0);
            for (double t = std::max(middle - bound, 0.0) + step / 2; t < middle + bound; t += step) {
                glm::dvec4 sum(0);
                for (const auto& [record, density] : near) {
                    const glm::dvec3 r = view.eye_index + t * u - glm::dvec3(field.voxel(record.voxel));
                    const double along = glm::dot(r, u);
                    const double h = footprints.cuts(record.edge)
                                         ? footprints.face_path(record.edge, r - along * u, u).kernel_at(along)
                                         : footprints.at_point(record.edge, r);
                    sum += h * density;
                }
                if (sum.w > 0)
                    seen += (1 - seen.w) * -std::expm1(-sum.w * mm * step) * glm::dvec4(glm::dvec3(sum) / sum.w, 1);
            }
            for (int c = 0; c < 4; ++c)
                image.at(x, y, c) = static_cast<float>(seen[c]);
        }
    }
    return image;
}

TEST(Direct, EqualsLimitOfSmallSteps) {
    const Volume volume = ball(12, 3.6);
    const Camera camera = looking_at(volume, {1, 2, -1}, 40, 20);
    for (const double extinction : {0.2, 8.0}) {
        const PreparedVolume prepared(volume, solid_scene(extinction), Settings{});
        const Image truth = stepped(prepared, camera, 12, 0.001);
        for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5}) {
            const DirectResult result = evaluated(prepared, camera, 12, tolerance);
            const double error = largest_difference(result.image, truth);
            // Steps and float32 are accurate to about 1e-6. A step in which a kernel ends is wrong by up to half a
            // step.
            EXPECT_LT(error, result.error_estimate + 0.5e-3 * std::min(extinction, 1.0))
                << extinction << ", " << tolerance;
            EXPECT_LE(result.error_estimate, tolerance) << extinction;
        }
    }
}

TEST(Direct, TighterTolerancesAgree) {
    const Volume volume = ball(14, 4.3);
    const Camera camera = looking_at(volume, {1, 2, -1}, 40, 30);
    Scene scene = solid_scene(8);
    scene.iso_values = {0.2, 0.8};
    scene.materials = {{}, {{1, 0.8, 0.6}, 0.3}, {{0.4, 0.7, 1}, 8}};
    for (const EdgeEstimator edges : {EdgeEstimator::Off, EdgeEstimator::March}) {
        Settings settings;
        settings.edges = edges;
        const PreparedVolume prepared(volume, scene, settings);
        const DirectResult coarse = evaluated(prepared, camera, 40, 1e-3);
        const DirectResult fine = evaluated(prepared, camera, 40, 1e-5);
        EXPECT_LT(largest_difference(coarse.image, fine.image), 1e-3);
        EXPECT_LT(coarse.samples, fine.samples);
        EXPECT_GT(coarse.samples, 0U);
    }
}

TEST(Direct, TauOfHomogeneousBodyIsExtinctionTimesLength) {
    // Plain kernels sum to 1 within their ripple (2e-3), which averages out over whole voxels along an axis.
    const Volume volume = sampled(glm::ivec3(16, 48, 16), [](const glm::dvec3& x) { return x.y < 100 ? 1.0 : 0.0; });
    Scene scene = solid_scene(0.05);
    scene.lights.clear();
    Settings settings;
    settings.edges = EdgeEstimator::Off;
    Camera camera;
    camera.direction = {0, 1, 0};
    camera.eye = {7.5, -30, 7.5};
    camera.fov_y = 2;
    const PreparedVolume prepared(volume, scene, settings);
    const Image color = evaluated(prepared, camera, 9, 1e-5).image;
    const Image tau = evaluated(prepared, camera, 9, 1e-5, Output::Tau).image;
    for (int y = 0; y < 9; ++y) {
        for (int x = 0; x < 9; ++x) {
            const double alpha = static_cast<double>(color.at(x, y, 3));
            EXPECT_NEAR(-std::log1p(-alpha), static_cast<double>(tau.at(x, y, 0)), 2e-4);
            EXPECT_NEAR(static_cast<double>(color.at(x, y, 1)), 0.8 * alpha, 2e-5);
            EXPECT_NEAR(alpha, -std::expm1(-0.05 * 48), 1e-3);
        }
    }
}

TEST(Direct, OneSplatMatchesClosedForm) {
    const Volume volume = sampled(glm::ivec3(3), [](const glm::dvec3& x) { return x == glm::dvec3(1) ? 1.0 : 0.0; });
    Settings settings;
    settings.edges = EdgeEstimator::Off;
    Camera camera = looking_at(volume, {0.3, 1, -0.2}, 20, 12);
    const PreparedVolume prepared(volume, solid_scene(0.7), settings);
    const auto check = [&] {
        const Image tau = evaluated(prepared, camera, 24, 1e-6, Output::Tau).image;
        const Image alpha = evaluated(prepared, camera, 24, 1e-6).image;
        const View view(camera, volume.geometry, 24, 24);
        for (int y = 0; y < 24; ++y) {
            for (int x = 0; x < 24; ++x) {
                const glm::dvec3 v = glm::dvec3(1) - view.eye_index;
                const double along = glm::dot(v, view.ray(x, y));
                const double rho2 = glm::dot(v, v) - along * along;
                // The half of the footprint beyond the point nearest to the voxel, plus the chord from the eye to that
                // point.
                const double expected = 0.7 * (kernel_footprint(rho2) / 2 + kernel_chord(rho2, along));
                EXPECT_NEAR(static_cast<double>(tau.at(x, y, 0)), expected, 2e-6);
                EXPECT_NEAR(static_cast<double>(alpha.at(x, y, 3)), -std::expm1(-expected), 2e-6);
            }
        }
    };
    check();
    camera.eye = {1.2, 0.7, 0.9};  // inside the kernel: only the part in front of the eye counts
    camera.fov_y = 80;
    check();
}

TEST(Direct, MeasuresAnisotropicGridsInMillimetres) {
    const glm::dmat3 axes(0.5, 0.1, 0, 0, 2, 0.3, 0, 0, 1.2);
    const Volume volume = sampled(
        glm::ivec3(12), [](const glm::dvec3& x) { return blurred(glm::length(x - 5.5) - 3.5); }, axes);
    const Camera camera = looking_at(volume, {1, 1, -1}, 40, 30);
    const PreparedVolume prepared(volume, solid_scene(0.5), Settings{});
    EXPECT_LT(largest_difference(evaluated(prepared, camera, 12, 1e-5).image, stepped(prepared, camera, 12, 0.001)),
              2e-4);
}

TEST(Direct, DegenerateInputsGiveFiniteNumbers) {
    const auto check = [](const Volume& volume, const Camera& camera, double extinction) {
        const PreparedVolume prepared(volume, solid_scene(extinction), Settings{});
        for (const Output output : {Output::Color, Output::Tau}) {
            const DirectResult result = evaluated(prepared, camera, 8, 1e-3, output);
            EXPECT_TRUE(std::isfinite(result.error_estimate));
            for (const float v : result.image.pixels)
                ASSERT_TRUE(std::isfinite(v));
        }
    };
    const Volume one = sampled(glm::ivec3(1), [](const glm::dvec3&) { return 1.0; });
    const Volume nothing = sampled(glm::ivec3(4), [](const glm::dvec3&) { return 0.0; });
    const Volume sheet = sampled(glm::ivec3(8, 1, 8), [](const glm::dvec3& x) { return x.x < 4 ? 1.0 : 0.0; });
    for (const Volume* volume : {&one, &nothing, &sheet}) {
        Camera camera = looking_at(*volume, {1, 2, -1}, 10, 40);
        check(*volume, camera, 1);
        camera.eye = glm::dvec3(0);  // on a voxel
        check(*volume, camera, 1);
        check(*volume, camera, 1e6);
        camera.direction = {0, 1, 0};  // along an axis, past everything
        camera.eye = {1e9, 1e9, 1e9};
        check(*volume, camera, 1);
    }
}

TEST(Direct, ProgressRisesAndCancels) {
    const Volume volume = ball(10, 3);
    const Camera camera = looking_at(volume, {1, 2, -1}, 30, 25);
    const PreparedVolume prepared(volume, solid_scene(1), Settings{});
    DirectOptions options;
    double last = 0;
    options.progress = [&](double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1);
        last = done;
        return true;
    };
    direct_evaluation(prepared, camera, 16, 16, Output::Color, options);
    EXPECT_EQ(last, 1);
    int calls = 0;
    options.progress = [&](double) { return ++calls < 2; };
    EXPECT_THROW(direct_evaluation(prepared, camera, 16, 64, Output::Color, options), Cancelled);
    EXPECT_EQ(calls, 2);
}

TEST(Direct, RefusesTolerancesOutOfRange) {
    const Volume volume = ball(8, 2);
    const PreparedVolume prepared(volume, solid_scene(1), Settings{});
    const Camera camera = looking_at(volume, {1, 2, -1}, 30, 25);
    for (const double tolerance : {0.0, -1.0, 0.2, std::nan("")})
        EXPECT_THROW(evaluated(prepared, camera, 4, tolerance), Error);
}

}  // namespace
}  // namespace edgesplat::reference
