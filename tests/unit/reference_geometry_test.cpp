// The geometry of splats, one source for shaders and reference, against closed forms and exact shapes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "engine/reference/face_geometry.h"
#include "engine/reference/faces.h"
#include "engine/reference/outlines.h"
#include "engine/reference/surface_point.h"
#include "engine/volume/filters.h"
#include "tests/unit/reference_random.h"

namespace edgesplat::geometry {
namespace {

using testing_random::Random;
using Face = FieldGeometry::Face;

/// Samples of a function and the scene's iso-values; all matter above the first is drawn.
struct SampledField {
    SampledField(const ivec3& size, std::vector<double> iso_values, const std::function<double(const vec3&)>& f)
        : dims(size) {
        for (int z = 0; z < dims.z; ++z)
            for (int y = 0; y < dims.y; ++y)
                for (int x = 0; x < dims.x; ++x)
                    values.push_back(static_cast<float>(f(vec3(x, y, z))));
        coefficients = bspline_coefficients(values, dims);
        field = {dims, values, coefficients};
        scene.iso = std::move(iso_values);
        scene.drawn.assign(scene.iso.size() + 1, true);
        scene.drawn[0] = false;
        scene.is_translucent.assign(scene.drawn.size(), false);
        for (std::size_t at = 0; at < values.size(); ++at)
            surfels.push_back(reference::find_surfel(field, scene, field.voxel(at), true));
    }
    SampledField(const SampledField&) = delete;
    SampledField& operator=(const SampledField&) = delete;

    FieldGeometry at(double noise = 0) const { return FieldGeometry(field, scene, surfels, noise); }

    template <typename Look>
    void for_inner_voxels(int margin, const Look& look) const {
        for (std::size_t k = 0; k < values.size(); ++k)
            if (const ivec3 p = field.voxel(k); p == clamp(p, ivec3(margin), dims - 1 - margin)) look(p);
    }

    ivec3 dims;
    std::vector<float> values, coefficients;
    reference::Field field;
    reference::ScaledScene scene;
    std::vector<reference::VoxelEdge> surfels;
};

/// An edge with a blur of .7 voxel; `inside`: depth in the matter, voxels.
double blurred(double inside) {
    return 0.5 * std::erfc(-inside / (0.7 * std::sqrt(2.0)));
}

const vec3 kMiddle(9.3, 8.7, 9.1);

double in_ball(const vec3& x, double radius) {
    return radius - length(x - kMiddle);
}

TEST(Bendings, MultiplyAsMatrices) {
    Random random;
    for (int k = 0; k < 100; ++k) {
        const Bending h = {random.vector(1), random.vector(1)};
        const mat3 m = matrix_of(h);
        const vec3 v = random.vector(2);
        EXPECT_LT(length(bent(h, v) - m * v), 1e-12);
        double squares = 0;
        for (int i = 0; i < 3; ++i)
            squares += dot(m[i], m[i]);
        EXPECT_NEAR(bending_norm(h), std::sqrt(squares), 1e-12);
        EXPECT_LT(length(bending_of(m).mixed - h.mixed), 1e-12);
    }
}

TEST(Bendings, TurnTheSlopeAlongTheNormalOnly) {
    Random random;
    for (int k = 0; k < 100; ++k) {
        const Bending h = {random.vector(1), random.vector(1)};
        const vec3 n = random.direction(), turn = random.vector(1);
        const double share = random(0, 1);
        const Bending other = turned_along(h, n, turn, share);
        vec3 want = turn - bent(h, n);
        want = share * (want - dot(want, n) * n);
        EXPECT_LT(length(bent(other, n) - bent(h, n) - want), 1e-12);
        const vec3 a = normalize(cross(n, random.direction())), b = cross(n, a);
        EXPECT_NEAR(dot(a, bent(other, b)), dot(a, bent(h, b)), 1e-12);
        EXPECT_NEAR(dot(a, bent(other, a)), dot(a, bent(h, a)), 1e-12);
    }
}

TEST(Bendings, HaveTheLargerCurvature) {
    Random random;
    for (int k = 0; k < 100; ++k) {
        const vec3 n = random.direction(), a = normalize(cross(n, random.direction())), b = cross(n, a);
        const double one = random(-1, 1), two = random(-1, 1);
        EXPECT_NEAR(largest_bend(bending_of(one * outerProduct(a, a) + two * outerProduct(b, b))), max(one, two),
                    1e-12);
    }
}

TEST(Quadrics, FitTheirOwnPoints) {
    Random random;
    for (int k = 0; k < 50; ++k) {
        const Quadric want = {random(-0.2, 0.2), random.direction(), {random.vector(0.2), random.vector(0.2)}};
        std::vector<vec3> points;
        Moments sums = no_moments();
        while (points.size() < 80) {
            vec3 r = random.vector(1.2);
            for (int step = 0; step < 20; ++step) {
                const vec3 slope = quadric_slope(want, r);
                r -= quadric_at(want, r) / max(dot(slope, slope), 0.05) * slope;
            }
            if (!(std::abs(quadric_at(want, r)) < 1e-9 && length(r) < 2)) continue;
            points.push_back(r);
            add_surfel(sums, r, quadric_slope(want, r), random(0.5, 1));
        }
        // The ridge pulls H towards 0 by a thousandth of a squared voxel over the points' scatter.
        const Quadric got = quadric_of(sums);
        for (const vec3& r : points) {
            EXPECT_LT(std::abs(quadric_at(got, r)), 6e-3);
            EXPECT_LT(length(quadric_slope(got, r) - quadric_slope(want, r)), 0.02);
        }
        const Quadric moved = quadric_about(got, points[0]);
        EXPECT_NEAR(quadric_at(moved, points[1] - points[0]), quadric_at(got, points[1]), 1e-12);
        EXPECT_NEAR(quadric_off({0.3, {2, 0, 0}, no_bending()}, vec3(0.1, 5, 5)), 0.25, 1e-12);
    }
}

TEST(Quadrics, HaveFootPointsNearestToTheVoxel) {
    Random random;
    for (int k = 0; k < 500; ++k) {
        const double radius = random(2.5, 9);
        const vec3 n = random.direction(), center = -radius * n + random.vector(0.2);
        const Quadric ball = {
            (dot(center, center) - radius * radius) / (2 * radius), -center / radius, {vec3(1 / radius), vec3(0)}};
        const vec3 voxel = random(-0.8, 0.8) * random.direction();
        const Foot foot = foot_of(ball, voxel, vec3(0));
        const vec3 want = center + radius * normalize(voxel - center);
        EXPECT_TRUE(foot.real);
        EXPECT_LT(length(foot.at - want), 8e-3) << radius;
        EXPECT_LT(length(normalize(foot.slope) - normalize(want - center)), 5e-3);
    }
    // No surface within reach.
    EXPECT_FALSE(foot_of({2, {1, 0, 0}, no_bending()}, vec3(0), vec3(0)).real);
}

TEST(Surfels, LieOnABall) {
    for (const double radius : {2.5, 6.0}) {
        const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) { return blurred(in_ball(x, radius)); });
        int found = 0;
        ball.for_inner_voxels(1, [&](const ivec3& p) {
            const vec3 from = vec3(p) - kMiddle;
            const double off = in_ball(vec3(p), radius);
            const reference::VoxelEdge& surfel = ball.surfels[ball.field.offset(p)];
            EXPECT_FALSE(surfel.border);
            EXPECT_TRUE(std::abs(off) <= 1.4 || !surfel.has_edge);
            EXPECT_TRUE(std::abs(off) >= 0.8 || surfel.has_edge);
            if (!surfel.has_edge) return;
            ++found;
            EXPECT_NEAR(surfel.D, std::abs(off), 0.03);
            EXPECT_EQ(surfel.upper, off < 0);
            EXPECT_GT(dot(surfel.n, normalize(from)) * (off < 0 ? -1 : 1), 0.998);
        });
        EXPECT_GT(found, 60);
    }
}

