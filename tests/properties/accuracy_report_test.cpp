// A whole accuracy report on a tiny scene: interrupted by Ctrl-C, resumed, and repeated. All errors must be the same.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using nlohmann::ordered_json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kArguments =
    "builtin:sphere:24 --size 48x48 --repeats 1 --orbit 1 --tolerance 1e-3 --knobs sheets,sheet-spacing --cameras "
    "far -q";

class AccuracyReport : public CliTest {
  protected:
    ProgramRun report(const std::string& folder, const std::string& more = "") const {
        return run("accuracy " + std::string(kArguments) + " --report " + folder + " " + more);
    }

    std::string journal(const std::string& folder) const { return text_of(folder_ / folder / "journal.jsonl"); }

    /// Starts the report, waits for a few finished measurements, and presses Ctrl-C. Returns the exit status.
    int interrupted(const std::string& folder) const {
        return CliTest::interrupted("accuracy " + std::string(kArguments) + " --report " + folder, [&] {
            const std::string lines = journal(folder);
            return std::count(lines.begin(), lines.end(), '\n') >= 4;
        });
    }

    /// The report without the parts that may differ between two runs.
    ordered_json errors_of(const std::string& folder) const {
        ordered_json json = ordered_json::parse(text_of(folder_ / folder / "report.json"));
        json.erase("command");
        json.erase("raycast_ms");
        json.erase("front");
        for (ordered_json& row : json["rows"]) {
            row.erase("time");
            row.erase("on_front");
            for (ordered_json& camera : row["cameras"])
                camera.erase("time");
        }
        return json;
    }
};

TEST_F(AccuracyReport, ResumesAfterCtrlCWithExactlyTheSameErrors) {
    EXPECT_EQ(interrupted("r"), 130);
    const std::string before = journal("r");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r" / "report.json"));

    const ProgramRun resumed = report("r");
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_THAT(journal("r"), StartsWith(before)) << "a finished measurement was repeated";
    for (const char* file : {"index.html", "report.json", "steps.csv"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / "r" / file)) << file;

    const ProgramRun other = report("r", "--edges march");
    EXPECT_EQ(other.status, 1);
    EXPECT_THAT(other.err, HasSubstr("--restart"));

    ASSERT_EQ(report("again").status, 0);
    EXPECT_EQ(ordered_json::diff(errors_of("r"), errors_of("again")), ordered_json::array());

    const ordered_json json = errors_of("r");
    for (const char* key : {"schema", "program", "truth", "volume", "device", "options", "largest_reference_error",
                            "surface", "cameras", "rows", "notes"})
        EXPECT_TRUE(json.contains(key)) << key;
    for (const char* key : {"kind", "name", "knob", "step", "raycast_filter", "settings", "truth_error", "method_error",
                            "edges_voxels", "popping", "device_bytes", "cameras"})
        EXPECT_TRUE(json["rows"][0].contains(key)) << key;
    EXPECT_THAT(text_of(folder_ / "r" / "steps.csv"),
                StartsWith("kind,name,knob,step,on_front,truth_psnr_db,truth_rms,truth_max,method_rms,method_max,"));
    const auto row = [&](const std::string& kind, const std::string& name) -> const ordered_json& {
        const auto found = std::ranges::find_if(
            json["rows"], [&](const ordered_json& r) { return r["kind"] == kind && r["name"] == name; });
        EXPECT_NE(found, json["rows"].end()) << kind << " " << name;
        return *found;
    };
    const auto decibels = [&](const ordered_json& r) { return r["truth_error"]["psnr_db"].get<double>(); };
    EXPECT_EQ(json["truth"], "exact scene");
    for (const char* rays : {"trilinear rays", "cubic rays"})
        EXPECT_GT(decibels(row("rays", rays)), decibels(row("plain", "plain splatting"))) << rays;
    EXPECT_TRUE(row("rays", "cubic rays")["edges_voxels"].is_null()) << "rays have no kernels";
    const std::string page = text_of(folder_ / "r" / "index.html");
    EXPECT_THAT(page, HasSubstr("<svg"));
    EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
    for (const char* outside : {"src=\"http", "href=\"http", "url(", "<script", "@import"})
        EXPECT_THAT(page, ::testing::Not(HasSubstr(outside))) << "the page must be self-contained";
}

TEST_F(AccuracyReport, QuickMeasuresLessAndSaysFirstHowLong) {
    const ProgramRun quick = run("accuracy builtin:sphere:16 --quick --size 24x24 --report q");
    ASSERT_EQ(quick.status, 0) << quick.err;
    EXPECT_THAT(quick.out, ::testing::MatchesRegex("[0-9]+ measurements, about [0-9]+ s\n.*"));
    EXPECT_TRUE(std::filesystem::exists(folder_ / "q" / "index.html"));
    const ordered_json json = errors_of("q");
    EXPECT_EQ(json["options"]["width"], 24) << "a given option counts";
    EXPECT_EQ(json["options"]["repeats"], 1);
    EXPECT_EQ(json["options"]["orbit_frames"], 0);
    EXPECT_EQ(json["cameras"].size(), 1U);
    for (const ordered_json& row : json["rows"])
        EXPECT_TRUE(row["kind"] != "step" || row["knob"] == "edges") << row["name"];
}

}  // namespace
}  // namespace edgesplat
