// `edgesplat scene`, `render SCENE.toml` and `rerun` from end to end.
#include <gmock/gmock.h>

#include <cstdlib>
#include <cstring>
#include <sstream>
#include <tuple>

#include "engine/image/image_file.h"
#include "engine/scene/scene_file.h"
#include "engine/scene/scene_keys.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::Pair;
using testing::StartsWith;

const fs::path kScenes = EDGESPLAT_SOURCE_DIR "/tests/scenes";

std::vector<std::string> scenes_in(const char* folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(kScenes / folder))
        names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string test_name(const testing::TestParamInfo<std::string>& parameter) {
    return parameter.param;
}

class CliScene : public CliTest {
  protected:
    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name) << text; }
    void copy(const fs::path& scene) const { fs::copy_file(scene, folder_ / scene.filename()); }
    /// Runs a command that must succeed.
    std::string good(const std::string& arguments) const {
        const ProgramRun result = run(arguments);
        EXPECT_EQ(result.status, 0) << arguments << '\n' << result.err;
        return result.out;
    }
    Image picture(const std::string& name) const { return read_image(folder_ / name).image; }
};

class CliBrokenScene : public CliScene, public testing::WithParamInterface<std::string> {};

TEST_P(CliBrokenScene, ReportsProblemWithFileAndLine) {
    const std::string file = GetParam() + ".toml";
    copy(kScenes / "broken" / file);
    const std::string text = text_of(folder_ / file), mark = "# expect: ";
    ASSERT_TRUE(text.starts_with(mark));
    const std::string expected = text.substr(mark.size(), text.find('\n') - mark.size());
    ASSERT_THAT(expected, StartsWith(file + ":")) << "every message names file and line";
    const ProgramRun check = run("scene check " + file);
    EXPECT_EQ(check.status, 1);
    EXPECT_THAT(check.err, HasSubstr(expected));
    EXPECT_THAT(check.out, IsEmpty());
    std::istringstream lines(check.err);
    for (std::string line; std::getline(lines, line);)
        EXPECT_THAT(line, StartsWith(file + ":")) << "one line per problem";
    const ProgramRun render = run("render " + file + " -o a.png");
    EXPECT_EQ(render.status, 1);
    EXPECT_THAT(render.err, AllOf(StartsWith("edgesplat: error: "), HasSubstr(expected)));
    EXPECT_THAT(files(), ElementsAre(file)) << "nothing is written";
}

INSTANTIATE_TEST_SUITE_P(Cli, CliBrokenScene, testing::ValuesIn(scenes_in("broken")), test_name);

TEST_F(CliScene, CorpusIsLarge) {
    EXPECT_GE(scenes_in("broken").size(), 40U);
}

TEST_F(CliScene, RefusesInvalidFiles) {
    fs::create_directories(folder_ / "folder.toml");
    fs::create_symlink("loop.toml", folder_ / "loop.toml");
    EXPECT_THAT(run("scene check none.toml").err, AllOf(HasSubstr("none.toml"), HasSubstr("no such file")));
    EXPECT_THAT(run("scene check folder.toml").err, AllOf(HasSubstr("folder.toml"), HasSubstr("is a folder")));
    EXPECT_THAT(run("scene check loop.toml").err, AllOf(HasSubstr("loop.toml"), HasSubstr("symbolic links")));
    for (const char* name : {"none", "folder", "loop"})
        EXPECT_EQ(run(std::string("scene check ") + name + ".toml").status, 1);
    write("a.toml", "[volume]\npath = \"loop.toml/x.nhdr\"\n");
    EXPECT_THAT(run("scene check a.toml").err, HasSubstr("a.toml:2: volume.path"));
}

class CliGoodScene : public CliScene, public testing::WithParamInterface<std::string> {};

