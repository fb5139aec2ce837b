// Pictures and measures of volumes in which some samples contain no data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using testing::HasSubstr;

constexpr int kSide = 20;

class CliNoData : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        const float missing = std::numeric_limits<float>::quiet_NaN();
        // Two balls, of 10 and of -10, in 0; without data beyond a sphere around both.
        for (const auto& [name, outside] :
             {std::pair<const char*, float>{"nan.raw", missing}, {"zero.raw", 0.0F}, {"least.raw", -10.0F}}) {
            std::vector<float> values;
            for (int z = 0; z < kSide; ++z)
                for (int y = 0; y < kSide; ++y)
                    for (int x = 0; x < kSide; ++x) {
                        const auto ball = [&](double cx) {
                            return std::exp(-0.2 * (std::pow(x - cx, 2) + std::pow(y - 9.5, 2) + std::pow(z - 9.5, 2)));
                        };
                        const double r = std::hypot(std::hypot(x - 9.5, y - 9.5), z - 9.5);
                        values.push_back(r > 9 ? outside : static_cast<float>(10 * ball(6) - 10 * ball(13)));
                    }
            std::ofstream(folder_ / name, std::ios::binary)
                .write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(4 * values.size()));
        }
    }
    /// Writes a scene; `look`: TOML after the volume.
    void scene(const std::string& name, const std::string& volume, const std::string& look) const {
        std::ofstream(folder_ / name) << "[volume]\npath = \"" << volume << "\"\nraw = \"20x20x20:float32:little\"\n"
                                      << look << "[camera]\nview = \"front\"\n[output]\nsize = [64, 64]\n";
    }
    ProgramRun drawn(const std::string& scene, const std::string& options, const std::string& picture) const {
        const ProgramRun done = run("render " + scene + " " + options + " -q -o " + picture);
        EXPECT_EQ(done.status, 0) << done.err;
        return done;
    }
    void expect_same(const std::string& a, const std::string& b, double difference = 0.004) const {
        const ProgramRun compared = run("compare " + a + " " + b + " --max-diff " + std::to_string(difference));
        EXPECT_EQ(compared.status, 0) << a << " and " << b << ": " << compared.out;
    }
    static constexpr const char* kDiverging =
        "[[transfer]]\nvalue = -6.0\ncolor = [0.1, 0.2, 1.0]\nextinction = 2.0\n"
        "[[transfer]]\nvalue = -2.0\ncolor = [0.1, 0.2, 1.0]\nextinction = 0.0\n"
        "[[transfer]]\nvalue = 2.0\ncolor = [1.0, 0.1, 0.05]\nextinction = 0.0\n"
        "[[transfer]]\nvalue = 6.0\ncolor = [1.0, 0.1, 0.05]\nextinction = 2.0\n";
};

TEST_F(CliNoData, IsTransparentWhereTheSmallestValueIsOpaque) {
    scene("nan.toml", "nan.raw", kDiverging);
    scene("zero.toml", "zero.raw", kDiverging);
    int number = 0;
    for (const char* options : {"", "--renderer raycast", "--renderer reference"}) {
        const std::string nan = std::to_string(number) + "nan.png", zero = std::to_string(number++) + "zero.png";
        drawn("nan.toml", options, nan);
        drawn("zero.toml", options, zero);
        expect_same(nan, zero, 0.01);
    }
    const ProgramRun cubic = run("render nan.toml --renderer raycast --raycast-filter cubic -o no.png");
    EXPECT_EQ(cubic.status, 1);
    EXPECT_THAT(cubic.err, HasSubstr("expected the trilinear one"));
}

TEST_F(CliNoData, IsDrawnAsTheSmallestValueIfThatIsTransparent) {
    const std::string look = "iso_values = [3.0]\n";
    for (const char* name : {"nan", "least"})
        std::ofstream(folder_ / (std::string(name) + ".toml"))
            << look << "[volume]\npath = \"" << name
            << ".raw\"\nraw = \"20x20x20:float32:little\"\n[camera]\nview = \"oblique\"\n[output]\nsize = [64, 64]\n";
    drawn("nan.toml", "", "a.png");
    drawn("least.toml", "", "b.png");
    // The range of values differs, and with it their rounding and which samples tell the noise.
    expect_same("a.png", "b.png", 0.04);
}

