// The single device of a test program, with validation and synchronization validation.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "engine/forecast/forecast.h"
#include "engine/frame/picture.h"

namespace edgesplat::test {

/// The owners of a renderer's data, without SplatProvider.
struct DeviceUnderTest {
    explicit DeviceUnderTest(const DeviceChoice& choice) : session(choice) {}

    /// Runs passes 1 to 2c as far as needed. Returns whether any ran.
    bool collect(const Scene& scene, const Settings& settings, bool keep_buried = false) {
        cost = {};
        added.clear();
        const FrameRequest request = request_of(scene, settings);
        for (const AddedVolume& beside : scene.added)
            added.emplace_back(session).volume.hold(beside.volume, 0);
        bool ran = false;
        std::vector<LitVolume> lit;
        for (std::size_t number = 0; number <= added.size(); ++number) {
            const FrameRequest one = request_of_volume(request, number);
            std::vector<CollectionPlan> plans;
            for (const FrameRequest& part : keep_buried ? std::vector{one} : parts_of_volume(one))
                plans.push_back(plan_collection(*part.volume, part.scene, drawn_settings(part), keep_buried,
                                                part.whole ? &*part.whole : nullptr));
            ran = level_of(number).provide(plans.back(), plans.size() > 1 ? &plans.front() : nullptr, cost) || ran;
            lit.push_back({&level_of(number), one.scene});
        }
        return light_volumes(lit, cost) || ran;
    }
    void draw(const Scene& scene, const Camera& camera, const Settings& settings, const glm::ivec2& size,
              std::uint32_t payload, const glm::dvec2& offset = {0, 0}) {
        std::vector<PicturePart> planned;
        const FrameRequest request = request_of(scene, settings);
        const bool undivided = added.empty() && !level.surfaces.collected();
        const std::vector<FrameRequest> parts = undivided ? std::vector{request} : drawn_parts(request);
        for (const FrameRequest& part : parts) {
            const LevelStore& of_part = level_of(part.number);
            const CollectedSplats list = part.mixed && !part.whole ? of_part.opaque() : of_part.all();
            planned.push_back({list, drawer.plan(list, part.scene, camera, drawn_settings(part), size, payload)});
            if (offset != glm::dvec2(0)) shift_rays(planned.back().plan, offset);
        }
        if (planned.size() == 1) return drawer.draw(planned.front().list, std::move(planned.front().plan));
        drawer.draw_parts(std::move(planned), are_of_several_volumes(parts));
    }
    FrameRequest request_of(const Scene& scene, const Settings& settings) const {
        return {level.volume.volume(), scene, {}, settings, {}, {}};
    }
    LevelStore& level_of(std::size_t number) { return number == 0 ? level : added[number - 1]; }
    const gpu::Device& device() const { return session.device(); }
    gpu::Commands& commands() { return session.commands(); }
    const SplatLists& lists() const { return level.splats.lists(); }
    const TargetResources& targets() { return drawer.targets().resources(); }
    const FramePlan& plan() const { return drawer.drawn(); }

    RenderOptions options;
    DeviceSession session;
    LevelStore level{session};
    std::vector<LevelStore> added;  ///< of the scene's added volumes
    PictureDrawer drawer{session, options};
    SetupCost cost;  ///< of the last collect()
};

inline std::unique_ptr<DeviceUnderTest>& held_device() {
    static std::unique_ptr<DeviceUnderTest> device;
    return device;
}

/// The device, opened at the first call. EDGESPLAT_TEST_DEVICE selects it; "gpu" or unset: the first usable one.
inline DeviceUnderTest& device_under_test() {
    auto& state = held_device();
    if (state == nullptr) {
        const char* device = std::getenv("EDGESPLAT_TEST_DEVICE");
        const bool first = device == nullptr || std::string_view(device) == "gpu";
        state = std::make_unique<DeviceUnderTest>(DeviceChoice{.device = first ? "" : device, .validation = true});
    }
    return *state;
}

/// Why the device cannot draw sheets in layers; empty if it can.
inline const std::string& layers_obstacle() {
    return device_under_test().device().layers_obstacle();
}

/// Base of tests of sheets in layers: skips them, with the reason, on a device without layers.
template <typename Base = testing::Test>
class NeedsLayers : public Base {
  protected:
    void SetUp() override {
        if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    }
};

/// Closes the device before main ends: later, the validation layer's static data is already destroyed.
class DeviceClosesInMain : public testing::Environment {
    void TearDown() override { held_device().reset(); }
};
/// Registered in every program that may open the device.
inline const testing::Environment* const kDeviceCloses = testing::AddGlobalTestEnvironment(new DeviceClosesInMain);

/// Fails every test with a validation message.
class ValidationIsSilent : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        const auto now = device_under_test().device().validation_messages();
        EXPECT_EQ(now, seen_) << "validation messages";
        seen_ = now;
    }
    std::uint64_t seen_ = 0;
};

}  // namespace edgesplat::test
