// `edgesplat bench` end to end: a tiny suite, its files and their keys, comparison of two runs. No test asserts a time.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using nlohmann::ordered_json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class CliBench : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        std::ofstream(folder_ / "tiny.toml") << R"(
[[modes]]
name = "default"
[[modes]]
name = "plain"
quality = { edges = "off" }
[[cases]]
name = "ball-16"
series = "ball"
sizes = [[64, 64]]
scene = { volume = { path = "builtin:sphere:16" }, camera = { view = "close" } }
[[cases]]
name = "ball-24"
series = "ball"
sizes = [[64, 64]]
modes = ["plain"]
camera = "far"
scene = { volume = { path = "builtin:sphere:24" } }
[[cases]]
name = "gone"
modes = ["plain"]
scene = { iso_values = [3], volume = { path = "gone.nrrd" } }
)";
    }

    ordered_json json(const std::string& folder) const {
        return ordered_json::parse(text_of(folder_ / folder / "bench.json"));
    }
};

TEST_F(CliBench, WritesEveryKeyAndComparesRuns) {
    const ProgramRun first = run("bench tiny.toml --repeat 1 -o one");
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_THAT(first.out, HasSubstr("skipped gone/plain/512x512: gone.nrrd: no such file"));
    EXPECT_THAT(first.out, HasSubstr("5_draw_tiles"));
    EXPECT_THAT(first.out, HasSubstr("frame_ms_of_splats_drawn"));
    const ordered_json one = json("one");
    for (const char* key : {"schema", "program", "command", "suite", "device", "cores", "ratio_clock", "rounds",
                            "seconds", "host_peak_bytes", "cases", "scaling", "skipped"})
        EXPECT_TRUE(one.contains(key)) << key;
    EXPECT_EQ(one["schema"], "edgesplat bench 1");
    EXPECT_EQ(one["rounds"], 1);
    ASSERT_EQ(one["cases"].size(), 3U);
    EXPECT_EQ(one["scaling"].size(), 2U) << "only the mode plain has two sizes of volume";
    for (const ordered_json& entry : one["cases"]) {
        for (const char* key :
             {"name",         "group",       "mode",         "series",    "volume",           "checksum",
              "dims",         "voxels",      "size",         "frame_ms",  "processor_ms",     "raycast_ms",
              "ratio",        "wall_ratio",  "passes_ms",    "setup_ms",  "setup_passes_ms",  "setup_ns_per_voxel",
              "cold",         "splats",      "vertices",     "fragments", "shaded_fragments", "sheets",
              "sheet_groups", "dirty_share", "device_bytes", "memory",    "host_peak_bytes",  "submissions"})
            EXPECT_TRUE(entry.contains(key) && !entry[key].is_null()) << key;
        const char* draws = entry["mode"] == "plain" ? "5_draw_tiles" : "5_draw_surfaces";
        for (const char* pass : {"3_select_footprints", "4_sort_sheets", "4_sort_tiles", draws})
            EXPECT_TRUE(entry["passes_ms"].contains(pass)) << pass;
        EXPECT_TRUE(entry["setup_passes_ms"].contains("2_collect_splats"));
        EXPECT_GT(entry["ratio"]["median"], 0);
        EXPECT_GT(entry["splats"]["drawn"], 0);
        EXPECT_GT(entry["cold"]["pipelines"], 0);
        EXPECT_GT(entry["dirty_share"], 0);
    }
    EXPECT_THAT(text_of(folder_ / "one" / "ratio.svg"), HasSubstr("<svg"));
    EXPECT_THAT(text_of(folder_ / "one" / "frame_scaling.svg"), HasSubstr("<svg"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "one" / "bench.csv"));

    const ProgramRun second = run("bench tiny.toml --cases 'ball-24' --repeat 1 -o two --compare one/bench.json");
    ASSERT_EQ(second.status, 0) << second.err;
    EXPECT_THAT(second.out, HasSubstr("geometric mean"));
    EXPECT_THAT(second.out, HasSubstr("ball-16/plain/64x64: only in the earlier run"));
    // Counts are equal in every run.
    for (const char* key : {"splats", "vertices", "fragments", "shaded_fragments", "sheets", "dirty_share", "memory"})
        EXPECT_EQ(json("two")["cases"][0][key], one["cases"][2][key]) << key;
    const ProgramRun compared = run("bench --compare one/bench.json --with two/bench.json");
    EXPECT_EQ(compared.status, 0) << compared.err;
    EXPECT_THAT(compared.out, HasSubstr("new / old"));
}

TEST_F(CliBench, ListsItsCases) {
    const ProgramRun listed = run("bench tiny.toml --list --cases 'ball-16'");
    EXPECT_EQ(listed.status, 0) << listed.err;
    EXPECT_EQ(listed.out, "ball-16/default/64x64\nball-16/plain/64x64\n");
}

TEST_F(CliBench, MeasuresAVolume) {
    const ProgramRun measured = run("bench builtin:shell:24 --size 48x32 --iso 0.4 --budget 1 -o one");
    ASSERT_EQ(measured.status, 0) << measured.err;
    EXPECT_THAT(measured.out, StartsWith("builtin:shell:24, 24 x 24 x 24 voxels: 6 pictures, about 1 s\n"));
    EXPECT_THAT(measured.out,
                HasSubstr("\nview    edgesplat ms  plain ms  ray caster ms  first picture ms  memory MiB"));
    EXPECT_THAT(measured.out, HasSubstr("\ninside: from the cavity at voxel "));
    const ordered_json one = json("one");
    std::vector<std::string> names;
    for (const ordered_json& entry : one["cases"])
        names.push_back(entry["name"]);
    EXPECT_THAT(names, ElementsAre("far/default/48x32", "far/plain/48x32", "near/default/48x32", "near/plain/48x32",
                                   "inside/default/48x32", "inside/plain/48x32"));
    EXPECT_EQ(one["suite"]["name"], "builtin:shell:24");
    EXPECT_NE(one["cases"][0]["splats"]["edge"], 0);
    EXPECT_EQ(one["cases"][1]["splats"]["edge"], 0) << "plain splatting has no edges";
}

TEST_F(CliBench, RefusesInvalidRequestsBeforeMeasuring) {
    EXPECT_THAT(run("bench tiny.toml --iso 3").err, HasSubstr("`bench VOLUME`; tiny.toml is a suite"));
    EXPECT_THAT(run("bench none.nrrd").err, HasSubstr("'none.nrrd' is neither a suite"));
    EXPECT_THAT(run("bench tiny.toml -o no/such").err, HasSubstr("does not exist"));
    EXPECT_THAT(run("bench tiny.toml --compare tiny.toml").err, HasSubstr("is not a bench.json of this version"));
    EXPECT_THAT(run("bench standart").err, HasSubstr("did you mean standard?"));
    EXPECT_THAT(run("bench tiny.toml --cases cube").err, HasSubstr("no case matches 'cube'"));
    EXPECT_THAT(files(), ElementsAre("tiny.toml"));
}

TEST_F(CliBench, CtrlCLeavesNoFile) {
    const auto start = std::chrono::steady_clock::now();
    const auto two_seconds_on = [&] { return std::chrono::steady_clock::now() - start >= std::chrono::seconds(2); };
    EXPECT_EQ(interrupted("bench tiny.toml --budget 600 -q -o out", two_seconds_on), 130);
    EXPECT_THAT(files(), ElementsAre("tiny.toml"));
}

}  // namespace
}  // namespace edgesplat
