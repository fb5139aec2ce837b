// Reads text files that users write, and validates UTF-8.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat {

/// Maximum size of a scene, script or suite, bytes.
inline constexpr std::size_t kMaxTextBytes = std::size_t{1} << 24;

/// The content of a regular file; `expected` describes it, e.g. "a scene file". Throws Error naming the file if it does
/// not exist, is a folder, a FIFO or a device (these are not opened), cannot be read, or has more than kMaxTextBytes.
std::string read_text_file(const std::filesystem::path& path, std::string_view expected);

/// Position of the first byte that is not valid UTF-8, or npos.
std::size_t invalid_utf8(std::string_view text);

/// The text with U+FFFD in place of each byte that is not valid UTF-8.
std::string valid_utf8(std::string_view text);

}  // namespace edgesplat
