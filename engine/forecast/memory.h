// Whether a frame fits into the device's memory, asked before anything is allocated; and what would fit if not.
#pragma once

#include <string>
#include <vector>

#include "engine/forecast/description.h"
#include "engine/forecast/forecast.h"

namespace edgesplat {

/// What a frame takes of a device, next to what is held there already.
struct MemoryNeed {
    struct Row {
        std::string name;
        std::uint64_t needed = 0;  ///< bytes, as the device rounds them up
        std::uint64_t held = 0;    ///< bytes held under this name before
    };
    std::vector<Row> rows;        ///< largest first
    std::uint64_t total = 0;      ///< everything that is held at once at most, other things of this renderer included
    std::uint64_t available = 0;  ///< of `total`
    std::string limited_by;       ///< "--memory-budget", "the heap of ..."
    std::vector<std::string> too_large;  ///< single resources beyond a limit of the device, a sentence each
    bool fits() const { return total <= available && too_large.empty(); }
};

/// `budget`: bytes that may be held in all, 0: as much as the device has. Allocates nothing.
MemoryNeed memory_need(const gpu::Device& device, const FrameForecast& forecast, std::uint64_t budget);

/// Changes, one at a time and then together, each of which is known to fit. `reach`: kernel_reach of the settings.
std::vector<FittingChange> what_fits(const gpu::Device& device, const FrameRequest& request, std::uint64_t budget);

/// Throws Error with what is needed, resource by resource, what is available and what would fit, if `need` does not.
[[noreturn]] void refuse_memory(const gpu::Device& device, const FrameRequest& request, const MemoryNeed& need,
                                std::uint64_t budget);

}  // namespace edgesplat
