// Kernels that a face cuts, against dense sums of the definition and closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <random>

#include "footprints/face.h"

namespace edgesplat {
namespace {

/// A ray at a plane face at `distance`: dot(u, n) = `cosine`; p is `along` n and `across` perpendicular to it.
FaceRay plane_ray(double distance, double cosine, double along, double across) {
    const double pn = along, sine2 = 1 - cosine * cosine;
    FaceRay ray{};
    ray.rho2 = sine2 > 0 ? along * along / sine2 + across * across : across * across;
    ray.phi = {pn - distance, cosine, 0};
    ray.slope2 = {1, 0, 0};
    ray.across = pn;
    return ray;
}

/// Integrates the definition with a dense sum.
double summed(const FaceRay& ray, const FaceCut& cut) {
    constexpr int kSteps = 20000;
    const double half = std::sqrt(std::max(cut.reach2 - ray.rho2, 0.0));
    const FacePath path(ray, cut);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        sum += path.kernel_at(-half + 2 * half * (i + 0.5) / kSteps);
    }
    return sum * 2 * half / kSteps;
}

TEST(Face, DeepKernelIsUncut) {
    const FaceRay ray = plane_ray(2.3, 0.6, 0.1, 0.4);
    const FaceCut cut = face_cut(5, 0, 0, std::numeric_limits<double>::infinity());
    FaceRay deep = ray;
    deep.phi.c -= 3;
    EXPECT_NEAR(FacePath(deep, cut).footprint(16).integral, kernel_footprint(ray.rho2), 1e-6);
}

TEST(Face, KernelIsZeroBeyondFace) {
    const FaceCut cut = face_cut(-3, 0, 0, std::numeric_limits<double>::infinity());
    EXPECT_EQ(FacePath(plane_ray(-3, 0, 0.2, 0.1), cut).footprint(8).integral, 0);
    // A ray parallel to the face: 0 just outside the face, positive just inside.
    const FaceCut at = face_cut(0.5, 0, 0, std::numeric_limits<double>::infinity());
    EXPECT_EQ(FacePath(plane_ray(0.5, 0, 0.51, 0), at).footprint(8).integral, 0);
    EXPECT_GT(FacePath(plane_ray(0.5, 0, 0.49, 0), at).footprint(8).integral, 0.1);
}

/// A plane of a crease at `distance` that is perpendicular to the face; p, u: of the ray along its normal.
FaceCrease crease(double p, double u, double distance) {
    FaceCrease seen = kNoCrease;
    seen.p = p;
    seen.u = u;
    seen.distance = distance;
    return seen;
}

/// Sum of the kernels of all voxels in a corner (x < corner.x, y < corner.y) at the point (x.x, x.y, 0); rays along y.
double sum_in_corner(const glm::dvec2& corner, const glm::dvec2& x) {
    double sum = 0;
    for (int i = -6; i <= 6; ++i)
        for (int j = -6; j <= 6; ++j)
            for (int k = -4; k <= 4; ++k) {
                const glm::dvec2 distance(corner.x - i, corner.y - j);
                if (distance.x < 0 || distance.y < 0) continue;
                // The nearer plane is the voxel's face; the ray runs along y.
                const bool first = distance.x <= distance.y;
                const double beside = first ? distance.y : distance.x;
                const FaceCut cut = with_crease(
                    face_cut(first ? distance.x : distance.y, 0, 0, std::numeric_limits<double>::infinity()), beside);
                const glm::dvec2 p(x.x - i, -k);
                FaceRay ray{};
                ray.rho2 = p.x * p.x + p.y * p.y;
                ray.phi = first ? Quadratic{p.x - distance.x, 0, 0} : Quadratic{-distance.y, 1, 0};
                ray.slope2 = {1, 0, 0};
                ray.across = first ? p.x : 0;
                sum += FacePath(ray, cut, crease(first ? 0 : p.x, first ? 1 : 0, beside)).kernel_at(x.y - j);
            }
    return sum;
}

TEST(Face, KernelsSumToPlateauAtCrease) {
    // Points near both planes of the corner, near one plane and deep in the matter; beyond the planes the sum is 0.
    const glm::dvec2 corner(0.3, 0.6);
    double least = 1e9, most = 0;
    for (double x = -3; x < 0.3; x += 0.31)
        for (double y = -3; y < 0.6; y += 0.29) {
            const double sum = sum_in_corner(corner, {x, y});
            least = std::min(least, sum);
            most = std::max(most, sum);
        }
    // Kernels sampled 0.8 voxel behind one plane sum to at least .82; behind two planes to the product.
    EXPECT_GT(least, 0.67);
    EXPECT_LT(most, 1.02);
    EXPECT_EQ(sum_in_corner(corner, {0.31, 0}), 0);
    EXPECT_EQ(sum_in_corner(corner, {0, 0.61}), 0);
}

TEST(Face, RayEntersAtCrease) {
    const FaceCut plain = face_cut(0.5, 0, 0, std::numeric_limits<double>::infinity());
    const FaceCut cut = with_crease(plain, 0.7);
    const FaceRay ray = plane_ray(0.5, 0, 0, 0);  // along the face
    const FaceFootprint entered = FacePath(ray, cut, crease(0, -1, 0.7)).footprint(8);
    EXPECT_EQ(entered.entry.plane, 1);
    EXPECT_NEAR(entered.entry.z, -0.7, 1e-12);
    EXPECT_EQ(FacePath(ray, cut, crease(0, 1, 0.7)).footprint(8).entry.plane, 0);
    EXPECT_GT(cut.reach2, plain.reach2);
    // A second plane out of reach cuts nothing.
    EXPECT_EQ(with_crease(plain, 4).reach2, plain.reach2);
}

TEST(Face, ThirdPlaneCutsAtCorner) {
    const FaceCut cut = with_crease(face_cut(0.5, 0, 0, std::numeric_limits<double>::infinity()), 0.7);
    const FaceRay ray = plane_ray(0.5, 0, 0, 0);  // along the face and the crease
    FaceCrease corner = crease(0, 0, 0.7);
    corner.corner_u = -1;
    corner.corner_distance = 0.4;
    const FaceFootprint entered = FacePath(ray, cut, corner).footprint(8);
    EXPECT_EQ(entered.entry.plane, 2);
    EXPECT_NEAR(entered.entry.z, -0.4, 1e-12);
    EXPECT_EQ(FacePath(ray, cut, corner).kernel_at(-0.41), 0);
    EXPECT_GT(FacePath(ray, cut, corner).kernel_at(-0.39), 0);
    // Turned, it ends the ray's path.
    corner.corner_u = 1;
    EXPECT_NEAR(FacePath(ray, cut, corner).footprint(8).leave.z, 0.4, 1e-12);
    EXPECT_EQ(FacePath(ray, cut, corner).kernel_at(0.41), 0);
    EXPECT_GT(FacePath(ray, cut, corner).kernel_at(0.39), 0);
    corner.corner_u = -1;
    // The nearer of two planes ends the matter.
    corner.u = -1;
    EXPECT_EQ(FacePath(ray, cut, corner).footprint(8).entry.plane, 2);
    corner.corner_distance = 0.8;
    EXPECT_EQ(FacePath(ray, cut, corner).footprint(8).entry.plane, 1);
    corner.u = corner.corner_u = 1;
    EXPECT_EQ(FacePath(ray, cut, corner).footprint(8).leave.plane, 1);
}

TEST(Face, QuadratureErrorIsSmall) {
    std::mt19937 random(5);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
    double squares = 0, worst_of_sixteen = 0;
    constexpr int kRays = 400;
    for (int i = 0; i < kRays; ++i) {
        const double distance = uniform(0, 2.4);
        const FaceRay ray = plane_ray(distance, uniform(-1, 1), uniform(-0.8, 0.8), uniform(0, 1));
        const double thickness = i % 2 == 0 ? distance + uniform(0.5, 2) : std::numeric_limits<double>::infinity();
        const FaceCut cut = face_cut(distance, 0, 0, thickness);
        const double want = summed(ray, cut), peak = kernel_footprint(0);
        squares += std::pow((FacePath(ray, cut).footprint(5).integral - want) / peak, 2);
        worst_of_sixteen =
            std::max(worst_of_sixteen, std::abs(FacePath(ray, cut).footprint(16).integral - want) / peak);
    }
    EXPECT_LE(std::sqrt(squares / kRays), 0.02);
    EXPECT_LE(worst_of_sixteen, 0.01);
}

/// Sum of all kernels at depth `below` under a plane face with normal n, `shift` beyond a lattice plane.
double sum_of_kernels(const std::array<double, 3>& n, double shift, double below) {
    double sum = 0;
    for (int z = -6; z <= 6; ++z)
        for (int y = -6; y <= 6; ++y)
            for (int x = -6; x <= 6; ++x) {
                const double along = n[0] * x + n[1] * y + n[2] * z, distance = shift - along;
                if (!(distance >= 0)) continue;
                // The point relative to the voxel; it is also shifted sideways off the lattice.
                const std::array<double, 3> r = {0.3 + (shift - below) * n[0] - x, 0.2 + (shift - below) * n[1] - y,
                                                 (shift - below) * n[2] - z};
                const double rn = r[0] * n[0] + r[1] * n[1] + r[2] * n[2];
                FaceRay ray{};
                ray.rho2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
                ray.phi = {rn - distance, 1, 0};
                ray.slope2 = {1, 0, 0};
                ray.across = rn;
                const FaceCut cut = face_cut(distance, 0, 0, std::numeric_limits<double>::infinity());
                sum += FacePath(ray, cut).kernel_at(0);
            }
    return sum;
}

TEST(Face, KernelsSumToPlateauUpToFace) {
    double least = 2, most = 0, total = 0;
    int count = 0;
    for (double shift = 0; shift < 1; shift += 0.1) {
        const double at_face = sum_of_kernels({0, 0, 1}, shift, 1e-9), behind = sum_of_kernels({0, 0, 1}, shift, 0.7);
        // The sum is constant from the face to the depth of sampling: the edge is a step.
        EXPECT_NEAR(at_face, behind, 1e-6) << shift;
        least = std::min(least, at_face);
        most = std::max(most, at_face);
        total += at_face;
        ++count;
    }
    EXPECT_GE(least, 0.8);
    EXPECT_LE(most, 1.01);
    EXPECT_NEAR(total / count, 0.97, 0.02);
    EXPECT_NEAR(sum_of_kernels({0, 0, 1}, 0.4, 2.2), 1, 1e-3);
}

TEST(Face, RaysEnterWallFromEitherSide) {
    const FaceRay through = plane_ray(0.6, 1, 0, 0), back = plane_ray(0.6, -1, 0, 0);
    const FacePath path(through, face_cut(0.6, 0, 0, 1.5));
    // The piece between both faces; the one beyond phi's second zero lies out of reach.
    ASSERT_EQ(path.pieces().size(), 1);
    EXPECT_NEAR(path.pieces()[0].low, -0.9, 1e-5);
    const FaceCut cut = face_cut(0.6, 0, 0, 1.5);
    const FaceFootprint out = FacePath(through, cut).footprint(8), in = FacePath(back, cut).footprint(8);
    EXPECT_TRUE(out.entry.side != in.entry.side);
    EXPECT_NEAR(std::min(out.entry.z, in.entry.z), -0.9, 1e-4);
    EXPECT_NEAR(std::max(out.entry.z, in.entry.z), -0.6, 1e-4);
    EXPECT_NEAR(out.integral, in.integral, 1e-6);
}

TEST(Face, DeepPartOfWallShowsOtherFace) {
    // Rays parallel to a wall of 2 voxels meet neither face. They show the near face, beyond a depth of 1.6 the far
    // face.
    const FaceCut cut = face_cut(0.6, 0, 0, 2);
    for (const double depth : {0.1, 0.9, 1.5, 1.7, 1.9}) {
        const FaceFootprint seen = FacePath(plane_ray(0.6, 0, 0.6 - depth, 0), cut).footprint(8);
        EXPECT_EQ(seen.entry.side<0, depth> 1.6) << depth;
        EXPECT_EQ(seen.leave.side<0, depth> 1.6) << depth;
    }
}

TEST(Face, DegenerateFacesAreFinite) {
    const double odd[] = {0, 1e-30, -1e-30, 1e6, -1e6, 1e30, 0.5};
    for (const double a : odd)
        for (const double b : odd)
            for (const double c : odd) {
                const FaceRay ray{0.3, {c, b, a}, {b * b, a * b, a * a}, c, a};
                for (const double thickness : {0.05, 1.0, std::numeric_limits<double>::infinity()}) {
                    const FaceFootprint f = FacePath(ray, face_cut(0.4, a, std::abs(b), thickness)).footprint(4);
                    EXPECT_TRUE(std::isfinite(f.integral) && f.integral >= 0 && f.integral < 2) << a << b << c;
                    EXPECT_TRUE(std::isfinite(f.entry.z));
                }
            }
}

}  // namespace
}  // namespace edgesplat
