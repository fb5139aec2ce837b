// The one device of a test program, with validation and synchronization validation on.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string_view>

#include "engine/renderer_state.h"

namespace edgesplat::test {

/// EDGESPLAT_TEST_DEVICE chooses another device than the first usable one ("gpu").
inline RendererState& device_under_test() {
    static RendererState state([] {
        const char* device = std::getenv("EDGESPLAT_TEST_DEVICE");
        const bool first = device == nullptr || std::string_view(device) == "gpu";
        return DeviceChoice{.device = first ? "" : device, .validation = true};
    }());
    return state;
}

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