TEST(Surfels, LieBelowTheirVoxels) {
    // Gradients beside the ball do not point to it.
    const double radius = 6;
    const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) {
        return 0.5 + 0.12 * in_ball(x, radius) * (1 + 0.5 * std::sin(0.8 * x.x + 0.5 * x.z));
    });
    int found = 0;
    ball.for_inner_voxels(1, [&](const ivec3& p) {
        const double off = in_ball(vec3(p), radius);
        const reference::VoxelEdge& surfel = ball.surfels[ball.field.offset(p)];
        if (std::abs(off) > 1.1) return;
        EXPECT_TRUE(surfel.has_edge);
        EXPECT_NEAR(surfel.D, std::abs(off), 0.03);
        ++found;
    });
    EXPECT_GT(found, 500);
}

TEST(Surfels, LieAtTheEndThatIsCrossed) {
    // A layer whose samples are near its lower end, beside matter above its upper end.
    const SampledField step({9, 6, 6}, {0.35, 0.65}, [](const vec3& x) { return x.x < 4 ? 0.4 : 0.9; });
    const reference::VoxelEdge& surfel = step.surfels[step.field.offset({3, 3, 3})];
    ASSERT_TRUE(surfel.has_edge);
    EXPECT_TRUE(surfel.upper);
    EXPECT_GT(surfel.n.x, 0.99);
    EXPECT_NEAR(surfel.D, 0.5, 0.1);
}

TEST(Surfels, EndAtTheBorder) {
    const SampledField solid({6, 7, 8}, {0.5}, [](const vec3&) { return 1.0; });
    for (const auto& [p, n] : {std::pair(ivec3(0, 3, 3), vec3(-1, 0, 0)), std::pair(ivec3(3, 6, 3), vec3(0, 1, 0))}) {
        const reference::VoxelEdge& surfel = solid.surfels[solid.field.offset(p)];
        EXPECT_TRUE(surfel.border);
        EXPECT_EQ(surfel.n, n);
        EXPECT_EQ(surfel.D, 0.5);
    }
    EXPECT_FALSE(solid.surfels[solid.field.offset({3, 3, 3})].has_edge);
    FieldGeometry at = solid.at();
    EXPECT_EQ(at.border_beside({3, 3, 3}), vec3(0));
    // The second face of a plane at the border is the opposite border.
    const Face face = at.fit_face({0, 3, 3}, 1);
    EXPECT_NEAR(face.edge.d, 0.5, 1e-12);
    EXPECT_NEAR(face.edge.d2, 5.5, 1e-12);
    // An axis of one voxel comes last.
    const SampledField slice({1, 7, 6}, {0.5}, [](const vec3&) { return 1.0; });
    EXPECT_EQ(slice.at().border_beside({0, 3, 3}), vec3(1, 0, 0));
    EXPECT_EQ(slice.at().border_beside({0, 0, 3}), vec3(0, -1, 0));
}

