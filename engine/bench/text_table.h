// Formats columns of text for a terminal.
#pragma once

#include <string>
#include <vector>

namespace edgesplat::bench {

/// The first row is the head. The first column is left-aligned, the others are right-aligned.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace edgesplat::bench
