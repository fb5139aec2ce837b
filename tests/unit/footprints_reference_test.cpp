// Compares with independently computed values. EDGESPLAT_MATH names the folder with reference.json; without it these
// tests are skipped.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "footprints/footprint_integral.h"
#include "footprints/kernel.h"

namespace edgesplat {
namespace {

using nlohmann::json;
using Numbers = std::vector<double>;

class Reference : public testing::Test {
  protected:
    void SetUp() override {
        const char* folder = std::getenv("EDGESPLAT_MATH");
        if (!folder) GTEST_SKIP() << "EDGESPLAT_MATH does not name a folder of reference values";
        std::ifstream in(std::filesystem::path(folder) / "reference.json");
        ASSERT_TRUE(in) << folder;
        values_ = json::parse(in);
    }
    const json& reference() const { return values_; }
    json values_;
};

TEST_F(Reference, Kernel) {
    const json& k7 = reference()["kernel"]["K7"];
    const Numbers r = k7["r"], K = k7["K"], g = k7["g"], phi = k7["phi"];
    for (std::size_t i = 0; i < r.size(); ++i) {
        EXPECT_NEAR(kernel(r[i] * r[i]), K[i], 1e-9);
        EXPECT_NEAR(kernel_footprint(r[i] * r[i]), g[i], 1e-9);
        EXPECT_NEAR(kernel_plane_integral(r[i] * r[i]), phi[i], 1e-9);
    }
    const Numbers c = k7["g_coeff_w2.5_to_w7.5"];
    for (std::size_t i = 0; i < c.size(); ++i)
        EXPECT_NEAR(footprint_coefficients(kKernel)[i], c[i], 1e-9);
}

TEST_F(Reference, PaperProfile) {
    const Numbers x = reference()["profile"]["x"];
    for (const json& set : reference()["profile"]["sets"]) {
        const PaperProfile q = {set["t1"], set["t2"], set["m1"], set["m2"]};
        PaperProfile smooth = q;
        smooth.curve = PaperCurve::Smooth;
        const Numbers p = set["p"], dp = set["dp"], map = set["map"], rq = set["rq_map"];
        for (std::size_t i = 0; i < x.size(); ++i) {
            EXPECT_NEAR(paper_profile(x[i], q), p[i], 1e-12);
            EXPECT_NEAR(paper_profile_slope(x[i], q), dp[i], 1e-9);
            EXPECT_NEAR(paper_map(x[i], q), map[i], 1e-7);  // infinite slope at the knots
            EXPECT_NEAR(paper_map(x[i], smooth), rq[i], 1e-12);
        }
    }
}

TEST_F(Reference, FigureEight) {
    const json& fig = reference()["fig8"];
    const Numbers x = fig["x"], normal = fig["normal_K7"], enhanced = fig["enhanced_K7"],
                  smooth = fig["enhanced_RQ_K7"];
    PaperProfile q = {fig["t1"], fig["t2"], 0, 0};
    q.m1 = fig["m1"];
    q.m2 = fig["m2"];
    PaperProfile rq = q;
    rq.curve = PaperCurve::Smooth;
    const auto reconstruct = [&](double at) {
        double sum = 0;
        for (int i = -4; i <= 5; ++i)
            sum += (i <= 0 ? fig["left"] : fig["right"]).get<double>() * kernel_plane_integral((at - i) * (at - i));
        return sum;
    };
    for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_NEAR(reconstruct(x[i]), normal[i], 1e-8);
        EXPECT_NEAR(reconstruct(paper_map(x[i], q)), enhanced[i], 1e-6);
        EXPECT_NEAR(reconstruct(paper_map(x[i], rq)), smooth[i], 1e-8);
    }
}

}  // namespace
}  // namespace edgesplat
