#include <chrono>

#include "apps/edgesplat-fly/scene_editing.h"
#include "engine/error.h"

namespace {

constexpr int kBins = 256, kSuggestions = 4;

ValueStatistics counted(const edgesplat::Volume& volume) {
    try {
        ValueStatistics found{edgesplat::histogram(volume, kBins), edgesplat::suggest_iso_values(volume, kSuggestions)};
        found.histogram.low = volume.in_file_unit(found.histogram.low);
        found.histogram.high = volume.in_file_unit(found.histogram.high);
        for (auto& suggestion : found.suggestions)
            suggestion.value = volume.in_file_unit(suggestion.value);
        return found;
    } catch (const edgesplat::Error&) {
        return {};  // the drawer reports packed files that have become unreadable
    }
}

}  // namespace

bool ValueCounter::busy() const {
    return to_come_.valid() && to_come_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
}

const ValueStatistics* ValueCounter::of(const std::shared_ptr<const edgesplat::Volume>& volume, bool wait) {
    if (counted_ == volume) return &found_;
    if (to_come_.valid() && (wait || to_come_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)) {
        found_ = to_come_.get();
        counted_ = std::move(volume_);
    }
    if (!to_come_.valid() && counted_ != volume) {
        volume_ = volume;
        to_come_ = std::async(std::launch::async, [volume] { return counted(*volume); });
        if (wait) return of(volume, wait);
    }
    return counted_ == volume ? &found_ : nullptr;
}
