#include "engine/scene/cuts.h"

#include <algorithm>
#include <utility>

#include "engine/error.h"

namespace edgesplat {

std::shared_ptr<const Volume> Cuts::apply(SceneDocument& document, std::shared_ptr<const Volume> whole) {
    document.whole = {};
    std::vector<Cutter> cutters;
    const auto for_entries = [&](const auto& work) {
        for (std::size_t i = 0; i < document.volumes.size(); ++i) {
            try {
                work(document.volumes[i]);
            } catch (const Error& error) {
                fail("volumes[{}]: {}", i, error.what());
            }
        }
    };
    for_entries([&](SceneDocument& entry) {
        entry.cut = {};
        if (cuts(entry) && entry.volume.visible)
            cutters.push_back({entry.read->volume, lowest_matter(entry, *entry.read->volume)});
    });
    std::vector<Cut> now;
    const auto cut = [&](const SceneDocument& matter, const std::shared_ptr<const Volume>& volume) {
        Cut wanted{volume, lowest_matter(matter, *volume), cutters, nullptr};
        const auto found = std::ranges::find_if(kept_, [&](const Cut& kept) {
            return kept.whole == wanted.whole && kept.iso == wanted.iso && kept.cutters == wanted.cutters;
        });
        wanted.drawn = found != kept_.end()
                           ? found->drawn
                           : std::make_shared<const Volume>(without_solids(*volume, wanted.iso, wanted.cutters));
        now.push_back(wanted);
        return wanted.drawn;
    };
    std::shared_ptr<const Volume> first = whole;
    if (!cutters.empty()) {
        first = cut(document, whole);
        document.whole = {std::move(whole)};
        for_entries([&](SceneDocument& entry) {
            if (!cuts(entry) && entry.volume.visible) entry.cut = {cut(entry, entry.read->volume)};
        });
    }
    kept_ = std::move(now);
    return first;
}

}  // namespace edgesplat
