// Metrics of the accuracy report on inputs with known answers.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include "engine/accuracy/configurations.h"
#include "engine/accuracy/edge_profiles.h"
#include "engine/accuracy/frame_times.h"
#include "engine/accuracy/heat_map.h"
#include "engine/accuracy/metrics.h"
#include "engine/accuracy/page_parts.h"
#include "engine/accuracy/report_cameras.h"
#include "engine/accuracy/svg_plot.h"
#include "engine/error.h"
#include "engine/scene/ladder.h"

namespace edgesplat::accuracy {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Image filled(float value, int channels = 4) {
    Image image(4, 3, channels);
    std::fill(image.pixels.begin(), image.pixels.end(), value);
    return image;
}

TEST(AccuracyMetrics, ImageErrorIgnoresAlpha) {
    Image a = filled(0.5F), b = filled(0.5F);
    b.at(1, 1, 3) = 0;  // alpha does not count
    EXPECT_EQ(image_error(a, b), ImageError{});
    b.at(2, 0, 1) = 0.75F;
    EXPECT_DOUBLE_EQ(image_error(a, b).max, 0.25);
    EXPECT_DOUBLE_EQ(image_error(a, b).rms, 0.25 / std::sqrt(36.0));
    b.at(0, 0, 0) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isinf(image_error(a, b).max));
    EXPECT_THROW(image_error(a, Image(4, 4, 4)), Error);
}

TEST(AccuracyMetrics, DecibelsUseRootMeanSquare) {
    EXPECT_DOUBLE_EQ(decibels({.rms = 0.01, .max = 1}), 40);
    EXPECT_TRUE(std::isinf(decibels({})));
}

TEST(AccuracyMetrics, PooledErrorIsTheRootMeanSquare) {
    const std::vector<ImageError> errors{{0.3, 0.5}, {0.4, 0.9}};
    EXPECT_DOUBLE_EQ(pooled(errors).rms, std::sqrt(0.125));
    EXPECT_DOUBLE_EQ(pooled(errors).max, 0.9);
    EXPECT_EQ(pooled({}), ImageError{});
}

TEST(AccuracyMetrics, MeasuresRiseAndLocationOfLinearEdge) {
    // A linear fall from 1 to 0 over a length of 2 around 0.3: from 10 to 90 % it takes 1.6.
    std::vector<double> profile;
    for (int i = 0; i <= 500; ++i)
        profile.push_back(std::clamp(0.5 - (-2.5 + 0.01 * i - 0.3) / 2, 0.0, 1.0));
    const auto edge = profile_edge(profile, -2.5, 0.01);
    ASSERT_TRUE(edge);
    EXPECT_NEAR(edge->rise, 1.6, 1e-9);
    EXPECT_NEAR(edge->location, 0.3, 1e-9);
}

TEST(AccuracyMetrics, MeasuresRiseOfGaussianBlur) {
    std::vector<double> profile;
    for (int i = 0; i <= 500; ++i)
        profile.push_back(0.5 * std::erfc((-2.5 + 0.01 * i) / (0.7 * std::sqrt(2.0))));
    EXPECT_NEAR(profile_edge(profile, -2.5, 0.01)->rise, 2 * 1.2815515655 * 0.7, 1e-4);
}

TEST(AccuracyMetrics, FindsNoEdgeInFlatProfile) {
    EXPECT_FALSE(profile_edge(std::vector<double>(50, 1.0), 0, 1));
    EXPECT_FALSE(profile_edge(std::vector<double>(50, 0.0), 0, 1));
    EXPECT_FALSE(profile_edge({}, 0, 1));
}

TEST(AccuracyMetrics, MeasuresPoppingOfKnownSequences) {
    const std::vector<Image> still{filled(0.2F), filled(0.2F), filled(0.2F)};
    const std::vector<Image> moving{filled(0.2F), filled(0.3F), filled(0.6F)};
    const std::vector<Image> back{filled(0.6F), filled(0.5F), filled(0.2F)};
    EXPECT_NEAR(popping(moving, still).mean_excess, 0.2, 1e-6);
    EXPECT_NEAR(popping(moving, still).max_difference, 0.3, 1e-6);
    EXPECT_NEAR(popping(moving, moving).mean_difference, 0, 1e-12);
    // Equal changes in the opposite order: the excess cancels, the difference does not.
    EXPECT_NEAR(popping(moving, back).mean_excess, 0, 1e-6);
    EXPECT_NEAR(popping(moving, back).mean_difference, 0.4, 1e-6);
    EXPECT_NEAR(popping(still, moving).max_excess, -0.1, 1e-6);
    EXPECT_THROW(popping(still, std::vector<Image>{filled(0)}), Error);
    EXPECT_THROW(popping(std::vector<Image>{filled(0)}, std::vector<Image>{filled(0)}), Error);
}

