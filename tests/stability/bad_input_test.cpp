// Malformed input: files that are truncated anywhere, have the wrong byte order, promise more than they contain, or are
// not regular files. Each is refused in one line that names it; nothing is written, and the program does not wait.
#include <OpenImageIO/imageio.h>
#include <itkGiplImageIO.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVTKImageIO.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cctype>
#include <cstring>
#include <regex>

#include "engine/viewer/preferences.h"
#include "engine/volume/pack_volume.h"
#include "engine/volume/packed_volume.h"
#include "tests/unit/cli_program.h"
#include "tests/unit/volume_test_files.h"

#ifdef __SANITIZE_ADDRESS__
#define EDGESPLAT_OWN_ALLOCATOR 1
#else
#define EDGESPLAT_OWN_ALLOCATOR 0
#endif

namespace {

using namespace volume_test;
using edgesplat::load_volume;
using edgesplat::LoadOptions;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class BadInput : public FolderTest {
  protected:
    /// The error if the file does not load; "" if it loads with exactly the values of `whole`.
    std::string refusal_unless_same(const std::string& path, const LoadOptions& options,
                                    const std::vector<float>& whole) const {
        try {
            auto volume = load_volume(path, options);
            if (volume.packed) volume = edgesplat::load_level(volume, 0);
            EXPECT_EQ(volume.values, whole) << "read with other samples";
        } catch (const edgesplat::Error& error) {
            return error.what();
        }
        return "";
    }

    /// Every prefix of the file is refused in one line, or already contains all samples.
    void check_prefixes(const std::string& name, const LoadOptions& options = {}) const {
        SCOPED_TRACE(name);
        const std::string bytes = content_of(file(name));
        auto volume = load_volume(file(name), options);
        if (volume.packed) volume = edgesplat::load_level(volume, 0);
        const std::string extension = name.substr(name.find('.'));
        // Long files are truncated at every byte of the probable header and end, and at every 61st byte between.
        for (std::size_t length = 0; length < bytes.size(); ++length) {
            if (length > 600 && length + 300 < bytes.size() && length % 61 != 0) continue;
            const std::string path = write("cut" + extension, bytes.substr(0, length));
            const std::string message = refusal_unless_same(path, options, volume.values);
            ASSERT_FALSE(HasFailure()) << name << ' ' << length << " of " << bytes.size();
            if (message.empty()) {
                ASSERT_GT(length, bytes.size() / 2) << name;
                continue;
            }
            ASSERT_THAT(message, AllOf(HasSubstr("cut"), testing::Not(HasSubstr("\n")))) << name << ' ' << length;
        }
    }
};

TEST_F(BadInput, TruncatedAnywhere) {
    const Place straight{.directions = glm::dmat3(1)};
    for (const bool compress : {false, true}) {
        write_itk(itk::NrrdImageIO::New(), file("a.nrrd"), {}, compress);
        write_itk(itk::MetaImageIO::New(), file("a.mha"), {}, compress);
        for (const char* name : {"a.nrrd", "a.mha"})
            check_prefixes(name);
    }
    for (const char* name : {"a.nii", "a.nii.gz"}) {
        write_itk(itk::NiftiImageIO::New(), file(name));
        check_prefixes(name);
    }
    write_itk(itk::VTKImageIO::New(), file("a.vtk"), straight);
    write_itk(itk::GiplImageIO::New(), file("a.gipl"), straight);
    for (const char* name : {"a.vtk", "a.gipl"})
        check_prefixes(name);
    write("a.raw", std::string(24, 'x'));
    check_prefixes("a.raw", {.raw = "2x3x2:uint16:big"});
}

TEST_F(BadInput, TruncatedTextAnywhere) {
    // A text without its last digit still ends in a whole number: it must not load as another volume.
    write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 1\nencoding: ascii\n\n1 2 3 4\n");
    check_prefixes("a.nrrd");
    write("b.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 1\nencoding: hex\n\n01020304\n");
    check_prefixes("b.nrrd");
    write("a.vtk",
          "# vtk DataFile Version 2.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\nSPACING 1 1 1\n"
          "ORIGIN 0 0 0\nPOINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4\n");
    check_prefixes("a.vtk");
}

TEST_F(BadInput, TruncatedPackedAnywhere) {
    write_itk(itk::NrrdImageIO::New(), file("a.nrrd"));
    edgesplat::pack_file(file("a.nrrd"), {}, file("a.esv"));
    check_prefixes("a.esv");
}

TEST_F(BadInput, TruncatedPicturesAnywhere) {
    for (const char* name : {"a.png", "a.tif"}) {
        const auto out = OIIO::ImageOutput::create(file(name));
        ASSERT_TRUE(out);
        const OIIO::ImageSpec spec(5, 4, 1, OIIO::TypeDesc::UINT16);
        std::vector<std::uint16_t> pixels(20);
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = static_cast<std::uint16_t>(1000 * i);
        ASSERT_TRUE(out->open(file(name), spec) && out->write_image(spec.format, pixels.data()) && out->close());
        check_prefixes(name);
    }
}

TEST_F(BadInput, WrongByteOrder) {
    write("a.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 1\nendian: middle\nencoding: raw\n\nabcdefgh");
    EXPECT_THAT(refusal(file("a.nrrd")), AllOf(HasSubstr("a.nrrd"), HasSubstr("endian")));
    write("b.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 1\nencoding: raw\n\nabcdefgh");
    EXPECT_THAT(refusal(file("b.nrrd")), AllOf(HasSubstr("b.nrrd"), HasSubstr("endian")));
    // A header in one byte order with dims in the other.
    write_itk(itk::NiftiImageIO::New(), file("a.nii"));
    auto bytes = content_of(file("a.nii"));
    for (int i = 0; i < 8; ++i)
        std::swap(bytes[static_cast<std::size_t>(40 + 2 * i)], bytes[static_cast<std::size_t>(41 + 2 * i)]);
    EXPECT_THAT(refusal(write("b.nii", bytes)), AllOf(HasSubstr("b.nii"), HasSubstr("axes")));
    // GIPL is big-endian only.
    write_itk(itk::GiplImageIO::New(), file("a.gipl"), {.directions = glm::dmat3(1)});
    bytes = content_of(file("a.gipl"));
    for (std::size_t i = 0; i < 4; ++i)
        std::swap(bytes[2 * i], bytes[2 * i + 1]);
    EXPECT_THAT(refusal(write("b.gipl", bytes)), HasSubstr("b.gipl"));
}

/// A header that promises more than its file contains, or more than a volume may have.
struct Lie {
    const char* name;
    const char* content;
    const char* word;  ///< part of the message
};

class LyingHeader : public BadInput, public testing::WithParamInterface<Lie> {};

/// The MiB of resident memory that refusing the file takes, at most; measured in a separate process.
long mib_to_refuse(const std::string& path, const LoadOptions& options, const std::string& word) {
    int ends[2] = {-1, -1};
    EXPECT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        rusage before{}, after{};
        getrusage(RUSAGE_SELF, &before);
        std::string message;
        try {
            (void)load_volume(path, options);
        } catch (const edgesplat::Error& error) {
            message = error.what();
        }
        getrusage(RUSAGE_SELF, &after);
        const long grown = message.find(word) == std::string::npos ? -1 : (after.ru_maxrss - before.ru_maxrss) / 1024;
        const bool told = ::write(ends[1], &grown, sizeof grown) == sizeof grown;
        ::write(STDERR_FILENO, (message + "\n").c_str(), message.size() + 1);
        _exit(told ? 0 : 1);
    }
    close(ends[1]);
    long grown = -1;
    EXPECT_EQ(read(ends[0], &grown, sizeof grown), static_cast<ssize_t>(sizeof grown));
    close(ends[0]);
    int status = 0;
    waitpid(child, &status, 0);
    return grown;
}

