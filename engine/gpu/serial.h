// Numbers that tell resources apart for ever: a driver may give the handle of one that is gone to the next.
#pragma once

#include <atomic>
#include <cstdint>

namespace edgesplat::gpu {

/// Never the same twice; never 0.
inline std::uint64_t next_serial() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

}  // namespace edgesplat::gpu