TEST_P(CliGoodScene, RerunsToSamePixels) {
    const std::string name = GetParam();
    copy(kScenes / "good" / (name + ".toml"));
    EXPECT_THAT(good("scene check " + name + ".toml"), HasSubstr("valid"));
    for (const char* extension : {".png", ".exr"}) {
        good("render " + name + ".toml -o a" + extension);
        EXPECT_THAT(good(std::string("rerun a") + extension + " -o b" + extension + " --check"),
                    HasSubstr("identical"));
        EXPECT_EQ(picture(std::string("a") + extension).pixels, picture(std::string("b") + extension).pixels);
        // The scene in the picture's metadata is a valid scene file.
        const LoadedImage a = read_image(folder_ / (std::string("a") + extension));
        for (const auto& [key, text] : a.metadata)
            if (key == "edgesplat:scene") write("again.toml", text);
        good(std::string("render again.toml -o c") + extension);
        EXPECT_EQ(picture(std::string("c") + extension).pixels, a.image.pixels);
    }
}

INSTANTIATE_TEST_SUITE_P(Cli, CliGoodScene, testing::ValuesIn(scenes_in("good")), test_name);

TEST_F(CliScene, SceneEqualsOptions) {
    const std::string options =
        "--iso 0.4,0.6 --color 1,0,0 --color 0,1,0 --extinction 0.1,5 --background 0.1,0.1,0.2 --light 1,-1,1 "
        "--ambient 0.3 --eye 40,-50,30 --target 12,12,12 --up 0,0.1,1 --fov 35 --size 24x20 --edges march "
        "--sheets sliced --sheet-spacing 0.5 --keep-buried --samples 1 --threshold 0.3 --box-filter";
    good("render builtin:sphere:24 -o a.exr " + options);
    write("a.toml", R"(iso_values = [0.4, 0.6]
background = [0.1, 0.1, 0.2]
ambient = 0.3
[volume]
path = "builtin:sphere:24"
threshold = 0.3
box_filter = true
[[materials]]
color = [1, 0, 0]
extinction = 0.1
[[materials]]
color = [0, 1, 0]
extinction = 5
[[lights]]
kind = "directional"
direction = [1, -1, 1]
[camera]
eye = [40, -50, 30]
target = [12, 12, 12]
up = [0, 0.1, 1]
fov = 35
[quality]
edges = "march"
sheets = "sliced"
sheet_spacing = 0.5
cull_buried = false
[output]
size = [24, 20]
file = "b.exr"
)");
    good("render a.toml");
    EXPECT_EQ(picture("a.exr").pixels, picture("b.exr").pixels);
    good(
        "render builtin:sphere:24 -o c.exr --set iso_values=0.4,0.6 --set background=0.1,0.1,0.2 --set ambient=0.3 "
        "--set volume.threshold=0.3 --set volume.box_filter=true --set materials[0].color=1,0,0 "
        "--set materials[0].extinction=0.1 --set materials[1].color=0,1,0 --set materials[1].extinction=5 "
        "--set lights[0].kind=directional --set lights[0].direction=1,-1,1 --set camera.eye=40,-50,30 "
        "--set camera.target=12,12,12 --set camera.up=0,0.1,1 --set camera.fov=35 --set quality.edges=march "
        "--set quality.sheets=sliced --set quality.sheet_spacing=0.5 --set quality.cull_buried=false "
        "--set output.size=24,20");
    EXPECT_EQ(picture("a.exr").pixels, picture("c.exr").pixels);
}

TEST_F(CliScene, RegistrationsPlaceTheMovingVolume) {
    write("to_moving.tfm",
          "#Insight Transform File V1.0\n#Transform 0\nTransform: AffineTransform_double_3_3\n"
          "Parameters: 1 0 0 0 1 0 0 0 1 3 0 -2\nFixedParameters: 0 0 0\n");
    const std::string view = " --size 20x16 --eye 10,-40,12 --direction 0,1,0 --up 0,0,1 -o ";
    good("render builtin:sphere:24 --registration to_moving.tfm" + view + "a.png");
    good("render builtin:sphere:24 --set volume.transform=1,0,0,-3,0,1,0,0,0,0,1,2,0,0,0,1" + view + "b.png");
    good("render builtin:sphere:24" + view + "c.png");
    EXPECT_EQ(picture("a.png").pixels, picture("b.png").pixels);
    EXPECT_NE(picture("a.png").pixels, picture("c.png").pixels);
    EXPECT_EQ(run("rerun a.png --check").status, 0) << "the picture records the registration";
    const ProgramRun refused = run("render builtin:sphere:24 --registration none.tfm" + view + "d.png");
    EXPECT_EQ(refused.status, 1);
    EXPECT_THAT(refused.err, HasSubstr("none.tfm"));
}

