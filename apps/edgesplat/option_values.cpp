#include "apps/edgesplat/option_values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace {

/// Removes the part of `text` up to its first separator and returns it without the separator; nullopt if there is none.
std::optional<std::string_view> take_before(std::string_view& text, char separator) {
    const std::size_t end = text.find(separator);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(end + 1);
    return part;
}

std::string expectation(Range range) {
    const bool low = std::isfinite(range.low);
    const bool high = std::isfinite(range.high);
    if (low && high)
        return range.above_low ? fmt::format("a number above {} and at most {}", range.low, range.high)
                               : fmt::format("a number from {} to {}", range.low, range.high);
    if (low) return fmt::format("a number {} {}", range.above_low ? "above" : "of at least", range.low);
    return "a number";
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    if (text.size() > 1 && text.front() == '+') text.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<glm::dvec3> parse_vector(std::string_view text) {
    const auto x_text = take_before(text, ',');
    const auto y_text = x_text ? take_before(text, ',') : std::nullopt;
    if (!y_text) return std::nullopt;
    const auto x = parse_number(*x_text);
    const auto y = parse_number(*y_text);
    const auto z = parse_number(text);
    if (!x || !y || !z) return std::nullopt;
    return glm::dvec3(*x, *y, *z);
}

std::optional<glm::ivec2> parse_size(std::string_view text) {
    const auto width_text = take_before(text, 'x');
    if (!width_text) return std::nullopt;
    glm::ivec2 size(0);
    const auto read = [](std::string_view digits, int& value) {
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        return error == std::errc() && end == digits.data() + digits.size() && value >= 1 && value <= 16384;
    };
    if (!read(*width_text, size.x) || !read(text, size.y)) return std::nullopt;
    return size;
}

double read_number(const std::string& names, const std::string& text, Range range) {
    const std::optional<double> value = parse_number(text);
    const bool fits = value && (range.above_low ? *value > range.low : *value >= range.low) && *value <= range.high;
    if (!fits) throw CLI::ValidationError(names, fmt::format("'{}' is not {}", text, expectation(range)));
    return *value;
}

glm::dvec3 read_vector(const std::string& names, const std::string& text, const std::string& type_name) {
    const std::optional<glm::dvec3> value = parse_vector(text);
    if (!value)
        throw CLI::ValidationError(
            names, fmt::format("'{}' is not three numbers {}, comma-separated without spaces, such as 0,1,0.05", text,
                               type_name));
    return *value;
}

CLI::Option* add_number(CLI::App& app, const std::string& names, double& value, Range range, const std::string& help) {
    return app
        .add_option_function<std::string>(
            names, [names, range, &value](const std::string& text) { value = read_number(names, text, range); }, help)
        ->type_name("NUMBER")
        ->default_str(fmt::format("{}", value));
}

CLI::Option* add_number(CLI::App& app, const std::string& names, std::optional<double>& value, Range range,
                        const std::string& help) {
    return app
        .add_option_function<std::string>(
            names, [names, range, &value](const std::string& text) { value = read_number(names, text, range); }, help)
        ->type_name("NUMBER");
}