TEST(Extrapolation, IsExactOnARamp) {
    const vec3 g(0.03, -0.04, 0.12);
    const SampledField ramp({8, 8, 8}, {0.3, 0.6}, [&](const vec3& x) { return 0.45 + dot(g, x - vec3(3.5)); });
    FieldGeometry at = ramp.at();
    int edges = 0;
    ramp.for_inner_voxels(1, [&](const ivec3& p) {
        const double value = at.voxel(p);
        const auto m = static_cast<int>(at.material_at(p));
        const double low = ramp.scene.lower(m), high = ramp.scene.upper(m);
        const Edge e = at.extrapolated_edge(value, voxel_gradient(ramp.field, p), low, high, 1.5);
        const double to_low = (value - low) / length(g), to_high = (high - value) / length(g);
        EXPECT_EQ(e.state >= EDGE_LOWER, min(to_low, to_high) <= 1.5);
        if (e.state < EDGE_LOWER) return;
        ++edges;
        EXPECT_NEAR(e.d, min(to_low, to_high), 1e-5);
        EXPECT_EQ(e.state == EDGE_UPPER, to_high < to_low);
        EXPECT_GT(dot(e.n, g) * (e.state == EDGE_UPPER ? 1 : -1), 0.999 * length(g));
    });
    EXPECT_GT(edges, 50);
    EXPECT_EQ(normal_only(vec3(0, 0, 5e-4)).state, EDGE_NONE);
    EXPECT_EQ(normal_only(vec3(0, 0, 2)).n, vec3(0, 0, -1));
}

TEST(FittedFaces, OfABallLieOnIt) {
    const double radius = 6;
    const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) { return blurred(in_ball(x, radius)); });
    FieldGeometry at = ball.at();
    int faces = 0;
    ball.for_inner_voxels(1, [&](const ivec3& p) {
        const double off = in_ball(vec3(p), radius);
        if (off < 0 || off > 1.8) return;
        ++faces;
        const Face face = at.fit_face(p, 1);
        ASSERT_EQ(face.edge.state, EDGE_LOWER);
        EXPECT_NEAR(face.edge.d, off, 0.04);
        EXPECT_GT(dot(face.edge.n, normalize(vec3(p) - kMiddle)), 0.999);
        EXPECT_GT(face.edge.d2, FACE_FARTHEST);
        EXPECT_FALSE(face.creased);
        // Both curvatures are 1 / radius.
        const vec3 a = normalize(cross(face.edge.n, vec3(0.2, 0.3, 0.9))), b = cross(face.edge.n, a);
        EXPECT_NEAR(dot(a, bent(face.h, a)), 1 / radius, 0.05);
        EXPECT_NEAR(dot(b, bent(face.h, b)), 1 / radius, 0.05);
        // Matter outside of the ball has the same face, from the other side.
        const Face outer = at.fit_face(p, 0);
        EXPECT_NEAR(outer.edge.d, -off, 0.04);
        EXPECT_LT(dot(outer.edge.n, face.edge.n), -0.999);
    });
    EXPECT_GT(faces, 300);
    // Beyond every surfel there is none.
    EXPECT_EQ(at.fit_face(ivec3(kMiddle), 1).edge.state, EDGE_NONE);
}

TEST(FittedFaces, OfWallsHaveTheirThickness) {
    const vec3 n = normalize(vec3(3, 1, -2));
    for (const double thickness : {1.5, 2.0, 2.6, 3.2}) {
        const SampledField wall({19, 18, 19}, {0.5}, [&](const vec3& x) {
            return blurred(0.5 * thickness - std::abs(dot(x - kMiddle, n)));
        });
        FieldGeometry at = wall.at();
        double sum = 0;
        int faces = 0, walls = 0;
        wall.for_inner_voxels(4, [&](const ivec3& p) {
            const double depth = 0.5 * thickness - std::abs(dot(vec3(p) - kMiddle, n));
            if (depth < 0.2) return;
            const Face face = at.fit_face(p, 1);
            ASSERT_EQ(face.edge.state, EDGE_LOWER);
            EXPECT_GT(std::abs(dot(face.edge.n, n)), 0.99);
            EXPECT_FALSE(face.mixed);
            // The other face is at the second distance, or where the quadric itself ends the matter again.
            FaceGeometry form;
            form.take(FieldGeometry::voxel_edge(face));
            const FaceRoots roots = form.face_roots(form.face_sight(vec3(0), face.edge.n).ray.phi, 0);
            const bool second = face.edge.d2 < FACE_FARTHEST;
            sum += second ? face.edge.d + face.edge.d2 : roots.high - roots.low;
            walls += second ? 1 : 0;
            ++faces;
        });
        ASSERT_GT(faces, 100);
        // The spline's level lies where the blurred wall is one half.
        EXPECT_NEAR(sum / faces, thickness, 0.15);
        EXPECT_TRUE(thickness < 2.5 || walls > 0.8 * faces) << walls << " of " << faces;
    }
}

