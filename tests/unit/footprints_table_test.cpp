#include "footprints/footprint_table.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "footprints/footprint_cache.h"
#include "tests/unit/footprints_samples.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;
using samples::Errors;
using samples::rays;
using testing::HasSubstr;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(FootprintTable, AgreesWithTheExactIntegral) {
    for (const EdgeBand& band : {EdgeBand{1.3, 8}, EdgeBand{1.3, 16}, EdgeBand{}}) {
        const double reach = kKernelRadius + band.half_width;
        const auto start = std::chrono::steady_clock::now();
        const FootprintTable table = FootprintTable::build(band);
        const double build_seconds = seconds_since(start);
        Errors lerp, nearest;
        for (const auto& [d, ray] : rays(20000, -reach, reach, 10)) {
            const double truth = exact_footprint(ray, Edge{d, band});
            lerp.add(table.lerp(ray, d), truth);
            nearest.add(table.nearest(ray, d), truth);
        }
        const std::string at = fmt::format("_a{}_k{}", band.half_width, band.strength);
        RecordProperty("lerp_max_percent" + at, std::to_string(100 * lerp.largest()));
        RecordProperty("lerp_p99_percent" + at, std::to_string(100 * lerp.percentile(99)));
        RecordProperty("nearest_max_percent" + at, std::to_string(100 * nearest.largest()));
        RecordProperty("build_seconds" + at, std::to_string(build_seconds));
        EXPECT_LE(lerp.largest(), 0.01) << at;
        EXPECT_LE(lerp.percentile(99), 0.003) << at;
        EXPECT_LE(nearest.largest(), 0.04) << at;
        EXPECT_LE(table.texels().size_bytes(), 64u << 20);
    }
}

TEST(FootprintTable, HoldsForExtremeBandsToo) {
    for (const EdgeBand& band : {EdgeBand{0.3, 30}, EdgeBand{3, 12}, EdgeBand{1.3, 1}}) {
        const FootprintTable table = FootprintTable::build(band);
        Errors errors;
        const double reach = kKernelRadius + band.half_width;
        for (const auto& [d, ray] : rays(4000, -reach, reach, 11))
            errors.add(table.lerp(ray, d), exact_footprint(ray, Edge{d, band}));
        EXPECT_LE(errors.largest(), band.strength == 1 ? 1e-4 : 0.03) << band.half_width << " " << band.strength;
    }
}

TEST(FootprintTable, IsPlainOutOfReachAndContinuousThere) {
    const FootprintTable table = FootprintTable::build({1.3, 12});
    for (const auto& [d, ray] : rays(500, 2.9, 5, 12)) {
        EXPECT_EQ(table.lerp(ray, d), kernel_footprint(ray.rho2));
        EXPECT_EQ(table.nearest(ray, -d), kernel_footprint(ray.rho2));
        EXPECT_NEAR(table.lerp(ray, 2.8999), kernel_footprint(ray.rho2), 1e-3);
    }
}

TEST(FootprintTable, DoesNotDependOnTheNumberOfThreads) {
    const FootprintTableSize size = {16, 8, 9, 7};
    const FootprintTable one = FootprintTable::build({1.3, 12}, size, 1),
                         three = FootprintTable::build({1.3, 12}, size, 3);
    EXPECT_TRUE(std::ranges::equal(one.texels(), three.texels()));
}

TEST(FootprintTable, RefusesWhatIsOutOfRange) {
    EXPECT_THROW(FootprintTable::build({0, 12}), std::invalid_argument);
    EXPECT_THROW(FootprintTable::build({1.3, std::nan("")}), std::invalid_argument);
    EXPECT_THROW(FootprintTable::build({1.3, 100}), std::invalid_argument);
    EXPECT_THROW(FootprintTable::build({1.3, 12}, {64, 24, 64, 64}), std::invalid_argument);
    EXPECT_THROW(FootprintTable::build({1.3, 12}, {1, 24, 4, 4}), std::invalid_argument);
    EXPECT_THROW(FootprintTable({1.3, 12}, {4, 4, 4, 4}, {}), std::invalid_argument);
}

TEST(Half, RoundsToNearestEven) {
    EXPECT_EQ(half_from_float(0.0f), 0x0000);
    EXPECT_EQ(half_from_float(1.0f), 0x3c00);
    EXPECT_EQ(half_from_float(-0.75f), 0xba00);
    EXPECT_EQ(half_from_float(1.00048828125f), 0x3c00);  // half way between two: the even one
    EXPECT_EQ(half_from_float(1.00146484375f), 0x3c02);
    EXPECT_EQ(half_from_float(5.9604644775390625e-8f), 0x0001);  // the smallest subnormal
    for (int bits = 0; bits < 0x7c00; ++bits)
        ASSERT_EQ(half_from_float(float_from_half(static_cast<std::uint16_t>(bits))), bits);
}

class FootprintCache : public testing::Test {
  protected:
    FootprintCache() {
        std::string name = (fs::temp_directory_path() / "edgesplat-cache-XXXXXX").string();
        folder_ = mkdtemp(name.data());
    }
    ~FootprintCache() override { fs::remove_all(folder_); }

