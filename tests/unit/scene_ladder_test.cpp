// The ladder of settings: every step of every knob, messages of refusals, presets and canonical settings.
#include "engine/scene/ladder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <sstream>
#include <string>

#include "engine/error.h"
#include "tests/unit/refusal.h"

namespace edgesplat {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// All values of a knob: its steps and others.
std::vector<std::string_view> values_of(const Knob& knob) {
    std::vector<std::string_view> values = knob.steps;
    values.insert(values.end(), knob.others.begin(), knob.others.end());
    return values;
}

/// Settings with a random value of every knob.
Settings random_settings(std::mt19937& random) {
    Settings settings;
    for (const Knob& knob : ladder()) {
        const auto values = values_of(knob);
        knob.set(settings, values[random() % values.size()]);
    }
    settings.cull_buried = random() % 2 == 0;
    return settings;
}

TEST(Ladder, EveryValueRoundTripsAndIsValid) {
    for (const Knob& knob : ladder()) {
        EXPECT_GE(knob.steps.size() + knob.others.size(), 2U) << knob.name;
        EXPECT_FALSE(knob.help.empty()) << knob.name;
        const auto values = values_of(knob);
        EXPECT_EQ(std::set(values.begin(), values.end()).size(), values.size()) << knob.name;
        for (const std::string_view value : values) {
            Settings settings;
            knob.set(settings, value);
            EXPECT_EQ(knob.get(settings), value) << knob.name;
            EXPECT_NO_THROW(validate(settings)) << knob.name << " " << value;
            // Only this knob differs from the defaults.
            const Settings usual;
            EXPECT_EQ(difference(settings),
                      value == knob.get(usual) ? "" : std::string(knob.name) + "=" + std::string(value));
        }
    }
}

TEST(Ladder, EveryEnumValueHasName) {
    const auto expect_names = [](std::string_view knob, std::span<const std::string_view> names) {
        const auto values = values_of(knob_named(knob));
        EXPECT_EQ(std::set<std::string_view>(values.begin(), values.end()),
                  std::set<std::string_view>(names.begin(), names.end()))
            << knob;
    };
    expect_names("edges", edge_estimator_names());
    expect_names("footprints", footprint_mode_names());
    expect_names("warp", warp_family_names());
    expect_names("sheets", sheet_cut_names());
    expect_names("sheet-format", sheet_format_names());
}

TEST(Ladder, RefusalsNameGivenAndExpectedValues) {
    for (const Knob& knob : ladder()) {
        Settings settings;
        const std::string message = refusal([&] { knob.set(settings, "sideways"); });
        EXPECT_THAT(message, HasSubstr("'sideways'")) << knob.name;
        EXPECT_EQ(settings, Settings{}) << knob.name << ": a refusal changes nothing";
        if (knob.number) {
            EXPECT_THAT(message, HasSubstr(knob.above_low ? "above" : "from")) << knob.name;
            continue;
        }
        for (const std::string_view value : values_of(knob))
            EXPECT_THAT(message, HasSubstr(std::string(value))) << knob.name;
        for (const std::string_view bad : {"", " ", "Off", "WHOLE", "march "})
            EXPECT_NE(refusal([&] { knob.set(settings, bad); }), "") << knob.name << " '" << bad << "'";
    }
}

TEST(Ladder, RefusesMalformedAndOutOfRangeNumbers) {
    for (const Knob& knob : ladder()) {
        if (!knob.number) continue;
        Settings settings;
        const auto refused = [&](const std::string& text) { return refusal([&] { knob.set(settings, text); }); };
        const auto text = [](double v) { return std::to_string(v); };
        for (const std::string& bad :
             {std::string(""), std::string("nan"), std::string("inf"), std::string("-inf"), std::string("1x"),
              std::string("1 "), std::string(" 1"), std::string("0x1"), std::string("1,5"), std::string("++1"),
              std::string("+"), std::string("1e999"), text(knob.low - 0.01), text(knob.high + 0.01)})
            EXPECT_THAT(refused(bad), AllOf(HasSubstr("'" + bad + "'"), HasSubstr("number"))) << knob.name;
        EXPECT_EQ(refused(text(knob.low)).empty(), !knob.above_low) << knob.name;
        EXPECT_EQ(refused(text(knob.high)), "") << knob.name;
        EXPECT_EQ(refused("+1"), "") << knob.name;
        EXPECT_EQ(knob.get(settings), "1");
        EXPECT_NO_THROW(validate(settings));
        // The knob's range equals the range that validate() checks.
        knob.set(settings, text(knob.high));
        EXPECT_NO_THROW(validate(settings)) << knob.name;
        if (!knob.above_low) {
            knob.set(settings, text(knob.low));
            EXPECT_NO_THROW(validate(settings)) << knob.name;
        }
    }
}

TEST(Ladder, StepsAreMonotoneAndNamesUnique) {
    std::set<std::string_view> names;
    for (const Knob& knob : ladder()) {
        EXPECT_TRUE(names.insert(knob.name).second) << knob.name;
        EXPECT_EQ(&knob_named(knob.name), &knob);
        if (!knob.number) continue;
        // Numbers rise or fall from step to step; the better direction depends on the knob.
        std::vector<double> steps;
        for (const std::string_view step : knob.steps)
            steps.push_back(std::stod(std::string(step)));
        const bool falls = steps.front() > steps.back();
        for (std::size_t i = 1; i < steps.size(); ++i)
            EXPECT_EQ(falls, steps[i - 1] > steps[i]) << knob.name;
    }
    EXPECT_THAT(refusal([] { knob_named("colour"); }),
                AllOf(HasSubstr("'colour'"), HasSubstr("edges"), HasSubstr("saturation")));
}

TEST(Ladder, EveryCombinationOfStepsIsValid) {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        const Settings settings = random_settings(random);
        ASSERT_NO_THROW(validate(settings)) << difference(settings);
        ASSERT_NO_THROW(validate(canonical_settings(settings))) << difference(settings);
    }
}

