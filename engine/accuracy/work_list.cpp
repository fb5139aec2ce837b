#include "engine/accuracy/work_list.h"

#include <algorithm>
#include <chrono>

namespace edgesplat::accuracy {

WorkList::Kind& WorkList::kind(const std::string& name) {
    const auto found = std::find_if(kinds_.begin(), kinds_.end(), [&](const auto& k) { return k.first == name; });
    return found != kinds_.end() ? found->second : kinds_.emplace_back(name, Kind{}).second;
}

void WorkList::add(Piece piece, double expected_seconds) {
    Kind& of = kind(piece.kind);
    of.expected = expected_seconds;
    if (journal_.find(piece.key) == nullptr) ++of.left;
    pieces_.push_back(std::move(piece));
}

bool WorkList::should_continue(double share_of_piece) {
    if (!progress_ || current_ >= pieces_.size()) return true;
    double left = 0;
    for (const auto& [name, k] : kinds_)
        left += static_cast<double>(k.left) * k.each();
    const double of_this = share_of_piece * kind(pieces_[current_].kind).each();
    left = std::max(left - of_this, 0.0);
    const double done = spent_ + of_this;
    const Progress state{done + left > 0 ? done / (done + left) : 1, left, current_, pieces_.size(),
                         pieces_[current_].what};
    return progress_(state);
}

void WorkList::check(double share_of_piece) {
    if (!should_continue(share_of_piece)) stop();
}

void WorkList::stop() const {
    throw Interrupted(fmt::format("stopped after {} of {} measurements; the same command continues from there",
                                  current_, pieces_.size()));
}

void WorkList::run() {
    for (current_ = 0; current_ < pieces_.size(); ++current_) {
        const Piece& piece = pieces_[current_];
        if (journal_.find(piece.key) != nullptr) continue;
        check();
        const auto begin = std::chrono::steady_clock::now();
        const nlohmann::ordered_json value = piece.run();
        journal_.add(piece.key, value);
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        Kind& of = kind(piece.kind);
        of.seconds += seconds;
        ++of.timed;
        --of.left;
        spent_ += seconds;
    }
}

}  // namespace edgesplat::accuracy
