#include "engine/volume/value_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace edgesplat {
namespace {

constexpr int kMostDigits = 17;       // of a double
constexpr double kResolution = 1e-4;  // of the range
constexpr double kShare = 5e-6;       // of the value

double number_in(const std::string& text) {
    return std::strtod(text.c_str(), nullptr);
}

/// Fewest digits whose number passes the test; all digits if none does.
template <typename Test>
std::string fewest_digits(double value, const Test& test) {
    for (int digits = 1; digits < kMostDigits; ++digits) {
        const std::string text = fmt::format("{:.{}g}", value, digits);
        // "1e+02" has fewer digits than "100", but reads worse.
        if (test(number_in(text)))
            return std::abs(value) < 1e6 && digits < 7 ? fmt::format("{:.7g}", number_in(text)) : text;
    }
    return fmt::format("{}", value);
}

}  // namespace

std::string value_text(const Volume& volume, float sample) {
    const double scale = volume.value_scale;
    return fewest_digits(volume.in_file_unit(static_cast<double>(sample)),
                         [&](double number) { return static_cast<float>(number / scale) == sample; });
}

std::string value_text(double value, double range) {
    const double tolerance = std::min(kResolution * range, kShare * std::abs(value));
    return fewest_digits(value, [&](double number) { return std::abs(number - value) <= tolerance; });
}

int value_digits(double largest, double range) {
    if (!(range > 0) || !(largest > 0)) return kMostDigits;
    return std::clamp(static_cast<int>(std::ceil(std::log10(largest / (kResolution * range)))) + 1, 5, kMostDigits);
}

std::string value_format(const Volume& volume) {
    const auto low = static_cast<double>(volume.min_value), high = static_cast<double>(volume.max_value);
    return fmt::format("%.{}g", value_digits(std::max(std::abs(low), std::abs(high)), high - low));
}

std::vector<std::string> value_texts(std::span<const double> values, double range) {
    // Within a twentieth of the smallest difference.
    constexpr double kApart = 0.05;
    for (std::size_t i = 0; i < values.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (const double gap = std::abs(values[i] - values[j]); gap > 0)
                range = std::min(range, kApart * gap / kResolution);
    std::vector<std::string> texts;
    for (const double value : values)
        texts.push_back(value_text(value, range));
    return texts;
}

}  // namespace edgesplat
