// Reads and writes the pipeline cache file: the driver's data behind a header with length and checksum.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace edgesplat::gpu {

/// The driver's data from the file. Empty if the file is missing, damaged, truncated, longer than its header states, or
/// not a regular file. Allocates at most the file's size.
std::vector<std::uint8_t> read_pipeline_cache_file(const std::filesystem::path& file);

/// Writes a temporary file and renames it; creates the folder. Returns whether that succeeded.
bool write_pipeline_cache_file(const std::filesystem::path& file, const std::vector<std::uint8_t>& data);

}  // namespace edgesplat::gpu
