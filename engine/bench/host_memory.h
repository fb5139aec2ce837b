// How much memory this process has taken.
#pragma once

#include <cstdint>

namespace edgesplat::bench {

/// The most that was resident since the process or forget_host_peak began, bytes; 0 where the system does not say.
std::uint64_t host_peak_bytes();

/// Counts the peak anew. Whether the system could.
bool forget_host_peak();

}  // namespace edgesplat::bench
