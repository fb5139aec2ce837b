// `edgesplat render` from end to end, on a small builtin volume: files, metadata, statistics.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Pair;

/// Skips its tests if the machine has no Vulkan device.
class CliRender : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        const ProgramRun devices = run("--list-devices");
        ASSERT_EQ(devices.status, 0) << devices.err;
        if (devices.out.find("no Vulkan device") == 0) GTEST_SKIP() << devices.out;
    }
    /// Runs a render that must succeed.
    void render(const std::string& arguments) const {
        const ProgramRun result = run("render " + arguments);
        ASSERT_EQ(result.status, 0) << result.err;
    }
};

TEST_F(CliRender, PictureRecordsCommand) {
    render("builtin:sphere:24 -o 'my sphere.png' --size 48x32");
    EXPECT_THAT(files(), ElementsAre("my sphere.png"));
    const LoadedImage picture = read_image(folder_ / "my sphere.png");
    EXPECT_EQ(picture.image.width, 48);
    EXPECT_EQ(picture.image.height, 32);
    EXPECT_THAT(picture.channel_names, ElementsAre("R", "G", "B"));
    EXPECT_THAT(picture.metadata, Contains(Pair("edgesplat:command",
                                                "edgesplat render builtin:sphere:24 -o 'my sphere.png' --size 48x32")));
    EXPECT_THAT(picture.metadata, Contains(Pair("edgesplat:volume", HasSubstr("builtin:sphere"))));
    EXPECT_THAT(picture.metadata, Contains(Pair("Software", HasSubstr("edgesplat 0."))));
    EXPECT_THAT(picture.metadata, Contains(Pair("edgesplat:checksum", ::testing::SizeIs(16))));
    EXPECT_GT(picture.image.at(24, 16, 0), 0.3F) << "the sphere is in the middle";
    EXPECT_EQ(picture.image.at(0, 0, 0), 0.0F) << "the background is around it";
}

TEST_F(CliRender, ExrContainsExtraOutputs) {
    render("builtin:sphere:24 -o a.exr --size 32x32 --aov tau,depth,normal,distance");
    EXPECT_THAT(files(), ElementsAre("a.exr"));
    EXPECT_THAT(read_image(folder_ / "a.exr").channel_names,
                IsSupersetOf({"R", "G", "B", "A", "tau", "depth.Z", "normal.X", "normal.Y", "normal.Z", "distance"}));
}

TEST_F(CliRender, PngWritesExtraOutputsBesideIt) {
    render("builtin:sphere:24 -o a.png --size 32x32 --aov tau,normal");
    EXPECT_THAT(files(), ElementsAre("a.normal.exr", "a.png", "a.tau.exr"));
    EXPECT_THAT(read_image(folder_ / "a.normal.exr").channel_names, ElementsAre("normal.X", "normal.Y", "normal.Z"));
}

/// Expects the red channel of `part` in `whole` from column `at` on.
void expect_within(const Image& whole, int at, const Image& part) {
    for (int y = 0; y < part.height; ++y)
        for (int x = 0; x < part.width; ++x)
            ASSERT_EQ(whole.at(at + x, y, 0), part.at(x, y, 0)) << x << ',' << y;
}

TEST_F(CliRender, CompareJoinsTwoPicturesWithDivider) {
    render("builtin:sphere:24 -o both.exr --size 40x32 --compare plain --json both.json");
    render("builtin:sphere:24 -o plain.exr --size 40x32 --edges off");
    render("builtin:sphere:24 -o edges.exr --size 40x32");
    const Image both = read_image(folder_ / "both.exr").image;
    const Image plain = read_image(folder_ / "plain.exr").image;
    const Image edges = read_image(folder_ / "edges.exr").image;
    ASSERT_EQ(both.width, 82);
    expect_within(both, 0, plain);
    expect_within(both, 42, edges);
    EXPECT_NE(plain.pixels, edges.pixels);
    const auto statistics = nlohmann::json::parse(text_of(folder_ / "both.json"));
    ASSERT_EQ(statistics["frames"].size(), 2U);
    EXPECT_EQ(statistics["frames"][0]["name"], "plain");
    EXPECT_EQ(statistics["frames"][1]["settings"]["edges"], "cubic");
}

