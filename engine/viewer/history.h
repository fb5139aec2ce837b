// Undo and redo of a value.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace edgesplat::viewer {

/// States of a value. Intermediate states of a drag are not kept, only the state before it and its last one.
template <typename State>
class History {
  public:
    explicit History(State first) : states_{std::move(first)} {}

    const State& now() const { return dragged_ ? *dragged_ : states_[at_]; }

    /// Sets a new state. `finished`: it becomes an undo step and discards the undone ones; else it is an intermediate
    /// state.
    void change(State state, bool finished) {
        if (!finished) {
            dragged_.emplace(std::move(state));
            return;
        }
        dragged_.reset();
        if (state == states_[at_]) return;
        states_.resize(at_ + 1);
        states_.push_back(std::move(state));
        if (states_.size() > kMost) states_.erase(states_.begin());
        at_ = states_.size() - 1;
    }

    /// Replaces the current state without a step.
    void amend(State state) { (dragged_ ? *dragged_ : states_[at_]) = std::move(state); }
    /// Calls change(state) for all states but the current one.
    template <typename Change>
    void for_others(const Change& change) {
        for (State& state : states_)
            if (&state != &now()) change(state);
    }

    /// Whether the current state is an intermediate one.
    bool has_pending_edit() const { return dragged_.has_value(); }
    bool can_undo() const { return at_ > 0 || dragged_; }
    bool can_redo() const { return at_ + 1 < states_.size() && !dragged_; }
    void undo() {
        if (dragged_)
            dragged_.reset();
        else if (at_ > 0)
            --at_;
    }
    void redo() {
        if (can_redo()) ++at_;
    }

  private:
    static constexpr std::size_t kMost = 200;
    std::vector<State> states_;
    std::optional<State> dragged_;
    std::size_t at_ = 0;
};

}  // namespace edgesplat::viewer
