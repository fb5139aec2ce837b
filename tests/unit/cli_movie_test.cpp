// `edgesplat movie`: its frames equal rendered pictures, and an interrupted movie resumes.
#include <gmock/gmock.h>
#include <signal.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <thread>

#include "engine/image/image_compare.h"
#include "engine/image/image_file.h"
#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kFlight = "movie builtin:torus:20 --orbit 90 --seconds 0.4 ";
const std::string kMovie = std::string(kFlight) + "--size 32x24 ";  // 10 frames
constexpr int kFrames = 10;

class CliMovie : public CliTest {
  protected:
    std::string good(const std::string& arguments) const {
        const ProgramRun result = run(arguments);
        EXPECT_EQ(result.status, 0) << arguments << '\n' << result.err;
        return result.out;
    }
    std::vector<std::string> names(const std::string& folder) const {
        std::vector<std::string> all;
        for (const auto& entry : fs::directory_iterator(folder_ / folder))
            all.push_back(entry.path().filename().string());
        std::sort(all.begin(), all.end());
        return all;
    }
    std::map<std::string, std::string> frames(const std::string& folder) const {
        std::map<std::string, std::string> all;
        for (const std::string& name : names(folder))
            if (name != "movie.json") all[name] = text_of(folder_ / folder / name);
        return all;
    }
    std::map<std::string, fs::file_time_type> times(const std::string& folder) const {
        std::map<std::string, fs::file_time_type> all;
        for (const std::string& name : names(folder))
            if (name.ends_with(".png") && !name.starts_with('.'))
                all[name] = fs::last_write_time(folder_ / folder / name);
        return all;
    }
    /// Starts a movie, waits for `count` frames and sends the signal. Returns the exit status, or minus the signal that
    /// ended the program. If the movie ends before the signal, it starts again, up to 8 times.
    int signalled(const std::string& arguments, const std::string& folder, std::size_t count, int signal) const {
        int status = 0;
        for (int attempt = 0; attempt < 8; ++attempt) {
            fs::remove_all(folder_ / folder);
            fs::remove_all(folder_ / fs::path(folder).stem());
            status = signalled_once(arguments, folder, count, signal);
            if (status != 0) break;
        }
        return status;
    }

  private:
    int signalled_once(const std::string& arguments, const std::string& folder, std::size_t count, int signal) const {
        const pid_t child = fork();
        if (child == 0) {
            const std::string command =
                "cd '" + folder_.string() + "' && exec '" EDGESPLAT_PROGRAM "' " + arguments + " >said 2>&1 </dev/null";
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(127);
        }
        for (int i = 0; i < 6000; ++i) {
            if (fs::exists(folder_ / folder) && times(folder).size() >= count) break;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        kill(child, signal);
        int status = 0;
        waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    }
};

TEST_F(CliMovie, FramesEqualRenderedPictures) {
    EXPECT_THAT(good(kMovie + "-o all/frame_%04d.png"), HasSubstr("10 frames, 0.4 s at 25"));
    const auto all = frames("all");
    ASSERT_EQ(all.size(), std::size_t{kFrames});
    // One frame alone, from another process, has the same bytes.
    good(kMovie + "-o one/frame_%04d.png --frames 7:7");
    const auto one = frames("one");
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one.begin()->first, "frame_0007.png");
    EXPECT_EQ(one.begin()->second, all.at("frame_0007.png"));
    EXPECT_NE(all.at("frame_0000.png"), all.at("frame_0007.png"));
    // The first frame equals the picture of `render`.
    good("render builtin:torus:20 --size 32x24 -o still.png");
    EXPECT_EQ(read_image(folder_ / "still.png").image.pixels, read_image(folder_ / "all/frame_0000.png").image.pixels);
    good(kMovie + "-o linear/f%d.exr --frames 0:1");
    EXPECT_THAT(names("linear"), testing::ElementsAre("f0.exr", "f1.exr", "movie.json"));
}