TEST(FittedFaces, ExpandQuadraticFieldsExactly) {
    const SampledField field({9, 8, 8}, {0.5}, [](const vec3& x) { return 0.2 + 0.05 * x.x + 0.004 * x.x * x.x; });
    FieldGeometry at = field.at();
    // Where the field is one half, relative to the voxel below.
    const double end = (std::sqrt(0.05 * 0.05 + 4 * 0.004 * 0.3) - 0.05) / (2 * 0.004) - 4;
    const auto [q, slope] = at.field_quadric({4, 4, 4}, 0.5, -1);
    EXPECT_NEAR(quadric_at(q, vec3(end, 0.3, 0.1)), 0, 1e-5);
    EXPECT_LT(q.c, 0);
    EXPECT_GT(q.g.x, 0.5);
    EXPECT_NEAR(q.h.diagonal.x * slope, 0.008, 1e-5);
}

TEST(FittedFaces, OfLayersEndAtBothIsoValues) {
    const vec3 n = normalize(vec3(1, 2, 3));
    for (const double slope : {0.18, 0.4}) {
        const SampledField ramp({15, 15, 15}, {0.35, 0.65}, [&](const vec3& x) {
            return std::clamp(0.5 + slope * dot(x - vec3(7.2), n), 0.0, 1.0);
        });
        FieldGeometry at = ramp.at();
        int faces = 0;
        ramp.for_inner_voxels(4, [&](const ivec3& p) {
            const double off = dot(vec3(p) - vec3(7.2), n), half = 0.15 / slope;
            if (std::abs(off) > half + 0.4) return;
            const Face face = at.fit_face(p, 1);
            if (face.edge.state < EDGE_LOWER) return;
            ++faces;
            const bool upwards = dot(face.edge.n, n) > 0;
            EXPECT_NEAR(face.edge.d, half - (upwards ? off : -off), 0.1);
            if (face.edge.d2 < FACE_FARTHEST) {
                EXPECT_NEAR(face.edge.d + face.edge.d2, 2 * half, 0.2);
                EXPECT_TRUE(face.mixed);
            }
            EXPECT_EQ(face.edge.state == EDGE_UPPER, upwards);
        });
        EXPECT_GT(faces, 80);
    }
}

TEST(FittedFaces, OfABinaryBoxHaveItsEdgesAndCorners) {
    const vec3 low(4, 5, 4), high(11, 12, 11);  // the outermost voxels
    SampledField box({16, 17, 16}, {0.5}, [&](const vec3& x) {
        return all(greaterThanEqual(x, low)) && all(lessThanEqual(x, high)) ? 1 : 0;
    });
    box.scene.two_values = true;
    FieldGeometry at = box.at();
    // Beside the middle of an edge: two planes half a voxel away.
    const Face edge = at.fit_face({11, 12, 8}, 1);
    ASSERT_TRUE(edge.creased);
    EXPECT_LT(std::abs(dot(edge.edge.n, edge.crease.n)), 0.05);
    EXPECT_NEAR(edge.edge.d, 0.5, 0.06);
    EXPECT_NEAR(edge.crease.away, 0.5, 0.06);
    EXPECT_GT(edge.edge.n.x + edge.edge.n.y, 0.97);
    EXPECT_GE(edge.corner, NO_PLANE);
    // At a corner, three.
    const Face corner = at.fit_face({11, 12, 11}, 1);
    ASSERT_TRUE(corner.creased);
    EXPECT_NEAR(std::abs(corner.corner), 0.5, 0.06);
    const vec3 third = sign(corner.corner) * cross(corner.edge.n, corner.crease.n);
    EXPECT_GT(corner.edge.n.x + corner.crease.n.x + third.x, 0.95);
    EXPECT_GT(corner.edge.n.z + corner.crease.n.z + third.z, 0.95);
    // One voxel further in, both planes are one voxel further.
    const Face inner = at.fit_face({10, 11, 8}, 1);
    EXPECT_TRUE(!inner.creased || std::abs(inner.edge.d - 1.5) < 0.1);
    // A flat side has none, and neither has a hollow edge of the surroundings.
    EXPECT_FALSE(at.fit_face({11, 8, 8}, 1).creased);
    EXPECT_FALSE(at.fit_face({12, 13, 8}, 0).creased);
    SampledField hollow({16, 16, 16}, {0.5}, [](const vec3& x) { return x.x > 7 && x.y > 7 ? 0 : 1; });
    hollow.scene.two_values = true;
    EXPECT_FALSE(hollow.at().fit_face({7, 7, 8}, 1).creased);
}

