// Labels on the command line: listed, chosen, named, measured and drawn by their own numbers.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/image/image_file.h"
#include "engine/scene/scene_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CliLabels : public CliTest {
  protected:
    void SetUp() override {
        CliTest::SetUp();
        // Three boxes of 4 x 6 x 6 voxels of 2 mm beside each other, with the ids of an atlas.
        std::ofstream file(folder_ / "atlas.nrrd", std::ios::binary);
        file << "NRRD0004\ntype: int64\ndimension: 3\nsizes: 18 12 12\nspace: left-posterior-superior\n"
                "space directions: (2,0,0) (0,2,0) (0,0,2)\nspace origin: (-17,-11,-11)\nendian: little\n"
                "encoding: raw\n\n";
        for (int z = 0; z < 12; ++z)
            for (int y = 0; y < 12; ++y)
                for (int x = 0; x < 18; ++x) {
                    const bool in = x > 2 && x < 15 && y > 2 && y < 9 && z > 2 && z < 9;
                    const std::int64_t id = !in ? 0 : x < 7 ? 997 : x < 11 ? 312782546 : 9007199254740993;
                    file.write(reinterpret_cast<const char*>(&id), sizeof id);
                }
        std::ofstream(folder_ / "names.csv") << "id,name,color_hex_triplet\n997,root,00ff00\n"
                                                "312782546,\"visual area, layer 1\",ff0000\n";
    }

    json measured(const std::string& options, const std::string& file = "atlas.nrrd") const {
        const ProgramRun ran = run(fmt::format("measure -q {} --json - {}", file, options));
        EXPECT_EQ(ran.status, 0) << ran.err;
        json all = ran.status == 0 ? json::parse(ran.out) : json();
        if (all.is_object()) all.erase("volume");
        return all;
    }

    void refuses(const std::string& arguments, const std::string& text) const {
        const ProgramRun ran = run(arguments);
        EXPECT_NE(ran.status, 0);
        EXPECT_THAT(ran.err, HasSubstr(text));
    }
};

TEST_F(CliLabels, AreListedAndMeasuredByTheirOwnNumbers) {
    const ProgramRun info = run("info atlas.nrrd --label-names names.csv --json -");
    ASSERT_EQ(info.status, 0) << info.err;
    const json labels = json::parse(info.out)["labels"];
    ASSERT_EQ(labels.size(), 4U);
    EXPECT_EQ(labels[3]["label"].get<std::int64_t>(), 9007199254740993);
    EXPECT_EQ(labels[2]["name"], "visual area, layer 1");
    EXPECT_EQ(labels[2]["voxels"], 144);
    EXPECT_THAT(info.out, HasSubstr("9007199254740993"));
    const json all = measured("");
    ASSERT_EQ(all["labels"].size(), 3U);
    for (const json& label : all["labels"])
        EXPECT_EQ(label["volume_mm3"]["value"], 1152);
    EXPECT_THAT(run("measure -q atlas.nrrd --label-names names.csv").out,
                HasSubstr("label 312782546 visual area, layer 1: 1152"));
}

TEST_F(CliLabels, AreChosenByNumberAndName) {
    EXPECT_EQ(measured("--only 9007199254740993")["labels"].size(), 1U);
    EXPECT_EQ(measured("--hide 997,312782546")["labels"][0]["label"].get<std::int64_t>(), 9007199254740993);
    const json named = measured("--label-names names.csv --only 'Visual*' --only root");
    EXPECT_EQ(named["labels"].size(), 2U);
    EXPECT_EQ(measured("--label-names names.csv --only 'visual area, layer 1'")["labels"].size(), 1U);
    refuses("measure -q atlas.nrrd --only 998", "has no label '998'");
    refuses("measure -q atlas.nrrd --label-names names.csv --only rot", "did you mean 'root'?");
    refuses("measure -q atlas.nrrd --only 997 --iso 5", "expected one of them");
    refuses("render builtin:sphere -o a.png --size 16x16 --only 1", "only (--only): expected a segmentation");
    refuses("measure -q atlas.nrrd --label-names missing.txt", "missing.txt: no such file");
}

TEST_F(CliLabels, AreCutByClipPlanesAndFoundAtPlaces) {
    const json half = measured("--clip-plane=0,0,0,0,-1,0");
    ASSERT_EQ(half["labels"].size(), 3U);
    for (const json& label : half["labels"])
        EXPECT_NEAR(label["volume_mm3"]["value"].get<double>(), 576, 1e-9);
    const json place = measured("--label-names names.csv --at 0,0,6");
    EXPECT_EQ(place["places"][0]["name"], "visual area, layer 1");
    EXPECT_NEAR(place["places"][0]["world_mm"][2].get<double>(), 6, 0.3);
}

TEST_F(CliLabels, IsoValuesAreTheFilesNumbers) {
    const json surface = measured("--labels on --iso 500");
    EXPECT_EQ(surface["materials"][1]["from"], 500);
    refuses("measure -q atlas.nrrd --iso -3", "the values of atlas.nrrd lie between 0 and ");
}

