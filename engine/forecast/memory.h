// Tests whether a frame fits into the device's memory before anything is allocated, and finds changes that fit.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// The memory that a frame needs on a device, including what is allocated already.
struct MemoryNeed {
    struct Row {
        std::string name;
        std::uint64_t needed = 0;  ///< bytes, rounded up by the device
        std::uint64_t held = 0;    ///< bytes allocated under this name now
    };
    std::vector<Row> rows;  ///< largest first
    /// Bytes of each volume by FrameRequest::number; the others are the picture's.
    std::map<std::size_t, std::uint64_t> of_volumes;
    std::uint64_t total = 0;             ///< peak bytes, including this renderer's other resources
    std::uint64_t available = 0;         ///< upper limit of `total`, bytes
    std::string limited_by;              ///< "the memory budget", "the free memory of heap 0 of ..."
    std::vector<std::string> too_large;  ///< single resources that exceed a limit of the device, a sentence each
    bool fits() const { return total <= available && too_large.empty(); }
};

/// `budget`: limit of the total, bytes; 0: the device's memory. Allocates nothing.
MemoryNeed memory_need(const gpu::Device& device, const FrameForecast& forecast, std::uint64_t budget);

/// Single changes of the request that fit; if there are none, a combination. `budget`: as above.
std::vector<FittingChange> fitting_changes(const gpu::Device& device, const FrameRequest& request,
                                           std::uint64_t budget);

/// Throws Error with the memory needed by resource, the memory available, and changes that fit.
[[noreturn]] void refuse_memory(const gpu::Device& device, const FrameRequest& request, const MemoryNeed& need,
                                std::uint64_t budget);

}  // namespace edgesplat
