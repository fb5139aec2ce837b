// Medians, percentiles and fits on data with known answers; comparison of two runs.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "engine/bench/compare.h"
#include "engine/bench/run_output.h"

namespace edgesplat::bench {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(BenchStatistics, ComputesMedianAndPercentiles) {
    std::vector<double> values;
    for (int i = 100; i >= 0; --i)
        values.push_back(i);
    const Sampled s = sampled(values);
    EXPECT_DOUBLE_EQ(s.median, 50);
    EXPECT_DOUBLE_EQ(s.p95, 95);
    EXPECT_DOUBLE_EQ(s.low, 10);
    EXPECT_DOUBLE_EQ(s.high, 90);
    EXPECT_EQ(s.count, 101U);
    EXPECT_DOUBLE_EQ(sampled({3, 1}).median, 2);
    EXPECT_TRUE(std::isnan(sampled({}).median));
}

TEST(BenchStatistics, FitsExponentOfPowerLaw) {
    std::vector<std::pair<double, double>> points{{0, 3}, {-1, 2}, {5, NAN}};
    for (const double x : {32.0, 64.0, 128.0, 512.0})
        points.emplace_back(x, 0.25 * std::pow(x, 2.5));
    const auto fit = fit_power(points);
    ASSERT_TRUE(fit);
    EXPECT_NEAR(fit->exponent, 2.5, 1e-12);
    EXPECT_NEAR(fit->factor, 0.25, 1e-12);
    EXPECT_NEAR(fit->residual, 0, 1e-12);
    EXPECT_EQ(fit->points, 4U);
    points.emplace_back(64, 0.25 * std::pow(64, 2.5) * std::exp(0.1));
    EXPECT_GT(fit_power(points)->residual, 0.01);
    EXPECT_FALSE(fit_power(std::vector<std::pair<double, double>>{{2, 3}, {2, 4}}));
    EXPECT_FALSE(fit_power({}));
}

CaseResult case_of(const std::string& name, double scale) {
    CaseResult c{.name = name, .group = name, .mode = "default", .series = "s", .volume = "v", .checksum = "0"};
    c.size = {64, 64};
    c.frame = c.processor = sampled({9 * scale, 10 * scale, 11 * scale, 10 * scale});
    c.raycast = sampled({5, 5, 5});
    c.ratio = c.wall_ratio = sampled({2 * scale, 2.1 * scale, 1.9 * scale});
    c.passes = {{"5_draw_splats", sampled({7 * scale, 8 * scale, 7 * scale})}};
    c.setup = sampled({20, 21, 22});
    c.stats.voxels = 4096;
    c.stats.splats_collected = 100;
    c.stats.splats_drawn = 60;
    c.stats.draw_counts = DrawCounts{1000, 2000, 1500};
    return c;
}

TEST(BenchScaling, FitsEachSeriesModeAndSizeSeparately) {
    std::vector<CaseResult> cases;
    for (const double n : {16.0, 32.0, 64.0}) {
        CaseResult c = case_of("a", 1);
        c.stats.splats_drawn = static_cast<std::uint64_t>(n * n);
        c.stats.voxels = static_cast<std::uint64_t>(n * n * n);
        c.frame.median = 3 * n * n;
        c.setup.median = n * n * n * n;
        cases.push_back(c);
        c.mode = "plain";
        c.frame.median = 5;
        cases.push_back(c);
        c.series.clear();
        cases.push_back(c);
    }
    const std::vector<Scaling> scaling = scaling_of(cases);
    ASSERT_EQ(scaling.size(), 4U);
    EXPECT_EQ(scaling[0].cost, "frame_ms_of_splats_drawn");
    EXPECT_NEAR(scaling[0].fit.exponent, 1, 1e-9);
    EXPECT_EQ(scaling[1].cost, "setup_ms_of_voxels");
    EXPECT_NEAR(scaling[1].fit.exponent, 4.0 / 3.0, 1e-9);
    EXPECT_EQ(scaling[2].mode, "plain");
    EXPECT_NEAR(scaling[2].fit.exponent, 0, 1e-9);
}

TEST(BenchCompare, MarksRatiosBeyondScatter) {
    BenchRun before{.program = "edgesplat 1", .cases = {case_of("a", 1), case_of("b", 1), case_of("old", 1)}};
    BenchRun after{.program = "edgesplat 2", .cases = {case_of("a", 0.5), case_of("b", 1.02), case_of("new", 1)}};
    after.cases[0].stats.draw_counts->shaded = 750;
    const Comparison c = compare_runs(run_json(before), run_json(after));
    ASSERT_EQ(c.cases.size(), 2U);
    const auto metric = [&](std::size_t at, const std::string& name) {
        for (const MetricChange& change : c.cases[at].metrics)
            if (change.metric == name) return change;
        return MetricChange{};
    };
    EXPECT_DOUBLE_EQ(*metric(0, "frame").ratio, 0.5);
    EXPECT_TRUE(metric(0, "frame").beyond_scatter);
    EXPECT_DOUBLE_EQ(*metric(0, "draw").ratio, 0.5);
    EXPECT_FALSE(metric(1, "frame").beyond_scatter);
    EXPECT_FALSE(metric(0, "setup").beyond_scatter);
    EXPECT_DOUBLE_EQ(*metric(0, "shaded").ratio, 0.5);
    EXPECT_TRUE(metric(0, "shaded").beyond_scatter);
    EXPECT_FALSE(metric(1, "shaded").beyond_scatter);
    EXPECT_FALSE(metric(0, "sort").ratio);
    EXPECT_THAT(c.notes, ::testing::ElementsAre(HasSubstr("program: \"edgesplat 1\" before"),
                                                "new: not in the earlier run", "old: only in the earlier run"));
    const std::string table = comparison_table(c);
    EXPECT_THAT(table, HasSubstr("0.50*"));
    EXPECT_THAT(table, HasSubstr("geometric mean"));
}

TEST(BenchOutput, CsvHasAColumnForEveryNumber) {
    BenchRun run{.cases = {case_of("a,b", 1), case_of("c", 1)}};
    run.cases[1].stats.draw_counts.reset();
    const std::string csv = run_csv(run);
    EXPECT_THAT(csv, StartsWith("name,group,mode,series,volume,checksum,dims.0,dims.1,dims.2,voxels,size.0,size.1,"
                                "frame_ms.median,"));
    EXPECT_THAT(csv, HasSubstr("\n\"a,b\",\"a,b\",default,"));
    const std::string head = csv.substr(0, csv.find('\n')), last = csv.substr(csv.find("\nc,") + 1);
    const auto commas = [](const std::string& line) { return std::count(line.begin(), line.end(), ','); };
    EXPECT_EQ(commas(head), commas(last.substr(0, last.find('\n'))));
}

}  // namespace
}  // namespace edgesplat::bench