TEST_F(CliScene, OptionsOverrideTheScene) {
    write("a.toml",
          "background = [0, 0, 1]\n[volume]\npath = \"builtin:sphere:24\"\n[camera]\neye = [12, -40, 12]\n"
          "[output]\nsize = [16, 16]\nfile = \"a.exr\"\n");
    good("render a.toml -o b.exr --background 1,0,0 --size 20x10 --view top");
    EXPECT_THAT(files(), ElementsAre("a.toml", "b.exr"));
    const Image b = picture("b.exr");
    EXPECT_EQ(b.width, 20);
    EXPECT_EQ(b.at(0, 0, 0), 1.0F);
    good("render a.toml --set output.size=8,8");
    EXPECT_EQ(picture("a.exr").width, 8);
    EXPECT_EQ(picture("a.exr").at(0, 0, 2), 1.0F);
    EXPECT_THAT(run("render a.toml --set output.sice=8,8").err, HasSubstr("did you mean output.size?"));
    EXPECT_THAT(run("render a.toml --target 1,2,3 --direction 1,0,0").err, HasSubstr("--direction"));
    EXPECT_THAT(run("render a.toml --color 1,0,0 --color 0,1,0").err, HasSubstr("--color"));
}

TEST_F(CliScene, PictureMetadataContainsEffectOptions) {
    good(
        "render builtin:sphere:24 -o a.png --size 8x8 --fog 0.01 --silhouette --occlusion 4 --light 1,0,1 --shadows "
        "--clip-plane 1,2,3,0,0,1 --clip-plane 4,5,6,1,0,0 --cut-box 0,0,0,5,6,7 --antialias --smooth-outlines "
        "--samples 2 "
        "--background-top 0,0,1 --overlay orientation,scale-bar,legend --ambient 0.4");
    SceneDocument d;
    for (const auto& [key, text] : read_image(folder_ / "a.png").metadata)
        if (key == "edgesplat:scene") d = parse_scene(text, "a.png", {});
    EXPECT_EQ(d.effects.fog->density, 0.01);
    EXPECT_EQ(d.effects.silhouette, Silhouette{});
    EXPECT_EQ(d.effects.occlusion->radius, 4);
    ASSERT_EQ(d.lights.size(), 1U);
    EXPECT_TRUE(d.lights[0].shadows);
    ASSERT_EQ(d.effects.clip.keep.size(), 2U);
    EXPECT_EQ(d.effects.clip.keep[1].point, glm::dvec3(4, 5, 6));
    EXPECT_EQ(d.effects.clip.remove.size(), 6U);
    EXPECT_FALSE(d.remove_box) << "the picture's scene contains the planes instead";
    EXPECT_TRUE(d.effects.antialias);
    EXPECT_TRUE(d.effects.smooth_outlines);
    EXPECT_EQ(d.effects.samples, 2);
    EXPECT_EQ(d.effects.background_top, glm::dvec3(0, 0, 1));
    EXPECT_TRUE(d.effects.overlays.orientation && d.effects.overlays.scale_bar && d.effects.overlays.legend);
    EXPECT_EQ(d.ambient, 0.4);
    for (const char* wrong : {"--clip-plane 1,2,3,0,0", "--clip-plane 1,2,3,0,0,0", "--clip-box 1,0,0,0,1,1",
                              "--samples 1.5", "--fog -1", "--occlusion 0", "--overlay scale"})
        EXPECT_EQ(run(std::string("render builtin:sphere:24 -o b.png ") + wrong).status, 2) << wrong;
    EXPECT_THAT(run("render builtin:sphere:24 -o b.png --shadows").err, HasSubstr("--light X,Y,Z"));
}

