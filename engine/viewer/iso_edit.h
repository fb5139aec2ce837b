// Iso-values of a scene as a hand changes them, each together with the material that begins at it.
#pragma once

#include <optional>

#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"

namespace edgesplat::viewer {

/// All of these want a document with as many materials as iso-values, these ascending (Session::open sees to that), and
/// keep it so. Iso-values stay within the volume's values, above the least of them, and so far apart:
inline constexpr double kIsoGap = 1e-5;  ///< of the range of the volume's values

/// Adds one, or the nearest to it that is allowed. Its material has the first default colour that no other has, and is
/// opaque above all others, else translucent, as in resolve_scene. Returns its place; none where there are
/// kMaxIsoValues, for a constant volume, and for a value that is not finite.
std::optional<std::size_t> add_iso_value(SceneDocument& document, const Volume& volume, double value);

/// Moves one, also past others; its material goes with it. Returns its new place. Does nothing for a value that is not
/// finite.
std::size_t move_iso_value(SceneDocument& document, const Volume& volume, std::size_t place, double value);

/// Takes one away with its material. The last one stays unless there is a transfer function. Whether it is gone.
bool remove_iso_value(SceneDocument& document, std::size_t place);

/// A material by its number: 0 lies below all iso-values.
MaterialChoice& material_choice(SceneDocument& document, std::size_t material);

/// Gives a material the look and the name of a preset that is one; its iso-value too, where the preset has one that
/// occurs in the volume. Returns the material's number afterwards.
std::size_t take_material(SceneDocument& document, const Volume& volume, std::size_t material,
                          const ScenePreset& preset);

}  // namespace edgesplat::viewer
