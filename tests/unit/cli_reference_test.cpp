// `edgesplat render --renderer reference|truth`: pictures without a Vulkan device, with their error.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Pair;

/// Runs the program without any Vulkan driver.
class CliReference : public CliTest {
  protected:
    ProgramRun run_without_device(const std::string& arguments, const std::string& before = "") const {
        return run("--version >/dev/null && VK_DRIVER_FILES=/none VK_ICD_FILENAMES=/none " + before +
                   " '" EDGESPLAT_PROGRAM "' render " + arguments);
    }
    void render(const std::string& arguments) const {
        const ProgramRun result = run_without_device(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err, "") << "progress is only printed to terminals";
    }
    void refuses(const std::string& arguments, int status, const std::string& because) const {
        const ProgramRun result = run_without_device(arguments);
        EXPECT_EQ(result.status, status) << arguments;
        EXPECT_THAT(result.err, HasSubstr(because));
        EXPECT_THAT(files(), IsEmpty());
    }
};

TEST_F(CliReference, PicturesNameTheirRenderer) {
    for (const std::string name : {"reference", "truth"}) {
        render("builtin:sphere:24 -o a.exr --size 32x24 --json a.json --renderer " + name);
        const LoadedImage picture = read_image(folder_ / "a.exr");
        EXPECT_EQ(picture.image.width, 32);
        EXPECT_THAT(picture.metadata, Contains(Pair("edgesplat:renderer", name)));
        EXPECT_GT(picture.image.at(16, 12, 0), 0.3F) << "the sphere is in the middle";
        EXPECT_EQ(picture.image.at(0, 0, 0), 0.0F) << "the background is around it";
        const auto s = nlohmann::json::parse(text_of(folder_ / "a.json"));
        EXPECT_EQ(s["renderer"], name);
        EXPECT_EQ(s["tolerance"], 1e-4);
        EXPECT_FALSE(s.contains("device"));
        const auto& frame = s["frames"][0];
        EXPECT_GT(frame["error_estimate"], 0);
        EXPECT_LE(frame["error_estimate"], 1e-4);
        EXPECT_GT(frame["seconds"], 0);
        EXPECT_GT(frame["samples"], 1000);
        EXPECT_EQ(frame["voxels"], 24 * 24 * 24);
        EXPECT_EQ(frame["settings"]["edges"], "cubic");
        EXPECT_FALSE(frame.contains("splats_drawn"));
    }
}

TEST_F(CliReference, ReferenceAndTruthShowSameSphere) {
    render("builtin:sphere -o reference.exr --size 32x32 --renderer reference");
    render("builtin:sphere -o truth.exr --size 32x32 --renderer truth");
    const Image reference = read_image(folder_ / "reference.exr").image;
    const Image truth = read_image(folder_ / "truth.exr").image;
    double sum = 0;
    for (std::size_t i = 0; i < truth.pixels.size(); ++i)
        sum += std::pow(static_cast<double>(reference.pixels[i] - truth.pixels[i]), 2);
    EXPECT_LT(std::sqrt(sum / static_cast<double>(truth.pixels.size())), 0.05);
    EXPECT_NE(reference.pixels, truth.pixels);
}

TEST_F(CliReference, KeepsTolerance) {
    render("builtin:cube-hole -o fine.exr --size 24x24 --renderer reference --tolerance 1e-5 --json fine.json");
    render("builtin:cube-hole -o coarse.exr --size 24x24 --renderer reference --tolerance 0.01 --json coarse.json");
    const Image fine = read_image(folder_ / "fine.exr").image;
    const Image coarse = read_image(folder_ / "coarse.exr").image;
    for (std::size_t i = 0; i < fine.pixels.size(); ++i)
        EXPECT_NEAR(fine.pixels[i], coarse.pixels[i], 0.01F);
    const auto samples = [&](const char* file) {
        return nlohmann::json::parse(text_of(folder_ / file))["frames"][0]["samples"].get<double>();
    };
    EXPECT_GT(samples("fine.json"), samples("coarse.json"));
}

TEST_F(CliReference, ComparesWithPlainKernels) {
    render("builtin:sphere:24 -o both.exr --size 20x16 --compare plain --renderer reference --json both.json");
    render("builtin:sphere:24 -o plain.exr --size 20x16 --edges off --renderer reference");
    const Image both = read_image(folder_ / "both.exr").image;
    const Image plain = read_image(folder_ / "plain.exr").image;
    ASSERT_EQ(both.width, 42);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 20; ++x)
            ASSERT_EQ(both.at(x, y, 0), plain.at(x, y, 0)) << x << ',' << y;
    const auto s = nlohmann::json::parse(text_of(folder_ / "both.json"));
    ASSERT_EQ(s["frames"].size(), 2U);
    EXPECT_EQ(s["frames"][0]["name"], "plain");
    EXPECT_GT(s["frames"][0]["samples"], 0);
}

TEST_F(CliReference, ReferenceWritesTau) {
    render("builtin:sphere:24 -o a.exr --size 16x16 --renderer reference --aov tau");
    const LoadedImage picture = read_image(folder_ / "a.exr");
    ASSERT_THAT(picture.channel_names, IsSupersetOf({"R", "G", "B", "A", "tau"}));
    EXPECT_GT(picture.image.at(8, 8, 4), 10.0F);
}

TEST_F(CliReference, RefusesUnsupportedOptions) {
    refuses("builtin:sphere:24 -o a.exr --renderer reference --aov tau,depth", 1, "only the extra output tau");
    refuses("builtin:sphere:24 -o a.exr --renderer truth --aov tau", 1, "no extra outputs");
    refuses("head.nrrd -o a.exr --renderer truth", 1, "only builtin:NAME volumes have");
    refuses("builtin:sphere:24 -o a.exr --renderer truth --box-filter", 1, "--box-filter");
    refuses("builtin:sphere:24 -o a.exr --renderer truth --compare plain", 1, "--compare plain");
    refuses("builtin:sphere:24 -o a.exr --renderer paint", 2, "expected one of splat, ");
    refuses("builtin:sphere:24 -o a.exr --renderer reference --tolerance 0", 2, "above 0 and at most 0.1");
    refuses("builtin:sphere:24 -o a.exr --renderer reference --tolerance 0.2", 2, "above 0 and at most 0.1");
}

TEST_F(CliReference, InterruptLeavesNoFile) {
    const ProgramRun result =
        run_without_device("builtin:orbital -o a.exr --size 2000x2000 --renderer reference", "timeout -s INT 1");
    EXPECT_EQ(result.status, 124);
    EXPECT_THAT(files(), IsEmpty());
}

}  // namespace
}  // namespace edgesplat
