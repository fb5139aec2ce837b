#include "engine/viewer/pace.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace edgesplat::viewer {
namespace {

constexpr std::array<double, 10> kScales{0.0625, 0.09375, 0.125, 0.1875, 0.25, 0.375, 0.5, 0.625, 0.75, 1.0};

// Shares of the target: the time to aim at, the time that triggers a step down, and the largest expected time after a
// step up.
constexpr double kAim = 0.6, kTooLong = 0.8, kRoom = 0.65;
constexpr int kCalm = 4;              // pictures with time to spare before a step up
constexpr double kLeastScale = 0.25;  // below this scale a coarser level shows more
constexpr double kFinerScale = 0.5;   // from this scale on a finer level shows more
constexpr int kTrial = 10;            // pictures until the trial of a finer level has succeeded
constexpr int kPenalty = 40;          // pictures before a failed level is tried again; doubled with each failure

/// The largest scale <= `scale`, or the smallest one.
double step_at_most(double scale) {
    double found = kScales.front();
    for (const double s : kScales)
        if (s <= scale + 1e-9) found = s;
    return found;
}

double step_above(double scale) {
    const auto above = std::ranges::upper_bound(kScales, scale + 1e-9);
    return above == kScales.end() ? kScales.back() : *above;
}

}  // namespace

std::span<const double> pace_scales() {
    return kScales;
}

Pace::Pace(double target, int coarsest, bool rays) : target_(target), coarsest_(rays ? 0 : coarsest) {
    rung_.rays = rays;
    restart();
}

void Pace::set_target(double milliseconds) {
    if (milliseconds == target_) return;
    target_ = milliseconds;
    calm_ = 0;
}

void Pace::restart() {
    rung_ = {coarsest_, kLeastScale, rung_.rays};
    calm_ = 0;
    since_finer_ = -1;
    finer_blocked_ = finer_penalty_ = 0;
}

void Pace::drawn(double milliseconds, double setup, bool finer_ready) {
    if (finer_blocked_ > 0) --finer_blocked_;
    if (since_finer_ >= 0 && ++since_finer_ > kTrial) {
        since_finer_ = -1;
        finer_penalty_ = 0;
    }
    const double drawing = milliseconds - setup;
    if (drawing > kTooLong * target_) return step_down(drawing);
    // Setup time counts where a coarser level exists: while the user edits the scene, every picture needs setup.
    if (milliseconds > target_ && rung_.level < coarsest_) return step_down(milliseconds);
    step_up(drawing, finer_ready);
}

void Pace::step_down(double milliseconds) {
    calm_ = 0;
    const double wanted = rung_.scale * std::sqrt(kAim * target_ / milliseconds);
    const double lower = std::min(step_at_most(wanted), step_at_most(rung_.scale * 0.999));
    const bool on_trial = since_finer_ >= 0;
    if (rung_.level < coarsest_ && (on_trial || lower < kLeastScale)) {
        since_finer_ = -1;
        finer_blocked_ = kPenalty << std::min(finer_penalty_++, 6);
        rung_ = {rung_.level + 1, std::max(step_at_most(wanted), kLeastScale)};
        return;
    }
    rung_.scale = std::max(lower, rung_.level < coarsest_ ? kLeastScale : kScales.front());
}

void Pace::step_up(double milliseconds, bool finer_ready) {
    const double next = step_above(rung_.scale);
    const double grown = next / rung_.scale;
    const bool finer = rung_.level > 0 && finer_ready && finer_blocked_ == 0 && rung_.scale >= kFinerScale;
    // A finer level has four times the splats on the same surfaces; its pictures have half the width.
    const double finer_cost = milliseconds * 4 * 0.5;
    const bool room =
        finer ? finer_cost < kAim * target_ : next > rung_.scale && milliseconds * grown * grown < kRoom * target_;
    if (!room) {
        // If the finer level does not fit, a larger picture of this level may still fit.
        const bool larger = next > rung_.scale && milliseconds * grown * grown < kRoom * target_;
        calm_ = larger ? calm_ + 1 : 0;
        if (calm_ < kCalm) return;
        calm_ = 0;
        rung_.scale = next;
        return;
    }
    if (++calm_ < kCalm) return;
    calm_ = 0;
    if (finer) {
        rung_ = {rung_.level - 1, kLeastScale};
        since_finer_ = 0;
    } else {
        rung_.scale = next;
    }
}

}  // namespace edgesplat::viewer