TEST(FinishedFaces, CutOnlyNearTheMatter) {
    const double radius = 6;
    const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) { return blurred(in_ball(x, radius)); });
    FieldGeometry at = ball.at();
    int cut = 0, lit = 0;
    ball.for_inner_voxels(1, [&](const ivec3& p) {
        const double off = in_ball(vec3(p), radius);
        const Face opaque = at.finished_face(p, 1, false, 3);
        if (off > 0.1 && off < 2.2) {
            EXPECT_GE(opaque.edge.state, EDGE_LOWER);
            EXPECT_NEAR(opaque.edge.d, off, 0.1);
            ++cut;
        }
        EXPECT_TRUE(off >= -0.1 || opaque.edge.d <= -0.05);
        // A kernel of translucent matter is cut within its own radius only; further in, the face lights it.
        const Face through = at.finished_face(p, 1, true, 3);
        if (off > 1.7 && off < 2.2) {
            EXPECT_EQ(through.edge.state, EDGE_NORMAL);
            EXPECT_GT(dot(through.edge.n, normalize(vec3(p) - kMiddle)), 0.99);
            ++lit;
        }
        EXPECT_TRUE(off >= -1.8 || through.edge.d == CARRIES_NOTHING);
    });
    EXPECT_GT(cut, 300);
    EXPECT_GT(lit, 50);
}

/// The face of a surface splat, and how far it is from the truth: `off`, distance in the matter.
struct SurfaceCount {
    int kept = 0, traced = 0;
};

TEST(FittedSurfaces, OfABallAreKept) {
    const double radius = 6;
    const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) { return blurred(in_ball(x, radius)); });
    FieldGeometry at = ball.at();
    SurfaceCount count;
    ball.for_inner_voxels(1, [&](const ivec3& p) {
        const double off = in_ball(vec3(p), radius);
        const bool matter = off > 0, ends = at.ends_beside(p, at.voxel(p), 1);
        const bool beside = in_ball(vec3(p) + vec3(p.x > kMiddle.x ? 1 : -1, 0, 0), radius) < 0;
        EXPECT_TRUE(!(matter && beside) || ends);
        EXPECT_TRUE(off <= 1.01 || !ends);
        if (!matter || !ends) return;
        const Face face = at.fit_surface(p, 1);
        (face.traced ? count.traced : count.kept) += 1;
        EXPECT_NEAR(face.edge.d, off, 0.03);
        EXPECT_GT(dot(face.edge.n, normalize(vec3(p) - kMiddle)), 0.999);
        EXPECT_TRUE(face.edge.d2 < 0.1 || at.thin_axes(p, 1) > 0);
    });
    EXPECT_GT(count.kept, 300);
    EXPECT_LT(count.traced, 0.02 * count.kept);
}

TEST(FittedSurfaces, OfThinMatterAreRefused) {
    const auto field_of = [](const std::function<bool(const ivec3&)>& matter) {
        return [matter](const vec3& x) { return matter(ivec3(x)) ? 1.0 : 0.0; };
    };
    const SampledField sheet({12, 12, 12}, {0.5}, field_of([](const ivec3& p) { return p.x == 6; }));
    const Face flat = sheet.at().fit_surface({6, 6, 6}, 1);
    EXPECT_TRUE(flat.traced);
    EXPECT_GE(flat.edge.d2, SURFACE_SHEET);
    EXPECT_EQ(sheet.at().thin_axes({6, 6, 6}, 1), 1);
    const SampledField rod({12, 12, 12}, {0.5}, field_of([](const ivec3& p) { return p.x == 6 && p.y == 5; }));
    EXPECT_TRUE(rod.at().fit_surface({6, 5, 6}, 1).traced);
    EXPECT_GE(rod.at().fit_surface({6, 5, 6}, 1).edge.d2, 1e8);
    EXPECT_EQ(rod.at().thin_axes({6, 5, 6}, 1), 2);
    const SampledField speck({12, 12, 12}, {0.5}, field_of([](const ivec3& p) { return p == ivec3(6, 5, 6); }));
    EXPECT_EQ(speck.at().thin_axes({6, 5, 6}, 1), 3);
}

TEST(FittedSurfaces, EndAtMissingSamples) {
    // Matter of the lowest material, between samples without data.
    SampledField gap({12, 12, 12}, {0.5}, [](const vec3& x) { return x.x == 6 ? 0.2 : -1e-30; });
    gap.scene.drawn = {true, true};
    EXPECT_EQ(gap.at().thin_axes({6, 6, 6}, 0), 1);
    EXPECT_TRUE(gap.at().ends_beside({6, 6, 6}, 0.2, 0));
}

TEST(FittedSurfaces, OfNoisyBallsAreKeptOnlyIfTheNoiseIsKnown) {
    const double radius = 6;
    std::mt19937 engine(3);
    std::normal_distribution<double> noise(0, 0.02);
    const SampledField ball({19, 18, 19}, {0.5}, [&](const vec3& x) {
        return std::clamp(blurred(in_ball(x, radius)) + noise(engine), 0.0, 1.0);
    });
    SurfaceCount silent, noisy;
    FieldGeometry without = ball.at(), with = ball.at(0.02);
    ball.for_inner_voxels(1, [&](const ivec3& p) {
        if (!(ball.field.at(p) > 0.5) || !with.ends_beside(p, with.voxel(p), 1)) return;
        (without.fit_surface(p, 1).traced ? silent.traced : silent.kept) += 1;
        (with.fit_surface(p, 1).traced ? noisy.traced : noisy.kept) += 1;
    });
    EXPECT_GT(silent.traced, silent.kept);
    EXPECT_GT(noisy.kept, 9 * noisy.traced);
}