TEST_F(CliScene, BoxEqualsSixPlanes) {
    const std::string sphere = "[volume]\npath = 'builtin:sphere:24'\n";
    write("boxes.toml", sphere +
                            "[effects.clip.keep_box]\nlow = [2, 3, 4]\nhigh = [20, 21, 22]\n"
                            "[effects.clip.remove_box]\nlow = [12, 0, 0]\nhigh = [24, 12, 24]\n");
    const auto plane = [](const char* list, const char* point, const char* normal) {
        return std::string("[[effects.clip.") + list + "]]\npoint = " + point + "\nnormal = " + normal + "\n";
    };
    std::string planes = sphere;
    for (const auto& [list, low, high] :
         {std::tuple{"keep", "[2, 3, 4]", "[20, 21, 22]"}, {"remove", "[12, 0, 0]", "[24, 12, 24]"}}) {
        planes += plane(list, low, "[-1, 0, 0]") + plane(list, low, "[0, -1, 0]") + plane(list, low, "[0, 0, -1]");
        planes += plane(list, high, "[1, 0, 0]") + plane(list, high, "[0, 1, 0]") + plane(list, high, "[0, 0, 1]");
    }
    write("planes.toml", planes);
    good("render boxes.toml -o a.exr --size 24x24 --view oblique");
    good("render planes.toml -o b.exr --size 24x24 --view oblique");
    good(
        "render builtin:sphere:24 -o c.exr --size 24x24 --view oblique --clip-box 2,3,4,20,21,22 "
        "--cut-box 12,0,0,24,12,24");
    good("render builtin:sphere:24 -o d.exr --size 24x24 --view oblique");
    EXPECT_EQ(picture("a.exr").pixels, picture("b.exr").pixels);
    EXPECT_EQ(picture("a.exr").pixels, picture("c.exr").pixels);
    EXPECT_NE(picture("a.exr").pixels, picture("d.exr").pixels);
    EXPECT_THAT(run("render boxes.toml -o e.png --clip-plane 1,2,3,0,0,1 --clip-plane 1,2,3,0,1,0 "
                    "--clip-plane 1,2,3,1,0,0")
                    .err,
                HasSubstr("3 planes beside keep_box: expected at most 2"));
}

TEST_F(CliScene, NewWritesASceneWithEveryKey) {
    const std::string printed = good("scene new builtin:orbital:24");
    good("scene new builtin:orbital:24 -o a.toml");
    EXPECT_EQ(text_of(folder_ / "a.toml"), printed);
    good("scene check a.toml");
    for (const SceneKey& key : scene_keys()) {
        const std::string leaf =
            key.path.substr(key.path.rfind('.') == std::string::npos ? 0 : key.path.rfind('.') + 1);
        EXPECT_THAT(printed,
                    HasSubstr("\n" + std::string(printed.find("\n" + leaf + " = ") == std::string::npos ? "# " : "") +
                              leaf + " = "));
    }
    const SceneDocument d = read_scene_file(folder_ / "a.toml");
    EXPECT_EQ(d.iso_values.size(), 2U) << "the builtin scene's own iso-values";
    EXPECT_TRUE(d.camera.eye && d.camera.direction);
    // Every commented-out line is usable: all lines together are valid TOML.
    std::istringstream lines(printed);
    std::string all;
    for (std::string line; std::getline(lines, line);) {
        const std::string rest = line.starts_with("# ") ? line.substr(2) : "";
        const std::size_t word = rest.find_first_not_of("abcdefghijklmnopqrstuvwxyz_");
        const bool key = word != std::string::npos && word > 0 && word == rest.find(" = ");
        const bool commented = rest.starts_with('[') || key;
        all += (commented ? rest : line) + "\n";
    }
    write("all.toml", all);
    const std::string problems = run("scene check all.toml").err;
    EXPECT_THAT(problems, Not(HasSubstr("no valid TOML")));
    EXPECT_THAT(problems, Not(HasSubstr("unknown key")));
}

