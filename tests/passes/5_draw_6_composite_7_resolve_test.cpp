// Passes 5, 6 and 7 against the reference; each gets the output of the device's previous pass.
#include <algorithm>
#include <cmath>

#include "engine/reference/6_composite_sheet.h"
#include "engine/reference/7_resolve.h"
#include "engine/reference/footprints.h"
#include "tests/passes/pass_fixture.h"

namespace edgesplat::test {
namespace {

constexpr glm::ivec2 kSheetSize{72, 64};
constexpr std::size_t kPixels = static_cast<std::size_t>(kSheetSize.x) * kSheetSize.y;

/// Thick sheets: all are in one group, and still on the device after the frame.
PassScene in_one_group(PassScene s, FootprintMode mode, WarpFamily warp) {
    s.settings.sheet_spacing = 6;
    s.settings.footprints = mode;
    s.settings.warp = warp;
    s.settings.saturation = 1;
    return s;
}

struct SheetVariant {
    FootprintMode mode;
    WarpFamily warp;
};

class DrawSplats : public NeedsLayers<testing::TestWithParam<SheetVariant>> {};

TEST_P(DrawSplats, SheetsAgreeWithTheReference) {
    for (PassScene s : pass_scenes()) {
        s = in_one_group(s, GetParam().mode, GetParam().warp);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto [records, sheets, rect] = drawn_sheets(state, s, kSheetSize);
        ASSERT_EQ(state.plan().params.group_count, 1U);
        const auto sheet_of = download<std::uint32_t>(state, state.targets().sheet_of, records.size());

        const Oracle oracle(s, records, kSheetSize);
        double peak = 0, worst = 0;
        for (std::uint32_t sheet = 0; sheet < state.plan().params.sheet_count; ++sheet) {
            std::vector<std::uint32_t> splats;
            for (std::uint32_t i = 0; i < records.size(); ++i) {
                if (sheet_of[i] == sheet) splats.push_back(i);
            }
            std::vector<glm::dvec4> want(kPixels, glm::dvec4(0));
            oracle.drawer.draw(splats, reference::Payload::Color, {}, want);
            for (std::size_t i = 0; i < kPixels; ++i) {
                const int x = static_cast<int>(i) % kSheetSize.x, y = static_cast<int>(i) / kSheetSize.x;
                // Outside the group's rectangle the sheets are neither cleared nor read.
                const bool inside = x >= rect.x && x < rect.z && y >= rect.y && y < rect.w;
                const glm::dvec4 got = inside ? glm::dvec4(sheets[sheet * kPixels + i]) : glm::dvec4(0);
                peak = std::max(peak, want[i].a);
                for (int c = 0; c < 4; ++c)
                    worst = std::max(worst, std::abs(got[c] - want[i][c]));
            }
        }
        // A sheet adds some tens of float32 splats. The device blends table layers, possibly in steps of 1/256. The
        // paper's map has an infinite slope at its knots, which amplifies rounding: 4.4e-5 on lavapipe, 5.6e-5 on a
        // GPU.
        const auto mode = GetParam().mode;
        const double good_to = mode == FootprintMode::Table ? 5e-4 : mode == FootprintMode::Warp2d ? 1e-4 : 5e-5;
        EXPECT_GT(peak, 0.5);
        EXPECT_LE(worst, good_to * peak) << "peak " << peak;
        RecordProperty("worst_of_peak_" + std::string(s.name), std::to_string(worst / peak));
    }
}

INSTANTIATE_TEST_SUITE_P(All, DrawSplats,
                         testing::Values(SheetVariant{FootprintMode::Isotropic, WarpFamily::Paper},
                                         SheetVariant{FootprintMode::Warp2d, WarpFamily::Paper},
                                         SheetVariant{FootprintMode::Procedural, WarpFamily::Paper},
                                         SheetVariant{FootprintMode::Table, WarpFamily::Face}),
                         [](const auto& test) { return std::string(name_of(test.param.mode)); });

class DrawSlices : public NeedsLayers<testing::TestWithParam<SheetVariant>> {};

TEST_P(DrawSlices, SheetsAgreeWithTheReference) {
    // The reference inverts the paper's cosine iteratively, which takes seconds: one scene is enough.
    const bool paper = GetParam().mode != FootprintMode::Isotropic;
    for (const std::size_t number : paper ? std::vector<std::size_t>{2} : std::vector<std::size_t>{0, 1, 2}) {
        PassScene s = in_one_group(pass_scenes()[number], GetParam().mode, GetParam().warp);
        s.settings.sheets = SheetCut::Sliced;
        s.settings = canonical_settings(s.settings);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        const auto [records, sheets, rect] = drawn_sheets(state, s, kSheetSize);
        ASSERT_EQ(state.plan().params.group_count, 1U);
        const auto sheet_of = download<std::uint32_t>(state, state.targets().sheet_of, records.size());

        const Oracle oracle(s, records, kSheetSize);
        const int reference_base =
            reference::sheets_of(records, oracle.field, oracle.view, s.settings, oracle.footprints).first();
        const double thickness = reference::sheet_thickness(oracle.view, s.settings);
        double peak = 0, worst = 0;
        for (std::uint32_t sheet = 0; sheet < state.plan().params.sheet_count; ++sheet) {
            std::vector<std::uint32_t> splats;
            for (std::uint32_t i = 0; i < records.size(); ++i) {
                // The reference decides which splats belong to this sheet; the device may have culled some.
                const int place = static_cast<int>(sheet) + state.plan().params.sheet_base - reference_base;
                const bool touches = oracle.selected[i].sheet <= place && place <= oracle.selected[i].last_sheet;
                if (touches && sheet_of[i] != shader::SHEET_NONE) splats.push_back(i);
            }
            std::vector<glm::dvec4> want(kPixels, glm::dvec4(0));
            const double first = state.plan().params.sheet_base + static_cast<double>(sheet);
            const reference::DepthRange cut{thickness * first, thickness * (first + 1)};
            oracle.drawer.draw(splats, reference::Payload::Color, {}, want, cut);
            for (std::size_t i = 0; i < kPixels; ++i) {
                const int x = static_cast<int>(i) % kSheetSize.x, y = static_cast<int>(i) / kSheetSize.x;
                const bool inside = x >= rect.x && x < rect.z && y >= rect.y && y < rect.w;
                const glm::dvec4 got = inside ? glm::dvec4(sheets[sheet * kPixels + i]) : glm::dvec4(0);
                peak = std::max(peak, want[i].a);
                for (int c = 0; c < 4; ++c)
                    worst = std::max(worst, std::abs(got[c] - want[i][c]));
            }
        }
        EXPECT_GT(peak, 0.5);
        EXPECT_LE(worst, 5e-5 * peak) << "peak " << peak;
    }
}

INSTANTIATE_TEST_SUITE_P(All, DrawSlices,
                         testing::Values(SheetVariant{FootprintMode::Isotropic, WarpFamily::Paper},
                                         SheetVariant{FootprintMode::Warp2d, WarpFamily::Paper},
                                         SheetVariant{FootprintMode::Procedural, WarpFamily::Paper}),
                         [](const auto& test) { return std::string(name_of(test.param.mode)); });

TEST(CompositeSheet, AgreesWithTheReferenceOnTheSameSheets) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    for (PassScene s : pass_scenes()) {
        s = in_one_group(s, FootprintMode::Procedural, WarpFamily::Face);
        SCOPED_TRACE(s.name);
        DeviceUnderTest& state = prepared(s);
        state.draw(s.scene, s.camera, layered(s.settings), kSheetSize, shader::PAYLOAD_COLOR);
        const auto sheets = download<glm::vec4>(state, state.targets().sheets);
        const auto got = download<glm::vec4>(state, state.targets().accumulated);
        const auto rect = state.targets().groups.mapped<shader::SheetGroup>(1)[0].rect;
        std::vector<glm::dvec4> want(kPixels, glm::dvec4(0));
        for (std::uint32_t sheet = 0; sheet < state.plan().params.sheet_count; ++sheet) {
            std::vector<glm::dvec4> layer(kPixels, glm::dvec4(0));
            for (int y = rect.y; y < rect.w; ++y) {  // layers are not cleared outside the rectangle
                for (int x = rect.x; x < rect.z; ++x) {
                    const auto at = static_cast<std::size_t>(y * kSheetSize.x + x);
                    layer[at] = sheets[sheet * kPixels + at];
                }
            }
            reference::composite_sheet(want, layer);
        }
        for (std::size_t i = 0; i < kPixels; ++i) {
            for (int c = 0; c < 4; ++c)
                ASSERT_NEAR(static_cast<double>(got[i][c]), want[i][c], 2e-6) << "pixel " << i;
        }
    }
}

TEST(Resolve, AddsTheBackgroundAndComputesMeans) {
    if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    PassScene s = in_one_group(pass_scenes()[1], FootprintMode::Procedural, WarpFamily::Face);
    s.scene.background = {0.1, 0.3, 0.7};
    DeviceUnderTest& state = prepared(s);
    const auto output = [&] { return state.targets().output.mapped<glm::vec4>(kPixels); };
    const auto accumulated = [&] {
        std::vector<glm::dvec4> frame;
        for (const auto& pixel : download<glm::vec4>(state, state.targets().accumulated))
            frame.emplace_back(pixel);
        return frame;
    };
    state.draw(s.scene, s.camera, layered(s.settings), kSheetSize, shader::PAYLOAD_COLOR);
    const Image color = reference::resolve_color(accumulated(), kSheetSize.x, kSheetSize.y, s.scene.background);
    for (std::size_t i = 0; i < kPixels * 4; ++i)
        ASSERT_NEAR(output()[i / 4][static_cast<int>(i % 4)], color.pixels[i], 1e-6F);
    EXPECT_FALSE(state.plan().gradient);
    s.scene.effects.background_top = glm::dvec3(0.9, 0, 0.25);
    state.draw(s.scene, s.camera, layered(s.settings), kSheetSize, shader::PAYLOAD_COLOR);
    EXPECT_TRUE(state.plan().gradient);
    const Image two = reference::resolve_color(accumulated(), kSheetSize.x, kSheetSize.y, s.scene.background,
                                               s.scene.effects.background_top);
    for (std::size_t i = 0; i < kPixels * 4; ++i)
        ASSERT_NEAR(output()[i / 4][static_cast<int>(i % 4)], two.pixels[i], 1e-6F);
    // In empty pixels, the first row has exactly the top colour, and the last row exactly the bottom colour.
    int seen = 0;
    for (const auto& [y, plain] :
         {std::pair{0, *s.scene.effects.background_top}, {kSheetSize.y - 1, s.scene.background}})
        for (int x = 0; x < kSheetSize.x; ++x) {
            const glm::vec4 pixel = output()[static_cast<std::size_t>(y * kSheetSize.x + x)];
            if (pixel.a > 0) continue;
            ++seen;
            ASSERT_EQ(glm::vec3(pixel), glm::vec3(plain)) << "row " << y;
        }
    EXPECT_GT(seen, kSheetSize.x);
    state.draw(s.scene, s.camera, layered(s.settings), kSheetSize, shader::PAYLOAD_DEPTH_DISTANCE);
    EXPECT_FALSE(state.plan().gradient);
    const Image depth = reference::resolve_mean(accumulated(), kSheetSize.x, kSheetSize.y);
    for (std::size_t i = 0; i < kPixels; ++i)
        ASSERT_NEAR(output()[i].x, depth.pixels[i], 1e-4F);
    state.draw(s.scene, s.camera, layered(s.settings), kSheetSize, shader::PAYLOAD_NORMAL);
    const Image normal = reference::resolve_normal(accumulated(), kSheetSize.x, kSheetSize.y);
    for (std::size_t i = 0; i < kPixels * 3; ++i)
        ASSERT_NEAR(output()[i / 3][static_cast<int>(i % 3)], normal.pixels[i], 1e-5F);
}

TEST(Frame, RepeatsBitForBit) {
    for (const auto& [sheets, format] :
         {std::pair{SheetCut::Whole, SheetFormat::Layers}, std::pair{SheetCut::Sliced, SheetFormat::Layers},
          std::pair{SheetCut::Whole, SheetFormat::Tiles}, std::pair{SheetCut::Sliced, SheetFormat::Tiles}}) {
        if (format == SheetFormat::Layers && !layers_obstacle().empty()) continue;
        PassScene s = pass_scenes()[1];
        s.settings.sheets = sheets;
        DeviceUnderTest& state = prepared(s);
        const auto render = [&, format = format] {
            state.level.splats.drop();
            state.collect(s.scene, s.settings, false);
            state.draw(s.scene, s.camera, format == SheetFormat::Tiles ? s.settings : layered(s.settings), kSheetSize,
                       shader::PAYLOAD_COLOR);
            const auto pixels = state.targets().output.mapped<glm::vec4>(kPixels);
            return std::vector<glm::vec4>(pixels.begin(), pixels.end());
        };
        const auto first = render();
        EXPECT_EQ(render(), first);
        EXPECT_EQ(render(), first);
    }
}

}  // namespace
}  // namespace edgesplat::test
