#include "engine/scene/label_fade.h"

#include <algorithm>

namespace edgesplat {
namespace {

/// Whether an entry shows some of the labels of the document's own volume, faded.
bool is_faded_part(const SceneDocument& document, const SceneDocument& entry) {
    return entry.volume.opacity && entry.volume.path == document.volume.path && entry.volume.only.size() == 1;
}

}  // namespace

void fade_labels(SceneDocument& document, const std::string& labels, double opacity) {
    VolumeSource& source = document.volume;
    if (labels == "*") {
        source.opacity = opacity < 1 ? std::optional(opacity) : std::nullopt;
        return;
    }
    const auto shows_them = [&](const SceneDocument& entry) {
        return is_faded_part(document, entry) && entry.volume.only.front() == labels;
    };
    const auto found = std::ranges::find_if(document.volumes, shows_them);
    if (found != document.volumes.end() && opacity < 1) {
        found->volume.opacity = opacity;
        return;
    }
    const auto hide_in = [&](VolumeSource& other, bool hidden) {
        std::erase(other.hide, labels);
        if (hidden) other.hide.push_back(labels);
    };
    if (found != document.volumes.end()) {
        document.volumes.erase(found);
        // Among labels that are listed one by one, they are shown again.
        if (!source.only.empty() && std::ranges::find(source.only, labels) == source.only.end())
            source.only.push_back(labels);
    }
    SceneDocument entry;
    entry.volume = source;
    hide_in(source, opacity < 1);
    for (SceneDocument& other : document.volumes)
        if (is_faded_part(document, other)) hide_in(other.volume, opacity < 1);
    if (opacity >= 1) return;
    entry.volume.only = {labels};
    entry.volume.opacity = opacity;
    entry.volume.checksum.clear();
    entry.iso_values = document.iso_values;
    entry.iso_sigmas = document.iso_sigmas;
    for (const MaterialChoice& material : document.materials) {
        entry.materials.push_back(material);
        entry.materials.back().extinction.reset();
    }
    document.volumes.push_back(std::move(entry));
}

double opacity_of_labels(const SceneDocument& document, const std::string& labels) {
    for (const SceneDocument& entry : document.volumes)
        if (is_faded_part(document, entry) && entry.volume.only.front() == labels) return *entry.volume.opacity;
    return 1;
}

}  // namespace edgesplat