TEST(Presets, AreValidOrderedAndFoundByName) {
    ASSERT_EQ(presets().size(), 2U);
    std::vector<std::string_view> names;
    for (const Preset& preset : presets()) {
        names.push_back(preset.name);
        EXPECT_NO_THROW(validate(preset.settings));
        EXPECT_FALSE(preset.help.empty());
        EXPECT_EQ(&preset_named(preset.name), &preset);
    }
    EXPECT_THAT(names, testing::ElementsAre("draft", "accurate"));
    EXPECT_THAT(refusal([] { preset_named("best"); }), AllOf(HasSubstr("'best'"), HasSubstr("accurate")));
    // Cheapest first: no knob of a later preset has a cheaper step than in an earlier preset.
    for (std::size_t i = 1; i < presets().size(); ++i) {
        EXPECT_NE(difference(presets()[i].settings, presets()[i - 1].settings), "");
        for (const Knob& knob : ladder()) {
            // Spacings of whole and of sliced sheets are not comparable.
            if (knob.name == "sheet-spacing" && presets()[i - 1].settings.sheets != presets()[i].settings.sheets)
                continue;
            const auto rank = [&](const Preset& preset) {
                const std::string value = knob.get(preset.settings);
                const bool falls = knob.number && std::stod(std::string(knob.steps.front())) >
                                                      std::stod(std::string(knob.steps.back()));
                if (knob.number) return falls ? -std::stod(value) : std::stod(value);
                return static_cast<double>(std::find(knob.steps.begin(), knob.steps.end(), value) - knob.steps.begin());
            };
            EXPECT_LE(rank(presets()[i - 1]), rank(presets()[i])) << knob.name;
        }
    }
}

