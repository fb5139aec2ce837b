#include "engine/viewer/pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace edgesplat::viewer {
namespace {

/// A cost model of a device: a part per splat (a finer level has four times as many) and a part per pixel.
struct Cost {
    double splats = 0, pixels = 0;  ///< milliseconds at level 0 and full size
    double of(const Rung& rung) const { return splats / std::pow(4.0, rung.level) + pixels * rung.scale * rung.scale; }
};

struct Flight {
    std::vector<double> times;
    std::vector<Rung> rungs;
    double share_within(double target) const {
        const auto within = std::ranges::count_if(times, [&](double t) { return t <= target; });
        return static_cast<double>(within) / static_cast<double>(times.size());
    }
    int changes(std::size_t from) const {
        int count = 0;
        for (std::size_t i = from + 1; i < rungs.size(); ++i)
            count += rungs[i] == rungs[i - 1] ? 0 : 1;
        return count;
    }
};

/// Draws `pictures` pictures; their costs scatter by +-15 %.
template <typename CostAt>
Flight fly(Pace& pace, int pictures, const CostAt& cost_at) {
    std::mt19937 random(7);
    Flight flight;
    for (int i = 0; i < pictures; ++i) {
        const Rung rung = pace.rung();
        const double noise = 0.85 + 0.3 * static_cast<double>(random()) / 4294967296.0;
        const double time = cost_at(i).of(rung) * noise;
        flight.times.push_back(time);
        flight.rungs.push_back(rung);
        pace.drawn(time, 0, true);
    }
    return flight;
}

TEST(Pace, StartsCoarse) {
    const Pace pace(150, 2);
    EXPECT_EQ(pace.rung().level, 2);
    EXPECT_LE(pace.rung().scale, 0.25);
}

TEST(Pace, ReachesFinestLevelWithEnoughTime) {
    Pace pace(150, 2);
    fly(pace, 300, [](int) { return Cost{5, 20}; });
    EXPECT_EQ(pace.rung(), (Rung{0, 1.0}));
}

TEST(Pace, MeetsTargetForEveryCostModel) {
    for (const Cost cost : {Cost{400, 50}, Cost{100, 3000}, Cost{30, 300}, Cost{1500, 1000}, Cost{10, 20000}}) {
        Pace pace(150, 3);
        const Flight flight = fly(pace, 400, [&](int) { return cost; });
        EXPECT_GE(flight.share_within(150), 0.95) << cost.splats << " " << cost.pixels;
    }
}

TEST(Pace, KeepsLevelInSteadyView) {
    for (const Cost cost : {Cost{400, 50}, Cost{100, 3000}, Cost{30, 300}, Cost{140, 100}, Cost{60, 500}}) {
        Pace pace(150, 3);
        const Flight flight = fly(pace, 600, [&](int) { return cost; });
        EXPECT_LE(flight.changes(100), 10) << cost.splats << " " << cost.pixels;
    }
}

TEST(Pace, AdaptsToChangingCost) {
    Pace pace(150, 3);
    const Flight flight = fly(pace, 600, [](int i) {
        const double nearer = 1 + 3 * (1 + std::sin(i * 0.02));
        return Cost{60 * nearer, 400 * nearer};
    });
    EXPECT_GE(flight.share_within(150), 0.95);
}

TEST(Pace, ReactsToOneSlowPicture) {
    Pace pace(150, 0);
    fly(pace, 200, [](int) { return Cost{5, 40}; });
    ASSERT_EQ(pace.rung().scale, 1);
    pace.drawn(600, 0, true);
    EXPECT_LT(pace.rung().scale, 1);
    EXPECT_LE(600 * pace.rung().scale * pace.rung().scale, 150);
}

TEST(Pace, RaysUseOnlyLevelZero) {
    Pace pace(150, 3, true);
    const Flight flight = fly(pace, 200, [](int) { return Cost{0, 2000}; });
    for (const Rung& rung : flight.rungs) {
        EXPECT_EQ(rung.level, 0);
        EXPECT_TRUE(rung.rays);
    }
    EXPECT_GE(flight.share_within(150), 0.95);
}

TEST(Pace, WaitsForFinerLevel) {
    Pace pace(150, 2);
    for (int i = 0; i < 200; ++i)
        pace.drawn(1, 0, false);
    EXPECT_EQ(pace.rung().level, 2);
    EXPECT_EQ(pace.rung().scale, 1);
}

}  // namespace
}  // namespace edgesplat::viewer
