// Recognition of segmentations (label volumes).
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "engine/error.h"
#include "engine/volume/filters.h"
#include "engine/volume/label_names.h"
#include "engine/volume/labels.h"
#include "engine/volume/sample_source.h"
#include "engine/volume/smooth_labels.h"

namespace {

using edgesplat::Volume;

/// The values of the recognised labels; empty if the volume is no segmentation.
std::vector<float> numbers_of_labels(const Volume& volume) {
    std::vector<float> values;
    if (const auto table = edgesplat::labels_of(volume))
        for (const edgesplat::Label& label : table->labels)
            values.push_back(label.value);
    return values;
}

edgesplat::Volume sampled(const std::function<double(const glm::dvec3&)>& value) {
    edgesplat::Volume volume;
    volume.geometry.dims = {40, 30, 20};
    for (int z = 0; z < 20; ++z)
        for (int y = 0; y < 30; ++y)
            for (int x = 0; x < 40; ++x)
                volume.values.push_back(static_cast<float>(value({x, y, z})));
    finish_volume(volume);
    return volume;
}

/// Two organs, one embedded in the side of the other, and a thin one.
double organ(const glm::dvec3& p) {
    if (glm::distance(p, {15, 15, 10}) < 5) return 7;
    if (glm::distance(p, {20, 15, 10}) < 9) return 3;
    return std::abs(p.x - 35) < 1 ? 250 : 0;
}

TEST(Labels, AreFewWholeNumbersWithoutPartialVolume) {
    EXPECT_EQ(numbers_of_labels(sampled(organ)), (std::vector<float>{0, 3, 7, 250}));
    EXPECT_EQ(numbers_of_labels(sampled([](const glm::dvec3& p) { return organ(p) == 3 ? 1 : 0; })),
              (std::vector<float>{0, 1}))
        << "a mask";
}

TEST(Labels, RejectsMeasuredValues) {
    const auto blurred = [](const glm::dvec3& p) {
        double sum = 0;
        for (int i = 0; i < 27; ++i)
            sum += organ(p + glm::dvec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1));
        return sum / 27;
    };
    EXPECT_TRUE(numbers_of_labels(sampled(blurred)).empty()) << "fractions";
    EXPECT_TRUE(numbers_of_labels(sampled([&](const glm::dvec3& p) { return std::round(blurred(p)); })).empty())
        << "partial volume, in whole numbers";
    EXPECT_TRUE(numbers_of_labels(sampled([](const glm::dvec3&) { return 4; })).empty()) << "constant";
    EXPECT_TRUE(numbers_of_labels(sampled([](const glm::dvec3& p) { return p.x + 40 * p.y; })).empty())
        << "many values";
}

/// Cells of 4^3 voxels with a number each, in no order, and a background around them.
double cell(const glm::dvec3& p) {
    const glm::ivec3 c = glm::ivec3(p) / 4;
    if (c.x == 0 || c.y == 0 || c.z == 0 || p.z > 17) return 0;
    const int place = c.x + 10 * (c.y + 8 * c.z);
    return 1 + place * 577 % 1009;
}

TEST(Labels, MayBeMany) {
    const std::vector<float> cells = numbers_of_labels(sampled(cell));
    EXPECT_GT(cells.size(), 190U);
    EXPECT_EQ(cells.front(), 0);
    // A measurement that was enlarged without interpolation has no transitions either.
    const auto enlarged = [](const glm::dvec3& p) {
        const glm::dvec3 q = glm::floor(p / 2.0);
        return std::round(500 + 400 * std::sin(q.x / 7) + 90 * q.y + 17 * q.z);
    };
    EXPECT_TRUE(numbers_of_labels(sampled(enlarged)).empty());
}

