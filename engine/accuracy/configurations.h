// The rows of the report: each step of each knob alone, combinations of method knobs, the presets, and for comparison
// plain splatting and both ray casters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/renderer_kind.h"
#include "engine/scene/settings.h"

namespace edgesplat::accuracy {

enum class ConfigurationKind { Base, Plain, Rays, Step, Combination, Preset };
std::string_view name_of(ConfigurationKind kind);  ///< base, plain, rays, step, combination, preset

/// One row of the report. Rows that show the same pictures are measured once.
struct Configuration {
    ConfigurationKind kind = ConfigurationKind::Base;
    std::string name;        ///< "base", "footprints=table", "sheets=sliced sheet-spacing=1", "draft"
    std::string knob, step;  ///< only of a Step
    Settings settings;
    std::optional<RaycastFilter> rays;  ///< set: ray caster instead of splats; `settings` are the base's
};

/// The base, plain splatting and the ray casters; steps of every knob that `base` uses, in the ladder's order; then
/// combinations (at most 40) and presets. With `knobs` only the steps of those, and no combinations. Throws Error for
/// the name of no knob.
std::vector<Configuration> configurations(const Settings& base, std::span<const std::string> knobs = {});

/// The same settings with all unused knobs at their defaults. The pictures are the same.
Settings canonical(const Settings& settings);

/// The pictures of a row, canonical: equal for rows that show the same pictures.
std::string picture_key(const Configuration& row);

/// "edges=march footprints=..." for every knob, canonical: equal for settings with the same pictures.
std::string settings_key(const Settings& settings);

/// The model that a method approximates: its method knobs have the values that the reference evaluates.
Settings model_of(const Settings& settings);

/// settings_key of the model.
std::string model_key(const Settings& settings);

}  // namespace edgesplat::accuracy
