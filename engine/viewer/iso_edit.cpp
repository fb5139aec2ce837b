#include "engine/viewer/iso_edit.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/default_materials.h"

namespace edgesplat::viewer {
namespace {

/// The allowed value nearest to `value`, given the `others`; nullopt if there is none.
std::optional<double> free_value(const std::vector<double>& others, const Volume& volume, double value) {
    const double low = volume.in_file_unit(static_cast<double>(volume.min_value));
    const double high = volume.in_file_unit(static_cast<double>(volume.max_value));
    const double gap = kIsoGap * (high - low);
    if (!(gap > 0) || !std::isfinite(value)) return std::nullopt;
    const auto allowed = [&](double v) {
        // 0.99: by rounding, a value exactly one gap away from another may be nearer.
        return v > low && v <= high &&
               std::ranges::none_of(others, [&](double other) { return std::abs(v - other) < 0.99 * gap; });
    };
    const double wanted = std::clamp(value, low + gap, high);
    std::vector<double> candidates{wanted};
    for (const double other : others)
        candidates.insert(candidates.end(), {other - gap, other + gap});
    std::optional<double> best;
    for (const double candidate : candidates)
        if (allowed(candidate) && (!best || std::abs(candidate - wanted) < std::abs(*best - wanted))) best = candidate;
    return best;
}

std::size_t insert(SceneDocument& document, double value, MaterialChoice material) {
    const auto at = std::ranges::upper_bound(document.iso_values, value) - document.iso_values.begin();
    document.iso_values.insert(document.iso_values.begin() + at, value);
    document.materials.insert(document.materials.begin() + at, std::move(material));
    return static_cast<std::size_t>(at);
}

void erase(SceneDocument& document, std::size_t place) {
    const auto at = static_cast<std::ptrdiff_t>(place);
    document.iso_values.erase(document.iso_values.begin() + at);
    document.materials.erase(document.materials.begin() + at);
}

glm::dvec3 unused_color(const SceneDocument& document, std::size_t place) {
    for (std::size_t i = 0; i < kMaxIsoValues; ++i) {
        const glm::dvec3 color = default_color(i);
        const auto same = [&](const MaterialChoice& material) { return material.color == color; };
        if (std::ranges::none_of(document.materials, same)) return color;
    }
    return default_color(place);
}

}  // namespace

std::optional<std::size_t> add_iso_value(SceneDocument& document, const Volume& volume, double value) {
    if (document.iso_values.size() >= kMaxIsoValues) return std::nullopt;
    const auto free = free_value(document.iso_values, volume, value);
    if (!free) return std::nullopt;
    const bool highest = document.iso_values.empty() || *free > document.iso_values.back();
    MaterialChoice material;
    material.color = unused_color(document, document.iso_values.size());
    material.extinction = default_extinction(highest, volume.geometry);
    return insert(document, *free, std::move(material));
}

std::size_t move_iso_value(SceneDocument& document, const Volume& volume, std::size_t place, double value) {
    std::vector<double> others = document.iso_values;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(place));
    const auto free = free_value(others, volume, value);
    if (!free) return place;
    MaterialChoice material = document.materials[place];
    erase(document, place);
    return insert(document, *free, std::move(material));
}

bool remove_iso_value(SceneDocument& document, std::size_t place) {
    const bool needed = document.transfer.empty() && document.transfer_preset.empty();
    if (place >= document.iso_values.size() || (needed && document.iso_values.size() == 1)) return false;
    erase(document, place);
    return true;
}

MaterialChoice& material_choice(SceneDocument& document, std::size_t material) {
    return material == 0 ? document.below : document.materials.at(material - 1);
}

std::size_t apply_material_preset(SceneDocument& document, const Volume& volume, std::size_t material,
                                  const ScenePreset& preset) {
    const SceneDocument& content = preset.content;
    if (content.materials.size() != 1) return material;
    // If the preset has no value, colour and extinction stay; everything else gets its default.
    const MaterialChoice &look = content.materials.front(), now = material_choice(document, material);
    MaterialChoice taken = choice_of(Material{});
    taken.color = look.color ? look.color : now.color;
    taken.extinction = look.extinction ? look.extinction : now.extinction;
    taken.ambient = look.ambient ? look.ambient : taken.ambient;
    taken.diffuse = look.diffuse ? look.diffuse : taken.diffuse;
    taken.specular = look.specular ? look.specular : taken.specular;
    taken.shininess = look.shininess ? look.shininess : taken.shininess;
    taken.name = look.name.empty() ? preset.name : look.name;
    material_choice(document, material) = std::move(taken);
    if (material == 0 || content.iso_values.empty()) return material;
    const double value = content.iso_values.front(), sample = value / volume.value_scale;
    if (!(sample > static_cast<double>(volume.min_value) && sample <= static_cast<double>(volume.max_value)))
        return material;
    return move_iso_value(document, volume, material - 1, value) + 1;
}

}  // namespace edgesplat::viewer
