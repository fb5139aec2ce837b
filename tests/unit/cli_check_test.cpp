// `edgesplat check`, and what `edgesplat info` says of place and samples.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "tests/unit/cli_program.h"

namespace edgesplat {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class CliCheck : public CliTest {
  protected:
    void write(const std::string& name, const std::string& content) const {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << content;
    }
    template <typename T>
    static std::string bytes_of(const std::vector<T>& values) {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
    }
    /// A ramp of 4 x 3 x 2 samples of int16 as NRRD.
    static std::string nrrd(const std::string& fields = "spacings: 1 2 3\n") {
        std::vector<std::int16_t> values(24);
        for (std::size_t i = 0; i < values.size(); ++i)
            values[i] = static_cast<std::int16_t>(i);
        return "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 3 2\nendian: little\nencoding: raw\n" + fields + "\n" +
               bytes_of(values);
    }
    static nlohmann::json parsed(const std::string& text) { return nlohmann::json::parse(text); }
};

TEST_F(CliCheck, ReadsAFolderAndGoesOnAfterErrors) {
    write("study/a.nrrd", nrrd());
    write("study/deep/b.nrrd",
          nrrd("space: left-posterior-superior\nspace directions: (0,2,0) (1,0,0) (0,0,-3)\nspace origin: (1,2,3)\n"));
    write("study/broken.nrrd", nrrd().substr(0, 130));
    write("study/c.mhd",
          "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\nElementSpacing = 1 1 1\n"
          "ElementDataFile = c.raw\n");
    write("study/c.raw", std::string(24, '\1'));
    write("study/readme.txt", "no volume");
    write("study/.hidden.nrrd", nrrd());
    const ProgramRun done = run("check study --json all.json");
    EXPECT_EQ(done.status, 1);
    EXPECT_EQ(done.err, "");
    EXPECT_THAT(done.out, HasSubstr("4 volumes: 3 read, 1 refused; 1 other files ignored"));
    EXPECT_THAT(done.out, HasSubstr("REFUSED"));
    EXPECT_THAT(done.out, HasSubstr("PLA"));
    std::istringstream lines(done.out);
    for (std::string line; std::getline(lines, line);)
        EXPECT_LE(line.size(), 120U) << line;
    const auto json = parsed(text_of(folder_ / "all.json"));
    EXPECT_EQ(json["refused"], 1);
    EXPECT_EQ(json["ignored_files"], 1);
    ASSERT_EQ(json["volumes"].size(), 4U);
    EXPECT_EQ(json["volumes"][0]["path"], "study/a.nrrd");
    EXPECT_EQ(json["volumes"][0]["format"], "NRRD");
    EXPECT_EQ(json["volumes"][0]["dims"], parsed("[4,3,2]"));
    EXPECT_EQ(json["volumes"][0]["orientation"], "none");
    EXPECT_EQ(json["volumes"][1]["status"], "refused");
    EXPECT_EQ(json["volumes"][2]["format"], "MetaImage");
    EXPECT_EQ(json["volumes"][3]["orientation"], "PLI");
    EXPECT_EQ(json["volumes"][3]["range"], parsed("[0.0,23.0]"));

    EXPECT_EQ(run("check study/a.nrrd study/c.mhd").status, 0);
    EXPECT_EQ(parsed(run("check study/a.nrrd --json -").out)["volumes"].size(), 1U);
    EXPECT_EQ(run("check nothing.nrrd").status, 1);
}

TEST_F(CliCheck, InfoSaysWhereThePlaceComesFrom) {
    write("b.nrrd",
          nrrd("space: left-posterior-superior\nspace directions: (0,2,0) (1,0,0) (0,0,-3)\nspace origin: (1,2,3)\n"));
    const auto json = parsed(run("info b.nrrd --json -").out);
    EXPECT_EQ(json["format"], "NRRD");
    EXPECT_EQ(json["affine"], parsed("[[0.0,1.0,0.0,1.0],[2.0,0.0,0.0,2.0],[0.0,0.0,-3.0,3.0],[0.0,0.0,0.0,1.0]]"));
    EXPECT_EQ(json["in_patient"], true);
    EXPECT_EQ(json["no_data"], 0);
    EXPECT_TRUE(json.contains("geometry_source"));
    EXPECT_TRUE(json.contains("length_unit"));
    std::vector<float> values(24);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<float>(i);
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(values.data()), 96);
    EXPECT_EQ(std::stoul(json["samples_crc32"].get<std::string>(), nullptr, 16), crc);
    const ProgramRun text = run("info b.nrrd");
    for (const char* line : {"format      NRRD", "place       ", "patient axes (LPS)", "no data     0 samples",
                             "range       0 .. 23, mean 11.5", "CRC-32 of the samples"})
        EXPECT_THAT(text.out, HasSubstr(line));
}

