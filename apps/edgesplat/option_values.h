// Strict parsing of option values: the whole text must match, and error messages name the expected form.
#pragma once

#include <CLI/CLI.hpp>
#include <exception>
#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Range of an option's values, both ends included unless `above_low`.
struct Range {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool above_low = false;  ///< excludes `low`
};

/// The whole of `text` as one finite number; nullopt otherwise.
std::optional<double> parse_number(std::string_view text);
/// Three finite numbers, comma-separated, e.g. "0,1,0.05"; nullopt otherwise.
std::optional<glm::dvec3> parse_vector(std::string_view text);
/// "WxH", each 1..16384; nullopt otherwise.
std::optional<glm::ivec2> parse_size(std::string_view text);

// The same, but an invalid text throws CLI::ValidationError naming the option, the text and the expected form.
double read_number(const std::string& option, const std::string& text, Range range);
glm::dvec3 read_vector(const std::string& option, const std::string& text, const std::string& type_name);

// Each function adds an option that is parsed as above, with the same errors. `value` must outlive the parse.
CLI::Option* add_number(CLI::App& app, const std::string& names, double& value, Range range, const std::string& help);
CLI::Option* add_number(CLI::App& app, const std::string& names, std::optional<double>& value, Range range,
                        const std::string& help);

/// Adds an option with named values. `named` converts a name to its value and throws edgesplat::Error for unknown
/// names.
template <typename Value, typename Named>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Value& value, Named named,
                        std::span<const std::string_view> names, std::string_view default_name,
                        const std::string& help) {
    const auto read = [name, &value, named](const std::string& text) {
        try {
            value = named(text);
        } catch (const std::exception& error) {
            throw CLI::ValidationError(name, error.what());
        }
    };
    std::string choices;
    for (const std::string_view choice : names)
        (choices += choices.empty() ? "" : "|") += choice;
    return app.add_option_function<std::string>(name, read, help)
        ->type_name(choices)
        ->default_str(std::string(default_name));
}
