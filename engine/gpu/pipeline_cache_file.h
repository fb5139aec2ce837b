// The file of compiled pipelines: what the driver gave, behind a header that tells whether it is whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace edgesplat::gpu {

/// What a driver gave, from the file; empty where there is none, where it is damaged, truncated or longer than its
/// header says, or not an ordinary file. Takes no more memory than the file has bytes.
std::vector<std::uint8_t> read_pipeline_cache_file(const std::filesystem::path& file);

/// Writes beside the file and renames; makes the folder. Whether all is well.
bool write_pipeline_cache_file(const std::filesystem::path& file, const std::vector<std::uint8_t>& data);

}  // namespace edgesplat::gpu
