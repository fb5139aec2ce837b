// Files that are kept between runs: bytes behind a header with their kind, their length and a checksum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace edgesplat {

/// The bytes of a file of this kind (8 letters). Empty if the file is missing, damaged, truncated, longer than its
/// header states, of another kind, or not a regular file. Allocates at most the file's size.
std::vector<std::uint8_t> read_checked_file(const std::filesystem::path& file, std::string_view kind);

/// Writes a temporary file and renames it, which is safe with several processes; creates the folder. Returns whether
/// that succeeded.
bool write_checked_file(const std::filesystem::path& file, std::string_view kind,
                        const std::vector<std::uint8_t>& bytes);

}  // namespace edgesplat
