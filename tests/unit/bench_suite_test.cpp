// Benchmark suites: parsing and error messages.
#include <gmock/gmock.h>

#include <algorithm>

#include "engine/bench/embedded_suites.h"
#include "engine/bench/suite.h"
#include "tests/unit/refusal.h"

namespace edgesplat::bench {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kSuite = R"(
about = "two cases"
budget = 7
[[modes]]
name = "default"
[[modes]]
name = "plain"
quality = { edges = "off", sheet_spacing = 0.5 }
[[cases]]
name = "ball"
series = "sizes"
sizes = [[64, 48], [32, 32]]
scene = { volume = { path = "builtin:sphere:16" }, camera = { view = "close" } }
[[cases]]
name = "gone"
modes = ["plain"]
camera = "inside"
[cases.scene]
iso_values = [3]
volume = { path = "no_such_folder/volume.nrrd" }
)";

std::string refusal_of(const std::string& text) {
    return refusal([&] { (void)parse_suite(text, "s.toml", {}); });
}

/// A suite of one case that ends with `line`.
std::string with(const std::string& line) {
    return "[[cases]]\nname = \"a\"\nscene = { volume = { path = \"builtin:sphere:16\" } }\n" + line + "\n";
}

TEST(BenchSuite, MakesCaseForEachModeAndSize) {
    const Suite suite = parse_suite(kSuite, "folder/tiny.toml", {""});
    EXPECT_EQ(suite.name, "tiny");
    EXPECT_EQ(suite.about, "two cases");
    EXPECT_EQ(suite.budget, 7);
    ASSERT_EQ(suite.cases.size(), 4U);
    EXPECT_EQ(suite.cases[0].name, "ball/default/64x48");
    EXPECT_EQ(suite.cases[1].name, "ball/default/32x32");
    EXPECT_EQ(suite.cases[3].name, "ball/plain/32x32");
    EXPECT_EQ(suite.cases[0].document.output.size, glm::ivec2(64, 48));
    EXPECT_EQ(suite.cases[0].document.camera.view, "close");
    EXPECT_EQ(suite.cases[0].series, "sizes");
    EXPECT_EQ(suite.cases[0].document.quality.settings, Settings{});
    EXPECT_EQ(suite.cases[3].document.quality.settings.edges, EdgeEstimator::Off);
    EXPECT_EQ(suite.cases[3].document.quality.settings.sheet_spacing, 0.5);
}

TEST(BenchSuite, SkipsMissingVolumesWithReason) {
    const Suite suite = parse_suite(kSuite, "s.toml", {""});
    ASSERT_EQ(suite.skipped.size(), 1U);
    EXPECT_EQ(suite.skipped[0].name, "gone/plain/512x512");
    EXPECT_THAT(suite.skipped[0].reason, AllOf(HasSubstr("no_such_folder/volume.nrrd"), HasSubstr("no such file")));
}

TEST(BenchSuite, SelectsCasesByNameOrGroup) {
    const auto kept = [](const std::string& glob) {
        Suite suite = parse_suite(kSuite, "s.toml", {""});
        keep_cases(suite, glob);
        return suite.cases.size() + 10 * suite.skipped.size();
    };
    EXPECT_EQ(kept("ball"), 4U);
    EXPECT_EQ(kept("*/plain/*"), 12U);
    EXPECT_EQ(kept("*32x32"), 2U);
    EXPECT_THAT(refusal([&] { (void)kept("cube"); }), AllOf(HasSubstr("'cube'"), HasSubstr("ball/default/64x48")));
}

