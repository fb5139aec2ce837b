// Samples without data: marked, kept by filters, in no statistics; fill values that no header declares.
#include "engine/volume/no_data.h"

#include <cmath>
#include <limits>

#include "engine/volume/filters.h"
#include "engine/volume/labels.h"
#include "engine/volume/sample_source.h"
#include "tests/unit/volume_test_files.h"

namespace {

using namespace edgesplat;
using testing::ElementsAre;
using testing::HasSubstr;

const float kMissing = std::numeric_limits<float>::quiet_NaN();

Volume no_data_volume(const glm::ivec3& dims, std::vector<float> values) {
    Volume volume;
    volume.name = "test";
    volume.geometry.dims = dims;
    volume.values = std::move(values);
    finish_volume(volume);
    return volume;
}

/// A blurred ball of 100 in 0; with `missing`, without data below a plane.
Volume ball_with(bool missing) {
    std::vector<float> values;
    for (int z = 0; z < 24; ++z)
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x) {
                const double r = glm::length(glm::dvec3(x, y, z) - 11.5);
                const auto value = static_cast<float>(50 * std::erfc((r - 7) / 1.2) + 1e-3 * (x + 3 * y));
                values.push_back(missing && z < 10 ? kMissing : value);
            }
    return no_data_volume(glm::ivec3(24), values);
}

TEST(NoData, SamplesAreMarkedAndCountInNoStatistics) {
    const Volume volume = no_data_volume({5, 1, 1}, {3, kMissing, -1, std::numeric_limits<float>::infinity(), 1});
    EXPECT_EQ(volume.non_finite_count, 2U);
    EXPECT_THAT(volume.values, ElementsAre(3, -1, -1, -1, 1));
    EXPECT_THAT(*volume.no_data, ElementsAre(false, true, false, true, false));
    EXPECT_EQ(mean_of(volume), 1);
    EXPECT_THAT(histogram(volume, 2).counts, ElementsAre(1, 2));
    EXPECT_THAT(scaled_field(volume), ElementsAre(1, kScaledNoData, 0, kScaledNoData, 0.5F));
    EXPECT_LT(kScaledNoData, 0);
    EXPECT_EQ(kScaledNoData + 1.0F, 1.0F);
}

TEST(NoData, WhichSamplesAreMissingIsInTheChecksum) {
    const Volume some = no_data_volume({3, 1, 1}, {1, 2, kMissing}), none = no_data_volume({3, 1, 1}, {1, 2, 1});
    EXPECT_EQ(some.values, none.values);
    EXPECT_NE(some.checksum, none.checksum);
    EXPECT_EQ(none.no_data, nullptr);
}

TEST(NoData, OpposedValuesHaveMeanZero) {
    std::vector<float> values;
    for (int i = 1; i < 2000; ++i) {
        values.push_back(0.1F * static_cast<float>(i));
        values.push_back(kMissing);
    }
    for (int i = 1; i < 2000; ++i)
        values.push_back(-0.1F * static_cast<float>(i));
    EXPECT_EQ(mean_of(no_data_volume({1999, 3, 1}, values)), 0);
}

TEST(NoData, IsInNoMean) {
    const Volume mean = box_filter(no_data_volume({3, 1, 1}, {kMissing, 2, 4}));
    EXPECT_EQ(mean.non_finite_count, 1U);
    EXPECT_FALSE(mean.has_data(std::size_t{0}));
    EXPECT_FLOAT_EQ(mean.at(1, 0, 0), 3);
    EXPECT_FLOAT_EQ(mean.at(2, 0, 0), 10 / 3.0F);
}

TEST(NoData, ThresholdCropAndLevelsKeepIt) {
    std::vector<float> values;
    for (int i = 0; i < 64; ++i)
        values.push_back(i % 4 == 3 || i < 8 ? kMissing : static_cast<float>(i));
    const Volume volume = no_data_volume(glm::ivec3(4), values);
    const Volume binary = threshold(volume, 30);
    EXPECT_EQ(*binary.no_data, *volume.no_data);
    EXPECT_EQ(binary.max_value, 1);
    const Volume part = cropped(volume, {2, 0, 0}, {3, 1, 1});
    EXPECT_THAT(*part.no_data, ElementsAre(true, true, true, true, false, true, false, true));
    const Volume half = halved(volume);
    // Of the eight samples of its first voxel, four contain data; of the second, two.
    EXPECT_TRUE(half.has_data(std::size_t{0}));
    EXPECT_FALSE(half.has_data(std::size_t{1}));
    EXPECT_FLOAT_EQ(half.at(0, 0, 0), (16 + 17 + 20 + 21) / 4.0F);
    const auto source = source_of(std::make_shared<const Volume>(volume), 0);
    EXPECT_FALSE(source->range({0, 0, 0}, {2, 2, 2}).complete);
    EXPECT_TRUE(source->range({0, 0, 1}, {3, 2, 2}).complete);
}