TEST(Classification, TakesValuesFromTheOwnSide) {
    // A ramp along x with the iso-value at 5.2: the voxel at 5 is matter of 0, and takes the value one voxel further
    // in.
    const SampledField ramp({12, 6, 6}, {0.52}, [](const vec3& x) { return 0.1 * x.x; });
    FieldGeometry at = ramp.at();
    const Edge below = edge_of(ramp.surfels[ramp.field.offset({5, 3, 3})]);
    ASSERT_EQ(below.state, EDGE_UPPER);
    EXPECT_NEAR(at.classified_value({5, 3, 3}, 0.5, 0, below), 0.4, 1e-5);
    const Edge above = edge_of(ramp.surfels[ramp.field.offset({6, 3, 3})]);
    EXPECT_NEAR(at.classified_value({6, 3, 3}, 0.6, 1, above), 0.7, 1e-5);
    EXPECT_NEAR(at.classified_value({9, 3, 3}, 0.9, 1, no_edge()), 0.9, 1e-12);
    // Beside the other matter: its value one voxel behind the edge.
    EXPECT_NEAR(at.carried_value({5, 3, 3}, 0, 1, below), 0.62, 1e-3);
    EXPECT_NEAR(at.carried_value({6, 3, 3}, 1, 0, above), 0.42, 1e-3);
    // Without an edge towards it, the extreme sample around.
    EXPECT_NEAR(at.carried_value({5, 3, 3}, 0, 1, no_edge()), 0.7, 1e-6);
    EXPECT_NEAR(at.carried_value({6, 3, 3}, 1, 0, no_edge()), 0.4, 1e-6);
    EXPECT_NEAR(at.values_around({5, 3, 3}).x, 0.3, 1e-6);
    EXPECT_NEAR(at.values_around({5, 3, 3}).y, 0.7, 1e-6);
}

reference::VoxelEdge edge_at(const vec3& n, double d, const Bending& h) {
    reference::VoxelEdge edge;
    edge.has_edge = edge.has_normal = true;
    edge.n = n;
    edge.D = d;
    edge.bending = matrix_of(h);
    return edge;
}

TEST(FaceSights, AreTheQuadricAlongTheRay) {
    Random random;
    for (int k = 0; k < 200; ++k) {
        const vec3 n = random.direction(), u = random.direction(), any = random.vector(1);
        const Bending h = {random.vector(0.4), random.vector(0.4)};
        const double d = random(-1, 1.5);
        FaceGeometry at;
        at.take(edge_at(n, d, h));
        const vec3 p = any - dot(any, u) * u;
        const FaceGeometry::FaceSight sight = at.face_sight(p, u);
        // phi(x) about the foot: n . r + r'Hr / 2, r = x - d n.
        for (const double z : {-1.3, 0.2, 0.9}) {
            const vec3 r = p + z * u - d * n, slope = n + bent(h, r);
            EXPECT_NEAR(quadratic_at(sight.ray.phi, z), dot(n, r) + 0.5 * dot(r, bent(h, r)), 1e-12);
            EXPECT_NEAR(quadratic_at(sight.ray.slope2, z), dot(slope, slope), 1e-12);
            EXPECT_NEAR(sight.ray.across + z * sight.ray.turn, dot(p, slope), 1e-12);
            EXPECT_LT(length(at.normal_at(sight, {z, 1, 0}, true) - slope), 1e-12);
            EXPECT_LT(length(at.normal_at(sight, {z, -1, 0}, true) + slope), 1e-12);
        }
        EXPECT_NEAR(sight.ray.rho2, dot(p, p), 1e-12);
    }
}

TEST(FaceSights, SeeThePlanesOfACorner) {
    Random random;
    for (int k = 0; k < 100; ++k) {
        const vec3 n = random.direction(), second = normalize(cross(n, random.direction()));
        const bool turned = k % 2 == 1;
        reference::VoxelEdge edge = edge_at(n, 0.3, no_bending());
        edge.crease = {second, 0.5};
        edge.corner = reference::square_to(n, second, 0.7, turned);
        EXPECT_LT(length(edge.corner.n - (turned ? -1.0 : 1.0) * cross(n, second)), 1e-12);
        FaceGeometry at;
        at.take(edge);
        const vec3 u = random.direction(), any = random.vector(1), p = any - dot(any, u) * u;
        const FaceCrease seen = at.crease_seen(p, u);
        EXPECT_NEAR(seen.p, dot(second, p), 1e-12);
        EXPECT_NEAR(seen.u, dot(second, u), 1e-12);
        EXPECT_NEAR(seen.facing, 0, 1e-12);
        EXPECT_EQ(seen.distance, 0.5);
        EXPECT_NEAR(seen.corner_p, dot(edge.corner.n, p), 1e-12);
        EXPECT_NEAR(seen.corner_u, dot(edge.corner.n, u), 1e-12);
        EXPECT_EQ(seen.corner_distance, 0.7);
        EXPECT_LT(length(at.normal_at(at.face_sight(p, u), {0, 1, 1}, true) - second), 1e-12);
        // Beyond the kernel's reach a plane cuts nothing.
        edge.crease.D = KERNEL_RADIUS + FACE_DEPTH + 0.1;
        at.take(edge);
        EXPECT_GE(at.crease_seen(p, u).distance, FACE_NO_WALL);
        EXPECT_GE(std::abs(at.face_form.corner), NO_PLANE);
    }
}