TEST(BenchSuite, ProblemsNameFileLineKeyValueAndExpectation) {
    const std::pair<std::string, std::string> wrong[] = {
        {"= 3", "s.toml:1: no valid TOML"},
        {"about = \"x\"", "s.toml:1: cases: is missing; expected tables begun by [[cases]]"},
        {"budgt = 3\n" + with(""), "s.toml:1: budgt: unknown key; did you mean budget?"},
        {"budget = -3\n" + with(""), "s.toml:1: budget: -3: expected a number of seconds above 0, at most 1000000"},
        {"cases = 3", "s.toml:1: cases: 3: expected a list of tables, each begun by [[cases]]"},
        {with("colour = 3"),
         "s.toml:4: cases[0].colour: unknown key; expected name, about, camera, series, sizes, modes, scene"},
        {with("sizes = [[64]]"),
         "s.toml:4: cases[0].sizes: [ [ 64 ] ]: expected a list of [width, height], each 1 to 16384 pixels"},
        {with("sizes = [[0, 64]]"), "s.toml:4: cases[0].sizes: [ [ 0, 64 ] ]: expected"},
        {with("modes = [\"fast\"]"), "s.toml:4: cases[0].modes[0]: 'fast': expected one of default"},
        {with("camera = \"above\""),
         "s.toml:4: cases[0].camera: \"above\": expected one of far, near, grazing, inside; use "
         "scene.camera for other cameras"},
        {with("series = \"a b\""), "s.toml:4: cases[0].series: \"a b\": expected letters, digits and - _ . :"},
        {with("") + with(""), "s.toml:6: cases[1].name: \"a\": an earlier case has this name"},
        {"[[cases]]\nname = \"a\"", "s.toml:1: cases[0].scene: expected a table with the keys of a scene file"},
        {"[[cases]]\nscene = { volume = { path = \"builtin:sphere\" } }",
         "s.toml:1: cases[0].name: is missing; expected a name"},
        {"[[cases]]\nname = \"a\"\nscene = {}", "s.toml:1: cases[0].scene.volume.path: is missing"},
        {"[[cases]]\nname = \"a\"\n[cases.scene]\nvolume = { path = \"builtin:sphre\" }",
         "s.toml:4: cases[0].scene.volume.path: \"builtin:sphre\": no builtin volume has this name"},
        {"[[cases]]\nname = \"a\"\n[cases.scene]\nvolume = { path = \"builtin:sphere\" }\ncamera = { fov = 200 }",
         "s.toml:5: cases[0].scene.camera.fov: 200.0: expected a number above 0"},
        {"[[cases]]\nname = \"a\"\n[cases.scene]\nvolume = { path = \"builtin:sphere\" }\noutput = { size = [3, 3] }",
         "cases[0].scene.output: is not for suites; use cases[0].sizes for sizes"},
        {"[[modes]]\nname = \"m\"\nquality = { edgs = \"off\" }\n" + with(""),
         "modes[0].quality.edgs: unknown key; did you mean quality.edges?"},
        {"[[modes]]\nname = \"m\"\nquality = { edges = \"none\" }\n" + with(""), "modes[0].quality.edges: "},
    };
    for (const auto& [text, message] : wrong)
        EXPECT_THAT(refusal_of(text), HasSubstr(message)) << text;
}

TEST(BenchSuite, ReportsEveryProblemOnce) {
    const std::string text = with("sizes = 3\nseries = 4\nmodes = []");
    const std::string said = refusal_of("[[modes]]\nname = \"a\"\n[[modes]]\nname = \"b\"\n" + text);
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 2) << said;
}

TEST(BenchSuite, ReadsEveryEmbeddedSuite) {
    std::vector<std::string> names;
    for (const EmbeddedSuite& suite : embedded_suites()) {
        const std::optional<Suite> read = find_suite(std::string(suite.name));
        ASSERT_TRUE(read) << suite.name;
        EXPECT_FALSE(read->cases.empty()) << suite.name;
        names.emplace_back(suite.name);
    }
    EXPECT_THAT(names, ::testing::UnorderedElementsAre("standard", "scaling", "full"));
    EXPECT_THAT(refusal([] { (void)find_suite("standart"); }), HasSubstr("did you mean standard?"));
    EXPECT_THAT(
        refusal([] { (void)find_suite("head.nrrd"); }),
        AllOf(HasSubstr("'head.nrrd' is neither a suite (full, scaling, standard or a file .toml) nor a volume"),
              HasSubstr("no such file or folder")));
    EXPECT_THAT(refusal([] { (void)find_suite("none.toml"); }), HasSubstr("none.toml: no such file"));
}

}  // namespace
}  // namespace edgesplat::bench