TEST_F(CliMovie, ResumesAfterKill) {
    good(kMovie + "-o whole/frame_%05d.png");
    EXPECT_EQ(signalled(kMovie + "-o film.mp4 --keep-frames", "film.mp4.frames", 4, SIGKILL), -SIGKILL);
    const auto before = times("film.mp4.frames");
    ASSERT_GE(before.size(), 4U);
    ASSERT_LT(before.size(), std::size_t{kFrames}) << "the movie ended before the signal";
    for (const auto& [name, time] : before)
        EXPECT_EQ(text_of(folder_ / "film.mp4.frames" / name), text_of(folder_ / "whole" / name)) << "a partial frame";
    std::ofstream(folder_ / "film.mp4.frames/.frame_00009.png.edgesplat-1-1.tmp") << "half";
    EXPECT_THAT(good(kMovie + "-o film.mp4 --keep-frames"),
                HasSubstr(std::to_string(before.size()) + " of 10 frames exist already"));
    const auto after = times("film.mp4.frames");
    for (const auto& [name, time] : before)
        EXPECT_EQ(after.at(name), time) << name << " was rendered again";
    EXPECT_EQ(frames("film.mp4.frames"), frames("whole"));
    EXPECT_GT(fs::file_size(folder_ / "film.mp4"), 1000U);
}

TEST_F(CliMovie, CtrlCFinishesTheFrame) {
    EXPECT_EQ(signalled(kMovie + "-o f/frame_%04d.png", "f", 3, SIGINT), 130);
    EXPECT_THAT(text_of(folder_ / "said"), HasSubstr("run the same command again to continue"));
    const auto before = times("f");
    EXPECT_GE(before.size(), 3U);
    EXPECT_LT(before.size(), std::size_t{kFrames});
    for (const std::string& name : names("f"))
        EXPECT_THAT(name, Not(HasSubstr(".tmp")));
    good(kMovie + "-o f/frame_%04d.png -q");
    EXPECT_EQ(times("f").size(), std::size_t{kFrames});
}

TEST_F(CliMovie, RefusesFramesOfOtherScene) {
    good(kMovie + "-o f/frame_%04d.png --frames 0:1");
    const auto before = frames("f");
    for (const auto& [change, named] :
         std::map<std::string, std::string>{{"--size 32x24 --color 1,0,0", "scene"},
                                            {"--size 32x24 --fps 30", "frames per second"},
                                            {"--size 34x24", "size"}}) {
        const ProgramRun other = run(std::string(kFlight) + "-o f/frame_%04d.png --frames 0:1 " + change);
        EXPECT_EQ(other.status, 1);
        EXPECT_THAT(other.err, HasSubstr(named));
        EXPECT_THAT(other.err, HasSubstr("--restart"));
    }
    EXPECT_EQ(frames("f"), before);
    good(kMovie + "-o f/frame_%04d.png --frames 1:1 --color 1,0,0 --restart");
    EXPECT_EQ(names("f"), (std::vector<std::string>{"frame_0001.png", "movie.json"}));
    // Frames of unknown origin are not overwritten either.
    fs::remove(folder_ / "f/movie.json");
    EXPECT_THAT(run(kMovie + "-o f/frame_%04d.png").err, HasSubstr("frames of unknown origin"));
}

TEST_F(CliMovie, FilmsAreCompleteAndLeaveNoFrames) {
    for (const char* film : {"a.mp4", "b.webm"}) {
        good(kMovie + "--frames 2:7 -o " + film);
        EXPECT_FALSE(fs::exists(folder_ / (std::string(film) + ".frames")));
        const std::string probe =
            "ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,height "
            "-of csv=p=0 '" +
            (folder_ / film).string() + "' > '" + (folder_ / "probe").string() + "'";
        ASSERT_EQ(std::system(probe.c_str()), 0);  // NOLINT: a shell is wanted here
        EXPECT_EQ(text_of(folder_ / "probe"), "32,24,6\n");
    }
    // Without the encoder nothing is rendered; the message names the package to install.
    const std::string nowhere = folder_.string();
    const std::string path = std::getenv("PATH");
    setenv("PATH", nowhere.c_str(), 1);
    const ProgramRun none = run(kMovie + "-o c.mp4");
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(none.status, 1);
    EXPECT_THAT(none.err, HasSubstr("Debian: ffmpeg"));
    EXPECT_FALSE(fs::exists(folder_ / "c.mp4.frames"));
}

