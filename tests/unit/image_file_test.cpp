// PNG and EXR round trips, metadata, and no files left after a failed write.
#include "engine/image/image_file.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <fstream>
#include <limits>

#include "engine/error.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;
using ::testing::ThrowsMessage;

/// A fresh folder for one test.
class ImageFile : public ::testing::Test {
  protected:
    void SetUp() override { fs::create_directories(folder_); }
    void TearDown() override { fs::remove_all(folder_); }
    int file_count() const { return static_cast<int>(std::distance(fs::directory_iterator(folder_), {})); }
    fs::path folder_ = fs::temp_directory_path() / ("edgesplat_image_" + std::to_string(getpid()));
};

Image gradient(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = static_cast<float>(i) / static_cast<float>(image.pixels.size());
    return image;
}

TEST_F(ImageFile, ExrKeepsEveryFloat) {
    Image image = gradient(7, 5, 4);
    image.at(0, 0, 0) = 1e-20F;
    image.at(1, 0, 0) = 40.0F;
    write_image(folder_ / "a.exr", image);
    const LoadedImage back = read_image(folder_ / "a.exr");
    EXPECT_THAT(back.channel_names, ElementsAre("R", "G", "B", "A"));
    EXPECT_EQ(back.image.pixels, image.pixels);
}

