// The one device of a test program, with validation and synchronization validation on.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include "engine/renderer/state.h"

namespace edgesplat::test {

inline std::unique_ptr<RendererState>& held_device() {
    static std::unique_ptr<RendererState> state;
    return state;
}

/// EDGESPLAT_TEST_DEVICE chooses another device than the first usable one ("gpu"). Opened when first asked for.
inline RendererState& device_under_test() {
    auto& state = held_device();
    if (state == nullptr) {
        const char* device = std::getenv("EDGESPLAT_TEST_DEVICE");
        const bool first = device == nullptr || std::string_view(device) == "gpu";
        state = std::make_unique<RendererState>(DeviceChoice{.device = first ? "" : device, .validation = true});
    }
    return *state;
}

/// Why the device under test draws no sheets in layers, and so no shadows either; empty where it does.
inline const std::string& layers_obstacle() {
    return device_under_test().device.layers_obstacle();
}

/// Tests of sheets in layers: skipped, with the reason, on a device that has none.
template <typename Base = testing::Test>
class NeedsLayers : public Base {
  protected:
    void SetUp() override {
        if (!layers_obstacle().empty()) GTEST_SKIP() << layers_obstacle();
    }
};

/// Closes the device before main ends: the validation layer's own statics are gone when ours would be destroyed.
class DeviceClosesInMain : public testing::Environment {
    void TearDown() override { held_device().reset(); }
};
/// In every program that may open it.
inline const testing::Environment* const kDeviceCloses = testing::AddGlobalTestEnvironment(new DeviceClosesInMain);

/// Fails any test during which validation spoke.
class ValidationIsSilent : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        const auto now = device_under_test().device.validation_messages();
        EXPECT_EQ(now, seen_) << "validation messages";
        seen_ = now;
    }
    std::uint64_t seen_ = 0;
};

}  // namespace edgesplat::test