TEST(AccuracyMetrics, QuantilesInterpolateLinearly) {
    EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
    EXPECT_DOUBLE_EQ(quantile({7}, 0.1), 7);
    EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
    EXPECT_DOUBLE_EQ(spread({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10}).high, 9);
}

TEST(AccuracyMetrics, ParetoFrontDropsDominatedPoints) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<CostAndError> points{{3, 1}, {1, 5}, {2, 5}, {2, 3}, {4, 1}, {1, 5}, {nan, 0}, {5, 0.5}};
    EXPECT_THAT(pareto_front(points), ElementsAre(1, 3, 0, 7));
    EXPECT_THAT(pareto_front({}), ElementsAre());
}

TEST(AccuracyTimes, ComputesRatioWithinTriples) {
    // In the second visit all times are doubled; the ratio does not change.
    TimedVisit fast{{{10, 5, 10}, {10, 5, 10}}, {{9, 3, 9}, {9, 3, 9}}, {{"5_draw_splats", 7}}, 0}, slow = fast;
    for (TimedTriple& t : slow.triples)
        t = {2 * t.before, 2 * t.ray, 2 * t.after};
    const std::vector<TimedVisit> visits{fast, slow};
    const FrameTimes times = summarise(visits, RatioClock::Wall);
    EXPECT_DOUBLE_EQ(times.ratio.median, 2);
    EXPECT_DOUBLE_EQ(times.ratio.high, 2);
    EXPECT_DOUBLE_EQ(times.frame.median, 15);
    EXPECT_DOUBLE_EQ(summarise(visits, RatioClock::Processor).ratio.median, 3);
    EXPECT_DOUBLE_EQ(summarise(visits, RatioClock::Processor).wall_ratio.median, 2);
    EXPECT_EQ(times.passes.front().first, "5_draw_splats");
    const TimedVisit again = timed_visit_from(to_json(slow));
    EXPECT_EQ(again.triples.size(), 2U);
    EXPECT_DOUBLE_EQ(again.triples[1].after, 20);
}

TEST(AccuracyTimes, ShufflesOrderOfEveryRound) {
    EXPECT_NE(order_of_round(20, 0), order_of_round(20, 1));
    EXPECT_EQ(order_of_round(20, 3), order_of_round(20, 3));
    auto sorted = order_of_round(20, 5);
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 0; i < sorted.size(); ++i)
        EXPECT_EQ(sorted[i], i);
}

TEST(AccuracyConfigurations, IncludesEveryUsedStepAndPreset) {
    const auto rows = configurations({});
    std::size_t combinations = 0, steps = 0, expected_steps = 0;
    for (const Configuration& row : rows) {
        combinations += row.kind == ConfigurationKind::Combination ? 1 : 0;
        steps += row.kind == ConfigurationKind::Step ? 1 : 0;
        EXPECT_NO_THROW(validate(row.settings)) << row.name;
    }
    for (const Knob& knob : ladder()) {
        Settings from;
        if (knob.from != nullptr) knob.from(from);
        if (knob.used(from) && knob.steps.size() > 1) expected_steps += knob.steps.size();
    }
    EXPECT_EQ(steps, expected_steps);
    EXPECT_GT(combinations, 10U);
    EXPECT_LE(combinations, 40U);
    EXPECT_EQ(rows.front().kind, ConfigurationKind::Base);
    for (const RaycastFilter filter : {RaycastFilter::Trilinear, RaycastFilter::Cubic})
        EXPECT_EQ(std::ranges::count(rows, std::optional(filter), &Configuration::rays), 1);
    EXPECT_EQ(std::ranges::count(rows, ConfigurationKind::Plain, &Configuration::kind), 1);
    std::set<std::string> pictures;
    for (const Configuration& row : rows)
        if (row.kind == ConfigurationKind::Base || row.rays) pictures.insert(picture_key(row));
    EXPECT_EQ(pictures.size(), 3U) << "ray configurations share the base's settings, but not its picture";
    for (const Preset& preset : presets())
        EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const Configuration& row) {
            return row.kind == ConfigurationKind::Preset && row.name == preset.name && row.settings == preset.settings;
        })) << preset.name;
}

TEST(AccuracyConfigurations, ModelKeyIgnoresMethodSettings) {
    Settings a, b;
    a.footprints = FootprintMode::Warp2d;
    a.sheets = SheetCut::Sliced;
    a.sheet_spacing = 2;
    a.saturation = 0.98;
    EXPECT_EQ(model_key(a), model_key(b));
    EXPECT_NE(settings_key(a), settings_key(b));
    b.edges = EdgeEstimator::March;
    EXPECT_NE(model_key(a), model_key(b));
    a.edges = b.edges = EdgeEstimator::Off;
    EXPECT_EQ(model_key(a), model_key(b));
}