TEST(FaceSights, OfWallsHaveTheirThickness) {
    FaceGeometry at;
    reference::VoxelEdge edge = edge_at({0, 0, 1}, 0.4, no_bending());
    at.take(edge);
    EXPECT_GE(at.face_form.cut.thickness, FACE_NO_WALL);
    EXPECT_EQ(at.face_form.cut.depth, FACE_DEPTH);
    edge.D2 = 0.6;
    at.take(edge);
    EXPECT_NEAR(at.face_form.cut.thickness, 1, 1e-12);
    EXPECT_NEAR(at.face_form.cut.depth, 0.5, 1e-12);
    edge.D2 = FACE_FARTHEST + 0.1;
    at.take(edge);
    EXPECT_GE(at.face_form.cut.thickness, FACE_NO_WALL);
}

/// A small volume seen from so far that rays are almost parallel.
reference::View far_view() {
    VolumeGeometry grid;
    grid.dims = {9, 9, 9};
    Camera camera;
    camera.eye = {4, -400, 4};
    camera.direction = {0, 1, 0};
    camera.fov_y = 0.5;
    return {camera, grid, 64, 64};
}

/// Side of one of its pixels at the volume's middle, voxels.
double side_of_pixel(const reference::View& view) {
    return 2 * view.frame.tan_half_y * 404 / view.height;
}

TEST(OutlinesOfFaces, LieWhereTheRayTouchesTheBall) {
    Random random;
    const reference::View view = far_view();
    const double pixel = side_of_pixel(view);
    int found = 0;
    for (int k = 0; k < 400; ++k) {
        // The ball's outline as seen from far passes right of the voxel; the ray is `outside` pixels beyond it. The
        // normal at the voxel is turned away, so that the ray touches the ball before or behind the voxel.
        const double radius = random(1.5, 6), turn = random(-0.12, 0.12), outside = random(-0.95, 0.95);
        const vec3 voxel(4, 4, 4), right = view.frame.right, n = normalize(right + turn * view.frame.forward);
        const double d = random(-0.3, 0.5), rim = radius - (radius - d) * dot(n, right);
        const vec3 u = normalize(voxel + (rim + outside * pixel) * right - view.eye_index);
        const vec3 from_eye = voxel - view.eye_index;
        const double ahead = dot(from_eye, u);
        const vec3 p = ahead * u - from_eye;
        const reference::VoxelEdge ball = edge_at(n, d, {vec3(1 / radius), vec3(0)});
        const auto outline = reference::outline_of(ball, view, p, u, ahead, 1);
        ASSERT_TRUE(outline) << outside;
        EXPECT_FALSE(outline->down);
        EXPECT_NEAR(outline->level, outside, 0.03);
        EXPECT_NEAR(outline->offset, -outside, 0.03);
        ++found;
        // A faint splat proves no matter.
        const auto faint = reference::outline_of(ball, view, p, u, ahead, 0.1);
        EXPECT_TRUE(std::abs(outside) < 0.05 || faint.has_value() == (outside > 0));
    }
    EXPECT_EQ(found, 400);
}

TEST(OutlinesOfFaces, LieOnTheEdgeOfACrease) {
    const reference::View view = far_view();
    const double pixel = side_of_pixel(view);
    const vec3 voxel(4, 4, 4), right = view.frame.right, forward = view.frame.forward;
    // A roof whose ridge points to the right: planes turn 45 degrees away on both sides.
    reference::VoxelEdge edge = edge_at(normalize(right - forward), 0.5, no_bending());
    edge.crease = {normalize(right + forward), 0.5};
    const double ridge = std::sqrt(0.5);
    for (const double outside : {-0.7, -0.2, 0.3, 0.8}) {
        const vec3 u = normalize(voxel + (ridge + outside * pixel) * right - view.eye_index),
                   from_eye = voxel - view.eye_index;
        const double ahead = dot(from_eye, u);
        const auto outline = reference::outline_of(edge, view, ahead * u - from_eye, u, ahead, 1);
        ASSERT_TRUE(outline) << outside;
        EXPECT_NEAR(outline->level, outside, 0.05);
        // Beyond a corner's plane there is no edge.
        reference::VoxelEdge cut = edge;
        cut.corner = reference::square_to(edge.n, edge.crease.n, 0.2, false);
        for (const double up : {-0.5, 0.5}) {
            const vec3 p = ahead * u - from_eye + up * view.frame.up;
            EXPECT_EQ(reference::outline_of(cut, view, p, u, ahead, 1).has_value(), up < 0);
        }
    }
}

