// Labels on the command line: listed, chosen, named, measured and drawn by their own numbers.
#include <gmock/gmock.h>

#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>

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

    json measured(const std::string& options) const {
        const ProgramRun ran = run("measure -q atlas.nrrd --json - " + options);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.status == 0 ? json::parse(ran.out) : json();
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

}  // namespace
}  // namespace edgesplat