TEST_P(LyingHeader, IsRefusedBeforeAllocation) {
    const Lie& lie = GetParam();
    const std::string path = write(lie.name, lie.content);
    const long grown = mib_to_refuse(path, {}, lie.word);
    EXPECT_GE(grown, 0) << "refused with another message, or not refused";
    EXPECT_LT(grown, 64);
}

#define NRRD(type, sizes, rest) \
    "NRRD0004\ntype: " type "\ndimension: 3\nsizes: " sizes "\nendian: little\nencoding: " rest "\n\nabcd"
#define META(size, rest) "NDims = 3\nDimSize = " size "\nElementType = MET_FLOAT\n" rest "ElementDataFile = LOCAL\nabcd"

INSTANTIATE_TEST_SUITE_P(
    BadInput, LyingHeader,
    testing::Values(Lie{"a.nrrd", NRRD("double", "1000 1000 1000", "raw"), "8000000000"},
                    Lie{"b.nrrd", NRRD("double", "1000 1000 1000", "gzip"), "8000000000"},
                    Lie{"c.nrrd", NRRD("double", "1000 1000 1000", "bzip2"), "bzip2"},
                    Lie{"d.nrrd", NRRD("double", "9223372036854775807 9223372036854775807 2", "raw"), "at most"},
                    Lie{"e.nrrd", NRRD("double", "4294967296 4294967296 1", "raw"), "at most"},
                    Lie{"f.nrrd", NRRD("double", "18446744073709551615 1 1", "raw"), "whole number"},
                    Lie{"g.nrrd", NRRD("uint8", "1290 1290 1290", "raw"), "2146689000"},
                    Lie{"a.mha", META("1000 1000 1000", ""), "4000000000"},
                    Lie{"b.mha", META("1000 1000 1000", "CompressedData = True\n"), "4000000000"},
                    Lie{"c.mha", META("9223372036854775807 9223372036854775807 2", ""), "at most"},
                    Lie{"d.mha", META("1000 1000 1000", "ElementNumberOfChannels = 1000000000\n"), "d.mha"},
                    Lie{"a.vtk",
                        "# vtk DataFile Version 2.0\nx\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 1000 1000 1000\n"
                        "SPACING 1 1 1\nORIGIN 0 0 0\nPOINT_DATA 1000000000\nSCALARS s double\nLOOKUP_TABLE default\nx",
                        "8000000000"}),
    [](const testing::TestParamInfo<Lie>& lie) {
        std::string name = lie.param.name;
        std::replace(name.begin(), name.end(), '.', '_');
        return name;
    });

