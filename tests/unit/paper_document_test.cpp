// docs/paper.md: its curves and proofs, and whether the page in the checkout is complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/paper/curve_sections.h"
#include "apps/paper/misprints.h"
#include "apps/paper/sharpness.h"

namespace edgesplat {
namespace {

using testing::HasSubstr;
using testing::Not;
using Numbers = std::vector<double>;

const std::filesystem::path kDocs = std::filesystem::path(EDGESPLAT_SOURCE_DIR) / "docs";

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

TEST(PaperCurves, FigureEightMatchesGroundTruth) {
    const char* folder = std::getenv("EDGESPLAT_MATH");
    if (!folder) GTEST_SKIP() << "EDGESPLAT_MATH does not name a folder of reference values";
    std::ifstream in(std::filesystem::path(folder) / "reference.json");
    ASSERT_TRUE(in) << folder;
    const nlohmann::json truth = nlohmann::json::parse(in)["fig8"];
    CurveExample e;
    e.profile = {truth["t1"], truth["t2"], truth["m1"], truth["m2"]};
    e.left = truth["left"];
    e.right = truth["right"];
    const Numbers x = truth["x"], normal = truth["normal_K7"], enhanced = truth["enhanced_K7"],
                  smooth = truth["enhanced_RQ_K7"];
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double warped = paper_map(x[i], e.profile);
        EXPECT_NEAR(reconstruction(e, x[i]), normal[i], 1e-8);
        EXPECT_NEAR(reconstruction(e, warped), enhanced[i], 1e-6);
        EXPECT_NEAR(reconstruction(e, paper_map(x[i], e.smooth())), smooth[i], 1e-8);
        for (int j = 0; j < 4; ++j)
            EXPECT_NEAR(weighted_kernel(e, j - 1, warped),
                        truth["splats"][static_cast<std::size_t>(j)][i].get<double>(), 1e-6);
    }
}

TEST(PaperCurves, WarpsSharpenAndLocateEdge) {
    const CurveExample e;
    const StepQuality plain = step_quality(e, [&](double x) { return reconstruction(e, x); });
    const StepQuality paper = step_quality(e, [&](double x) { return reconstruction(e, paper_map(x, e.profile)); });
    const StepQuality ours = step_quality(e, [&](double x) { return cut_reconstruction(e, x); });
    EXPECT_NEAR(plain.rise, 0.843, 0.002);
    EXPECT_NEAR(plain.location, 0.5 - e.edge(), 1e-3);  // plain reconstruction is symmetric about the middle
    EXPECT_LT(paper.rise, 0.65);
    EXPECT_NEAR(paper.location, 0, 1e-3);
    EXPECT_LT(ours.rise, 1e-3);
    EXPECT_NEAR(ours.location, 0, 1e-3);
    EXPECT_LT(ours.rms, paper.rms);
    EXPECT_LT(paper.rms, plain.rms);
}

const PaperProfile kProfiles[] = {CurveExample{}.profile, {0.2, 0.7, 0.3, 0.45}, {0.1, 0.9, 0.45, 0.52}};

void expect_boundary(const Boundary& actual, const Boundary& wanted, double tolerance) {
    EXPECT_NEAR(actual.start, wanted.start, tolerance);
    EXPECT_NEAR(actual.start_slope, wanted.start_slope, tolerance);
    EXPECT_NEAR(actual.end, wanted.end, tolerance);
    EXPECT_NEAR(actual.end_slope, wanted.end_slope, tolerance);
}

TEST(PaperMisprints, CorrectedIntervalsMeetTheirConditions) {
    for (const PaperProfile& q : kProfiles)
        for (int interval = 1; interval <= 3; ++interval)
            expect_boundary(corrected(q, interval), required(q, interval), 1e-10);
}

TEST(PaperMisprints, IntervalOneSwapsTwoCoefficients) {
    for (const PaperProfile& q : kProfiles) {
        expect_boundary(boundary_of(interval1(q), 0, q.t1), required(q, 1), 1e-12);
        expect_boundary(boundary_of(interval1_printed(q), 0, q.t1), {1, 0, q.m1 + 1 - q.t1, -1}, 1e-12);
    }
}

TEST(PaperMisprints, IntervalTwoIsReversed) {
    for (const PaperProfile& q : kProfiles)
        expect_boundary(interval2_printed(q), {q.m2, 0, q.m1, 0}, 1e-12);
}

TEST(PaperMisprints, IntervalThreeHasOneSolution) {
    for (const PaperProfile& q : kProfiles) {
        const SolvedCubic solved = interval3_solved(q);
        EXPECT_NEAR(solved.determinant, std::pow(1 - q.t2, 4), 1e-14);
        expect_boundary(boundary_of(solved.cubic, q.t2, 1), required(q, 3), 1e-9);
        for (int i = 1; i < 100; ++i) {
            const double x = q.t2 + (1 - q.t2) * i / 100;
            EXPECT_NEAR(boundary_of(solved.cubic, x, x).start, paper_profile(x, q), 1e-10);
        }
    }
}

TEST(PaperMisprints, RulePredictsMonotoneProfiles) {
    const MonotoneScan scan = scan_monotone(12);
    EXPECT_GT(scan.monotone, 0);
    EXPECT_GT(scan.profiles, scan.monotone);
    EXPECT_EQ(scan.disagreements, 0);
}

TEST(PaperMisprints, MapIsASquareRootAtItsKnots) {
    for (const PaperProfile& q : kProfiles) {
        const std::vector<SlopeRow> rows = map_slopes(q);
        for (std::size_t i = 2; i < rows.size(); ++i) {  // from h = 1e-6 on only the square root matters
            EXPECT_NEAR(rows[i].below_m1 / rows[i - 1].below_m1, 10, 0.15);
            EXPECT_NEAR(rows[i].above_m2 / rows[i - 1].above_m2, 10, 0.15);
            EXPECT_NEAR(rows[i].smooth, (q.t2 - q.t1) / (q.m2 - q.m1), 0.01);
        }
    }
}

TEST(PaperPictures, MeasuredEdgeWidthMatchesBlur) {
    double energy = 0;
    for (const double deviation : {4.0, 2.0, 1.0}) {  // pixels; a Gaussian's step rises from 10 to 90 % over 2.563
        Image image(96, 96, 4);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 4; ++c)
                    image.at(x, y, c) = static_cast<float>(
                        0.5 * std::erfc(((x - 47.3) * 0.8 + (y - 48.1) * 0.6) / (deviation * std::sqrt(2.0))));
        const Sharpness sharp = sharpness(image);
        EXPECT_GT(sharp.edges, 50);
        EXPECT_NEAR(sharp.edge_width, 2.563 * deviation, 0.25 + 0.08 * deviation);
        EXPECT_GT(sharp.gradient_energy, energy * 1.9);  // proportional to 1 / deviation
        energy = sharp.gradient_energy;
    }
}

