// Every row of the table of effects is active exactly when its switch is set.
#include <gmock/gmock.h>

#include <algorithm>
#include <set>

#include "engine/error.h"
#include "engine/forecast/effect_table.h"
#include "engine/forecast/forecast.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {
namespace {

FrameRequest torus_request() {
    const Shot shot = torus_shot();
    return {shot.volume, shot.scene, shot.camera, shot.settings, {48, 48}, {}};
}

TEST(EffectTable, HasNoActiveEffectForAPlainRequest) {
    const FrameRequest plain = plain_request(torus_request());
    validate(plain.scene);
    validate(plain.settings);
    for (const Effect& effect : effect_table())
        EXPECT_EQ(effect.reason(plain), "") << effect.name;
}

TEST(EffectTable, EachSwitchActivatesOnlyItsOwnEffect) {
    std::set<std::string_view> names;
    for (const Effect& effect : effect_table()) {
        EXPECT_TRUE(names.insert(effect.name).second) << effect.name;
        EXPECT_NE(effect.help, "") << effect.name;
        EXPECT_NE(effect.call, "") << effect.name;
        FrameRequest request = plain_request(torus_request());
        if (effect.base != nullptr) effect.base(request);
        EXPECT_EQ(effect.reason(request), "") << effect.name;
        const auto active_effects = [&] {
            std::set<std::string_view> on;
            for (const Effect& other : effect_table())
                if (!other.reason(request).empty()) on.insert(other.name);
            return on;
        };
        auto expected = active_effects();
        expected.insert(effect.name);
        effect.turn_on(request);
        validate(request.scene);
        validate(request.settings);
        EXPECT_NE(effect.reason(request), "") << effect.name;
        EXPECT_EQ(active_effects(), expected) << effect.name;
    }
    EXPECT_THROW(effect_named("bloom"), Error);
    EXPECT_EQ(&effect_named("light"), &*std::ranges::find(effect_table(), "light", &Effect::name));
}

TEST(EffectTable, NamesResourcesThatExist) {
    for (const Effect& effect : effect_table()) {
        FrameRequest request = plain_request(torus_request());
        if (effect.base != nullptr) effect.base(request);
        effect.turn_on(request);
        const FrameForecast forecast = forecast_frame(request, most_splats_of, gpu::profile_named("lavapipe"));
        std::set<std::string_view> names;
        for (const PlannedResource& resource : forecast.resources)
            names.insert(resource.text.name);
        for (const auto* listed : {&effect.resources, &effect.resized})
            for (const std::string_view name : *listed)
                EXPECT_TRUE(names.contains(name)) << effect.name << ": " << name;
    }
}

}  // namespace
}  // namespace edgesplat::test