TEST(Labels, AreDrawnAsMask) {
    const Volume raw = sampled(organ), drawn = edgesplat::drawn_labels(raw);
    ASSERT_TRUE(drawn.shown_labels && drawn.labels);
    const auto label = [&](const Volume& volume, const glm::ivec3& p) {
        const glm::ivec3 dims = volume.geometry.dims;
        const std::uint32_t number =
            volume.shown_labels->at[static_cast<std::size_t>(p.x + dims.x * (p.y + dims.y * p.z))];
        return number == 0 ? 0.0F : volume.labels->labels[number - 1].value;
    };
    for (const glm::ivec3& p : {glm::ivec3(0), glm::ivec3(22, 15, 10), glm::ivec3(15, 15, 10), glm::ivec3(35, 1, 10)}) {
        EXPECT_EQ(label(drawn, p), raw.at(p.x, p.y, p.z));
        EXPECT_EQ(drawn.at(p.x, p.y, p.z) > 0.5F, raw.at(p.x, p.y, p.z) > 0);
    }
    EXPECT_EQ(drawn.shown_labels->largest.size(), 3U);
    EXPECT_EQ(drawn.labels->labels[drawn.shown_labels->largest.front() - 1].value, 3);
    // Crops and coarser levels keep their labels; a hidden one is part of the background.
    const Volume part = cropped(drawn, {10, 10, 5}, {30, 20, 15});
    EXPECT_EQ(label(part, {5, 5, 5}), 7);
    EXPECT_EQ(label(halved(drawn), {7, 7, 5}), 7);
    const Volume without = edgesplat::drawn_labels(raw, drawn.labels, {false, true, false, true});
    EXPECT_LT(without.at(15, 15, 10), 0.5F);
    EXPECT_EQ(label(without, {22, 15, 10}), 3);
    EXPECT_THROW(edgesplat::drawn_labels(raw, drawn.labels, {false, false, false, false}), edgesplat::Error);
    EXPECT_THROW(edgesplat::drawn_labels(sampled([](const glm::dvec3& p) { return p.x / 3; })), edgesplat::Error);
}

/// Labels 0 and 1.
Volume drawn_mask(bool (*inside)(const glm::dvec3&)) {
    Volume volume;
    volume.geometry.dims = glm::ivec3(31);
    for (int z = 0; z < 31; ++z)
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 31; ++x)
                volume.values.push_back(inside(glm::dvec3(x, y, z)) ? 1.0F : 0.0F);
    finish_volume(volume);
    auto table = std::make_shared<edgesplat::LabelTable>();
    table->labels = {{0, 0, {}, {}}, {1, 1, {}, {}}};
    return edgesplat::drawn_labels(volume, table, {false, true});
}

TEST(Labels, KeepEveryVoxelOnItsSide) {
    // Noise: sheets, strands, specks and gaps of one voxel.
    const auto noise = [](const glm::dvec3& p) {
        const auto word = static_cast<std::uint32_t>(p.x + 31 * (p.y + 31 * p.z)) * 2654435761U;
        return (word >> 16 & 3U) == 0;
    };
    const Volume drawn = drawn_mask(noise);
    for (int z = 0; z < 31; ++z)
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x < 31; ++x) {
                const float sample = drawn.at(x, y, z);
                ASSERT_EQ(sample > 0.5F, noise(glm::dvec3(x, y, z))) << x << ' ' << y << ' ' << z;
                ASSERT_GE(std::abs(sample - 0.5F) * 2 * edgesplat::kLabelReach, 0.049F);
            }
}

/// Distance from the surface, voxels, of a sample.
double depth(const Volume& mask, const glm::ivec3& p) {
    return 2 * edgesplat::kLabelReach * (static_cast<double>(mask.at(p.x, p.y, p.z)) - 0.5);
}

TEST(Labels, KeepTheirThickness) {
    const Volume sheet = drawn_mask([](const glm::dvec3& p) { return p.x == 15; });
    const double inside = depth(sheet, {15, 15, 15}), beside = depth(sheet, {14, 15, 15});
    EXPECT_NEAR(2 * inside / (inside - beside), 1, 0.05);
    const Volume strand = drawn_mask([](const glm::dvec3& p) { return p.x == p.y && std::abs(p.z - p.x) < 0.1; });
    EXPECT_NEAR(depth(strand, {15, 15, 15}), 0.3, 1e-5);
    // A plane between voxels is where it is, and samples are distances from it.
    const Volume half = drawn_mask([](const glm::dvec3& p) { return p.x < 15; });
    for (int x = 13; x < 17; ++x)
        EXPECT_NEAR(depth(half, {x, 15, 15}), 14.5 - x, 0.01) << x;
}