TEST_F(CliScene, NewStoresTheSamePicture) {
    for (const std::string options :
         {"builtin:sphere:16 --size 16x16 --view oblique --iso 0.5 --color .9,.2,.1",
          "builtin:phantom:16 --size 16x16 --light 1,-1,1 --voxel --eye 8,-20,9 --direction 0,1,0.01 --fog 0.01",
          "builtin:cube-hole --size 16x16 --threshold 0.5 --preset draft --set lights[0].intensity=0.7"}) {
        SCOPED_TRACE(options);
        good("render " + options + " -o a.exr");
        good("scene new " + options + " -o a.toml");
        good("render a.toml -o b.exr");
        const Image a = picture("a.exr"), b = picture("b.exr");
        ASSERT_EQ(a.pixels.size(), b.pixels.size());
        EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof a.pixels[0]), 0);
    }
}

TEST_F(CliScene, ListsKeysAndPresets) {
    EXPECT_THAT(good("scene keys"), AllOf(HasSubstr("effects.fog.density"), HasSubstr("per mm")));
    EXPECT_THAT(good("scene keys --markdown"), HasSubstr("| `density` |"));
    EXPECT_THAT(good("scene presets"), AllOf(HasSubstr("ct-bone"), HasSubstr("built in")));
    EXPECT_EQ(run("scene").status, 2);
    EXPECT_THAT(run("scene chek a.toml").err, HasSubstr("Did you mean check?"));
}

