// What the fuzzers share: a folder of the process's own, and files in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace edgesplat::fuzz {

/// Where fuzzed files lie, in memory where the system has such a place; the program's own temporary files go there too,
/// and readers of volumes get 256 MiB. Made once, removed when the process ends.
const std::filesystem::path& folder();

/// Writes FOLDER/`name`, anew.
std::string write(const std::string& name, std::string_view content);

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Reads the content as a volume under that name; its path. Errors are what is expected; anything else that is thrown
/// ends the fuzzer.
std::string load(const std::string& name, std::string_view content);

}  // namespace edgesplat::fuzz
