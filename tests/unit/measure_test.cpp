// Volumes, surfaces, distances and angles, compared with solids in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>
#include <string>

#include "engine/measure/extents.h"
#include "engine/measure/places.h"
#include "tests/unit/refusal.h"
#include "tests/unit/viewer_volumes.h"

namespace edgesplat::measure {
namespace {

using namespace viewer_test;
using std::numbers::pi;

/// A solid in the middle of a rotated, shifted, anisotropic volume, with its volume (mm^3) and surface (mm^2) in closed
/// form.
struct Solid {
    Cavity cavity;
    double volume = 0, surface = 0;
};

Solid solid(const std::string& name, const Room& room, double volume, double surface, double blur = 0.7) {
    Cavity cavity;
    cavity.name = name;
    cavity.dims = {52, 44, 40};
    cavity.spacing = {0.9, 1.1, 1.2};
    cavity.axes = kTurned;
    cavity.origin = {100, -20, 7};
    cavity.room = [room, middle = glm::dvec3(cavity.dims - 1) * cavity.spacing / 2.0 +
                                  glm::dvec3(0.13, -0.21, 0.37)](const glm::dvec3& x) { return room(x - middle); };
    cavity.blur = blur;
    return {cavity, volume, surface};
}

Solid ball(double radius, double blur = 0.7) {
    return solid(
        "ball", [=](const glm::dvec3& x) { return glm::length(x) - radius; }, 4.0 / 3 * pi * std::pow(radius, 3),
        4 * pi * radius * radius, blur);
}

Solid torus(double major, double minor, double blur = 0.7) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.4, 0.5, 0.7));
    const auto room = [=](const glm::dvec3& x) {
        const double along = glm::dot(x, axis);
        return std::hypot(glm::length(x - along * axis) - major, along) - minor;
    };
    return solid("torus", room, 2 * pi * pi * major * minor * minor, 4 * pi * pi * major * minor, blur);
}

Extents extents_of(const Solid& s, const Clip& clip = {}) {
    const double iso = 0.5;
    return measure_extents(*sampled(s.cavity), {&iso, 1}, clip);
}

void expect_within(const Quantity& measured, double truth, double least_relative, const std::string& what) {
    std::cout << what << ": " << measured.value << " +- " << measured.uncertainty << ", truth " << truth << '\n';
    EXPECT_LE(std::abs(measured.value - truth), measured.uncertainty) << what;
    EXPECT_LE(measured.uncertainty, least_relative * truth) << what;
}

TEST(Measure, MeasuresSmoothSolidsWithinUncertainty) {
    for (const Solid& s : {ball(14), ball(6), torus(11, 4)}) {
        const Extents extents = extents_of(s);
        ASSERT_EQ(extents.volumes.size(), 2);
        ASSERT_EQ(extents.surfaces.size(), 1);
        expect_within(extents.volumes[1], s.volume, 0.05, s.cavity.name);
        expect_within(extents.surfaces[0], s.surface, 0.05, s.cavity.name);
        EXPECT_NEAR(extents.volumes[1].value, s.volume, 0.005 * s.volume);
        EXPECT_NEAR(extents.surfaces[0].value, s.surface, 0.005 * s.surface);
    }
}

TEST(Measure, MaterialVolumesSumToWhole) {
    const Solid s = ball(13);
    const std::vector<double> isos{0.2, 0.5, 0.8};
    const Extents extents = measure_extents(*sampled(s.cavity), isos);
    double all = 0;
    for (const Quantity& q : extents.volumes)
        all += q.value;
    const double box = 52 * 44 * 40 * 0.9 * 1.1 * 1.2;
    EXPECT_NEAR(all, box, 1e-6 * box);
    // The edge profile is a Gaussian's integral: contours are balls, except for a small shift by curvature.
    for (std::size_t m = 1; m <= 3; ++m)
        EXPECT_GT(extents.volumes[m].value, 0);
    EXPECT_GT(extents.surfaces[0].value, extents.surfaces[1].value);
    EXPECT_GT(extents.surfaces[1].value, extents.surfaces[2].value);
}

