// Text files that people write: read whole, when they are what they seem to be.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat {

/// Bytes a scene, a script or a suite may have.
inline constexpr std::size_t kMaxTextBytes = std::size_t{1} << 24;

/// What is in an ordinary file; `expected` says what it should be: "a scene file". Throws Error naming the file: it is
/// not there, is a folder, a FIFO or a device (which are not opened), cannot be read, or has more than kMaxTextBytes.
std::string read_text_file(const std::filesystem::path& path, std::string_view expected);

/// The first byte that is not part of valid UTF-8, or npos.
std::size_t invalid_utf8(std::string_view text);

/// The text with U+FFFD in the place of every byte that is not part of valid UTF-8.
std::string valid_utf8(std::string_view text);

}  // namespace edgesplat
