#include "apps/paper/document.h"

#include <fmt/format.h>

#include <sstream>

namespace edgesplat {
namespace {

std::string opening(std::string_view key) {
    return fmt::format("<!-- {} -->\n", key);
}

std::string closing(std::string_view key) {
    return fmt::format("<!-- end of {} -->\n", key);
}

bool stands_alone(const std::string& line) {
    return line.empty() || std::string_view("#|!<`").find(line.front()) != std::string_view::npos;
}

}  // namespace

std::string filled(std::string_view text) {
    constexpr std::size_t kColumns = 120;
    std::istringstream in{std::string(text)};
    std::string out, line, paragraph;
    bool code = false;
    const auto end_paragraph = [&] {
        std::istringstream words(paragraph);
        std::size_t column = 0;
        for (std::string word; words >> word; column += word.size()) {
            if (column == 0) {
                out += word;
            } else if (column + 1 + word.size() > kColumns) {
                out += "\n" + word;
                column = 0;
            } else {
                out += " " + word;
                ++column;
            }
        }
        if (column > 0) out += "\n";
        paragraph.clear();
    };
    while (std::getline(in, line)) {
        const bool fence = line.starts_with("```");
        if (code || fence || (stands_alone(line) && !line.starts_with('`'))) {
            end_paragraph();
            out += line + "\n";
            if (fence) code = !code;
        } else {
            paragraph += line + " ";
        }
    }
    end_paragraph();
    return out;
}

std::string kept_section(std::string_view page, std::string_view key) {
    const std::string open = opening(key), close = closing(key);
    const std::size_t begin = page.find(open);
    if (begin == std::string_view::npos) return {};
    const std::size_t start = begin + open.size(), end = page.find(close, start);
    if (end == std::string_view::npos) return {};
    return std::string(page.substr(start, end - start));
}

std::string page_of(const std::vector<Section>& sections) {
    std::string page;
    for (const Section& section : sections) {
        if (!page.empty()) page += "\n";
        page += opening(section.key) + filled(section.text) + closing(section.key);
    }
    return page;
}

std::vector<std::string> pictures_in(std::string_view page) {
    std::vector<std::string> found;
    for (std::size_t at = page.find("!["); at != std::string_view::npos; at = page.find("![", at + 1)) {
        const std::size_t open = page.find("](", at), close = page.find(')', open);
        if (open == std::string_view::npos || close == std::string_view::npos) break;
        found.emplace_back(page.substr(open + 2, close - open - 2));
    }
    return found;
}

}  // namespace edgesplat