TEST(PaperDocument, SectionsRoundTrip) {
    const std::string page = page_of({{"one", "# One\n\ntext\n"}, {"two", "![a](b.png)\n| ![c](d.svg) |\n"}});
    EXPECT_EQ(kept_section(page, "one"), "# One\n\ntext\n");
    EXPECT_EQ(kept_section(page, "two"), "![a](b.png)\n| ![c](d.svg) |\n");
    EXPECT_EQ(kept_section(page, "three"), "");
    EXPECT_EQ(page_of({{"one", kept_section(page, "one")}, {"two", kept_section(page, "two")}}), page);
    EXPECT_THAT(pictures_in(page), testing::ElementsAre("b.png", "d.svg"));
}

TEST(PaperDocument, FillsOnlyParagraphs) {
    const std::string word(70, 'w');
    EXPECT_EQ(filled("a\nb\n\n| c |\n| d |\n"), "a b\n\n| c |\n| d |\n");
    EXPECT_EQ(filled(word + " " + word + "\n"), word + "\n" + word + "\n");
    EXPECT_EQ(filled("text\n```sh\nx\ny\n```\n`code` at\nthe start\n"),
              "text\n```sh\nx\ny\n```\n`code` at the start\n");
}

TEST(PaperDocument, PageIsComplete) {
    const std::string page = text_of(kDocs / "paper.md");
    for (const char* number : {"4", "6", "7", "8", "9", "10", "11", "12"})
        EXPECT_THAT(kept_section(page, std::string("figure ") + number), HasSubstr(std::string("## Figure ") + number));
    EXPECT_THAT(kept_section(page, "misprints"), HasSubstr("Interval 3"));
    for (const char* leftover : {"TODO", "TBD", "FIXME", "XXX", "{}", " nan", "/work", "/home", "/tmp"})
        EXPECT_THAT(page, Not(HasSubstr(leftover)));
    const std::vector<std::string> pictures = pictures_in(page);
    EXPECT_EQ(pictures.size(), 17U);
    std::uintmax_t bytes = 0;
    for (const std::string& picture : pictures) {
        ASSERT_TRUE(std::filesystem::exists(kDocs / picture)) << picture;
        bytes += std::filesystem::file_size(kDocs / picture);
        EXPECT_THAT(text_of(kDocs / picture), Not(testing::AnyOf(HasSubstr("/work/"), HasSubstr("/home/")))) << picture;
    }
    EXPECT_LT(bytes, 1500000U) << "the page's pictures must stay small";
}

}  // namespace
}  // namespace edgesplat