TEST_F(CliMovie, AnimatesNumbers) {
    std::ofstream(folder_ / "s.toml") << R"(
[volume]
path = "builtin:torus:20"
[effects.fog]
color = [0, 0, 0.2]
density = 0
[output]
size = [32, 24]
[movie]
fps = 10
[[movie.animate]]
key = "effects.fog.density"
times = [0, 0.5]
values = [0, 0.05]
)";
    good("movie s.toml -o f/%d.png");
    EXPECT_EQ(frames("f").size(), 5U);
    good("render s.toml -o first.png");
    good("render s.toml -o third.png --set effects.fog.density=0.02");
    const auto pixels = [&](const char* name) { return read_image(folder_ / name).image.pixels; };
    EXPECT_EQ(pixels("f/0.png"), pixels("first.png"));
    EXPECT_EQ(pixels("f/2.png"), pixels("third.png"));
    EXPECT_NE(pixels("f/2.png"), pixels("first.png"));
}

// Two balls of different size, one per frame of the file.
TEST_F(CliMovie, AnimatesTheFileAsWholeNumbers) {
    std::string voxels;
    for (const int radius : {2, 4})
        for (int i = 0; i < 10 * 10 * 10; ++i) {
            const int x = i % 10 - 5, y = i / 10 % 10 - 5, z = i / 100 - 5;
            voxels += static_cast<char>(x * x + y * y + z * z <= radius * radius ? 100 : 0);
        }
    const std::string head =
        "NRRD0004\ntype: uint8\ndimension: 4\nspace dimension: 3\nsizes: 10 10 10 2\nspace directions: (1,0,0) "
        "(0,1,0) "
        "(0,0,1) none\nkinds: space space space time\nencoding: raw\n\n";
    std::ofstream(folder_ / "two.nrrd", std::ios::binary) << head + voxels;
    std::ofstream(folder_ / "two.toml")
        << "iso_values = [50]\n[volume]\npath = \"two.nrrd\"\n[camera]\nview = \"front\"\n[output]\nsize = [24, 24]\n"
           "[movie]\nfps = 25\n[[movie.animate]]\nkey = \"volume.frame\"\ntimes = [0, 0.12]\nvalues = [0, 1]\n";
    good("movie two.toml -o f/%d.png --seconds 0.16");
    good("render two.toml --frame 0 -o 0.png");
    EXPECT_EQ(frames("f").size(), 4U);
    const auto pixels = [&](const char* name) { return read_image(folder_ / name).image.pixels; };
    EXPECT_EQ(pixels("f/0.png"), pixels("0.png"));
    EXPECT_EQ(pixels("f/1.png"), pixels("0.png")) << "frame 0.3 is frame 0";
    EXPECT_NE(pixels("f/3.png"), pixels("0.png"));
    good("movie two.toml -o g/%d.png --seconds 0.16 --set movie.interpolate_frames=true");
    good("render two.toml --frame 0 --set volume.frame_share=0.3333333333 -o third.png");
    EXPECT_EQ(pixels("g/0.png"), pixels("0.png"));
    EXPECT_EQ(pixels("g/3.png"), pixels("f/3.png"));
    EXPECT_NE(pixels("g/1.png"), pixels("0.png"));
    EXPECT_GT(compare_images(read_image(folder_ / "g/1.png").image, read_image(folder_ / "third.png").image).psnr, 60);
    for (char& voxel : voxels)
        voxel = static_cast<char>(voxel == 0 ? 0 : 1 + (&voxel - voxels.data()) % 10 / 5);
    std::ofstream(folder_ / "labels.nrrd", std::ios::binary) << head + voxels;
    EXPECT_THAT(run("render labels.nrrd --frame 0 --set volume.frame_share=0.5 -o l.png").err,
                HasSubstr("labels have no numbers between frames"));
    const ProgramRun alone = run("render two.toml --set volume.frame_share=0.5 -o l.png");
    EXPECT_THAT(alone.err, HasSubstr("expected volume.frame beside it"));
}