TEST_F(BadInput, RespectsTheMemoryLimit) {
    write("a.raw", std::string(std::size_t{5} << 20, 'x'));
    const LoadOptions options{.raw = "1024x1024x5:uint8:little"};
    setenv("EDGESPLAT_READ_MEMORY", "16", 1);
    EXPECT_THAT(refusal(file("a.raw"), options),
                AllOf(HasSubstr("a.raw"), HasSubstr("26 MiB"), HasSubstr("at most 16 MiB"),
                      HasSubstr("EDGESPLAT_READ_MEMORY")));
    setenv("EDGESPLAT_READ_MEMORY", "26", 1);
    EXPECT_EQ(load_volume(file("a.raw"), options).values.size(), std::size_t{5} << 20);
    for (const char* wrong : {"0", "-1", "many", "1.5", "99999999999999999999"}) {
        setenv("EDGESPLAT_READ_MEMORY", wrong, 1);
        EXPECT_THAT(refusal(file("a.raw"), options), AllOf(HasSubstr(wrong), HasSubstr("whole number of MiB")));
    }
    unsetenv("EDGESPLAT_READ_MEMORY");
}

/// The real program, with every argument that is a file; FILE is its placeholder.
class BadFile : public edgesplat::CliTest, public testing::WithParamInterface<const char*> {
  protected:
    std::string command(const std::string& name) const {
        std::string text = GetParam();
        text.replace(text.find("FILE"), 4, name);
        return text;
    }
    /// The ending that the name needs, so that this command reads the file.
    std::string extension() const {
        const std::string text = GetParam();
        const auto end = text.find("FILE") + 4;
        return text.substr(end, text.find(' ', end) - end);
    }
    void expect_refusal(const std::string& name, const std::vector<const char*>& words) const {
        const auto before = files();
        // Opening a FIFO would wait for a writer.
        const auto result = run_shell("timeout 60 '" EDGESPLAT_PROGRAM "' " + command("'" + name + "'"));
        EXPECT_GT(result.status, 0);
        EXPECT_NE(result.status, 124) << "the program waited";
        if (!std::string(GetParam()).starts_with("scene check")) {  // findings are its result, not an error
            EXPECT_THAT(result.err, StartsWith("edgesplat: error: "));
        }
        // After a wrong command line a second line refers to the help; every other error is one line.
        if (result.status == 1) {
            EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        }
        for (const char* word : words)
            EXPECT_THAT(result.err, HasSubstr(word));
        EXPECT_THAT(result.out, testing::IsEmpty());
        EXPECT_EQ(files(), before);
    }
};

