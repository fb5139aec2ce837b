// The ladder: a table of all approximations as knobs with named steps, cheapest first. The command line, its help, the
// accuracy report and the app are built from it; presets are rows of it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/settings.h"

namespace edgesplat {

/// What a better step improves.
enum class KnobKind {
    Method,  ///< the error against the model: the sum of all kernels, evaluated without sheets or tables
    Model,   ///< the model's error against the truth
};

/// One approximation.
struct Knob {
    std::string_view name;  ///< name of the option (--NAME), of report columns and keys
    std::string_view help;  ///< description in one line
    KnobKind kind;
    std::vector<std::string_view> steps;  ///< cheapest first
    /// Accepted values that are not steps of the ladder, e.g. the paper's methods.
    std::vector<std::string_view> others;
    /// Adapts the base settings so that this knob has an effect, before its steps are measured.
    void (*from)(Settings&) = nullptr;
    bool number = false;       ///< true: accepts any number in the range; only `steps` are measured
    double low = 0, high = 0;  ///< range of the number; `low` is excluded if `above_low`
    bool above_low = false;
    std::string (*get)(const Settings&);  ///< the value as written on the command line
    void (*assign)(Settings&, const Knob&, std::string_view value);
    bool (*matters)(const Settings&) = nullptr;  ///< whether the knob has an effect with these settings; null: always

    /// Sets the knob. Throws Error with the given and the expected value.
    void set(Settings& settings, std::string_view value) const { assign(settings, *this, value); }
    bool used(const Settings& settings) const { return matters == nullptr || matters(settings); }
};

/// All knobs, in the order of the pipeline.
std::span<const Knob> ladder();

/// The knob with this name; throws Error listing the names.
const Knob& knob_named(std::string_view name);

/// A named row of the ladder.
struct Preset {
    std::string_view name;
    std::string_view help;
    Settings settings;
};

/// draft and accurate, cheapest first. The default settings use whole kernels, as draft does. draft estimates edges
/// faster; accurate draws slower than both.
std::span<const Preset> presets();

/// The preset with this name; throws Error listing the names.
const Preset& preset_named(std::string_view name);

/// The knobs in which `settings` differs from `from`, e.g. "edges=march sheets=sliced"; empty if none.
std::string difference(const Settings& settings, const Settings& from = {});

}  // namespace edgesplat
