// Cases of the image tests: small scenes that together use every mode, estimator, output and view.
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
    double smallest_psnr = 50;  ///< against the reference, dB; peak = max(1, largest value)
};

inline void PrintTo(const ImageCase& image_case, std::ostream* out) {
    *out << image_case.name;
}

/// Compared with the double-precision reference.
std::vector<ImageCase> reference_cases();

/// Compared with the pictures in tests/image/golden.
std::vector<ImageCase> golden_cases();

/// The renderer's refusal if the case needs layers and the device has none; empty otherwise.
std::string refusal_of_layers(const ImageCase& image_case);

/// The output of a case as the device renders it.
Image render_on_device(const ImageCase& image_case);

}  // namespace edgesplat::test