// Open iso-values are those of the first frame.
TEST_F(CliMovie, KeepsTheSurfacesOfTheFirstFrame) {
    std::string voxels;
    for (const double contrast : {1.0, 0.5})
        for (int i = 0; i < 12 * 12 * 12; ++i) {
            const double x = i % 12 - 5.5, y = i / 12 % 12 - 5.5, z = i / 144 - 5.5;
            voxels +=
                static_cast<char>(std::lround(contrast * std::clamp(60 - 20 * (std::hypot(x, y, z) - 3), 0.0, 120.0)));
        }
    std::ofstream(folder_ / "two.nrrd", std::ios::binary)
        << "NRRD0004\ntype: uint8\ndimension: 4\nspace dimension: 3\nsizes: 12 12 12 2\nspace directions: (1,0,0) "
           "(0,1,0) (0,0,1) none\nkinds: space space space time\nencoding: raw\n\n" +
               voxels;
    std::ofstream(folder_ / "two.toml")
        << "[volume]\npath = \"two.nrrd\"\n[camera]\neye = [6, -20, 6]\ntarget = [6, 0, 6]\n[output]\nsize = [24, 24]\n"
           "[movie]\nfps = 25\n[[movie.animate]]\nkey = \"volume.frame\"\ntimes = [0, 0.04]\nvalues = [0, 1]\n";
    good("movie two.toml -o f/%d.png --seconds 0.08");
    const auto pixels = [&](const char* name) { return read_image(folder_ / name).image.pixels; };
    good("render two.nrrd --frame 0 -o 0.png --json 0.json --eye 6,-20,6 --target 6,0,6 --size 24x24");
    const std::string iso = text_of(folder_ / "0.json");
    const auto begin = iso.find("\"iso_values\"");
    ASSERT_NE(begin, std::string::npos) << iso;
    const std::string value = iso.substr(iso.find_first_of("0123456789", begin), 12);
    good("render two.nrrd --frame 1 -o 1.png --eye 6,-20,6 --target 6,0,6 --size 24x24 --iso " +
         std::to_string(std::stod(value)));
    EXPECT_EQ(pixels("f/0.png"), pixels("0.png"));
    EXPECT_GT(compare_images(read_image(folder_ / "f/1.png").image, read_image(folder_ / "1.png").image).psnr, 50);
}

// A ball that cuts a box moves.
TEST_F(CliMovie, MovesWhatCuts) {
    std::ofstream(folder_ / "s.toml") << R"(
iso_values = [0.5]
[volume]
path = "builtin:box:20"
[[volumes]]
volume.path = "builtin:sphere:20"
volume.rule = "cut"
volume.transform = [1,0,0,0, 0,1,0,-8, 0,0,1,0, 0,0,0,1]
[camera]
eye = [10, -40, 10]
target = [10, 0, 10]
[output]
size = [32, 24]
[movie]
fps = 10
[[movie.animate]]
key = "volumes[0].volume.transform[3]"
times = [0, 0.3]
values = [0, 9]
)";
    good("movie s.toml -o f/%d.png");
    EXPECT_EQ(frames("f").size(), 3U);
    good("render s.toml -o first.png");
    good("render s.toml -o last.png --set volumes[0].volume.transform=1,0,0,6,0,1,0,-8,0,0,1,0,0,0,0,1");
    good("render s.toml -o whole.png --set volumes[0].volume.visible=false");
    const auto pixels = [&](const char* name) { return read_image(folder_ / name).image.pixels; };
    EXPECT_EQ(pixels("f/0.png"), pixels("first.png"));
    EXPECT_EQ(pixels("f/2.png"), pixels("last.png"));
    EXPECT_NE(pixels("f/2.png"), pixels("first.png"));
    EXPECT_NE(pixels("whole.png"), pixels("first.png"));
}

TEST_F(CliMovie, RefusesInvalidMovies) {
    const auto says = [&](const std::string& arguments, const char* what) {
        const ProgramRun result = run(arguments);
        EXPECT_NE(result.status, 0) << arguments;
        EXPECT_THAT(result.err, HasSubstr(what)) << arguments;
    };
    says("movie builtin:torus:20 -o f/%d.png", "the movie has no duration");
    says(kMovie + "-o film.avi", "expected a film (.mp4 or .webm)");
    says(kMovie + "-o f/frame.png", "one number in it");
    says(kMovie + "-o f/%d.png --frames 5:20", "last frame is 9, not 20");
    says(kMovie + "-o f/%d.png --frames 5", "FIRST:LAST");
    says(kMovie + "-o f/%d.png --aov tau", "--aov");
    says("movie builtin:torus:20 --orbit 0 -o f/%d.png", "orbit degrees: 0");
}

}  // namespace
}  // namespace edgesplat