TEST(NoData, IsNoSurfaceForSuggestions) {
    const auto whole = suggest_iso_values(ball_with(false)), part = suggest_iso_values(ball_with(true));
    ASSERT_FALSE(whole.empty());
    ASSERT_FALSE(part.empty());
    EXPECT_NEAR(part.front().value, whole.front().value, 5);
}

TEST(NoData, IsDeclaredByValue) {
    const auto declared = [](std::vector<float> values, double value) {
        Volume volume = no_data_volume({static_cast<int>(values.size()), 1, 1}, values);
        const std::size_t count = declare_no_data(volume, value);
        finish_volume(volume);
        EXPECT_EQ(volume.non_finite_count, count);
        return count;
    };
    EXPECT_EQ(declared({1, 2, -9999, 3, -9999}, -9999), 2U);
    EXPECT_EQ(declared({1, 2, 9.96921e36F, 3}, 9.97e36), 1U);  // as messages round it
    EXPECT_EQ(declared({1, 2, 1000, 1000.5F}, 1000.2), 0U);    // either of two
    EXPECT_EQ(declared({1, 2, 3}, 7), 0U);
}

TEST(NoData, IsDeclaredForAFile) {
    std::vector<float> values(1000);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = i % 10 == 0 ? -9999 : static_cast<float>(i % 97);
    struct Folder : volume_test::FolderTest {
        using FolderTest::SetUp;
        using FolderTest::TearDown;
        void TestBody() override {}
        using FolderTest::write;
    } folder;
    folder.SetUp();
    const std::string path = folder.write("a.raw", {reinterpret_cast<const char*>(values.data()), 4 * values.size()});
    LoadOptions options;
    options.raw = "10x10x10:float32:little";
    const Volume noticed = load_volume(path, options);
    EXPECT_EQ(noticed.min_value, -9999);
    EXPECT_THAT(noticed.warnings, ElementsAre("100 samples are -9999, far from the rest (0 to 96). If they contain no "
                                              "data, give --no-data -9999."));
    EXPECT_EQ(noticed.format, "raw data");
    options.no_data = -9999;
    const Volume declared = load_volume(path, options);
    EXPECT_EQ(declared.min_value, 0);
    EXPECT_EQ(declared.non_finite_count, 100U);
    EXPECT_THAT(declared.warnings, testing::IsEmpty());
    EXPECT_THAT(declared.notes, testing::Contains("100 of 1000 samples contain no data."));
    options.no_data = -1;
    EXPECT_THAT(load_volume(path, options).warnings, testing::Contains("--no-data -1: no sample has this value."));
    folder.TearDown();
}

TEST(NoData, UndeclaredFillValuesAreNoticed) {
    const auto noticed = [](float low, float high, std::vector<float> fills, int copies = 5) {
        std::vector<float> values;
        for (int i = 0; i < 200; ++i)
            values.push_back(low + (high - low) * static_cast<float>(i % 40) / 39);
        for (const float fill : fills)
            values.insert(values.end(), static_cast<std::size_t>(copies), fill);
        std::vector<float> found;
        const int count = static_cast<int>(values.size());
        for (const auto& fill : suspected_fill(no_data_volume({count, 1, 1}, std::move(values))))
            found.push_back(fill.value);
        return found;
    };
    const float most = std::numeric_limits<float>::max();
    for (const float fill : {9.96921e36F, 1e20F, -1e30F, -3.4e38F, most, -most, -32768.0F, 65535.0F, -9999.0F})
        EXPECT_THAT(noticed(0, 1000, {fill}), ElementsAre(fill));
    EXPECT_THAT(noticed(-1024, 3071, {-32768}), ElementsAre(-32768));
    EXPECT_THAT(noticed(0, 8848, {-9999}), ElementsAre(-9999));
    EXPECT_THAT(noticed(270, 310, {-most, most}), ElementsAre(-most, most));
    EXPECT_THAT(noticed(0, 1, {-500}), ElementsAre(-500));           // no usual number, but very far
    EXPECT_THAT(noticed(0, 1000, {-2000}), ElementsAre());           // not far enough
    EXPECT_THAT(noticed(0, 1000, {9.96921e36F}, 2), ElementsAre());  // too few
    EXPECT_THAT(noticed(5000, 5010, {0}), ElementsAre());            // background
    EXPECT_THAT(noticed(-1024, 3071, {}), ElementsAre());
    EXPECT_THAT(suspected_fill(no_data_volume({6, 1, 1}, {0, 1, 0, 255, 255, 255})), testing::IsEmpty());  // a mask
}

TEST(NoData, CaseOfNaN) {
    const char* folder = std::getenv("EDGESPLAT_DATA");
    const std::string path = std::string(folder != nullptr ? folder : "") + "/odd/cases/nrrd/nan.nrrd";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not there (EDGESPLAT_DATA)";
    const Volume volume = load_volume(path);
    EXPECT_EQ(volume.non_finite_count, 65872U);
    EXPECT_EQ(mean_of(volume), 0);
}

}  // namespace