TEST_F(CliCheck, ValuesUpTo1e60AreWrittenInTheFilesUnit) {
    std::vector<double> values(16 * 16 * 16);
    for (int i = 0; i < 4096; ++i)
        values[static_cast<std::size_t>(i)] =
            1e60 *
            std::exp(-0.02 * (std::pow(i % 16 - 7.5, 2) + std::pow(i / 16 % 16 - 7.5, 2) + std::pow(i / 256 - 7.5, 2)));
    write("large.raw", bytes_of(values));
    const std::string raw = "--raw 16x16x16:float64:little ";
    const auto json = parsed(run("info large.raw " + raw + "--json -").out);
    EXPECT_NEAR(json["range"][1].get<double>() / 0.985e60, 1, 1e-3);
    EXPECT_THAT(run("info large.raw " + raw).out, HasSubstr("e+59, mean "));

    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] /= 1e60;
    write("usual.raw", bytes_of(values));
    ASSERT_EQ(run("render usual.raw " + raw + "--iso .5 -o usual.png --size 64x64 --view front").status, 0);
    const ProgramRun drawn = run("render large.raw " + raw + "--iso 5e59 -o large.png --size 64x64 --view front");
    ASSERT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_EQ(run("compare usual.png large.png --max-diff 0.02 --max-share 0.002").status, 0);
    const auto measured = parsed(run("measure large.raw " + raw + "--iso 5e59 --json -").out);
    EXPECT_NEAR(measured["surfaces"][0]["iso_value"].get<double>() / 5e59, 1, 1e-6);
    EXPECT_THAT(run("render large.raw " + raw + "--iso 5e61 -o no.png").err, HasSubstr("lie between"));
    EXPECT_EQ(run("rerun large.png --check").status, 0);
}

TEST_F(CliCheck, LoadsLibrariesOnlyForFilesThatNeedThem) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "the sanitizer loads libraries itself";
#endif
    write("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 1 1\nencoding: raw\n\nabcdefgh");
    write("a.npy", std::string("\x93NUMPY\x01\x00", 8) + std::string("v\x00", 2) +
                       fmt::format("{:<117}\n", "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 2), }") +
                       "abcdefgh");
    for (const char* file : {"a.nrrd", "a.npy"}) {
        const ProgramRun info =
            run_shell(fmt::format("LD_DEBUG=files LD_DEBUG_OUTPUT=loaded '" EDGESPLAT_PROGRAM "' info {}", file));
        ASSERT_EQ(info.status, 0) << info.err;
    }
    std::string loaded;
    for (const std::string& name : files())
        if (name.starts_with("loaded")) loaded += text_of(folder_ / name);
    EXPECT_THAT(loaded, HasSubstr("libc.so"));
    for (const char* library : {"libtiff", "libgdcm", "libblosc", "libOpenImageIO", "libITK", "libvtk", "edgesplat_"})
        EXPECT_THAT(loaded, Not(HasSubstr(library)));
}

}  // namespace
}  // namespace edgesplat
