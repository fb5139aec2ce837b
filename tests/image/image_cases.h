// The pictures of the image tests: small scenes that between them use every mode, estimator, output and view.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "engine/image/image_compare.h"
#include "engine/reference/reference_renderer.h"
#include "tests/properties/scenes.h"

namespace edgesplat::test {

struct ImageCase {
    std::string name;
    Shot shot;
    reference::Output output = reference::Output::Color;
    double smallest_psnr = 50;  ///< against the reference, dB, of a peak that is the larger of 1 and what there is
};

inline void PrintTo(const ImageCase& image_case, std::ostream* out) {
    *out << image_case.name;
}

/// Held against the double-precision reference.
std::vector<ImageCase> reference_cases();

/// Held against the pictures in tests/image/golden.
std::vector<ImageCase> golden_cases();

/// Where the device has no layers and the case needs them: what the renderer says. Empty otherwise.
std::string refusal_of_layers(const ImageCase& image_case);

/// The output of a case as the device renders it.
Image render_on_device(const ImageCase& image_case);

}  // namespace edgesplat::test