TEST_F(CliRender, CompareJoinsAllNamedPictures) {
    render("builtin:sphere:24 -o all.exr --size 40x32 --compare plain,raycast --raycast-filter cubic --json all.json");
    render("builtin:sphere:24 -o rays.exr --size 40x32 --renderer raycast --raycast-filter cubic");
    render("builtin:sphere:24 -o edges.exr --size 40x32");
    const Image all = read_image(folder_ / "all.exr").image;
    const Image rays = read_image(folder_ / "rays.exr").image;
    const Image edges = read_image(folder_ / "edges.exr").image;
    ASSERT_EQ(all.width, 124);
    expect_within(all, 42, rays);
    expect_within(all, 84, edges);
    const auto statistics = nlohmann::json::parse(text_of(folder_ / "all.json"));
    ASSERT_EQ(statistics["frames"].size(), 3U);
    EXPECT_EQ(statistics["frames"][1]["name"], "raycast");
}

TEST_F(CliRender, StatisticsAreComplete) {
    render("builtin:sphere:24 -o a.png --size 32x32 --json a.json --validation");
    const auto s = nlohmann::json::parse(text_of(folder_ / "a.json"));
    for (const char* key : {"version", "command", "volume", "scene", "camera", "device", "frames", "peak_host_bytes"})
        EXPECT_TRUE(s.contains(key)) << key;
    for (const char* key : {"name", "type", "driver", "driver_version", "api_version"})
        EXPECT_FALSE(s["device"][key].get<std::string>().empty()) << key;
    const auto& frame = s["frames"][0];
    EXPECT_EQ(frame["voxels"], 24 * 24 * 24);
    EXPECT_GT(frame["splats_drawn"], 0);
    EXPECT_GT(frame["sheets"], 0);
    EXPECT_GT(frame["device_bytes"], 0);
    EXPECT_EQ(frame["validation_messages"], 0);
    EXPECT_TRUE(frame["passes_ms"].contains("5_draw_surfaces")) << frame["passes_ms"].dump();
}

TEST_F(CliRender, KeepsSplatsForTheNextRun) {
    const std::string arguments = "builtin:torus:32 --size 32x32 --keep-splats -q ";
    const auto draw = [&](const std::string& view, const std::string& name) {
        const ProgramRun run = run_shell("EDGESPLAT_CACHE=kept '" EDGESPLAT_PROGRAM "' render " + arguments +
                                         "--view " + view + " -o " + name + ".exr --json " + name + ".json");
        EXPECT_EQ(run.status, 0) << run.err;
        return nlohmann::json::parse(text_of(folder_ / (name + ".json")))["frames"][0]["splats_read"].get<bool>();
    };
    EXPECT_FALSE(draw("front", "a"));
    EXPECT_TRUE(draw("front", "b"));
    EXPECT_TRUE(draw("oblique", "c"));
    EXPECT_EQ(run("compare a.exr b.exr").status, 0);
    EXPECT_NE(run("compare a.exr c.exr").status, 0);
}

TEST_F(CliRender, VoxelCoordinatesAndWorldCoordinatesAgree) {
    // The default grid of builtin:sphere starts at 0,0,0 with a spacing of 1 mm, so index and world coordinates are
    // equal.
    render("builtin:sphere -o a.exr --size 24x24 --eye 32,-30,32 --direction 0,1,0.05 --fov 40");
    render("builtin:sphere -o b.exr --size 24x24 --eye 32,-30,32 --direction 0,1,0.05 --fov 40 --voxel");
    EXPECT_EQ(read_image(folder_ / "a.exr").image.pixels, read_image(folder_ / "b.exr").image.pixels);
}

}  // namespace
}  // namespace edgesplat
