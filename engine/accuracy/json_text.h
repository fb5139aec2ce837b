// Converts JSON to text.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace edgesplat {

/// The value as text, indented if `indent` >= 0. Names of files need not be UTF-8, but JSON must be: invalid bytes
/// become U+FFFD instead of an exception.
template <typename Json>
std::string json_text(const Json& value, int indent = -1) {
    return value.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace edgesplat