TEST(Measure, ClipPlanesRemoveTheirShare) {
    const Solid s = ball(14);
    const glm::dvec3 middle =
        s.cavity.to_world(glm::dvec3(s.cavity.dims - 1) * s.cavity.spacing / 2.0 + glm::dvec3(0.13, -0.21, 0.37));
    Clip half;
    half.keep.push_back({middle, glm::normalize(glm::dvec3(0.3, -0.5, 0.8))});
    const Extents kept = extents_of(s, half);
    EXPECT_NEAR(kept.volumes[1].value, s.volume / 2, 0.005 * s.volume);
    EXPECT_NEAR(kept.surfaces[0].value, s.surface / 2, 0.01 * s.surface);
    // Removing the same half space keeps the other half.
    Clip other;
    other.remove = half.keep;
    const Extents rest = extents_of(s, other);
    EXPECT_NEAR(kept.volumes[1].value + rest.volumes[1].value, extents_of(s).volumes[1].value, 0.002 * s.volume);
}

TEST(Measure, BinaryDataAreUncertainByHalfAVoxel) {
    for (const double radius : {5.0, 9.0, 14.0}) {
        const Solid s = ball(radius, 0);
        const Extents extents = extents_of(s);
        expect_within(extents.volumes[1], s.volume, 3.0 / radius, "binary ball");
        expect_within(extents.surfaces[0], s.surface, 1.0, "binary ball's surface");
        EXPECT_GT(extents.volumes[1].uncertainty, 0.3 * s.surface);
    }
}

TEST(Measure, UncertaintyIncludesRounding) {
    const Solid s = ball(12);
    auto fine = std::make_shared<Volume>(*sampled(s.cavity));
    Volume coarse = *fine;
    for (float& v : coarse.values)
        v = std::round(8 * v) / 8;
    finish_volume(coarse);
    const double iso = 0.5 - 1e-6;
    const Extents of_fine = measure_extents(*fine, {&iso, 1}), of_coarse = measure_extents(coarse, {&iso, 1});
    expect_within(of_coarse.volumes[1], s.volume, 0.2, "rounded to eighths");
    EXPECT_GT(of_coarse.volumes[1].uncertainty, 2 * of_fine.volumes[1].uncertainty);
}

TEST(Measure, MatterEndsAtVolumeBorder) {
    Volume volume;
    volume.geometry.dims = {12, 10, 8};
    volume.values.assign(volume.geometry.voxel_count(), 1);
    volume.values[0] = 0.9F;
    finish_volume(volume);
    const double iso = 0.5;
    const Extents extents = measure_extents(volume, {&iso, 1});
    EXPECT_DOUBLE_EQ(extents.volumes[1].value, 12 * 10 * 8);
    EXPECT_EQ(extents.surfaces[0].value, 0);
    EXPECT_EQ(extents.volumes[0].value, 0);
}

TEST(Measure, FlatVolumesGiveFiniteNumbers) {
    for (const glm::ivec3 dims : {glm::ivec3(1, 1, 1), glm::ivec3(1, 7, 5), glm::ivec3(6, 1, 1), glm::ivec3(2, 2, 2)}) {
        Volume volume;
        volume.geometry.dims = dims;
        volume.values.assign(volume.geometry.voxel_count(), 0);
        volume.values.back() = 1;
        finish_volume(volume);
        const double iso = 0.25;
        const Extents extents = measure_extents(volume, {&iso, 1});
        const auto voxels = static_cast<double>(volume.geometry.voxel_count());
        EXPECT_NEAR(extents.volumes[0].value + extents.volumes[1].value, voxels, 1e-9);
        EXPECT_TRUE(std::isfinite(extents.surfaces[0].value) && std::isfinite(extents.surfaces[0].uncertainty));
        EXPECT_TRUE(std::isfinite(extents.volumes[1].uncertainty));
    }
}

TEST(Measure, CountsLabels) {
    Volume volume;
    volume.geometry.dims = {4, 3, 2};
    volume.geometry.index_to_world_axes = glm::dmat3(2.0);
    volume.values.assign(24, 0);
    for (const std::size_t i : {0, 1, 4, 5})
        volume.values[i] = 7;
    volume.values[23] = 3;
    finish_volume(volume);
    const std::vector<LabelExtent> labels = measure_labels(volume);
    ASSERT_EQ(labels.size(), 3);
    EXPECT_EQ(labels[1].number, "3");
    EXPECT_EQ(labels[1].voxels, 1);
    EXPECT_EQ(labels[2].label.value, 7);
    EXPECT_EQ(labels[2].volume.value, 32);
    EXPECT_EQ(labels[2].volume.uncertainty, 16);  // each of the four has another label above it
}