TEST_F(CliLabels, AreTheSameInAPackedVolume) {
    const ProgramRun pack = run("pack atlas.nrrd -o atlas.esv");
    ASSERT_EQ(pack.status, 0) << pack.err;
    const json packed = json::parse(run("info atlas.esv --label-names names.csv --json -").out);
    const json file = json::parse(run("info atlas.nrrd --label-names names.csv --json -").out);
    for (const char* key : {"labels", "range", "mean", "checksum", "geometry_source", "length_unit", "in_patient",
                            "notes", "warnings", "histogram"})
        EXPECT_EQ(packed[key], file[key]) << key;
    EXPECT_EQ(packed["packed"]["levels"].size(), 1U);
    EXPECT_THAT(run("info atlas.esv").out, HasSubstr("312782546"));
    for (const char* options : {"", "--only 997", "--label-names names.csv --only root"}) {
        EXPECT_EQ(measured(options, "atlas.esv"), measured(options)) << options;
        const std::string picture = fmt::format(" --size 48x32 -q {}", options);
        ASSERT_EQ(run("render atlas.nrrd -o a.png" + picture).status, 0);
        const ProgramRun drawn = run("render atlas.esv -o b.png" + picture);
        ASSERT_EQ(drawn.status, 0) << drawn.err;
        EXPECT_EQ(run("compare a.png b.png --max-diff 0").status, 0) << options;
    }
    EXPECT_EQ(measured("--iso 500", "atlas.esv"), measured("--iso 500"));
    refuses("measure -q atlas.esv --only 998", "has no label '998'");
}

TEST_F(CliLabels, ChecksumsDifferByTheNumbers) {
    std::string content;
    std::ifstream in(folder_ / "atlas.nrrd", std::ios::binary);
    content.assign(std::istreambuf_iterator<char>(in), {});
    const std::int64_t from = 312782546, to = 312782547;
    const std::string before(reinterpret_cast<const char*>(&from), sizeof from);
    for (auto at = content.find(before); at != std::string::npos; at = content.find(before, at + sizeof to))
        content.replace(at, sizeof to, reinterpret_cast<const char*>(&to), sizeof to);
    std::ofstream(folder_ / "other.nrrd", std::ios::binary) << content;
    const auto checksum = [&](const char* file) {
        return json::parse(run(fmt::format("info {} --json -", file)).out)["checksum"];
    };
    EXPECT_NE(checksum("atlas.nrrd"), checksum("other.nrrd"));
}

TEST_F(CliLabels, AreDrawnTheSameFromTheirScene) {
    const std::string how = " --label-names names.csv --hide 997 --size 32x24 -q";
    ASSERT_EQ(run("render atlas.nrrd -o a.png" + how).status, 0);
    ASSERT_EQ(run("render atlas.nrrd -o rays.png --renderer raycast" + how).status, 0);
    ASSERT_EQ(run("rerun a.png -o again.png -q").status, 0);
    EXPECT_EQ(run("compare a.png again.png").status, 0);
    const ProgramRun scene = run("scene new atlas.nrrd -o scene.toml");
    ASSERT_EQ(scene.status, 0) << scene.err;
    const SceneDocument document = read_scene_file((folder_ / "scene.toml").string());
    EXPECT_EQ(document.volume.labels, true);
    EXPECT_TRUE(document.iso_values.empty());
}

/// A ball with a smooth rim around the boxes' middle, in which the atlas has its labels.
TEST_F(CliLabels, ColourAScan) {
    std::ofstream file(folder_ / "scan.nrrd", std::ios::binary);
    file << "NRRD0004\ntype: float\ndimension: 3\nsizes: 30 30 30\nspace: left-posterior-superior\n"
            "space directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (-14.5,-14.5,-14.5)\nendian: little\n"
            "encoding: raw\n\n";
    for (int z = 0; z < 30; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 30; ++x) {
                const auto value =
                    static_cast<float>(100 / (1 + std::exp(std::hypot(x - 14.5, y - 14.5, z - 14.5) - 11)));
                file.write(reinterpret_cast<const char*>(&value), sizeof value);
            }
    file.close();
    const std::string both = "scan.nrrd --segmentation atlas.nrrd --label-names names.csv ";
    const ProgramRun ran = run("measure -q --json - --only root " + both);
    ASSERT_EQ(ran.status, 0) << ran.err;
    const json labels = json::parse(ran.out)["labels"];
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_EQ(labels[0]["name"], "root");
    EXPECT_GT(labels[0]["mean"].get<double>(), 10);
    const ProgramRun at = run("measure -q --json - --at 0,-7,0 --only 'visual*' --iso 50 " + both);
    ASSERT_EQ(at.status, 0) << at.err;
    EXPECT_EQ(json::parse(at.out)["places"][0]["name"], "visual area, layer 1");
    // The scene file keeps the segmentation and, with chosen labels, the iso-value of the whole scan.
    const ProgramRun made = run("scene new -o a.toml --hide root " + both);
    ASSERT_EQ(made.status, 0) << made.err;
    const SceneDocument document = read_scene_file((folder_ / "a.toml").string());
    EXPECT_EQ(document.volume.segmentation, "atlas.nrrd");
    EXPECT_EQ(document.iso_values.size(), 1U);
    ASSERT_EQ(run("render -q --size 32x32 -o a.png a.toml").status, 0);
    ASSERT_EQ(run("render -q --size 32x32 -o b.png --hide root " + both).status, 0);
    EXPECT_EQ(read_image((folder_ / "a.png").string()).image.pixels,
              read_image((folder_ / "b.png").string()).image.pixels);
    refuses("render -q -o c.png scan.nrrd --segmentation scan.nrrd", "expected a segmentation of 2 to");
    refuses("render -q -o c.png --transfer ct-lung-airways " + both, "the scene has a transfer function");
    refuses("render -q -o c.png --labels on " + both, "has its own");
    refuses("render -q -o c.png --threshold 50 " + both, "makes a mask");
    refuses("render -q -o c.png scan.nrrd --segmentation none.nrrd", "none.nrrd: no such file");
}

}  // namespace
}  // namespace edgesplat