TEST(Labels, OnBothSidesHaveOneSurface) {
    const auto inside = [](const glm::dvec3& p) { return std::cos(p.x * p.x + 3 * p.y + p.y * p.z) > 0.3; };
    const auto outside = [](const glm::dvec3& p) { return !(std::cos(p.x * p.x + 3 * p.y + p.y * p.z) > 0.3); };
    const Volume one = drawn_mask(inside), other = drawn_mask(outside);
    for (int i = 0; i < 31 * 31; ++i)
        EXPECT_NEAR(depth(one, {i % 31, i / 31, 11}), -depth(other, {i % 31, i / 31, 11}), 1e-4);
}

TEST(Labels, AreBallsInsteadOfStairs) {
    constexpr double kRadius = 11.3;
    const glm::dvec3 middle(15.2, 14.7, 15.1);
    const Volume ball =
        drawn_mask([](const glm::dvec3& p) { return glm::distance(p, glm::dvec3(15.2, 14.7, 15.1)) < kRadius; });
    double off = 0, off_of_mask = 0;
    int count = 0;
    for (int z = 0; z < 31; ++z)
        for (int y = 0; y < 31; ++y)
            for (int x = 0; x + 1 < 31; ++x) {
                const auto a = static_cast<double>(ball.at(x, y, z)), b = static_cast<double>(ball.at(x + 1, y, z));
                if ((a > 0.5) == (b > 0.5)) continue;
                const auto away = [&](double at) { return glm::distance(glm::dvec3(x + at, y, z), middle) - kRadius; };
                off += std::pow(away((0.5 - a) / (b - a)), 2);
                off_of_mask += std::pow(away(0.5), 2);
                ++count;
            }
    EXPECT_GT(count, 600);
    EXPECT_LT(std::sqrt(off / count), 0.065);
    EXPECT_GT(std::sqrt(off_of_mask / count), 0.18);
}

TEST(Labels, HaveZeroAsBackgroundIfItIsAtTheSides) {
    const Volume full = sampled([](const glm::dvec3& p) { return p.x < 2 ? 0 : p.x < 30 ? 4 : 9; });
    EXPECT_EQ(edgesplat::background_label(full, *edgesplat::labels_of(full)), 0U);
    const Volume other = sampled([](const glm::dvec3& p) { return organ(p) == 0 ? 4 : -10 * organ(p); });
    const auto table = edgesplat::labels_of(other);
    EXPECT_EQ(table->labels[edgesplat::background_label(other, *table)].value, 4);
    EXPECT_EQ(table->number_of(table->labels.front()), "-2500");
}

TEST(Labels, BesideVoxelsCount) {
    std::vector<std::uint32_t> labels(1000, 0);
    labels[555] = 3;
    labels[557] = 4;
    const glm::ivec3 dims(10);
    edgesplat::ShownLabels shown{.at = labels, .largest = {}};
    EXPECT_EQ(edgesplat::label_near(shown, dims, {5, 5, 5}), 3U);
    EXPECT_EQ(edgesplat::label_near(shown, dims, {4, 5, 5}), 3U);
    EXPECT_EQ(edgesplat::label_near(shown, dims, {8, 5, 5}), 4U);
    EXPECT_EQ(edgesplat::label_near(shown, dims, {9, 7, 7}), 4U);
    EXPECT_EQ(edgesplat::label_near(shown, dims, {0, 0, 0}), 0U);
    shown.on_scan = true;
    EXPECT_EQ(edgesplat::label_near(shown, dims, {4, 6, 6}), 3U);
    EXPECT_EQ(edgesplat::label_near(shown, dims, {3, 5, 5}), 0U);
}

