// Pass 4: sorts splats into sheets, front to back (docs/method/4_sort_sheets.md).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/reference/3_select_footprints.h"

namespace edgesplat::reference {

/// Kept splats ordered by sheet; within a sheet in list order.
struct SortedSheets {
    std::vector<std::uint32_t> order;  ///< indices of the kept records
    std::vector<std::uint32_t> begin;  ///< sheet s is order[begin[s] .. begin[s + 1]); sheets + 1 entries
    std::size_t sheets() const { return begin.size() - 1; }
    std::span<const std::uint32_t> sheet(std::size_t s) const {
        return std::span(order).subspan(begin[s], begin[s + 1] - begin[s]);
    }
};

SortedSheets sort_sheets(std::span<const Selected> selected);

}  // namespace edgesplat::reference
