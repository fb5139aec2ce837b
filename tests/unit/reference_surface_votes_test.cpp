// Votes about surfaces: closed forms, order, and the same source in float and in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "engine/geometry/in_double.h"
#include "tests/unit/reference_random.h"

#undef EDGESPLAT_BENDING_GLSL
#undef EDGESPLAT_SURFACE_VOTES_GLSL
namespace edgesplat::in_float {

using Real = float;
using uint = std::uint32_t;
using vec2 = glm::vec2;
using vec3 = glm::vec3;
using glm::abs;
using glm::clamp;
using glm::dot;
using glm::length;
using glm::max;
using glm::min;
using glm::sqrt;
using shader::BEGUN_MATTER;
using shader::SURFACE_CERTAIN;
using shader::SURFACE_CHORD;
using shader::SURFACE_SURE;
using shader::SURFACE_WINDOW;

// GLSL literals are float, C++ literals double: glm's functions take two arguments of one type.
inline float max(float a, double b) {
    return glm::max(a, static_cast<float>(b));
}
inline float clamp(float v, double low, double high) {
    return glm::clamp(v, static_cast<float>(low), static_cast<float>(high));
}
inline vec3 operator*(double factor, const vec3& v) {
    return static_cast<float>(factor) * v;
}

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdouble-promotion"
#define INOUT(type) type&
#include "engine/geometry/bending.glsl"
// After what it uses.
#include "engine/geometry/surface_votes.glsl"
#undef INOUT
#pragma GCC diagnostic pop

}  // namespace edgesplat::in_float

