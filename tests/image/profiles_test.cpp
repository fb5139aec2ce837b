// The picture does not depend on the device's profile: what only one kind of driver needs changes nothing that is seen.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/image/image_cases.h"

namespace edgesplat::test {
namespace {

/// On this device, as on another kind of device.
Renderer renderer_of(const std::string& profile) {
    return Renderer({.device = test_renderer().device().name, .validation = true, .profile = profile});
}

TEST(Profiles, ShowTheSamePicture) {
    Renderer rounds = renderer_of("lavapipe"), whole = renderer_of("discrete");
    double worst = std::numeric_limits<double>::infinity();
    for (ImageCase& c : golden_cases()) {
        if (!refusal_of_layers(c).empty() || c.shot.settings.sheet_format != SheetFormat::Tiles) continue;
        c.shot.settings.pixels = PixelChoice::Every;  // interpolated pixels are an approximation of their own
        const auto drawn = [&](Renderer& renderer) {
            renderer.set_volume(c.shot.volume);
            const Shot& s = c.shot;
            return renderer.render(s.scene, s.camera, s.settings, s.width, s.height).color;
        };
        const ImageDifference difference = compare_images(drawn(rounds), drawn(whole));
        EXPECT_GE(difference.psnr, 90) << c.name << ": " << difference.max << " at " << difference.x << ", "
                                       << difference.y;
        worst = std::min(worst, difference.psnr);
    }
    std::printf("at least %.1f dB\n", worst);
    EXPECT_EQ(rounds.validation_messages() + whole.validation_messages(), 0U);
}

}  // namespace
}  // namespace edgesplat::test
