// Helpers of the fuzzers: a temporary folder of the process, and files in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat::fuzz {

/// The folder of fuzzed files, in memory (/dev/shm) if possible, as are the program's temporary files. Volume readers
/// may use 256 MiB. Created once, removed when the process ends.
const std::filesystem::path& folder();

/// Writes FOLDER/`name`, replacing an older file; returns its path.
std::string write(const std::string& name, std::string_view content);

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Writes the content under that name, loads it as a volume and returns its path. Error is expected; any other
/// exception ends the fuzzer.
std::string load(const std::string& name, std::string_view content);

}  // namespace edgesplat::fuzz
