#include "engine/bench/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace edgesplat::bench {

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
    std::vector<std::size_t> width;
    for (const auto& row : rows) {
        width.resize(std::max(width.size(), row.size()), 0);
        for (std::size_t c = 0; c < row.size(); ++c)
            width[c] = std::max(width[c], row[c].size());
    }
    std::string out;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += c == 0 ? fmt::format("{:<{}}", row[c], width[c]) : fmt::format("  {:>{}}", row[c], width[c]);
        out.append(line, 0, line.find_last_not_of(' ') + 1).append("\n");
    }
    return out;
}

}  // namespace edgesplat::bench