struct Named {
    std::uint64_t id;
    std::string name;
    bool has_color = true;
};

void expect_names(std::string_view text, const std::vector<Named>& expected) {
    const std::vector<edgesplat::Label> labels = edgesplat::parse_label_names(text, "table");
    ASSERT_EQ(labels.size(), expected.size()) << text;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        EXPECT_EQ(labels[i].id, expected[i].id) << text;
        EXPECT_EQ(labels[i].name, expected[i].name) << text;
        EXPECT_EQ(labels[i].color.has_value(), expected[i].has_color) << text;
    }
}

TEST(LabelNames, ComeFromTablesOfOtherPrograms) {
    expect_names("# Color table file\n0 background 0 0 0 0\n1 left lung 221 130 101 255\n3 tissue_2 0 151 206\n",
                 {{0, "background"}, {1, "left lung"}, {3, "tissue_2"}});
    expect_names("\xef\xbb\xbf# ITK-SnAP\r\n  0  0 0 0  0 0 0 \"Clear Label\"\r\n 2 255 0 0 0.5 1 1 \"Label 2\"\r\n",
                 {{0, "Clear Label"}, {2, "Label 2"}});
    expect_names("#No. Label Name: R G B A\n10  Left-Thalamus-Proper  0 118 14 0\n", {{10, "Left-Thalamus-Proper"}});
    expect_names(
        "id,atlas_id,name,acronym,color_hex_triplet\n997,-1,root,root,FFFFFF\n"
        "312782546,1049,\"Visual area, layer 1\",VISa1,09F68\n18446744073709551615,1,last,l,\n",
        {{997, "root"}, {312782546, "Visual area, layer 1"}, {18446744073709551615ULL, "last", false}});
    expect_names("label\tname\tr\tg\tb\n-1\tgap\t1\t2\t3\n", {{18446744073709551615ULL, "gap"}});
    expect_names("1 a 0 0 0\n1 b 0 0 0\n", {{1, "a"}});
    const auto labels = edgesplat::parse_label_names("7 spleen 255 128 0 255\n", "table");
    EXPECT_NEAR(labels[0].color->x, 1, 1e-9);
    EXPECT_NEAR(labels[0].color->y, 0.2159, 1e-4);
    edgesplat::LabelTable table;
    table.labels = {{7, 7, {}, {}}, {8, 8, "own", {}}};
    const auto named = with_names(table, labels);
    EXPECT_EQ(named.labels[0].name, "spleen");
    EXPECT_EQ(named.labels[1].name, "own");
}

TEST(LabelNames, RefuseOtherTexts) {
    for (const char* text :
         {"", "# nothing\n", "hello\n", "1 lung\n", "1 lung 300 0 0\n", "x lung 3 0 0\n", "a,b\n1,2\n",
          "id,name\nx,y\n", "id,name\n1\n", "99999999999999999999 big 0 0 0\n", "1 lung 1 2\n"})
        EXPECT_THROW(edgesplat::parse_label_names(text, "table"), edgesplat::Error) << text;
    // Damaged tables are read or refused.
    const std::string whole = "id,name,color_hex_triplet\n1,\"a \"\"b\"\"\",ff00ff\n2,c,00\n";
    std::uint32_t seed = 1;
    for (int i = 0; i < 3000; ++i) {
        std::string damaged = i % 2 == 0 ? whole : "1 a b 3 4 5 6\n2 5 6 7 1 1 1 \"q r\"\n";
        for (int k = 0; k < 3; ++k) {
            seed = seed * 1664525 + 1013904223;
            damaged[(seed >> 8) % damaged.size()] = static_cast<char>(seed >> 24);
        }
        try {
            edgesplat::parse_label_names(std::string_view(damaged).substr(0, (seed >> 4) % damaged.size()), "table");
        } catch (const edgesplat::Error&) {
        }
    }
}

}  // namespace