TEST_F(CliNoData, BelongsToNoOpaqueMaterialBelow) {
    // Everything below 3 is opaque: the volume's cube without a mark, its sphere with data with one.
    const std::string look = "iso_values = [3.0]\n[below]\ncolor = [0.2, 0.9, 0.2]\nextinction = 8.0\n";
    for (const char* name : {"nan", "least"})
        std::ofstream(folder_ / (std::string(name) + ".toml"))
            << look << "[volume]\npath = \"" << name
            << ".raw\"\nraw = \"20x20x20:float32:little\"\n[camera]\neye = [9.5, -40.0, 9.5]\nup = [0.0, 0.0, 1.0]\n"
               "[output]\nsize = [64, 64]\n";
    drawn("nan.toml", "", "splats.png");
    drawn("least.toml", "", "least.png");
    // A third of the square's pixels are beyond the disc.
    EXPECT_EQ(run("compare splats.png least.png --max-diff 0.1 --max-share 0.03").status, 1);
    drawn("nan.toml", "--renderer raycast", "rays.png");
    EXPECT_EQ(run("compare splats.png rays.png --max-diff 0.35 --max-share 0.08").status, 0)
        << run("compare splats.png rays.png --max-diff 0.35 --max-share 0.08").out;
}

TEST_F(CliNoData, IsInNoMaterialsVolume) {
    const auto volumes = [&](const std::string& name) {
        const ProgramRun done = run("measure " + name + " --raw 20x20x20:float32:little --iso 3 --json -");
        return nlohmann::json::parse(done.out)["materials"];
    };
    const auto missing = volumes("nan.raw"), whole = volumes("zero.raw");
    EXPECT_NEAR(missing[1]["volume_mm3"]["value"].get<double>(), whole[1]["volume_mm3"]["value"].get<double>(), 0.5);
    const double sum =
        missing[0]["volume_mm3"]["value"].get<double>() + missing[1]["volume_mm3"]["value"].get<double>();
    EXPECT_NEAR(sum, 4.0 / 3 * M_PI * 9 * 9 * 9, 60);
    EXPECT_NEAR(whole[0]["volume_mm3"]["value"].get<double>() + whole[1]["volume_mm3"]["value"].get<double>(), 8000, 1);
}

TEST_F(CliNoData, IsDeclaredOnTheCommandLineAndInScenes) {
    const std::string raw = "--raw 20x20x20:float32:little ";
    const auto told = nlohmann::json::parse(run("info least.raw " + raw + "--no-data -10 --json -").out);
    const auto nan = nlohmann::json::parse(run("info nan.raw " + raw + "--json -").out);
    EXPECT_EQ(told["no_data"], nan["no_data"]);
    EXPECT_EQ(told["range"], nan["range"]);
    EXPECT_EQ(told["checksum"], nan["checksum"]);
    EXPECT_EQ(told["samples_crc32"], nan["samples_crc32"]);
    ASSERT_EQ(run("scene new least.raw " + raw + "--no-data=-10 -o new.toml").status, 0);
    EXPECT_THAT(text_of(folder_ / "new.toml"), HasSubstr("no_data = -10"));
    const ProgramRun rendered = run("render new.toml -o new.png --size 64x64");
    EXPECT_EQ(rendered.status, 0);
    EXPECT_THAT(rendered.err, HasSubstr("samples contain no data; they are transparent"));
    ASSERT_EQ(run("pack least.raw " + raw + "--no-data -10 -o packed.esv").status, 0);
    const auto packed = nlohmann::json::parse(run("info packed.esv --json -").out);
    EXPECT_EQ(packed["no_data"], nan["no_data"]);
    EXPECT_NEAR(packed["mean"].get<double>(), nan["mean"].get<double>(), 1e-9);
    EXPECT_THAT(packed["notes"].dump(), HasSubstr("as packed volumes do not mark them"));
}

TEST_F(CliNoData, CaseOfNaN) {
    const char* data = std::getenv("EDGESPLAT_DATA");
    const std::string cases = std::string(data != nullptr ? data : "") + "/odd/cases/nrrd/";
    if (!std::filesystem::exists(cases + "nan.toml")) GTEST_SKIP() << cases << " is not there (EDGESPLAT_DATA)";
    for (const char* name : {"nan.nrrd", "zero.nrrd", "nan.toml"})
        std::filesystem::copy(cases + name, folder_ / name);
    std::string text = text_of(folder_ / "nan.toml");
    text.replace(text.find("nan.nrrd"), 8, "zero.nrrd");
    std::ofstream(folder_ / "zero.toml") << text;
    drawn("nan.toml", "--size 64x64", "nan.png");
    drawn("zero.toml", "--size 64x64", "zero.png");
    expect_same("nan.png", "zero.png", 0);
}

}  // namespace
}  // namespace edgesplat