TEST(Difference, NamesOnlyChangedSettings) {
    EXPECT_EQ(difference({}), "");
    Settings settings;
    settings.edges = EdgeEstimator::March;
    settings.sheet_spacing = 0.5;
    EXPECT_EQ(difference(settings), "edges=march sheet-spacing=0.5");
    EXPECT_EQ(difference(settings, settings), "");
    EXPECT_EQ(difference({}, settings), "edges=cubic sheet-spacing=0.25");
    // The text is sufficient to restore the settings.
    std::mt19937 random(2);
    for (int i = 0; i < 200; ++i) {
        const Settings wanted = random_settings(random);
        Settings made;
        made.cull_buried = wanted.cull_buried;
        std::istringstream words(difference(wanted));
        for (std::string word; words >> word;) {
            const auto equals = word.find('=');
            knob_named(word.substr(0, equals)).set(made, word.substr(equals + 1));
        }
        ASSERT_EQ(made, wanted) << difference(wanted);
    }
}

TEST(CanonicalSettings, AreIdempotent) {
    std::mt19937 random(3);
    for (int i = 0; i < 5000; ++i) {
        const Settings settings = random_settings(random), drawn = canonical_settings(settings);
        ASSERT_EQ(canonical_settings(drawn), drawn) << difference(settings) << " -> " << difference(drawn);
    }
    EXPECT_EQ(canonical_settings({}), Settings{});
}

TEST(CanonicalSettings, Warp2dRequiresPaperWarp) {
    Settings settings = paper_settings();
    settings.sheets = SheetCut::Sliced;
    EXPECT_EQ(canonical_settings(settings), settings) << "warp2d also works with sliced sheets";
    settings.warp = WarpFamily::Face;
    EXPECT_EQ(canonical_settings(settings).footprints, FootprintMode::Procedural);
}

TEST(CanonicalSettings, TableRequiresFaceWarpAndWholeSheets) {
    Settings settings;
    settings.footprints = FootprintMode::Table;
    EXPECT_TRUE(draws_table(settings));
    EXPECT_EQ(canonical_settings(settings), settings);
    Settings sliced = settings;
    sliced.sheets = SheetCut::Sliced;
    Settings paper = settings;
    paper.warp = WarpFamily::Paper;
    for (const Settings& other : {sliced, paper}) {
        EXPECT_FALSE(draws_table(other));
        EXPECT_EQ(canonical_settings(other).footprints, FootprintMode::Procedural);
    }
}

TEST(CanonicalSettings, ResetUnusedSettings) {
    Settings settings;
    settings.edges = EdgeEstimator::Off;
    settings.footprints = FootprintMode::Warp2d;
    settings.warp = WarpFamily::Paper;
    settings.sheet_spacing = 2;
    settings.sheet_format = SheetFormat::Layers;
    Settings plain;
    plain.sheet_format = SheetFormat::Layers;
    plain.edges = EdgeEstimator::Off;
    plain.footprints = FootprintMode::Isotropic;
    plain.sheet_spacing = 2;
    EXPECT_EQ(canonical_settings(settings), plain) << difference(canonical_settings(settings));
    // Isotropic footprints give the same picture with every edge estimator.
    settings.edges = EdgeEstimator::Cubic;
    settings.footprints = FootprintMode::Isotropic;
    EXPECT_EQ(canonical_settings(settings), plain);
}

TEST(CanonicalSettings, UnusedSettingsChangeNothing) {
    std::mt19937 random(4);
    for (int i = 0; i < 2000; ++i) {
        const Settings settings = random_settings(random);
        for (const Knob& knob : ladder()) {
            if (knob.used(settings)) continue;
            for (const std::string_view value : values_of(knob)) {
                Settings other = settings;
                knob.set(other, value);
                ASSERT_EQ(canonical_settings(other), canonical_settings(settings))
                    << knob.name << " of " << difference(settings);
            }
        }
    }
}

}  // namespace
}  // namespace edgesplat
