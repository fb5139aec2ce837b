// Tests --explain, --memory-budget and `edgesplat effects` end to end.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include <cstdint>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CliExplain : public CliTest {};

TEST_F(CliExplain, PlansOnlyWithoutOutput) {
    const ProgramRun plan = run("render builtin:sphere:24 --size 40x30 --explain");
    ASSERT_EQ(plan.status, 0) << plan.err;
    for (const char* text : {"5_draw_surfaces", "edge field", "light: lights[0] is a headlight", "peak",
                             "splat record, 20 bytes", "left out", "sliced sheets", "--sheets sliced"})
        EXPECT_THAT(plan.out, HasSubstr(text));
    EXPECT_THAT(plan.out, Not(HasSubstr(" ms ")));
    for (const char* text : {" REFINED=1", " GROUP=16", " ISO_COUNT=1"})
        EXPECT_THAT(plan.out, HasSubstr(text)) << "every constant has its name";
    EXPECT_THAT(plan.out, Not(HasSubstr("?=")));
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
}

TEST_F(CliExplain, MeasuresWithOutput) {
    const ProgramRun done = run("render builtin:sphere:24 --size 40x30 --explain -o a.png --json a.json -q");
    ASSERT_EQ(done.status, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr(" ms "));
    const auto json = nlohmann::json::parse(text_of(folder_ / "a.json"));
    const auto& plan = json["plan"];
    std::uint64_t sum = 0;
    for (const auto& resource : plan["resources"]) {
        EXPECT_EQ(resource["device_bytes"], resource["allocated_bytes"]) << resource["name"];
        if (resource["held"] == "always" || resource["held"] == "while drawing")
            sum += resource["allocated_bytes"].get<std::uint64_t>();
    }
    EXPECT_EQ(sum, json["frames"][0]["device_bytes"].get<std::uint64_t>());
    EXPECT_EQ(plan["passes"].size(), json["frames"][0]["passes_ms"].size());
    EXPECT_TRUE(plan["effects"].contains("light"));
}

TEST_F(CliExplain, NamesDeviceProfile) {
    const ProgramRun forced =
        run("render builtin:sphere:16 --size 40x30 --explain -o a.png --json a.json -q --device-profile generic");
    ASSERT_EQ(forced.status, 0) << forced.err;
    EXPECT_THAT(forced.out, HasSubstr("device profile generic: set by --device-profile"));
    EXPECT_THAT(forced.out, HasSubstr(" GROUP=32"));
    EXPECT_EQ(nlohmann::json::parse(text_of(folder_ / "a.json"))["plan"]["device_profile"], "generic");
    const ProgramRun discrete = run("render builtin:sphere:16 --size 40x30 --explain --device-profile discrete");
    EXPECT_THAT(discrete.out, HasSubstr("device profile discrete does not use it")) << "its pixels are not refined";
    EXPECT_THAT(discrete.out, Not(HasSubstr("refined pixels: ")));
    const ProgramRun wrong = run("render builtin:sphere:16 -o a.png --device-profile fast");
    EXPECT_EQ(wrong.status, 1);
    EXPECT_THAT(wrong.err, HasSubstr("device profile `fast`: expected lavapipe, generic or discrete"));
}

TEST_F(CliExplain, NamesTheShareOfEachVolume) {
    const ProgramRun done =
        run("render builtin:sphere:32 builtin:torus:16 --size 40x30 --explain -o a.png --json a.json -q");
    ASSERT_EQ(done.status, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("of it builtin:torus"));
    const auto plan = nlohmann::json::parse(text_of(folder_ / "a.json"))["plan"];
    const auto& volumes = plan["volumes"];
    ASSERT_EQ(volumes.size(), 2U);
    EXPECT_EQ(volumes[0]["name"], "builtin:sphere");
    std::uint64_t of_volumes = 0, fields = 0, all = 0;
    for (const auto& volume : volumes)
        of_volumes += volume["bytes"].get<std::uint64_t>();
    for (const auto& resource : plan["resources"]) {
        const auto bytes = resource["bytes"].get<std::uint64_t>();
        all += bytes;
        for (const char* name : {"volume", "B-spline coefficients", "edge field", "splat list"})
            if (resource["name"] == name) fields += bytes;
    }
    EXPECT_GT(of_volumes, fields);
    EXPECT_LT(of_volumes, all);
    EXPECT_GT(volumes[0]["bytes"].get<std::uint64_t>(), 6 * volumes[1]["bytes"].get<std::uint64_t>());
    const ProgramRun refused =
        run("render builtin:sphere:32 builtin:torus:16 --size 400x300 --memory-budget 4 -o b.png");
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("MiB of it for builtin:torus"));
    EXPECT_THAT(run("render builtin:sphere:32 --explain").out, Not(HasSubstr("of it")));
}

TEST_F(CliExplain, RequiresOutputOrExplain) {
    const ProgramRun wrong = run("render builtin:sphere:24");
    EXPECT_EQ(wrong.status, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--output"));
}

TEST_F(CliExplain, OffersFittingSizeBeyondMemoryBudget) {
    const ProgramRun refused = run("render builtin:sphere:24 --size 400x300 --memory-budget 4 -o a.png --json a.json");
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("4.00 MiB are available (the memory budget)"));
    EXPECT_THAT(refused.err, HasSubstr("tile entries"));
    EXPECT_TRUE(std::filesystem::is_empty(folder_));
    const auto at = refused.err.find("--size ");
    ASSERT_NE(at, std::string::npos) << refused.err;
    const std::string offer = refused.err.substr(at, refused.err.find('\n', at) - at);
    const ProgramRun fits = run("render builtin:sphere:24 --memory-budget 4 -o a.png -q " + offer);
    EXPECT_EQ(fits.status, 0) << offer << ": " << fits.err;
}

TEST_F(CliExplain, MeasuresEffects) {
    const ProgramRun done =
        run("effects builtin:sphere:20 --size 24x24 --repeats 1 --only light,fog,'sliced sheets' --markdown -q");
    ASSERT_EQ(done.status, 0) << done.err;
    EXPECT_THAT(done.out, HasSubstr("| effect"));
    EXPECT_THAT(done.out, HasSubstr("| light "));
    EXPECT_THAT(done.out, HasSubstr("| fog "));
    EXPECT_THAT(done.out, HasSubstr("medians of 1"));
    const ProgramRun unknown = run("effects builtin:sphere:20 --only bloom");
    EXPECT_EQ(unknown.status, 1);
    EXPECT_THAT(unknown.err, HasSubstr("unknown effect 'bloom'"));
}

}  // namespace
}  // namespace edgesplat