TEST(Measure, CutsLabelsAtClipPlanes) {
    Volume volume;
    volume.geometry.dims = {21, 19, 17};
    volume.geometry.index_to_world_axes = glm::dmat3(2.0);
    for (int z = 0; z < 17; ++z)
        for (int y = 0; y < 19; ++y)
            for (int x = 0; x < 21; ++x) {
                const int in = std::min({x, y, z, 20 - x, 18 - y, 16 - z});
                volume.values.push_back(in < 2 ? 0.0F : in < 5 ? 3.0F : 8.0F);
            }
    finish_volume(volume);
    const std::vector<LabelExtent> whole = measure_labels(volume);
    const glm::dvec3 middle = volume.geometry.center();
    for (const glm::dvec3& normal : {glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0), glm::dvec3(1, 1e-6, 0),
                                     glm::dvec3(1, 2, -3), glm::dvec3(1, 1, 0)}) {
        const std::vector<LabelExtent> half = measure_labels(volume, {.keep = {{middle, normal}}, .remove = {}});
        for (std::size_t i = 0; i < whole.size(); ++i) {
            EXPECT_NEAR(half[i].volume.value, whole[i].volume.value / 2, 1e-3 * whole[i].volume.value);
            EXPECT_LT(half[i].volume.uncertainty, whole[i].volume.uncertainty);
        }
    }
    const std::vector<LabelExtent> none =
        measure_labels(volume, {.keep = {{middle, {0, 0, 1}}, {middle, {0, 0, -1}}}, .remove = {}});
    EXPECT_TRUE(none.empty() || none[0].volume.value < 1e-6);
}

TEST(Measure, SnapsPlacesToNearestSurface) {
    const Solid s = ball(14);
    const auto volume = sampled(s.cavity);
    const glm::dvec3 middle =
        s.cavity.to_world(glm::dvec3(s.cavity.dims - 1) * s.cavity.spacing / 2.0 + glm::dvec3(0.13, -0.21, 0.37));
    const double iso = 0.5;
    const glm::dvec3 way = glm::normalize(glm::dvec3(1, 2, -0.5)), across = glm::normalize(glm::dvec3(2, -1, 0));
    ASSERT_NEAR(glm::dot(way, across), 0, 1e-12);
    std::vector<Place> places;
    for (const auto& [direction, off] : {std::pair(way, 1.2), {across, -0.9}, {-way, 0.4}}) {
        const auto place = nearest_surface(*volume, {&iso, 1}, middle + (14 + off) * direction);
        ASSERT_TRUE(place);
        EXPECT_NEAR(glm::length(place->world - middle), 14, std::max(place->uncertainty, 0.01));
        EXPECT_LT(glm::distance(place->world, middle + 14.0 * direction), 0.1);
        EXPECT_GT(place->uncertainty, 0);
        EXPECT_EQ(place->iso, iso);
        places.push_back(*place);
    }
    const Quantity through = distance(places[0], places[2]);
    EXPECT_NEAR(through.value, 28, through.uncertainty);
    EXPECT_LT(through.uncertainty, 0.5);
    // Thales: a diameter subtends a right angle at the ball's surface.
    const Quantity right = angle(places[0], places[1], places[2]);
    EXPECT_NEAR(right.value, 90, right.uncertainty);
    EXPECT_LT(right.uncertainty, 3);
    EXPECT_FALSE(nearest_surface(*volume, {&iso, 1}, middle + 20.0 * way));
    EXPECT_FALSE(nearest_surface(*volume, {&iso, 1}, middle));
}

TEST(Measure, AngleUncertaintyMatchesPerturbedPlaces) {
    const Place a{{10, 0, 0}, 0.02, {}}, corner{{0, 0, 0}, 0.05, {}}, b{{3, 6, 0}, 0.03, {}};
    const Quantity q = angle(a, corner, b);
    double square = 0;
    for (const int which : {0, 1, 2}) {
        double most = 0;
        for (int k = 0; k < 64; ++k) {
            Place p[3] = {a, corner, b};
            p[which].world += p[which].uncertainty * glm::dvec3(std::cos(k * pi / 32), std::sin(k * pi / 32), 0);
            most = std::max(most, std::abs(angle(p[0], p[1], p[2]).value - q.value));
        }
        square += most * most;
    }
    EXPECT_NEAR(q.uncertainty, std::sqrt(square), 0.02 * q.uncertainty);
}

TEST(Measure, RefusesUnmeasurableInput) {
    const Place a{{1, 2, 3}, 0, {}}, b{{2, 2, 3}, 0, {}};
    EXPECT_EQ(refusal([&] { angle(a, a, b); }), "angle: two of its three points are equal");
    const Solid s = ball(5);
    const double iso = 0.5;
    EXPECT_THROW(measure_extents(*sampled(s.cavity), {&iso, 1}, {}, [](double) { return false; }),
                 reference::Cancelled);
}

}  // namespace
}  // namespace edgesplat::measure
