// Columns of text for a terminal.
#pragma once

#include <string>
#include <vector>

namespace edgesplat::bench {

/// The first row is the head; the first column is flush left, the others flush right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace edgesplat::bench
