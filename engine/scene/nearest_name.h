// "Did you mean ...?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace edgesplat {

/// Letters to insert, delete or replace to turn one word into the other (Levenshtein 1966).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that is spelled most like `text`; empty if none is near: more than a third of its letters differ.
std::string nearest_name(std::string_view text, std::span<const std::string> names);

}  // namespace edgesplat
