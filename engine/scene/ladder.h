// The ladder: every approximation is a knob with named steps, cheapest first. One table that the command line, its
// help, the accuracy report and the app are made from; presets are rows of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/settings.h"

namespace edgesplat {

/// What a better step buys.
enum class KnobKind {
    Method,  ///< nearer to the model: the sum of all kernels, evaluated without sheets or tables
    Model,   ///< a model that is nearer to the truth
};

/// One approximation.
struct Knob {
    std::string_view name;  ///< option (--NAME), column and key of reports
    std::string_view help;  ///< what it decides, in one line
    KnobKind kind;
    std::vector<std::string_view> steps;  ///< cheapest first
    /// Values that are no steps but can be asked for all the same (what the paper did, where that is no bargain).
    std::vector<std::string_view> others;
    /// Where the steps are measured from, given the base: a step of a knob that has no say there would be none.
    void (*from)(Settings&) = nullptr;
    bool number = false;       ///< any number of the setting's range is accepted; `steps` are those that are measured
    double low = 0, high = 0;  ///< range of a number; `low` itself is excluded where `above_low`
    bool above_low = false;
    std::string (*get)(const Settings&);  ///< the value as the command line spells it
    void (*assign)(Settings&, const Knob&, std::string_view value);
    bool (*matters)(const Settings&) = nullptr;  ///< whether it does anything there; null: always

    /// Throws Error saying what was given and what is expected.
    void set(Settings& settings, std::string_view value) const { assign(settings, *this, value); }
    bool used(const Settings& settings) const { return matters == nullptr || matters(settings); }
};

/// All knobs, in the order of the pipeline.
std::span<const Knob> ladder();

/// The knob of that name; throws Error listing the names.
const Knob& knob_named(std::string_view name);

/// A named row of the ladder.
struct Preset {
    std::string_view name;
    std::string_view help;
    Settings settings;
};

/// draft, accurate: cheapest first. The default settings are whole kernels, as draft is: draft is found sooner,
/// accurate is drawn slower than both.
std::span<const Preset> presets();

/// The preset of that name; throws Error listing the names.
const Preset& preset_named(std::string_view name);

/// "edges=march sheets=sliced ...": the knobs in which `settings` differs from `from`; empty if in none.
std::string difference(const Settings& settings, const Settings& from = {});

}  // namespace edgesplat