TEST_F(ImageFile, PngErrorIsBelowHalfAStep) {
    const Image image = gradient(16, 16, 3);
    write_image(folder_ / "a.png", image);
    const LoadedImage back = read_image(folder_ / "a.png");
    ASSERT_EQ(back.image.channels, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(back.image.pixels[i], image.pixels[i], 0.0046F) << i;  // half a step of 1/255 at slope 2.3
}

TEST_F(ImageFile, PngMiddleGreyIsSrgb) {
    Image image(1, 1, 3);
    image.pixels = {0.2140F, 0.2140F, 0.2140F};  // encodes to 0.5
    write_image(folder_ / "a.png", image);
    EXPECT_NEAR(read_image(folder_ / "a.png").image.pixels[0], 0.2140F, 0.002F);
}

TEST_F(ImageFile, PngAlphaIsStraightInTheFileAndPremultipliedInMemory) {
    Image image(2, 1, 4);
    image.pixels = {0.25F, 0.5F, 0.1F, 0.5F, 0, 0, 0, 0};
    write_image(folder_ / "a.png", image);
    const Image back = read_image(folder_ / "a.png").image;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_NEAR(back.pixels[i], image.pixels[i], 0.004F) << i;
}

TEST_F(ImageFile, PngClampsAndWritesNanAsBlack) {
    Image image(1, 1, 3);
    image.pixels = {std::numeric_limits<float>::quiet_NaN(), -1.0F, std::numeric_limits<float>::infinity()};
    write_image(folder_ / "a.png", image);
    EXPECT_THAT(read_image(folder_ / "a.png").image.pixels, ElementsAre(0.0F, 0.0F, 1.0F));
}

TEST_F(ImageFile, BothFormatsKeepMetadata) {
    const ImageMetadata metadata{{"Software", "edgesplat 0.1.0"},
                                 {"edgesplat:command", "edgesplat render 'a b.nrrd' --eye=-1,2,3 -o \"x\""},
                                 {"edgesplat:volume", "builtin:sphere"},
                                 {"edgesplat:checksum", "0123456789abcdef"}};
    for (const char* name : {"a.png", "a.exr"}) {
        write_image(folder_ / name, gradient(4, 4, 3), metadata);
        const LoadedImage back = read_image(folder_ / name);
        for (const auto& [key, text] : metadata)
            EXPECT_THAT(back.metadata, Contains(Pair(key, text))) << name;
    }
}

TEST_F(ImageFile, ExrContainsNamedLayers) {
    const Image color = gradient(3, 2, 4);
    const Image depth = gradient(3, 2, 1);
    const Image normal = gradient(3, 2, 3);
    const std::array<ImageLayer, 3> layers{
        {{&color, {"R", "G", "B", "A"}}, {&depth, {"depth.Z"}}, {&normal, {"normal.X", "normal.Y", "normal.Z"}}}};
    const FileContent file{folder_ / "a.exr", encode_exr(layers, {})};
    write_files({&file, 1});
    const LoadedImage back = read_image(file.path);
    EXPECT_THAT(back.channel_names,
                ::testing::UnorderedElementsAre("R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z"));
    const auto channel = [&](const std::string& name) {
        return static_cast<int>(std::find(back.channel_names.begin(), back.channel_names.end(), name) -
                                back.channel_names.begin());
    };
    EXPECT_EQ(back.image.at(2, 1, channel("depth.Z")), depth.at(2, 1, 0));
    EXPECT_EQ(back.image.at(1, 1, channel("normal.Y")), normal.at(1, 1, 1));
    EXPECT_EQ(back.image.at(1, 0, channel("A")), color.at(1, 0, 3));
}

TEST_F(ImageFile, ReplacesFileAndLeavesNoTemporary) {
    write_image(folder_ / "a.png", gradient(4, 4, 3));
    write_image(folder_ / "a.png", gradient(8, 8, 3));
    EXPECT_EQ(read_image(folder_ / "a.png").image.width, 8);
    EXPECT_EQ(file_count(), 1);
}

TEST_F(ImageFile, WritesAllFilesOrNone) {
    const std::array<FileContent, 2> files{{{folder_ / "good.png", "x"}, {folder_ / "missing" / "bad.png", "y"}}};
    EXPECT_THROW(write_files(files), Error);
    EXPECT_EQ(file_count(), 0);
}

TEST_F(ImageFile, SignalsWaitUntilFileIsWritten) {
    const FileContent file{folder_ / "a.bin", std::string(1 << 24, 'x')};
    for (int delay_ms = 0; delay_ms < 12; delay_ms += 2) {
        fs::remove(file.path);
        const pid_t child = fork();
        if (child == 0) {
            write_files({&file, 1});
            _exit(0);
        }
        usleep(static_cast<useconds_t>(delay_ms) * 1000);
        kill(child, SIGINT);
        waitpid(child, nullptr, 0);
        // Whether the signal came before, during or after the write: the file is complete or absent, and no other file
        // is left.
        const bool there = fs::exists(file.path);
        EXPECT_EQ(file_count(), there ? 1 : 0);
        EXPECT_EQ(there ? fs::file_size(file.path) : file.bytes.size(), file.bytes.size());
    }
}

TEST_F(ImageFile, RefusesInvalidOutputPathsEarly) {
    static constexpr std::array<std::string_view, 2> kExtensions{".png", ".exr"};
    const auto refused = [&](const fs::path& path) { return [=] { check_output_path(path, kExtensions); }; };
    EXPECT_THAT(refused(folder_ / "a.jpg"), ThrowsMessage<Error>(HasSubstr("must end in .png or .exr")));
    EXPECT_THAT(refused(folder_ / "nowhere" / "a.png"), ThrowsMessage<Error>(HasSubstr("does not exist")));
    fs::create_directory(folder_ / "b.png");
    EXPECT_THAT(refused(folder_ / "b.png"), ThrowsMessage<Error>(HasSubstr("is a folder")));
    EXPECT_THAT(refused("/proc/a.png"), ThrowsMessage<Error>(HasSubstr("cannot write /proc/a.png")));
    EXPECT_NO_THROW(check_output_path(folder_ / "A.PNG", kExtensions));
    EXPECT_EQ(file_count(), 1);
}

TEST_F(ImageFile, ErrorsNameUnreadableFile) {
    EXPECT_THAT([&] { read_image(folder_ / "none.png"); }, ThrowsMessage<Error>(HasSubstr("none.png: no such file")));
    std::ofstream(folder_ / "text.png") << "not a picture";
    EXPECT_THAT([&] { read_image(folder_ / "text.png"); }, ThrowsMessage<Error>(HasSubstr("text.png")));
}

}  // namespace
}  // namespace edgesplat