namespace edgesplat::geometry {
namespace {

using testing_random::Random;

/// phi = (|x - c|^2 - r^2) / (2 r) about the origin; the foot lies towards the origin.
SurfaceSplat ball(const vec3& center, double radius, double reach) {
    SurfaceSplat splat;
    splat.value = (glm::dot(center, center) - radius * radius) / (2 * radius);
    splat.slope = -center / radius;
    splat.h = {glm::dvec3(1 / radius), glm::dvec3(0)};
    splat.foot = center - radius * glm::normalize(center);
    splat.reach = reach;
    return splat;
}

TEST(SurfaceVotes, OnABallAreWhereTheRayEntersIt) {
    Random random;
    int hits = 0, misses = 0;
    for (int k = 0; k < 20000; ++k) {
        const double radius = random(0.6, 12);
        const vec3 center = (radius + random(-0.9, 0.4)) * random.direction(), u = random.direction();
        const vec3 p = random.across(u, 1.3);
        const SurfaceVote vote = vote_of(ball(center, radius, 1.3), p, u);
        const vec3 from = p - center;
        const double b = glm::dot(from, u), root2 = b * b - glm::dot(from, from) + radius * radius;
        if (vote.weight <= 0) continue;
        EXPECT_EQ(vote.enters, root2 >= 0);
        if (vote.enters) {
            EXPECT_NEAR(vote.z, -b - std::sqrt(root2), 1e-9 * radius);
            EXPECT_NEAR(glm::dot(glm::normalize(vote.n), glm::normalize(from + vote.z * u)), 1, 1e-9);
            EXPECT_LT(glm::dot(vote.n, u), 1e-9);
            ++hits;
        } else {
            ++misses;
        }
    }
    EXPECT_GT(hits, 2000);
    EXPECT_GT(misses, 200);
}

/// A ray inside of matter all along passes no surface by.
TEST(SurfaceVotes, InsideAHollowSayNothing) {
    SurfaceSplat hollow = ball({0, 0, 3}, 2.5, 1.3);
    hollow.value = -hollow.value;
    hollow.slope = -hollow.slope;
    hollow.h = scaled(hollow.h, -1);
    const SurfaceVote vote = vote_of(hollow, {0, 0.1, 0.2}, {1, 0, 0});
    EXPECT_EQ(vote.weight, 0);
}

TEST(SurfaceVotes, OfPlanesAreWhereTheRayIsInsideAllOfThem) {
    Random random;
    int hits = 0;
    for (int k = 0; k < 20000; ++k) {
        const Plane one{random.direction(), random(0, 1)}, two{random.direction(), random(0, 1.4)};
        const Plane three{random.direction(), k % 2 == 0 ? 1e9 : random(0, 1.4)};
        const vec3 u = random.direction(), p = random.across(u, 1.2);
        const SurfaceVote vote = vote_of_planes(one, two, three, 1.3, p, u);
        if (!(vote.weight > 0)) continue;
        const auto outside = [&](double z) {
            double most = -1e9;
            for (const Plane& plane : {one, two, three})
                most = std::max(most, glm::dot(plane.n, p + z * u) - plane.away);
            return most;
        };
        if (vote.enters) {
            EXPECT_NEAR(outside(vote.z), 0, 1e-9);
            EXPECT_GT(outside(vote.z - 1e-3), 0);
            ++hits;
        } else {
            for (int step = -40; step <= 40; ++step)
                EXPECT_GT(outside(vote.z + 0.1 * step), 0);
        }
    }
    EXPECT_GT(hits, 2000);
}

struct Ballot {
    SurfaceVote vote;
    double way = 0;
    uint number = 0;
};

/// Votes about two surfaces on one ray, as they may lie.
std::vector<Ballot> two_surfaces(Random& random) {
    std::vector<Ballot> ballots;
    for (uint k = 0; k < 12; ++k) {
        Ballot b;
        b.way = (k < 6 ? 10 : 13) + random(-0.3, 0.3);
        b.vote.weight = random(0.1, 1);
        b.vote.enters = k % 3 != 2;
        b.vote.n = random.direction();
        b.number = k;
        ballots.push_back(b);
    }
    return ballots;
}

/// Sums do not depend on the order in which splats of the same depth come.
TEST(SurfaceVotes, CountTheSameInAnyOrder) {
    Random random;
    std::mt19937 order(3);
    for (int k = 0; k < 500; ++k) {
        std::vector<Ballot> ballots = two_surfaces(random);
        const auto counted = [&] {
            SurfacePair pair = no_surfaces();
            for (const Ballot& b : ballots)
                count_vote(pair, b.vote, b.way, {b.number, 1});
            return pair;
        };
        const SurfacePair first = counted();
        // Within each of the surfaces: a list has them by depth.
        std::shuffle(ballots.begin(), ballots.begin() + 6, order);
        std::shuffle(ballots.begin() + 6, ballots.end(), order);
        const SurfacePair again = counted();
        for (const auto& [a, b] : {std::pair(first.front, again.front), std::pair(first.behind, again.behind)}) {
            EXPECT_NEAR(a.hits, b.hits, 1e-12);
            EXPECT_NEAR(a.misses, b.misses, 1e-12);
            EXPECT_NEAR(way_to(a), way_to(b), 1e-12);
            EXPECT_NEAR(glm::distance(a.normal, b.normal), 0, 1e-12);
            EXPECT_EQ(a.number, b.number);
        }
    }
}

/// Rays that graze a ridge collect votes against it; the surface behind them must not get lost.
TEST(SurfaceVotes, AgainstSurfacesLeaveRoomForTheNext) {
    SurfacePair pair = no_surfaces();
    SurfaceVote miss, hit;
    miss.weight = hit.weight = 1;
    miss.enters = false;
    hit.enters = true;
    hit.n = {0, 0, -1};
    for (int k = 0; k < 20; ++k)
        count_vote(pair, miss, 10 + 0.4 * k, {1, 1});
    count_vote(pair, hit, 20, {7, 1});
    count_vote(pair, hit, 20.1, {7, 1});
    EXPECT_TRUE(wins(pair.front));
    EXPECT_NEAR(way_to(pair.front), 20.05, 1e-12);
    count_vote(pair, miss, 20, {1, 1});
    count_vote(pair, miss, 20, {1, 1});
    EXPECT_FALSE(wins(pair.front));
}

TEST(SurfaceVotes, OfMissesBeforeTheHitCountAgainstIt) {
    SurfacePair pair = no_surfaces();
    SurfaceVote miss, hit;
    miss.weight = 2;
    hit.weight = 1;
    miss.enters = false;
    hit.enters = true;
    hit.n = {0, 0, -1};
    count_vote(pair, miss, 9.8, {1, 1});
    count_vote(pair, hit, 10, {2, 1});
    EXPECT_EQ(pair.front.misses, 2);
    EXPECT_FALSE(wins(pair.front));
}

TEST(SurfaceVotes, ShowTheMeanLight) {
    std::vector<double> weights{0.5, 0.3, 0.45, 0.4, 0.2};
    std::vector<std::size_t> order{0, 1, 2, 3, 4};
    SurfaceVote hit;
    hit.enters = true;
    hit.n = {0, 0, -1};
    do {
        SurfacePair pair = no_surfaces();
        for (const std::size_t i : order) {
            hit.weight = weights[i];
            const Shown shown{static_cast<uint>(i), i == 0 ? 0.2 : 1.0, {1.0, i == 0 ? 0.4 : 0.8}};
            count_vote(pair, hit, 5, shown);
        }
        EXPECT_EQ(pair.front.number, 0U);
        EXPECT_NEAR(arrives_at(pair.front), 1 - 0.8 * 0.5 / 1.85, 1e-12);
        EXPECT_EQ(lights_at(pair.front).x, 1);
        EXPECT_NEAR(lights_at(pair.front).y, 0.8 - 0.4 * 0.5 / 1.85, 1e-12);
    } while (std::ranges::next_permutation(order).found);
}

/// Nothing outvotes matter that begins at a plane; a surface in front of it is seen all the same.
TEST(SurfaceVotes, BeginMatterCertainly) {
    SurfacePair pair = no_surfaces();
    begin_matter(pair.front, 7, 2, {0, 1, 0}, 5);
    SurfaceVote vote;
    vote.weight = 1;
    vote.n = {1, 0, 0};
    vote.enters = false;
    for (int k = 0; k < 30; ++k)
        count_vote(pair, vote, 7.1, {1, 0});
    EXPECT_TRUE(wins(pair.front));
    EXPECT_NEAR(way_to(pair.front), 7, 1e-12);
    vote.enters = true;
    count_vote(pair, vote, 5, {2, 1});
    EXPECT_EQ(pair.front.number, 2U);
    EXPECT_EQ(pair.behind.number, 5U);
}

/// A pixel stays open until what lies behind thin matter is known.
TEST(SurfaceVotes, AreOpenBehindThinMatter) {
    SurfacePair pair = no_surfaces();
    SurfaceVote hit;
    hit.weight = 1;
    hit.n = {0, 0, -1};
    hit.enters = true;
    hit.chord = 0.25;
    count_vote(pair, hit, 5, {1, 1});
    EXPECT_FALSE(is_decided(pair, 5.5, 1)) << "later votes may be about it";
    EXPECT_FALSE(is_decided(pair, 20, 1));
    EXPECT_TRUE(is_decided(pair, 20, 0.2)) << "solid";
    SurfaceVote miss = hit;
    miss.enters = false;
    count_vote(pair, miss, 5.1, {2, 1});
    hit.weight = 0.5;
    count_vote(pair, hit, 5.1, {3, 1});
    EXPECT_NEAR(mean_chord(pair.front), 0.25 * 1.5 / 2.5, 1e-12) << "0 where it passes by";
    hit.chord = 2;
    count_vote(pair, hit, 9, {4, 1});
    EXPECT_FALSE(is_decided(pair, 9.5, 1));
    EXPECT_TRUE(is_decided(pair, 10, 1));
    // Votes against the surface behind leave its place to the next.
    count_vote(pair, miss, 9, {5, 1});
    EXPECT_FALSE(is_decided(pair, 12, 1));
    EXPECT_EQ(way_to(pair.behind), NO_SURFACE);
    EXPECT_NEAR(way_to(pair.front), 5 + 0.1 / 3, 1e-12);
}

/// The chord of a ray through a ball, nearly grazing it.
TEST(SurfaceVotes, KnowHowLongRaysStayInABall) {
    for (const double depth : {0.01, 0.05, 0.1}) {
        const double radius = 5, aside = radius - depth;
        const SurfaceSplat splat = ball({0, 0.3 - radius, 0}, radius, 3);
        const SurfaceVote vote = vote_of(splat, {0, 0.3 - radius + aside, 0}, {1, 0, 0});
        ASSERT_TRUE(vote.enters);
        EXPECT_NEAR(vote.chord, std::min(2 * std::sqrt(radius * radius - aside * aside), 2.0), 0.02 * vote.chord);
    }
    // Head on nothing is known of the other side.
    EXPECT_EQ(vote_of(ball({0, 0, 4.8}, 5, 3), {0, 0, 0}, {0, 0, 1}).chord, 2);
}

TEST(SurfaceVotes, InFloatEqualThoseInDouble) {
    Random random;
    for (int k = 0; k < 5000; ++k) {
        const double radius = random(1, 8);
        const vec3 center = (radius + random(-0.8, 0.2)) * random.direction(), u = random.direction();
        const vec3 p = random.across(u, 1);
        const SurfaceSplat splat = ball(center, radius, 1.3);
        const SurfaceVote exact = vote_of(splat, p, u);
        in_float::SurfaceSplat rounded;
        rounded.value = static_cast<float>(splat.value);
        rounded.slope = splat.slope;
        rounded.h = {glm::vec3(splat.h.diagonal), glm::vec3(splat.h.mixed)};
        rounded.foot = splat.foot;
        rounded.reach = 1.3F;
        const in_float::SurfaceVote vote = in_float::vote_of(rounded, p, u);
        // A ray that touches the ball may meet it or not; there its place is a root of rounding errors.
        if (exact.enters != vote.enters || std::abs(glm::dot(glm::normalize(exact.n), u)) < 0.05) continue;
        EXPECT_NEAR(static_cast<double>(vote.weight), exact.weight, 2e-4);
        if (exact.weight > 0) {
            EXPECT_NEAR(static_cast<double>(vote.z), exact.z, 2e-4);
        }
    }
}

/// The field of a ball, whose surface is a step of width 1.
SurfaceCheck check_of(const SurfaceSplat& face, const vec3& center, double radius, double shift) {
    SurfaceCheck check = no_check();
    const vec3 n = glm::normalize(face.slope + bent(face.h, face.foot));
    for (int k = 0; k < SURFACE_CHECKS; ++k) {
        const vec3 at = checked_point(face, n, k), from = at - center;
        check_point(check, face, at, radius + shift - glm::length(from), -glm::normalize(from));
    }
    return check;
}

TEST(SurfaceChecks, AcceptTheFieldsOwnSurfaceAndNoOther) {
    Random random;
    for (int k = 0; k < 200; ++k) {
        const double radius = random(2, 12);
        const vec3 center = (radius + random(-0.8, 0.2)) * random.direction();
        const SurfaceSplat face = ball(center, radius, 1.3);
        const SurfaceCheck own = check_of(face, center, radius, 0);
        EXPECT_LT(own.away, 1e-3);
        EXPECT_LT(own.turned, 1e-3);
        EXPECT_TRUE(is_verified(own, 0, 2));
        const SurfaceCheck shifted = check_of(face, center, radius, 0.1);
        EXPECT_NEAR(shifted.away, 0.1, 1e-3);
        EXPECT_FALSE(is_verified(shifted, 0, 2));
        EXPECT_NEAR(error_of(shifted), 0.1, 1e-3);
        // Noise of that size explains it.
        EXPECT_TRUE(is_verified(shifted, 0.05, 2));
        // Ripples do where the field rises by no more than in a voxel.
        EXPECT_TRUE(is_verified(shifted, 0, 1));
        // A face that is too flat agrees at its foot only.
        SurfaceSplat flat = face;
        const vec3 n = normalize(face.foot - center);
        flat.h = no_bending();
        flat.slope = n;
        flat.value = -dot(n, face.foot);
        EXPECT_EQ(is_verified(check_of(flat, center, radius, 0), 0, 2), radius > 27);
    }
}

TEST(SurfaceChecks, SeeSamplesOnTheWrongSide) {
    const SurfaceSplat face = ball({0, 0, -4.6}, 5, 1.3);  // the surface lies .4 above the voxel
    EXPECT_EQ(contradiction(face, {0, 0, 0}, true), 0);
    EXPECT_EQ(contradiction(face, {0, 0, 1}, false), 0);
    EXPECT_NEAR(contradiction(face, {0, 0, 1}, true), 0.6, 0.05);
    EXPECT_NEAR(contradiction(face, {0, 0, 0}, false), 0.4, 0.05);
    EXPECT_EQ(contradiction(face, {0, 0, 3}, true), 0) << "too far away to say anything";
}

}  // namespace
}  // namespace edgesplat::geometry
