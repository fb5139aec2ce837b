// The label that a surface shows: the line between labels, more of them than are remembered, ends of the volume, scans.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/geometry/in_double.h"

namespace edgesplat::geometry {
namespace {

/// Voxels with labels, as a surface asks for them.
struct Labelled {
    ivec3 dims{40};
    std::function<uint(const ivec3&)> number;
    std::function<bool(const ivec3&)> matter = [](const ivec3&) { return true; };
    bool on_scan = false;

    uint label_number(ivec3 p) const { return number(p); }
    bool label_votes(ivec3 p, uint) const { return on_scan ? matter(p) : number(p) > 0; }
#undef EDGESPLAT_SEEN_LABEL_GLSL
#define IF_ANY(condition) if (condition)
#include "engine/geometry/seen_label.glsl"
#undef IF_ANY
};

/// A place on the surface z = 20.3 of matter below it, and distances from a plane across it.
const vec3 kAcross = glm::normalize(vec3(1, 0.37, 0.2));
double beyond(const vec3& p) {
    return glm::dot(p - vec3(20), kAcross);
}

TEST(SeenLabels, MeetAlongTheLineBetweenThem) {
    Labelled halves{.number = [](const ivec3& p) { return p.z > 20 ? 0U : beyond(p) < 0 ? 1U : 2U; }};
    double squares = 0, worst = 0;
    int rows = 0;
    for (double y = 8; y < 32; y += 0.13, ++rows) {
        double x = 10;
        while (halves.seen_label({x, y, 20.3}, 1) == 1)
            x += 0.02;
        const double off = beyond({x, y, 20.3});
        squares += off * off;
        worst = std::max(worst, std::abs(off));
        for (; x < 30; x += 0.1)
            EXPECT_EQ(halves.seen_label({x, y, 20.3}, 1), 2U) << "one line";
    }
    // Voxels have stairs of one voxel: .29 rms, up to .6 off.
    EXPECT_LT(std::sqrt(squares / rows), 0.16);
    EXPECT_LT(worst, 0.3);
}

TEST(SeenLabels, AreThoseOfTheNearestVoxelAmongMany) {
    Labelled each{.number = [](const ivec3& p) { return static_cast<uint>(1 + p.x + 40 * (p.y + 40 * p.z)); }};
    for (const vec3 at : {vec3(12.2, 7.9, 3.3), vec3(0.1, 39, 38.8), vec3(20.4, 20.4, 20.4), vec3(-0.4, 0.3, 39.4)})
        EXPECT_EQ(each.seen_label(at, 1), each.number(glm::clamp(ivec3(glm::round(at)), ivec3(0), ivec3(39))));
    Labelled none{.number = [](const ivec3&) { return 0U; }};
    EXPECT_EQ(none.seen_label({3, 4, 5}, 1), 0U);
    Labelled speck{.number = [](const ivec3& p) { return p == ivec3(9) ? 7U : 0U; }};
    EXPECT_EQ(speck.seen_label({9.3, 9.2, 9}, 1), 7U);
}

/// Matter without a label counts; voxels without matter do not.
TEST(SeenLabels, OfScansEndWhereMatterHasNone) {
    Labelled scan{.number = [](const ivec3& p) { return p.z > 20   ? 5U
                                                        : p.x < 20 ? 3U
                                                                   : 0U; },
                  .matter = [](const ivec3& p) { return p.z <= 20; },
                  .on_scan = true};
    for (const double x : {12.0, 18.9, 20.1, 28.0})
        EXPECT_EQ(scan.seen_label({x, 15.2, 20.4}, 1), x < 19.5 ? 3U : 0U) << x;
    scan.number = [](const ivec3& p) { return p.z <= 20 ? 3U : 0U; };
    EXPECT_EQ(scan.seen_label({12, 15, 20.49}, 1), 3U);
}

}  // namespace
}  // namespace edgesplat::geometry
