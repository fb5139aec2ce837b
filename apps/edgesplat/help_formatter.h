// Layout of --help: option and type on the left, wrapped text with the default on the right.
#pragma once

#include <CLI/CLI.hpp>
#include <sstream>
#include <string>

/// Like CLI11's formatter, but wraps long texts and puts defaults after the description.
class HelpFormatter : public CLI::Formatter {
  public:
    HelpFormatter() { column_width(kLeft); }

    std::string make_option_opts(const CLI::Option* option) const override {
        const std::string& type = option->get_type_name();
        return type.empty() ? "" : " " + type;
    }

    std::string make_option_desc(const CLI::Option* option) const override {
        std::string text = option->get_description();
        if (option->get_required()) text += " (required)";
        if (!option->get_default_str().empty()) text += " (default: " + option->get_default_str() + ")";
        return wrapped(text);
    }

  private:
    static constexpr std::size_t kLeft = 34;   ///< columns before the description
    static constexpr std::size_t kRight = 80;  ///< columns of the description

    static std::string wrapped(const std::string& text) {
        std::istringstream words(text);
        std::string out;
        std::string word;
        std::size_t column = 0;
        while (words >> word) {
            const bool fits = column + 1 + word.size() <= kRight;
            if (column > 0) out += fits ? " " : "\n";
            column = (column > 0 && fits ? column + 1 : 0) + word.size();
            out += word;
        }
        return out;
    }
};
