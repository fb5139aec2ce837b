// Registers the listener that fails every test of this program with a validation message; closes the device.
#include <exception>

#include "tests/passes/device_under_test.h"

namespace edgesplat::test {

static const bool kListening = [] {
    testing::UnitTest::GetInstance()->listeners().Append(new ValidationIsSilent);
    return true;
}();

TEST(Device, ListensToValidation) {
    EXPECT_TRUE(kListening);
    EXPECT_EQ(device_under_test().device().validation_messages(), 0U);
    EXPECT_FALSE(device_under_test().device().info().name.empty());
}

TEST(Device, RejectsUnknownNamesWithReasons) {
    try {
        DeviceUnderTest state({.device = "no such device"});
        FAIL() << "opened a device that does not exist";
    } catch (const std::exception& error) {
        EXPECT_NE(std::string(error.what()).find("no such device"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("usable"), std::string::npos) << error.what();
    }
}

}  // namespace edgesplat::test
