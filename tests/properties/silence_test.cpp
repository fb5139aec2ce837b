// Registers the listener that fails every test of this program with a validation message; closes the renderer.
#include <gtest/gtest.h>

#include "tests/properties/test_renderer.h"

namespace edgesplat::test {
namespace {

class ValidationIsSilent : public testing::EmptyTestEventListener {
    void OnTestEnd(const testing::TestInfo&) override {
        const auto now = test_renderer().validation_messages();
        EXPECT_EQ(now, seen_) << "validation messages";
        seen_ = now;
    }
    std::uint64_t seen_ = 0;
};

class RendererClosesInMain : public testing::Environment {
    void TearDown() override { close_test_renderer(); }
};

const bool kListening = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new ValidationIsSilent);
    testing::AddGlobalTestEnvironment(new RendererClosesInMain);
    return true;
}();

TEST(Renderer, ListensToValidation) {
    EXPECT_TRUE(kListening);
    EXPECT_EQ(test_renderer().validation_messages(), 0U);
}

}  // namespace
}  // namespace edgesplat::test