TEST_P(BadFile, IsRefusedInOneLine) {
    const std::string end = extension();
    std::ofstream(folder_ / ("empty" + end)).flush();
    std::filesystem::create_directory(folder_ / ("folder" + end));
    ASSERT_EQ(mkfifo((folder_ / ("pipe" + end)).c_str(), 0600), 0);
    std::filesystem::create_symlink("loop" + end, folder_ / ("loop" + end));
    std::filesystem::create_symlink("nowhere", folder_ / ("dangling" + end));
    for (const char* name : {"empty", "folder", "pipe", "loop", "dangling", "none", "\xff\xfe none", "/dev/zero"}) {
        SCOPED_TRACE(name);
        if (*name == '/' && !end.empty()) continue;
        expect_refusal(name, {name});
    }
}

TEST_P(BadFile, IsRefusedIfUnreadable) {
    if (geteuid() == 0) GTEST_SKIP() << "root may read every file";
    const std::filesystem::path file = folder_ / ("secret" + extension());
    std::ofstream(file) << "x";
    std::filesystem::permissions(file, std::filesystem::perms::none);
    expect_refusal("secret", {"secret"});
}

INSTANTIATE_TEST_SUITE_P(BadInput, BadFile,
                         testing::Values("info FILE", "info FILE.nrrd", "info FILE.nii.gz", "info FILE.mha --json -",
                                         "info FILE.esv", "info FILE --raw 2x2x2:uint8:little", "measure FILE.nrrd",
                                         "pack FILE.nrrd -o a.esv", "render FILE.nrrd -o a.png",
                                         "render FILE.toml -o a.png", "scene check FILE.toml", "scene new FILE.nii",
                                         "movie FILE.toml -o f_%03d.png", "accuracy FILE.nrrd --report r",
                                         "rerun FILE.png -o b.png", "compare FILE.png FILE.png", "bench FILE.toml -o r",
                                         "bench standard -o r --compare FILE.json"),
                         [](const testing::TestParamInfo<const char*>& place) {
                             std::string name;
                             for (const char c : std::string(place.param))
                                 if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
                             return name;
                         });

class BadName : public edgesplat::CliTest {};

TEST_F(BadName, MayBeOtherThanUtf8) {
    const std::string name = "\xff\xfe.nrrd";
    std::ofstream(folder_ / name) << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\nabcdefgh";
    const auto plain = run("info '" + name + "'");
    EXPECT_EQ(plain.status, 0) << plain.err;
    EXPECT_THAT(plain.out, HasSubstr(name));
    const auto json = run("info '" + name + "' --json -");
    EXPECT_EQ(json.status, 0) << json.err;
    EXPECT_THAT(json.out, HasSubstr("\xef\xbf\xbd\xef\xbf\xbd.nrrd"));
}

