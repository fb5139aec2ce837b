#include "apps/edgesplat/label_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <string>
#include <vector>

#include "engine/measure/extents.h"
#include "engine/scene/default_materials.h"
#include "engine/scene/label_choice.h"
#include "engine/volume/labels.h"
#include "engine/volume/packed_volume.h"

namespace {

using edgesplat::Label;
using edgesplat::LabelTable;
using edgesplat::Volume;
using Json = nlohmann::ordered_json;

template <typename Any>
Any number_of(const LabelTable& table, const Label& label) {
    if (table.is_signed) return static_cast<std::int64_t>(label.id);
    return label.id;
}

double rounded_number(const LabelTable& table, const Label& label) {
    return table.is_signed ? static_cast<double>(static_cast<std::int64_t>(label.id)) : static_cast<double>(label.id);
}

template <typename Any = Json>
Any described(const LabelTable& table, const Label& label) {
    Any json{{"label", number_of<Any>(table, label)}};
    if (!label.name.empty()) json["name"] = label.name;
    return json;
}

/// Replaces statistics of ranks by those of the numbers.
void describe_numbers(nlohmann::json& json, const LabelTable& table, const std::vector<std::size_t>& count) {
    const auto number = [&](std::size_t place) { return rounded_number(table, table.labels[place]); };
    const double low = number(0), high = number(table.labels.size() - 1);
    json["range"] = {number_of<nlohmann::json>(table, table.labels.front()),
                     number_of<nlohmann::json>(table, table.labels.back())};
    std::vector<std::size_t> bins(json["histogram"]["counts"].size());
    double sum = 0, voxels = 0;
    for (std::size_t place = 0; place < count.size(); ++place) {
        sum += number(place) * static_cast<double>(count[place]);
        voxels += static_cast<double>(count[place]);
        const double bin = (number(place) - low) / (high - low) * static_cast<double>(bins.size());
        bins[std::min(static_cast<std::size_t>(bin), bins.size() - 1)] += count[place];
    }
    json["mean"] = sum / voxels;
    json["histogram"] = {{"low", low}, {"high", high}, {"counts", bins}};
    for (nlohmann::json& suggestion : json["suggested_iso_values"]) {
        const double rank = std::clamp(suggestion["value"].get<double>(), 0.0, static_cast<double>(count.size()) - 1);
        const auto below = std::min(static_cast<std::size_t>(rank), count.size() - 2);
        suggestion["value"] = (number(below) + number(below + 1)) / 2;
    }
}

}  // namespace

void add_labels(nlohmann::json& json, const Volume& volume) {
    const auto table = edgesplat::labels_of(volume);
    if (!table) return;
    std::vector<std::size_t> count(table->labels.size());
    if (volume.packed) count = volume.packed->label_voxels();
    const bool of_scan = volume.has_segmentation();
    for (std::size_t at = 0; at < volume.values.size(); ++at) {
        if (of_scan && volume.shown_labels->at[at] > 0) ++count[volume.shown_labels->at[at] - 1];
        if (!of_scan && volume.has_data(at)) ++count[place_of_label(*table, volume.values[at])];
    }
    const std::vector<glm::dvec3> colors = edgesplat::label_colors(*table);
    json["labels"] = nlohmann::json::array();
    for (std::size_t place = 0; place < table->labels.size(); ++place) {
        const Label& label = table->labels[place];
        auto entry = described<nlohmann::json>(*table, label);
        entry["color"] = {colors[place].x, colors[place].y, colors[place].z};
        entry["voxels"] = count[place];
        json["labels"].push_back(entry);
    }
    if (!of_scan && has_ranks(*table) && count.size() > 1) describe_numbers(json, *table, count);
}

Json labels_measured(const Volume& volume, const edgesplat::Clip& clip, const edgesplat::VolumeSource& source) {
    Json json{{"labels", Json::array()}};
    // A mask has its shown labels only.
    std::vector<bool> shown(volume.labels->labels.size(), true);
    if (volume.has_segmentation()) shown = chosen_labels(volume, *volume.labels, source.only, source.hide);
    for (const auto& extent : edgesplat::measure::measure_labels(volume, clip)) {
        if (!shown[place_of_label(*volume.labels, extent.label.value)]) continue;
        Json entry = described(*volume.labels, extent.label);
        entry["voxels"] = extent.voxels;
        entry["volume_mm3"] = {{"value", extent.volume.value}, {"uncertainty", extent.volume.uncertainty}};
        if (extent.values) {
            entry["mean"] = extent.values->x;
            entry["standard_deviation"] = extent.values->y;
        }
        json["labels"].push_back(entry);
    }
    return json;
}

Json described_label_at(const Volume& volume, const glm::dvec3& world) {
    if (!volume.shown_labels) return nullptr;
    const glm::dvec3 index = volume.geometry.to_index(world);
    const glm::dvec3 last(volume.geometry.dims - 1);
    if (glm::any(glm::lessThan(index, glm::dvec3(-1))) || glm::any(glm::greaterThan(index, last + 1.0))) return nullptr;
    const std::uint32_t number = edgesplat::label_at(volume, index);
    return number == 0 ? Json(nullptr) : described(*volume.labels, volume.labels->labels[number - 1]);
}

void print_labels(const nlohmann::json& json) {
    if (!json.contains("labels")) return;
    constexpr std::size_t kMost = 40;
    std::vector<const nlohmann::json*> rows;
    for (const nlohmann::json& label : json["labels"])
        rows.push_back(&label);
    const auto voxels = [](const nlohmann::json* label) { return (*label)["voxels"].get<std::size_t>(); };
    const std::size_t shown = std::min(rows.size(), kMost);
    if (shown < rows.size()) std::ranges::stable_sort(rows, std::greater{}, voxels);
    std::cout << fmt::format("labels      {}{}\n", rows.size(),
                             shown < rows.size() ? fmt::format("; the largest {} (--json lists all)", shown) : "");
    for (std::size_t i = 0; i < shown; ++i)
        std::cout << fmt::format("  {:>12} {:>11} voxels  {}\n", (*rows[i])["label"].dump(), voxels(rows[i]),
                                 rows[i]->value("name", ""));
}
