// Interactive changes of a scene's iso-values, each with the material that begins at it.
#pragma once

#include <optional>

#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"

namespace edgesplat::viewer {

/// All functions expect as many materials as iso-values, with ascending iso-values, and preserve this. Session::open
/// ensures it. Iso-values stay above the volume's least value, up to its largest one, and at least this far apart:
inline constexpr double kIsoGap = 1e-5;  ///< share of the range of the volume's values

/// Adds an iso-value, or the nearest allowed one. Its material gets the first unused default colour. It is opaque if it
/// is the highest, else translucent, as in resolve_scene. Returns its index. nullopt if there are kMaxIsoValues
/// already, for a constant volume, and for a value that is not finite.
std::optional<std::size_t> add_iso_value(SceneDocument& document, const Volume& volume, double value);

/// Moves an iso-value with its material, also past others. Returns its new index. Does nothing if the value is not
/// finite.
std::size_t move_iso_value(SceneDocument& document, const Volume& volume, std::size_t place, double value);

/// Removes an iso-value with its material. Returns whether it did: the last one stays unless there is a transfer
/// function.
bool remove_iso_value(SceneDocument& document, std::size_t place);

/// The material with a number; number 0 lies below all iso-values.
MaterialChoice& material_choice(SceneDocument& document, std::size_t material);

/// Gives a material the look and name of a material preset. If the preset has an iso-value that occurs in the volume,
/// the material moves there. Returns the material's new number.
std::size_t apply_material_preset(SceneDocument& document, const Volume& volume, std::size_t material,
                                  const ScenePreset& preset);

}  // namespace edgesplat::viewer
