// Finds the name closest to a misspelled one, for "did you mean ...?".
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace edgesplat {

/// Number of letters to insert, delete or replace to turn one word into the other (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name with the smallest edit distance to `text`; empty if more than a third of its letters differ from all names.
std::string nearest_name(std::string_view text, std::span<const std::string> names);

}  // namespace edgesplat
