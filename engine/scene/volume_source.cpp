// Finds, loads and preprocesses a scene's volume.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "engine/error.h"
#include "engine/scene/cuts.h"
#include "engine/scene/label_choice.h"
#include "engine/scene/scene_document.h"
#include "engine/scene/scene_presets.h"
#include "engine/volume/analytic_volumes.h"
#include "engine/volume/filters.h"
#include "engine/volume/itk_transform.h"
#include "engine/volume/label_names.h"
#include "engine/volume/labels.h"
#include "engine/volume/load_volume.h"
#include "engine/volume/packed_volume.h"
#include "engine/volume/segmentation.h"

namespace edgesplat {
namespace {

namespace fs = std::filesystem;

/// Whether the path can be opened; for a pattern of slices ("slice_%03d.tif", "*.dcm") only its folder is checked.
bool may_be_opened(const fs::path& path) {
    std::error_code ignored;
    if (fs::exists(split_inner(path.string()).file, ignored)) return true;
    const bool pattern = path.filename().string().find_first_of("%*?") != std::string::npos;
    return pattern && fs::is_directory(path.has_parent_path() ? path.parent_path() : fs::path("."), ignored);
}

}  // namespace

fs::path find_file(const std::string& path, const std::vector<fs::path>& folders) {
    std::error_code ignored;
    for (const fs::path& folder : folders)
        if (fs::exists(folder / path, ignored)) return folder / path;
    return path;
}

std::vector<fs::path> volume_folders(const fs::path& first) {
    std::vector<fs::path> folders{first};
    if (const char* text = std::getenv("EDGESPLAT_VOLUMES")) {
        std::istringstream in(text);
        for (std::string folder; std::getline(in, folder, ':');)
            if (!folder.empty()) folders.emplace_back(folder);
    }
    return folders;
}

bool chooses_labels(const VolumeSource& source) {
    return !source.only.empty() || !source.hide.empty();
}

std::string find_volume(const std::string& path, const std::vector<fs::path>& folders) {
    if (is_builtin(path)) return path;
    if (fs::path(path).extension() == ".toml")
        fail("{}: is a scene file; expected a volume: a file, a folder, a pattern of slices or builtin:NAME", path);
    std::string places;
    for (const fs::path& folder : folders) {
        // For an absolute path, folder / path is path.
        const fs::path candidate = folder / path;
        if (may_be_opened(candidate)) return candidate.string();
        if (fs::path(path).is_absolute()) break;
        places += fmt::format("{}{}", places.empty() ? "" : ", ", folder.empty() ? "." : folder.string());
    }
    if (places.empty()) fail("{}: no such file or folder", path);
    fail("{}: no such file or folder in {}; the environment variable EDGESPLAT_VOLUMES can name more folders", path,
         places);
}

namespace {

glm::dmat4 matrix_of_rows(const std::vector<double>& rows) {
    glm::dmat4 matrix(1);
    for (int i = 0; i < 16; ++i)
        matrix[i % 4][i / 4] = rows[static_cast<std::size_t>(i)];
    const double volume = glm::determinant(glm::dmat3(matrix));
    if (glm::transpose(matrix)[3] != glm::dvec4(0, 0, 0, 1) || volume == 0 || !std::isfinite(volume))
        fail("volume.transform: expected a 4 x 4 matrix that can be inverted, with 0, 0, 0, 1 as its last row");
    return matrix;
}

void move(VolumeGeometry& geometry, const glm::dmat4& matrix) {
    geometry.origin = glm::dvec3(matrix * glm::dvec4(geometry.origin, 1));
    geometry.index_to_world_axes = glm::dmat3(matrix) * geometry.index_to_world_axes;
}

}  // namespace

void read_as(VolumeSource& source, const VolumeSource& other) {
    source.path = other.path;
    source.raw = other.raw;
    source.series = other.series;
    source.component = other.component;
    source.frame = other.frame;
    source.frame_share = other.frame_share;
    source.level = other.level;
    source.resample = other.resample;
    source.spacing = other.spacing;
    source.no_data = other.no_data;
    source.segmentation = other.segmentation;
    source.label_names = other.label_names;
    source.registration = other.registration;
}

namespace {

/// Moves the samples of a frame by this share towards those of the next one. Samples that one of them has no data for
/// have none.
void mix_in(Volume& volume, const Volume& next, double share) {
    constexpr std::size_t kMask = 2;  // labels, whose mean is a share
    const auto table = labels_of(volume);
    if (volume.packed || (table && table->labels.size() > kMask))
        fail("{}: volume.frame_share: {}: expected 0; {} between frames", volume.name, share,
             volume.packed ? "packed volumes have nothing" : "labels have no numbers");
    auto no_data = std::make_shared<std::vector<bool>>(volume.values.size());
    for (std::size_t at = 0; at < volume.values.size(); ++at) {
        (*no_data)[at] = !volume.has_data(at) || !next.has_data(at);
        volume.values[at] = static_cast<float>((1 - share) * static_cast<double>(volume.values[at]) +
                                               share * static_cast<double>(next.values[at]));
    }
    if (std::ranges::find(*no_data, true) != no_data->end()) volume.no_data = no_data;
    finish_volume(volume);
}

}  // namespace

VolumeSource reading_part(const VolumeSource& source) {
    VolumeSource part;
    read_as(part, source);
    return part;
}

Volume read_source(const VolumeSource& source, const std::vector<fs::path>& folders, const LoadProgress& progress) {
    LoadOptions options;
    options.component = source.component;
    options.frame = source.frame;
    options.level = source.level;
    options.series = source.series;
    options.raw = source.raw;
    options.spacing = source.spacing;
    options.no_data = source.no_data;
    options.resample = source.resample;
    options.progress = progress;
    const std::string path = find_volume(source.path, folders);
    if (source.frame_share > 0 && !source.frame)
        fail("volume.frame_share: {}: the share of a frame after another; expected volume.frame beside it",
             source.frame_share);
    Volume volume = load_volume(path, options);
    if (source.frame_share > 0) {
        options.frame = *source.frame + 1;
        mix_in(volume, load_volume(path, options), source.frame_share);
    }
    if (!source.segmentation.empty()) {
        if (source.threshold)
            fail(
                "volume.segmentation (--segmentation): colours measured values, but volume.threshold (--threshold) "
                "makes a mask of them; expected one of them");
        add_segmentation(volume, load_volume(find_volume(source.segmentation, folders), {}));
    }
    if (!source.label_names.empty()) name_labels(volume, find_file(source.label_names, folders));
    // A registration leads from the fixed image to this one.
    if (!source.registration.empty())
        move(volume.geometry, glm::inverse(read_itk_transform(find_file(source.registration, folders))));
    return volume;
}

void name_labels(Volume& volume, const fs::path& path) {
    const std::vector<Label> named = read_label_names(path);
    const auto table = labels_of(volume);
    if (!table)
        fail("{}: volume.label_names (--label-names): expected a segmentation; its samples are measured values",
             volume.name);
    volume.labels = std::make_shared<const LabelTable>(with_names(*table, named));
}

Volume load_source(const VolumeSource& source, const std::vector<fs::path>& folders, const LoadProgress& progress) {
    return preprocessed(read_source(source, folders, progress), source);
}

namespace {

Volume cut_volume(SceneDocument& document, Volume volume) {
    if (std::ranges::none_of(document.volumes, cuts)) return volume;
    return *Cuts().apply(document, std::make_shared<const Volume>(std::move(volume)));
}

}  // namespace

Volume load_scene_volume(SceneDocument& document, const std::vector<fs::path>& folders, const LoadProgress& progress) {
    Volume samples = read_source(document.volume, folders, progress);
    const VolumeSource reading = reading_part(document.volume);
    const auto reads_them = [&](const SceneDocument& entry) { return reading_part(entry.volume) == reading; };
    if (std::ranges::none_of(document.volumes, reads_them)) {
        Volume volume = prepared_volume(document, std::move(samples));
        read_volumes(document, folders, progress);
        return cut_volume(document, std::move(volume));
    }
    Volume volume = prepared_volume(document, samples);
    read_volumes(document, folders, progress, &samples);
    return cut_volume(document, std::move(volume));
}

void read_volumes(SceneDocument& document, const std::vector<fs::path>& folders, const LoadProgress& progress,
                  const Volume* first) {
    const auto what_is_read = [](const SceneDocument& entry) {
        VolumeSource source = entry.volume;
        source.visible = source.clip = true;
        source.opacity.reset();
        source.rule = VolumeRule::Add;
        source.rim = 0;
        return std::pair(source, entry.iso_values);
    };
    const auto is_as_it_was = [&](const SceneDocument& entry, const VolumeSource& source) {
        return entry.read && std::pair(source, entry.read->iso_values) == what_is_read(entry);
    };
    for (std::size_t i = 0; i < document.volumes.size(); ++i) {
        SceneDocument& entry = document.volumes[i];
        if (entry.read && is_as_it_was(entry, entry.read->source)) continue;
        try {
            SceneDocument still = entry;
            still.volume.transform.clear();
            VolumeSource before = entry.read ? entry.read->source : VolumeSource();
            before.transform.clear();
            Volume volume;
            if (is_as_it_was(still, before)) {
                volume = *entry.read->volume;
                volume.geometry = entry.read->still;
            } else {
                const bool is_read = first && reading_part(entry.volume) == reading_part(document.volume);
                volume = prepared_volume(still, is_read ? *first : read_source(entry.volume, folders, progress));
            }
            const VolumeGeometry geometry = volume.geometry;
            still.volume.transform = entry.volume.transform;
            if (!still.volume.transform.empty()) move(volume.geometry, matrix_of_rows(still.volume.transform));
            entry = std::move(still);
            auto [source, iso_values] = what_is_read(entry);
            entry.read = std::make_shared<const ReadVolume>(ReadVolume{
                std::move(source), std::move(iso_values), geometry, std::make_shared<const Volume>(std::move(volume))});
        } catch (const Error& error) {
            fail("volumes[{}]: {}", i, error.what());
        }
    }
}

namespace {

/// The scene of a document's own volume, while others may not be read yet.
Scene scene_of_first(SceneDocument document, const Volume& volume) {
    document.volumes.clear();
    return resolve_scene(document, volume);
}

}  // namespace

void set_open_iso_values(SceneDocument& document, const Volume& volume) {
    const bool of_presets = document.iso_sigmas.empty() && document.materials.size() > 1;
    if (!document.iso_values.empty() || of_presets) return;
    document.iso_values = scene_of_first(document, volume).iso_values;
    for (double& value : document.iso_values)
        value = volume.in_file_unit(value);
    document.iso_sigmas.clear();
}

double lowest_matter(const SceneDocument& document, const Volume& volume) {
    const Scene scene = scene_of_first(document, volume);
    if (!scene.transfer.empty()) {
        const auto first =
            std::ranges::find_if(scene.transfer, [](const TransferPoint& p) { return p.extinction > 0; });
        if (first == scene.transfer.begin())
            fail("{}: its transfer function makes matter of the lowest values; expected an extinction of 0 at them",
                 volume.name);
        return std::prev(first)->value;
    }
    if (scene.materials.front().extinction > 0)
        fail("{}: below the lowest iso-value it has matter; expected an extinction of 0 there", volume.name);
    std::size_t lowest = 0;
    while (lowest + 1 < scene.iso_values.size() && !(scene.materials[lowest + 1].extinction > 0))
        ++lowest;
    return scene.iso_values[lowest];
}

Volume prepared_volume(SceneDocument& document, Volume volume) {
    const bool open = !document.volume.labels;
    choose_labels(document, volume);
    VolumeSource& source = document.volume;
    if (volume.has_segmentation() && chooses_labels(source)) {
        const std::vector<bool> shown = chosen_labels(volume, *volume.labels, source.only, source.hide);
        set_open_iso_values(document, volume);
        volume = with_labels_shown(volume, shown, source.only.empty(), lowest_matter(document, volume));
    }
    if (open && source.labels.value_or(false) && !source.checksum.empty()) {
        // The checksum may be that of the samples, as `info` prints it.
        VolumeSource as_read = source;
        as_read.labels = false;
        as_read.only.clear();
        as_read.hide.clear();
        as_read.checksum.clear();
        const Volume samples = preprocessed(volume, as_read);
        if (source.checksum == fmt::format("{:016x}", samples.checksum)) source.checksum.clear();
        Volume drawn = preprocessed(std::move(volume), source);
        source.checksum = fmt::format("{:016x}", drawn.checksum);
        return drawn;
    }
    return preprocessed(std::move(volume), source);
}

namespace {

/// Ranks become the file's numbers, rounded to floats.
void put_numbers(Volume& volume) {
    const std::shared_ptr<const LabelTable> table = volume.labels;
    if (!table) return;
    const auto number = [&](const Label& label) {
        return table->is_signed ? static_cast<float>(static_cast<std::int64_t>(label.id))
                                : static_cast<float>(label.id);
    };
    volume.labels = nullptr;
    if (!has_ranks(*table)) return;
    for (float& sample : volume.values)
        sample = number(table->labels[std::min(place_of_label(*table, sample), table->labels.size() - 1)]);
    volume.notes.push_back("Numbers of labels above 2^24 are rounded to 24 bits.");
    finish_volume(volume);
}

}  // namespace

Volume preprocessed(Volume volume, const VolumeSource& source) {
    const auto warnings = volume.warnings;
    const bool chosen = chooses_labels(source), drawn = source.labels.value_or(chosen);
    volume = small_labels_in_memory(std::move(volume));
    if (volume.packed && volume.labels && (drawn || has_ranks(*volume.labels))) volume = load_level(volume, 0);
    // prepared_volume has chosen among the labels of a segmentation.
    if (drawn && !volume.has_segmentation()) {
        auto table = labels_of(volume);
        if (!table)
            fail("{}: volume.{}: expected a segmentation of 2 to {} whole numbers without transitions", volume.name,
                 !chosen               ? "labels (--labels)"
                 : source.only.empty() ? "hide (--hide)"
                                       : "only (--only)",
                 kMaxRankedLabels);
        const std::vector<bool> shown = chosen_labels(volume, *table, source.only, source.hide);
        volume = drawn_labels(volume, std::move(table), shown);
    } else if (!volume.has_segmentation()) {
        put_numbers(volume);
    }
    if (source.threshold) volume = threshold(volume, *source.threshold / volume.value_scale);
    if (source.box_filter) volume = box_filter(volume);
    if (source.crop_low || source.crop_high)
        volume = cropped(volume, source.crop_low.value_or(glm::ivec3(0)),
                         source.crop_high.value_or(volume.geometry.dims - 1));
    if (!source.transform.empty()) move(volume.geometry, matrix_of_rows(source.transform));
    volume.warnings = warnings;
    const std::string checksum = fmt::format("{:016x}", volume.checksum);
    if (!source.checksum.empty() && source.checksum != checksum)
        fail("{}: its samples have the checksum {}, but the scene was made for {} (volume.checksum)", volume.name,
             checksum, source.checksum);
    return volume;
}

namespace {

/// The first key of the document that draws surfaces or colours of the file's numbers; empty: none.
std::string_view key_of_numbers(const SceneDocument& document) {
    if (!document.iso_values.empty()) return "iso_values (--iso)";
    if (!document.iso_sigmas.empty()) return "iso_sigmas";
    if (!document.transfer.empty()) return "transfer";
    if (!document.transfer_preset.empty()) return "transfer_preset (--transfer)";
    if (document.volume.threshold) return "volume.threshold (--threshold)";
    for (const MaterialChoice& material : document.materials)
        if (!material.preset.empty() && !scene_preset(material.preset).content.iso_values.empty())
            return "a material with an iso-value (--material)";
    return "";
}

}  // namespace

void choose_labels(SceneDocument& document, const Volume& volume) {
    constexpr std::size_t kFewest = 3;  // two labels are a mask, which has one surface
    VolumeSource& source = document.volume;
    const bool chosen = chooses_labels(source);
    const std::string_view numbers = key_of_numbers(document);
    if (volume.has_segmentation()) {
        if (!document.transfer.empty() || !document.transfer_preset.empty())
            fail(
                "volume.segmentation (--segmentation): labels have their own colours, but the scene has a transfer "
                "function; expected one of them");
        if (source.labels.value_or(false))
            fail(
                "volume.labels (--labels): draws the samples as labels, but volume.segmentation (--segmentation) has "
                "its own; expected one of them");
        return;
    }
    if (!numbers.empty()) {
        if (chosen)
            fail("volume.{0} (--{0}): chooses labels, but {1} draws the numbers themselves; expected one of them",
                 source.only.empty() ? "hide" : "only", numbers);
        if (source.labels.value_or(false) && (!document.transfer.empty() || !document.transfer_preset.empty()))
            fail(
                "volume.labels: labels have their own colours, but the scene has a transfer function; expected one of "
                "them");
        source.labels = false;
        return;
    }
    if (chosen) {
        if (source.labels == false)
            fail("volume.{0} (--{0}): chooses labels, but volume.labels (--labels) is off; expected one of them",
                 source.only.empty() ? "hide" : "only");
        source.labels = true;
    }
    // Labels are drawn from memory.
    const bool too_large = volume.packed && volume.geometry.voxel_count() > kMaxVoxels;
    if (source.labels || source.box_filter || too_large || is_builtin(volume.name)) return;
    const auto table = labels_of(volume);
    if (!table) return;
    const bool named = std::ranges::any_of(table->labels, [](const Label& label) { return !label.name.empty(); });
    if (table->labels.size() >= kFewest || named) source.labels = true;
}

}  // namespace edgesplat
