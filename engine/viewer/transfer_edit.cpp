#include "engine/viewer/transfer_edit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/default_materials.h"
#include "engine/scene/transfer_function.h"

namespace edgesplat::viewer {

std::optional<std::size_t> add_transfer_point(TransferPoints& points, double value, double gap) {
    if (points.empty() || points.size() >= kMaxTransferPoints || !std::isfinite(value)) return std::nullopt;
    const auto above = std::ranges::upper_bound(points, value, {}, &TransferPoint::value);
    if (above != points.end() && above->value - value < gap) return std::nullopt;
    if (above != points.begin() && value - (above - 1)->value < gap) return std::nullopt;
    const auto place = static_cast<std::size_t>(above - points.begin());
    points.insert(above, transfer_at(points, value));
    return place;
}

void move_transfer_point(TransferPoints& points, std::size_t place, double value, double extinction, double gap) {
    TransferPoint& point = points.at(place);
    if (std::isfinite(extinction)) point.extinction = std::max(extinction, 0.0);
    if (!std::isfinite(value)) return;
    constexpr double kFar = std::numeric_limits<double>::max();
    const double low = place == 0 ? -kFar : points[place - 1].value + gap;
    const double high = place + 1 == points.size() ? kFar : points[place + 1].value - gap;
    if (low <= high) point.value = std::clamp(value, low, high);
}

bool remove_transfer_point(TransferPoints& points, std::size_t place) {
    if (points.size() < 2 || place >= points.size()) return false;
    points.erase(points.begin() + static_cast<std::ptrdiff_t>(place));
    return true;
}

TransferPoints transfer_of_materials(const Scene& scene, double low, double high, double width) {
    const auto& iso = scene.iso_values;
    const auto& materials = scene.materials;
    const auto color = [&](std::size_t m) {
        if (materials[m].extinction > 0) return materials[m].color;
        if (m + 1 < materials.size()) return materials[m + 1].color;
        return materials[m == 0 ? 0 : m - 1].color;
    };
    const auto point = [&](double value, std::size_t m) {
        return TransferPoint{value, color(m), materials[m].extinction};
    };
    TransferPoints points;
    for (std::size_t i = 0; i < iso.size(); ++i) {
        const double room = i == 0 ? width : std::min(width, (iso[i] - iso[i - 1]) / 2);
        points.push_back(point(iso[i] - room, i));
        points.push_back(point(iso[i], i + 1));
    }
    if (points.empty() || low < points.front().value) points.insert(points.begin(), point(low, 0));
    if (high > points.back().value) points.push_back(point(high, materials.size() - 1));
    return points;
}

void use_transfer(SceneDocument& document, TransferPoints points) {
    document.transfer_preset.clear();
    document.transfer = std::move(points);
}

void use_transfer_preset(SceneDocument& document, const Volume& volume, const ScenePreset& preset) {
    SceneDocument changed = document;
    use_transfer(changed, preset.content.transfer);
    changed.iso_values = preset.content.iso_values;
    changed.materials.clear();
    changed.below = {};
    write_out_materials(changed, resolve_scene(changed, volume), volume);
    document = std::move(changed);
}

void use_materials(SceneDocument& document, const Volume& volume) {
    SceneDocument changed = document;
    use_transfer(changed, {});
    write_out_materials(changed, resolve_scene(changed, volume), volume);
    document = std::move(changed);
}

ExtinctionScale ExtinctionScale::of(const VolumeGeometry& geometry) {
    const double voxel = geometry.mean_spacing();
    return {1e-3 / voxel, 1e3 / voxel};
}

double ExtinctionScale::share(double extinction) const {
    return std::clamp(std::log1p(extinction / least) / std::log1p(most / least), 0.0, 1.0);
}

double ExtinctionScale::extinction(double share) const {
    return least * std::expm1(std::clamp(share, 0.0, 1.0) * std::log1p(most / least));
}

}  // namespace edgesplat::viewer