/// Bytes of a volume of 8^3 floats: a ball with the value `inside`, 0 outside.
std::string small_volume(float inside) {
    std::string bytes;
    for (int i = 0; i < 512; ++i) {
        const glm::dvec3 p(i % 8 - 3.5, i / 8 % 8 - 3.5, i / 64 - 3.5);
        const float value = glm::length(p) < 3 ? inside : 0.0F;
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    return bytes;
}

TEST_F(CliScene, FindsVolumesBesideSceneAndInFolders) {
    fs::create_directories(folder_ / "scenes");
    fs::create_directories(folder_ / "data");
    const std::string scene =
        "iso_values = [0.5]\n[volume]\npath = \"v.raw\"\nraw = \"8x8x8:float32:little\"\n[output]\nsize = [8, 8]\n";
    write("scenes/a.toml", scene);
    write("data/v.raw", small_volume(1));
    EXPECT_THAT(run("scene check scenes/a.toml").err,
                AllOf(HasSubstr("a.toml:3"), HasSubstr("v.raw"), HasSubstr("scenes")));
    setenv("EDGESPLAT_VOLUMES", ("/nonexistent:" + (folder_ / "data").string()).c_str(), 1);
    good("render scenes/a.toml -o a.png");
    good("rerun a.png --check");
    unsetenv("EDGESPLAT_VOLUMES");
    EXPECT_THAT(run("rerun a.png --check").err, AllOf(HasSubstr("v.raw"), HasSubstr("EDGESPLAT_VOLUMES")));
    fs::rename(folder_ / "data" / "v.raw", folder_ / "scenes" / "v.raw");
    good("render scenes/a.toml -o b.png");
    good("rerun b.png --check");
    good("rerun b.png -o c.png");
    EXPECT_EQ(picture("a.png").pixels, picture("c.png").pixels);
    // A file with the same name but other samples.
    write("scenes/v.raw", small_volume(2));
    const ProgramRun other = run("rerun b.png -o d.png");
    EXPECT_EQ(other.status, 1);
    EXPECT_THAT(other.err, HasSubstr("checksum"));
    std::string checksum;
    for (const auto& [key, text] : read_image(folder_ / "b.png").metadata)
        if (key == "edgesplat:checksum") checksum = text;
    EXPECT_THAT(other.err, HasSubstr(checksum));
    EXPECT_FALSE(fs::exists(folder_ / "d.png"));
}

TEST_F(CliScene, RerunChecksEveryPixel) {
    good("render builtin:sphere:24 -o a.exr --size 16x16 --aov tau,normal");
    good("rerun a.exr --check");
    good("rerun a.exr -o b.png --check");
    LoadedImage a = read_image(folder_ / "a.exr");
    a.image.at(3, 4, 0) += 0.001F;
    const ImageLayer layer{&a.image, a.channel_names};
    const FileContent file{folder_ / "changed.exr", encode_exr({&layer, 1}, a.metadata)};
    write_files({&file, 1});
    const ProgramRun changed = run("rerun changed.exr --check");
    EXPECT_EQ(changed.status, 1);
    EXPECT_THAT(changed.err, HasSubstr("pixel 3,4"));
    write_image(folder_ / "plain.png", Image(4, 4, 3));
    EXPECT_THAT(run("rerun plain.png --check").err, HasSubstr("contains no scene"));
    EXPECT_THAT(run("rerun a.exr").err, HasSubstr("--check"));
    EXPECT_EQ(run("rerun none.png --check").status, 1);
}

/// More volumes on the command line are entries of `volumes`, also those of scene files elsewhere.
TEST_F(CliScene, DrawsSeveralVolumes) {
    fs::create_directory(folder_ / "far");
    write("far/ball.toml", "[volume]\npath = \"builtin:sphere:20\"\n[[materials]]\ncolor = [1, 0, 0]\n");
    const std::string sources = "builtin:box:20 far/ball.toml ", size = " --size 48x40 --view oblique";
    good("render " + sources + "-o a.png --set volumes[0].volume.transform=1,0,0,9,0,1,0,0,0,0,1,0,0,0,0,1" + size);
    good("rerun a.png --check");
    good("scene new " + sources + "-o s.toml --set volumes[0].volume.transform=1,0,0,9,0,1,0,0,0,0,1,0,0,0,0,1" + size);
    good("scene check s.toml");
    good("render s.toml -o b.png");
    EXPECT_EQ(picture("a.png").pixels, picture("b.png").pixels);
    good("render s.toml far/ball.toml -o c.png");
    EXPECT_NE(picture("c.png").pixels, picture("b.png").pixels);
    good("render s.toml -o d.png --set volumes[0].volume.visible=false");
    good("render builtin:box:20 -o e.png " + size);
    EXPECT_NE(picture("d.png").pixels, picture("b.png").pixels);
    EXPECT_THAT(good("render s.toml --explain"), HasSubstr("6_merge_surfaces"));
    EXPECT_THAT(run("render s.toml -o f.png --compare raycast").err, HasSubstr("several volumes"));
    EXPECT_THAT(run("render builtin:box:20 builtin:nothing -o f.png").err, HasSubstr("volumes[0].volume.path"));
    for (const char* renderer : {"raycast", "reference", "truth"})
        EXPECT_THAT(run(std::string("render s.toml -o f.png --renderer ") + renderer).err,
                    AllOf(HasSubstr(renderer), HasSubstr("draws one volume")));
    EXPECT_THAT(run("render s.toml -o f.png --max-error 0.05").err, HasSubstr("its model is of one volume"));
    write("turn.toml",
          text_of(folder_ / "s.toml") +
              "\n[[movie.animate]]\nkey = \"volumes[0].iso_values[0]\"\ntimes = [0, 1]\nvalues = [0.4, 0.6]\n");
    good("movie turn.toml -o frames/f_%d.png --seconds 0.1");
    EXPECT_NE(picture("frames/f_0.png").pixels, picture("frames/f_2.png").pixels);
    EXPECT_FALSE(fs::exists(folder_ / "f.png"));
}

TEST_F(CliScene, RerunsEveryRenderer) {
    for (const char* options :
         {"--renderer raycast", "--renderer raycast --raycast-filter cubic", "--renderer raycast --raycast-step 0.3",
          "--renderer reference --tolerance 0.01 --aov tau", "--renderer truth --tolerance 0.01",
          "--compare plain --preset draft", "--compare plain --renderer raycast", "--max-error 0.05"}) {
        good(std::string("render builtin:cube-hole:16 --size 8x8 -o a.exr --view oblique ") + options);
        good("rerun a.exr --check");
    }
}

}  // namespace
}  // namespace edgesplat