TEST(AccuracyCameras, PlacesNoEyeInMatter) {
    for (const char* name : {"sphere", "cube-hole", "torus", "plates", "phantom", "orbital"}) {
        const AnalyticScene analytic = analytic_scene(name);
        const Volume volume = sample(analytic);
        Scene scene;
        scene.iso_values = analytic.iso_values;
        scene.materials.assign(scene.iso_values.size() + 1, {{1, 1, 1}, 1});
        scene.materials.front().extinction = 0;
        const auto cameras = report_cameras(volume, scene, 96, 96);
        ASSERT_FALSE(cameras.empty());
        EXPECT_EQ(cameras.front().name, "far");
        EXPECT_EQ(cameras.back().name, "inside") << name;
        for (const ReportCamera& c : cameras) {
            const glm::ivec3 voxel(glm::round(volume.geometry.to_index(c.camera.eye)));
            const bool within = glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
                                glm::all(glm::lessThan(voxel, volume.geometry.dims));
            if (within) {
                EXPECT_LT(static_cast<double>(volume.at(voxel.x, voxel.y, voxel.z)), scene.iso_values.front())
                    << name << " " << c.name;
            }
        }
        EXPECT_EQ(report_cameras(volume, scene, 96, 96).back().camera.eye, cameras.back().camera.eye);
    }
}

TEST(AccuracyEdges, SurfacePointsLieOnTheSurface) {
    const AnalyticScene scene = sphere_scene(glm::ivec3(24), {11.2, 11.7, 11.5}, 7);
    const SurfacePoints points = surface_points(scene, 50);
    ASSERT_EQ(points.points.size(), 50U);
    for (const SurfacePoint& p : points.points) {
        EXPECT_NEAR(scene.signed_distance(p.position), 0, 1e-6);
        EXPECT_NEAR(scene.signed_distance(p.position + p.axis), 1, 1e-6);
    }
}

TEST(AccuracyEdges, SharperModelsRiseFaster) {
    const AnalyticScene analytic = sphere_scene(glm::ivec3(28), {13.2, 13.7, 13.5}, 9);
    const Volume volume = sample(analytic);
    Scene scene;
    scene.iso_values = {0.5};
    scene.materials = {{}, {{1, 1, 1}, 4}};
    const SurfacePoints points = surface_points(analytic, 20);
    Settings plain, sharp;
    plain.edges = EdgeEstimator::Off;
    const EdgeFigures off = edge_figures({volume, scene, plain}, points.points);
    const EdgeFigures on = edge_figures({volume, scene, sharp}, points.points);
    EXPECT_EQ(off.measured, 20);
    EXPECT_NEAR(off.rise_mean, 1.05, 0.15);
    EXPECT_LT(on.rise_mean, 0.25);
    EXPECT_LT(on.location_mean, off.location_mean);
    // A ray's edge lies where the interpolated field crosses the iso-value; its rise is only the profile's sampling
    // step.
    const EdgeFigures rays = ray_edge_figures(volume, 0.5, points.points);
    EXPECT_EQ(rays.measured, 20);
    EXPECT_LE(rays.rise_max, 0.0100001);
    EXPECT_GT(rays.location_mean, on.location_mean);
    EXPECT_LT(rays.location_mean, 0.1);
}

TEST(AccuracyPage, EscapesTextAndEmbedsPictures) {
    EXPECT_EQ(escaped("a<b & \"c\""), "a&lt;b &amp; &quot;c&quot;");
    EXPECT_EQ(base64("Man"), "TWFu");
    EXPECT_EQ(base64("Ma"), "TWE=");
    EXPECT_EQ(base64("M"), "TQ==");
    EXPECT_THAT(figure(filled(0.5F), "x"), HasSubstr("src=\"data:image/png;base64,iVBOR"));
    const std::string svg =
        log_plot_svg({"time", "error", {{"steps", "pt 7", {{1, 0.1, "one"}, {2, 0.01, ""}, {0, 1, "none"}}}}, {}});
    EXPECT_EQ(svg.find("<svg"), 0U);
    EXPECT_THAT(svg, HasSubstr("one"));
    EXPECT_THAT(svg, Not(HasSubstr("none<")));
    EXPECT_THAT(log_plot_svg({"time", "error", {}, {}}), Not(HasSubstr("<svg")));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(AccuracyPage, HeatMapRisesWithDifference) {
    Image a = filled(0), b = filled(0);
    b.at(0, 0, 0) = 1;
    const Image map = heat_map(a, b);
    EXPECT_GT(map.at(0, 0, 0), 0.9F);
    EXPECT_LT(map.at(1, 0, 1), 0.01F);
    EXPECT_THROW(heat_map(a, Image(1, 1, 4)), Error);
}

}  // namespace
}  // namespace edgesplat::accuracy