TEST(LowPasses, WidenKernelsToPixels) {
    Random random;
    for (int k = 0; k < 200; ++k) {
        const vec3 u = random.direction(), across = random.vector(3), down = random.vector(3);
        const LowPass f = low_pass(across, down, u, 1.6);
        // The form A of the pixel's sides across the ray, and its determinants.
        const vec3 x = across - dot(across, u) * u, y = down - dot(down, u) * u;
        const double trace = dot(x, x) + dot(y, y), det = dot(x, x) * dot(y, y) - dot(x, y) * dot(x, y);
        EXPECT_NEAR(f.of_voxels, 1 / (1 + trace + det), 1e-12);
        EXPECT_NEAR(f.of_pixels, det / (1 + trace + det), 1e-12);
        // The longest axis of (1 + A)^(1/2).
        const double largest = 0.5 * trace + std::sqrt(max(0.25 * trace * trace - det, 0.0));
        EXPECT_NEAR(f.reach, 1.6 * std::sqrt(1 + largest), 1e-9);
        const double side = std::sqrt(max(dot(x, x), dot(y, y)));
        EXPECT_TRUE(side >= 0.5 || f.share == 0);
        EXPECT_TRUE(side <= 1 || f.share == 1);
    }
    const LowPass huge = low_pass({1e20, 0, 0}, {0, 1e20, 0}, {0, 0, 1}, 1.6);
    EXPECT_NEAR(huge.of_pixels, 1, 1e-12);
    EXPECT_TRUE(std::isfinite(huge.reach));
}

TEST(LowPasses, ShareTheMatterOfAVoxel) {
    // The shares of layers a voxel apart sum to the distance from the outermost layer's face to the last.
    for (const bool carried : {false, true})
        for (double d = 0; d < 1; d += 0.1) {
            double sum = 0;
            for (int layer = carried ? -2 : 0; layer < 6; ++layer)
                sum += matter_between(d + layer, 1e9, carried);
            EXPECT_NEAR(sum, d + 5.5, 1e-12) << d;
        }
    EXPECT_EQ(matter_between(0.3, 0.4, false), 1);
    EXPECT_NEAR(matter_between(0.3, 0.4, true), 0.7, 1e-12);
}

TEST(SurfacePoints, LieOnTheSurface) {
    VolumeGeometry grid;
    grid.dims = {9, 9, 9};
    grid.index_to_world_axes = glm::dmat3(1, 0, 0, 0, 2, 0, 0, 0, 3);
    const vec3 n = normalize(vec3(0, 1, 2));
    reference::VoxelEdge edge = edge_at(n, 0.4, no_bending());
    const reference::SurfacePoint plain = reference::surface_point(edge, 3, false, grid);
    EXPECT_LT(length(plain.foot - 0.4 * n), 1e-12);
    // Normals transform by the inverse transpose; voxel: mm along the normal between planes a voxel apart.
    const vec3 world = normalize(vec3(0, n.y / 2, n.z / 3));
    EXPECT_LT(length(plain.normal - world), 1e-12);
    EXPECT_LT(length(plain.step - vec3(world.x, world.y / 2, world.z / 3)), 1e-12);
    EXPECT_NEAR(plain.voxel, 1 / length(plain.step), 1e-12);
    EXPECT_GE(plain.room, 1e8);
    // Outside of matter the normal points back to the voxel's side.
    edge.upper = true;
    edge.D2 = 1.2;
    EXPECT_LT(dot(reference::surface_point(edge, 1, false, grid).normal, world), -0.999);
    EXPECT_NEAR(reference::surface_point(edge, 1, false, grid).room, 0.8 * plain.voxel, 1e-12);
    // A wall has two faces.
    edge.upper = false;
    ASSERT_TRUE(reference::is_wall(edge, 3));
    const reference::SurfacePoint front = reference::surface_point(edge, 3, false, grid);
    const reference::SurfacePoint back = reference::surface_point(edge, 3, true, grid);
    EXPECT_LT(length(front.normal + back.normal), 1e-12);
    EXPECT_NEAR(length(front.foot - back.foot), 1.6, 1e-12);
}

TEST(SurfacePoints, LieOnTheNearestCut) {
    VolumeGeometry grid;
    grid.dims = {9, 9, 9};
    const reference::VoxelEdge edge = edge_at({0, 0, 1}, 0.8, no_bending());
    IndexClip clip;
    clip.keep = {{{1, 0, 0}, -4.3}, {{0, 1, 0}, -6}};
    const vec3 voxel(4, 4, 4);
    const reference::SurfacePoint own = reference::surface_point(edge, 3, false, grid);
    const reference::SurfacePoint cut = reference::at_cut(own, edge, voxel, clip, grid);
    EXPECT_LT(length(cut.foot - vec3(0.3, 0, 0)), 1e-12);
    EXPECT_LT(length(cut.normal - vec3(1, 0, 0)), 1e-12);
    // A hole's wall faces into the hole.
    clip.remove = {{{0, 0, -1}, 4.1}};
    const reference::SurfacePoint hole = reference::at_cut(own, edge, voxel, clip, grid);
    EXPECT_LT(length(hole.foot - vec3(0, 0, 0.1)), 1e-12);
    EXPECT_LT(length(hole.normal - vec3(0, 0, 1)), 1e-12);
    // The splat's own edge is nearer.
    EXPECT_LT(length(reference::at_cut(own, edge, vec3(2, 4, 1), clip, grid).foot - own.foot), 1e-12);
}

}  // namespace
}  // namespace edgesplat::geometry
