// The FNV-1a checksum of bytes.
#pragma once

#include <cstdint>
#include <string_view>

namespace edgesplat {

/// 64-bit FNV-1a. Detects accidental damage and gives a long text a short name; not secure against attacks.
constexpr std::uint64_t fnv1a(std::string_view bytes) {
    std::uint64_t hash = 0xcbf29ce484222325U;
    for (const char byte : bytes)
        hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
    return hash;
}

}  // namespace edgesplat