TEST_F(BadName, IsRefusedInASceneFileIfNotUtf8) {
    const std::string name = "\xff\xfe.nrrd";
    std::ofstream(folder_ / name) << "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\nabcdefgh";
    const auto scene = run("scene new '" + name + "' -o a.toml");
    EXPECT_EQ(scene.status, 1);
    EXPECT_THAT(scene.err, AllOf(HasSubstr(name), HasSubstr("not UTF-8")));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.toml"));
    // Rendering works; the scene stored in the picture contains a UTF-8 version of the name.
    const auto picture = run("render '" + name + "' --size 8x8 -o a.png");
    EXPECT_EQ(picture.status, 0) << picture.err;
    const auto again = run("rerun a.png -o b.png");
    EXPECT_EQ(again.status, 1);
    EXPECT_THAT(again.err, HasSubstr("\xef\xbf\xbd\xef\xbf\xbd.nrrd"));
}

/// A PNG whose header claims this size, without any pixels.
std::string lying_png(std::uint32_t width, std::uint32_t height) {
    const auto number = [](std::uint32_t n) {
        std::string bytes;
        for (int shift = 24; shift >= 0; shift -= 8)
            bytes += static_cast<char>(n >> shift & 0xFF);
        return bytes;
    };
    const auto chunk = [&](const std::string& content, std::uint32_t size) {
        const auto* bytes = reinterpret_cast<const Bytef*>(content.data());
        return number(size) + content +
               number(static_cast<std::uint32_t>(crc32(0, bytes, static_cast<uInt>(content.size()))));
    };
    const std::string header = "IHDR" + number(width) + number(height) + std::string("\x08\x02\0\0\0", 5);
    return "\x89PNG\r\n\x1a\n" + chunk(header, 13) + chunk("IDAT", 0) + chunk("IEND", 0);
}

TEST_F(BadName, LyingPicturesAreRefusedBeforeAllocation) {
    std::ofstream(folder_ / "a.png", std::ios::binary) << lying_png(60000, 60000);
    for (const char* command : {"compare a.png a.png", "info a.png", "rerun a.png -o b.png"}) {
        auto result = run_shell(std::string(EDGESPLAT_OWN_ALLOCATOR ? "" : "ulimit -v 3000000; ") +
                                "'" EDGESPLAT_PROGRAM "' " + command);
        // A slow machine shows progress first.
        result.err = std::regex_replace(result.err, std::regex("\\[[.=#]*\\][^\n]*\n"), "");
        EXPECT_GT(result.status, 0);
        EXPECT_THAT(result.err, AllOf(StartsWith("edgesplat: error: "), HasSubstr("a.png")));
        EXPECT_THAT(result.err, testing::Not(HasSubstr("bad_alloc")));
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    EXPECT_THAT(files(), testing::ElementsAre("a.png"));
}

// The limit is less than half of what the header promises: an allocation before the check would give another message.
TEST_F(BadName, LyingHeadersAreRefusedUnderALimit) {
    if (EDGESPLAT_OWN_ALLOCATOR) GTEST_SKIP() << "the address sanitizer reserves more than any limit";
    std::ofstream(folder_ / "a.nrrd") << NRRD("double", "1000 1000 1000", "gzip");
    const auto result = run_shell("ulimit -v 3000000; '" EDGESPLAT_PROGRAM "' info a.nrrd");
    EXPECT_EQ(result.status, 1);
    EXPECT_THAT(result.err, AllOf(HasSubstr("8000000000"), HasSubstr("truncated"), testing::Not(HasSubstr("memory"))));
}

// Unusable preferences count as missing.
TEST_F(BadInput, IgnoresPreferencesThatAreNoRegularFiles) {
    for (const auto kind : {0, 1, 2}) {
        const auto path = folder_ / ("fly" + std::to_string(kind));
        if (kind == 0) std::filesystem::create_directory(path);
        if (kind == 1) {
            ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
        }
        if (kind == 2) std::filesystem::create_symlink(path, path);
        EXPECT_EQ(edgesplat::viewer::read_preferences(path), edgesplat::viewer::Preferences{});
    }
}

}  // namespace
