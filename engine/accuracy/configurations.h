// What the report measures: each step of each knob on its own, combinations of method knobs, the presets, and what they
// are held against: plain splatting and both ray casters.
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

/// One row of the report. Several rows may show the same pictures; those are measured once.
struct Configuration {
    ConfigurationKind kind = ConfigurationKind::Base;
    std::string name;        ///< "base", "footprints=table", "sheets=sliced sheet-spacing=1", "draft"
    std::string knob, step;  ///< of a Step
    Settings settings;
    std::optional<RaycastFilter> rays;  ///< the ray caster in place of splats; `settings` are the base's
};

/// The base, plain splatting and the ray casters; steps of every knob that is used in `base`, in the ladder's order;
/// then combinations (at most 40) and presets. With `knobs` only the steps of those, and no combinations. Throws Error
/// for a name that is no knob's.
std::vector<Configuration> configurations(const Settings& base, std::span<const std::string> knobs = {});

/// The same pictures are made: knobs that are of no use there are at their defaults.
Settings canonical(const Settings& settings);

/// What is to be drawn, canonical: equal for rows that show the same pictures.
std::string picture_key(const Configuration& row);

/// "edges=march footprints=..." of every knob, canonical: equal for settings that make the same pictures.
std::string settings_key(const Settings& settings);

/// The model that a method stands for: method knobs are at what the reference evaluates, whatever they were.
Settings model_of(const Settings& settings);

/// settings_key of the model.
std::string model_key(const Settings& settings);

}  // namespace edgesplat::accuracy
