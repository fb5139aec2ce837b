// Measures how much memory this process uses.
#pragma once

#include <cstdint>

namespace edgesplat::bench {

/// Peak resident memory since the process began or reset_host_peak() was called, bytes; 0 if the system does not
/// report it.
std::uint64_t host_peak_bytes();

/// Resets the peak. False: the system cannot do it.
bool reset_host_peak();

}  // namespace edgesplat::bench