    LoadedFootprintTable load() const { return load_footprint_table(band_, size_, folder_ / "new"); }
    fs::path file() const { return footprint_cache_file(folder_ / "new", band_, size_); }
    void expect_rebuilt(const std::string& reason) const {
        const LoadedFootprintTable first = load();
        EXPECT_FALSE(first.from_cache);
        EXPECT_THAT(first.warning, HasSubstr(reason));
        const LoadedFootprintTable second = load();
        EXPECT_TRUE(second.from_cache);
        EXPECT_EQ(second.warning, "");
        EXPECT_TRUE(std::ranges::equal(second.table.texels(), FootprintTable::build(band_, size_).texels()));
    }
    void overwrite(std::streamoff at, char byte) const {
        std::fstream out(file(), std::ios::binary | std::ios::in | std::ios::out);
        out.seekp(at);
        out.put(byte);
    }

    fs::path folder_;
    EdgeBand band_ = {1.3, 12};
    FootprintTableSize size_ = {16, 8, 9, 7};
};

TEST_F(FootprintCache, IsWrittenOnceAndThenRead) {
    expect_rebuilt("");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), {}), 1);
}

TEST_F(FootprintCache, DamageIsNoticedAndRepaired) {
    load();
    overwrite(300, 'x');
    expect_rebuilt("damaged");
    overwrite(8, 99);  // the version
    expect_rebuilt("not a footprint table of this version");
    fs::resize_file(file(), fs::file_size(file()) - 2);
    expect_rebuilt("damaged");
    fs::resize_file(file(), fs::file_size(file()) + 2);
    expect_rebuilt("damaged");
    fs::resize_file(file(), 10);
    expect_rebuilt("not a footprint table");
    fs::resize_file(file(), 0);
    expect_rebuilt("not a footprint table");
}

TEST_F(FootprintCache, FilesOfOtherParametersHaveOtherNamesAndAreNotTaken) {
    const fs::path other = footprint_cache_file(folder_ / "new", {1.3, 12.000001}, size_);
    EXPECT_NE(other, file());
    load_footprint_table({1.3, 12.000001}, size_, folder_ / "new");
    fs::rename(other, file());
    expect_rebuilt("these parameters");
}

TEST_F(FootprintCache, AFolderThatCannotBeWrittenOnlyWarns) {
    std::ofstream(folder_ / "file") << "in the way";
    const LoadedFootprintTable loaded = load_footprint_table(band_, size_, folder_ / "file" / "below");
    EXPECT_FALSE(loaded.from_cache);
    EXPECT_THAT(loaded.warning, HasSubstr("not cached"));
    EXPECT_THAT(load_footprint_table(band_, size_, {}).warning, HasSubstr("not cached"));
    fs::create_directories(file());  // a folder where the file should be
    EXPECT_FALSE(load().from_cache);
    EXPECT_THAT(load().warning, HasSubstr("not cached"));
}

TEST_F(FootprintCache, ManyMayLoadAtOnce) {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([this] {
            for (int j = 0; j < 5; ++j)
                EXPECT_EQ(load().warning, "");
        });
    threads.clear();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "new"), {}), 1);
    EXPECT_TRUE(load().from_cache);
}

TEST_F(FootprintCache, TheDefaultTableIsReadAsItWasBuilt) {
    const LoadedFootprintTable built = load_footprint_table(band_, {}, folder_);
    EXPECT_FALSE(built.from_cache);
    const auto start = std::chrono::steady_clock::now();
    const LoadedFootprintTable read = load_footprint_table(band_, {}, folder_);
    RecordProperty("load_milliseconds", std::to_string(1e3 * seconds_since(start)));
    EXPECT_TRUE(read.from_cache);
    EXPECT_TRUE(std::ranges::equal(read.table.texels(), built.table.texels()));
}

TEST(FootprintCacheFolder, FollowsTheEnvironment) {
    const auto restore = [](const char* name) {
        const char* value = std::getenv(name);
        return std::pair(std::string(name), std::string(value ? value : ""));
    };
    const std::pair<std::string, std::string> before[] = {restore("EDGESPLAT_CACHE"), restore("XDG_CACHE_HOME"),
                                                          restore("HOME")};
    setenv("EDGESPLAT_CACHE", "/a", 1);
    setenv("XDG_CACHE_HOME", "/b", 1);
    setenv("HOME", "/c", 1);
    EXPECT_EQ(footprint_cache_folder(), "/a");
    unsetenv("EDGESPLAT_CACHE");
    EXPECT_EQ(footprint_cache_folder(), "/b/edgesplat");
    unsetenv("XDG_CACHE_HOME");
    EXPECT_EQ(footprint_cache_folder(), "/c/.cache/edgesplat");
    unsetenv("HOME");
    EXPECT_TRUE(footprint_cache_folder().empty());
    for (const auto& [name, value] : before) {
        if (!value.empty()) setenv(name.c_str(), value.c_str(), 1);
    }
}

}  // namespace
}  // namespace edgesplat
