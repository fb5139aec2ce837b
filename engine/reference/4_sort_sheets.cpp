#include "engine/reference/4_sort_sheets.h"

#include <algorithm>

namespace edgesplat::reference {

SortedSheets sort_sheets(std::span<const Selected> selected) {
    std::size_t sheets = 0;
    for (const Selected& s : selected) {
        if (s.kept) sheets = std::max(sheets, static_cast<std::size_t>(s.last_sheet) + 1);
    }
    const auto for_each_sheet = [](const Selected& s, const auto& work) {
        if (!s.kept) return;
        for (int sheet = s.sheet; sheet <= s.last_sheet; ++sheet)
            work(static_cast<std::size_t>(sheet));
    };
    SortedSheets sorted;
    sorted.begin.assign(sheets + 1, 0);
    for (const Selected& s : selected)
        for_each_sheet(s, [&](std::size_t sheet) { ++sorted.begin[sheet + 1]; });
    for (std::size_t s = 0; s < sheets; ++s)
        sorted.begin[s + 1] += sorted.begin[s];

    std::vector<std::uint32_t> next(sorted.begin.begin(), sorted.begin.end() - 1);
    sorted.order.resize(sorted.begin.back());
    for (std::size_t i = 0; i < selected.size(); ++i)
        for_each_sheet(selected[i],
                       [&](std::size_t sheet) { sorted.order[next[sheet]++] = static_cast<std::uint32_t>(i); });
    return sorted;
}

}  // namespace edgesplat::reference
