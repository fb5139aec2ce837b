// Reads OME-Zarr images (0.1 to 0.5) and plain Zarr arrays: axes, scales and units from the metadata, samples chunk by
// chunk.
#include "engine/volume/io/zarr.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <unordered_set>

#include "engine/image/srgb.h"
#include "engine/volume/io/half.h"
#include "engine/volume/io/ome.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/labels.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

enum class ZarrRole { Time, Channel, Space, Other };

struct ZarrAxis {
    std::string name, unit;
    ZarrRole role = ZarrRole::Other;
    double scale = 1, offset = 0;
};

/// What is read of an array: which axis is which, one index on all others.
struct ZarrView {
    std::vector<ZarrAxis> axes;
    std::array<std::optional<std::size_t>, 3> space;  ///< axes of x, y, z
    bool has_place = false;
    std::vector<std::string> channel_names;
    std::vector<std::string> notes;
    std::shared_ptr<const json> labels;  ///< "image-label"; null: none
};

const json* member(const json& object, const char* name) {
    const auto found = object.is_object() ? object.find(name) : object.end();
    return found == object.end() ? nullptr : &*found;
}

std::string text_of(const json& object, const char* name) {
    const json* value = member(object, name);
    return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

/// OME's attributes: under "ome" since 0.5, else at the top.
const json& ome_attributes(const ZarrNode& node) {
    const json* ome = member(node.attributes, "ome");
    return ome != nullptr && ome->is_object() ? *ome : node.attributes;
}

ZarrRole role_of(const std::string& type, const std::string& name) {
    if (type == "space") return ZarrRole::Space;
    if (type == "time") return ZarrRole::Time;
    if (type == "channel") return ZarrRole::Channel;
    if (!type.empty()) return ZarrRole::Other;
    if (name == "t" || name == "time") return ZarrRole::Time;
    if (name == "c" || name == "channel") return ZarrRole::Channel;
    if (name == "x" || name == "y" || name == "z") return ZarrRole::Space;
    return ZarrRole::Other;
}

/// The axes of a multiscale image of `count` dimensions.
std::vector<ZarrAxis> multiscale_axes(const std::string& where, const json& multiscale, std::size_t count) {
    std::vector<ZarrAxis> axes;
    const json* list = member(multiscale, "axes");
    if (list == nullptr) {  // before 0.3: t, c, z, y, x; the first may be missing
        constexpr std::string_view kNames = "tczyx";
        if (count > 5) fail("{}: {} axes without names, expected at most t, c, z, y, x", where, count);
        for (std::size_t i = 5 - count; i < 5; ++i) {
            const std::string name(1, kNames[i]);
            axes.push_back({.name = name, .role = role_of("", name)});
        }
        return axes;
    }
    if (!list->is_array() || list->size() != count)
        fail("{}: 'axes': {} of them, but its array has {}", where, list->is_array() ? list->size() : 0, count);
    for (const json& entry : *list) {
        const std::string name = entry.is_string() ? entry.get<std::string>() : text_of(entry, "name");
        axes.push_back({.name = name, .unit = text_of(entry, "unit"), .role = role_of(text_of(entry, "type"), name)});
    }
    return axes;
}

/// Applies a list of coordinateTransformations to the axes. Returns whether there was a scale.
bool apply_transformations(const std::string& where, const json& holder, std::vector<ZarrAxis>& axes) {
    const json* list = member(holder, "coordinateTransformations");
    if (list == nullptr) return false;
    if (!list->is_array()) fail("{}: 'coordinateTransformations': expected a list", where);
    bool has_scale = false;
    for (const json& entry : *list) {
        const std::string type = text_of(entry, "type");
        if (type == "identity") continue;
        if (type != "scale" && type != "translation")
            fail("{}: coordinateTransformations of type '{}': expected scale or translation", where, type);
        const json* values = member(entry, type.c_str());
        if (values == nullptr || !values->is_array() || values->size() != axes.size())
            fail("{}: coordinateTransformations: '{}': expected a list of {} numbers", where, type, axes.size());
        for (std::size_t axis = 0; axis < axes.size(); ++axis) {
            const json& value = (*values)[axis];
            const double number = value.is_number() ? value.get<double>() : std::nan("");
            const bool is_space = axes[axis].role == ZarrRole::Space;
            if (!std::isfinite(number) || (type == "scale" && number == 0 && is_space))
                fail("{}: coordinateTransformations: '{}' of axis {} is {}: expected a finite number{}", where, type,
                     axes[axis].name, value.dump(), type == "scale" ? " that is not 0" : "");
            if (type == "scale") {
                axes[axis].scale *= number;
                axes[axis].offset *= number;
            } else {
                axes[axis].offset += number;
            }
        }
        has_scale = has_scale || type == "scale";
    }
    return has_scale;
}

/// Finds the axes x, y and z.
void find_space(const std::string& where, ZarrView& view) {
    std::vector<std::size_t> space;
    for (std::size_t axis = 0; axis < view.axes.size(); ++axis)
        if (view.axes[axis].role == ZarrRole::Space) space.push_back(axis);
    if (space.size() < 2 || space.size() > 3) fail("{}: {} axes of space, expected 2 or 3", where, space.size());
    const auto named = [&](std::string_view name) -> std::optional<std::size_t> {
        for (const std::size_t axis : space)
            if (view.axes[axis].name == name) return axis;
        return std::nullopt;
    };
    view.space = {named("x"), named("y"), named("z")};
    const auto found = std::ranges::count_if(view.space, [](const auto& axis) { return axis.has_value(); });
    if (static_cast<std::size_t>(found) == space.size() && view.space[0] && view.space[1]) return;
    // Other names: the last axis is x.
    view.space = {space[space.size() - 1], space[space.size() - 2],
                  space.size() == 3 ? std::optional(space[0]) : std::nullopt};
}

std::size_t along(const ZarrArray& array, const std::optional<std::size_t>& axis) {
    return axis ? array.shape[*axis] : 1;
}

std::vector<std::size_t> dims_of(const ZarrArray& array, const ZarrView& view) {
    return {along(array, view.space[0]), along(array, view.space[1]), along(array, view.space[2])};
}

/// The index on each axis that is not of space: the chosen channel and frame.
ZarrShape fixed_indices(const std::string& path, const LoadOptions& options, const ZarrArray& array,
                        const ZarrView& view) {
    std::size_t channels = 1, frames = 1;
    for (std::size_t axis = 0; axis < array.shape.size(); ++axis) {
        const ZarrAxis& one = view.axes[axis];
        if (one.role == ZarrRole::Other && array.shape[axis] > 1)
            fail("{}: its axis '{}' of {} is neither space, time nor channel", path, one.name, array.shape[axis]);
        std::size_t& count = one.role == ZarrRole::Channel ? channels : frames;
        if (one.role != ZarrRole::Space && __builtin_mul_overflow(count, array.shape[axis], &count))
            fail("{}: too many channels or frames", path);
    }
    auto names = view.channel_names;
    if (names.size() > channels) names.resize(channels);
    std::size_t channel = chosen_component(path, options, channels, names);
    std::size_t frame = chosen_frame(path, options, frames);
    ZarrShape fixed(array.shape.size(), 0);
    for (std::size_t axis = array.shape.size(); axis-- > 0;) {
        if (view.axes[axis].role == ZarrRole::Space) continue;
        std::size_t& left = view.axes[axis].role == ZarrRole::Channel ? channel : frame;
        fixed[axis] = left % array.shape[axis];
        left /= array.shape[axis];
    }
    return fixed;
}

/// Copies pieces of chunks into the samples, (z, y, x).
class ZarrTarget {
  public:
    ZarrTarget(const ZarrArray& array, const ZarrView& view, const ZarrShape& fixed)
        : array_(array), view_(view), fixed_(fixed), dims_(dims_of(array, view)) {
        samples_.resize(dims_[0] * dims_[1] * dims_[2] * array.item());
    }

    std::vector<char>& samples() { return samples_; }

    bool needs(const ZarrShape& origin, const ZarrShape& shape) const {
        for (std::size_t axis = 0; axis < origin.size(); ++axis) {
            const bool is_space = view_.axes[axis].role == ZarrRole::Space;
            if (is_space && origin[axis] >= array_.shape[axis]) return false;
            if (!is_space && (fixed_[axis] < origin[axis] || fixed_[axis] - origin[axis] >= shape[axis])) return false;
        }
        return true;
    }

    void take(const ZarrPiece& piece) {
        if (!needs(piece.origin, piece.shape)) return;
        const char* from = piece.data;
        std::array<std::size_t, 3> begin{}, count{1, 1, 1};
        std::array<std::ptrdiff_t, 3> stride{};
        for (std::size_t axis = 0; axis < piece.shape.size(); ++axis)
            if (view_.axes[axis].role != ZarrRole::Space)
                from += piece.strides[axis] * static_cast<std::ptrdiff_t>(fixed_[axis] - piece.origin[axis]);
        for (std::size_t i = 0; i < 3; ++i) {
            if (!view_.space[i]) continue;
            const std::size_t axis = *view_.space[i];
            begin[i] = piece.origin[axis];
            count[i] = std::min(piece.shape[axis], array_.shape[axis] - begin[i]);
            stride[i] = piece.strides[axis];
        }
        const std::size_t item = array_.item();
        for (std::size_t z = 0; z < count[2]; ++z)
            for (std::size_t y = 0; y < count[1]; ++y) {
                const char* row =
                    from + stride[2] * static_cast<std::ptrdiff_t>(z) + stride[1] * static_cast<std::ptrdiff_t>(y);
                char* to = samples_.data() + (((begin[2] + z) * dims_[1] + begin[1] + y) * dims_[0] + begin[0]) * item;
                if (stride[0] == static_cast<std::ptrdiff_t>(item)) {
                    std::memcpy(to, row, count[0] * item);
                    continue;
                }
                for (std::size_t x = 0; x < count[0]; ++x)
                    std::memcpy(to + x * item, row + stride[0] * static_cast<std::ptrdiff_t>(x), item);
            }
    }

  private:
    const ZarrArray& array_;
    const ZarrView& view_;
    const ZarrShape& fixed_;
    std::vector<std::size_t> dims_;
    std::vector<char> samples_;
};

struct ZarrChunk {
    std::string key;
    ZarrShape origin;
};

/// The chunks that hold the chosen samples.
std::vector<ZarrChunk> wanted_chunks(const std::string& path, const ZarrArray& array, const ZarrView& view,
                                     const ZarrShape& fixed) {
    constexpr std::size_t kMostChunks = 1 << 22;
    ZarrShape first, count;
    std::size_t all = 1;
    for (std::size_t axis = 0; axis < array.shape.size(); ++axis) {
        const bool is_space = view.axes[axis].role == ZarrRole::Space;
        first.push_back(is_space ? 0 : fixed[axis] / array.chunk[axis]);
        count.push_back(is_space ? (array.shape[axis] - 1) / array.chunk[axis] + 1 : 1);
        if (__builtin_mul_overflow(all, count.back(), &all) || all > kMostChunks)
            fail("{}: more than {} chunks to read", path, kMostChunks);
    }
    std::vector<ZarrChunk> chunks;
    ZarrShape at(first.size(), 0);
    for (std::size_t i = 0; i < all; ++i) {
        ZarrChunk chunk{.key = zarr_key(array.key, array.key_prefix)};
        std::string indices;
        for (std::size_t axis = 0; axis < at.size(); ++axis) {
            const std::size_t index = first[axis] + at[axis];
            if (axis > 0) indices += array.separator;
            indices += std::to_string(index);
            chunk.origin.push_back(index * array.chunk[axis]);
        }
        // "c/0/1" and "c.0.1"; without prefix "0.1" in the array's folder.
        chunk.key = array.key_prefix.empty() ? zarr_key(array.key, indices) : chunk.key + array.separator + indices;
        chunks.push_back(std::move(chunk));
        for (std::size_t axis = at.size(); axis-- > 0;) {
            if (++at[axis] < count[axis]) break;
            at[axis] = 0;
        }
    }
    return chunks;
}

/// A declared "no data" and the scale of values, as CF's attributes give them.
void take_attributes(const ZarrArray& array, StoredSamples& stored, Volume& volume) {
    const auto number = [&](const char* name) -> std::optional<double> {
        const json* value = member(array.attributes, name);
        if (value != nullptr && value->is_array() && value->size() == 1) value = &(*value)[0];
        if (value == nullptr || !value->is_number()) return std::nullopt;
        return value->get<double>();
    };
    stored.slope = number("scale_factor").value_or(1);
    stored.intercept = number("add_offset").value_or(0);
    if (!std::isfinite(stored.slope) || !std::isfinite(stored.intercept) || stored.slope == 0)
        fail("{}: scale_factor {} and add_offset {}: expected finite numbers", array.attributes_where, stored.slope,
             stored.intercept);
    if (stored.slope != 1 || stored.intercept != 0)
        volume.notes.push_back(
            fmt::format("scale_factor {} and add_offset {} are applied.", stored.slope, stored.intercept));
    stored.fill = number("_FillValue");
    if (!stored.fill) stored.fill = number("missing_value");
}

/// Labels with the names and colours of "image-label".
void take_zarr_labels(const json& image_label, Volume& volume) {
    std::shared_ptr<LabelTable> table;
    if (volume.labels) {
        table = std::make_shared<LabelTable>(*volume.labels);
    } else {
        std::unordered_set<float> found;
        for (const float value : volume.values) {
            if (value != std::floor(value)) return;
            found.insert(value);
            if (found.size() > kMaxRankedLabels) return;
        }
        std::vector<float> values(found.begin(), found.end());
        std::ranges::sort(values);
        table = std::make_shared<LabelTable>();
        table->is_signed = !values.empty() && values[0] < 0;
        for (const float value : values)
            table->labels.push_back({.id = static_cast<std::uint64_t>(static_cast<std::int64_t>(value)),
                                     .value = value,
                                     .name = {},
                                     .color = {}});
    }
    const auto label_of = [&](const json& entry) -> Label* {
        const json* value = member(entry, "label-value");
        if (value == nullptr || !value->is_number_integer()) return nullptr;
        const std::uint64_t id = value->is_number_unsigned() ? value->get<std::uint64_t>()
                                                             : static_cast<std::uint64_t>(value->get<std::int64_t>());
        const auto label = std::ranges::find(table->labels, id, &Label::id);
        return label == table->labels.end() ? nullptr : &*label;
    };
    if (const json* colors = member(image_label, "colors"); colors != nullptr && colors->is_array())
        for (const json& entry : *colors) {
            const json* rgba = member(entry, "rgba");
            Label* label = label_of(entry);
            if (label == nullptr || rgba == nullptr || !rgba->is_array() || rgba->size() < 3) continue;
            glm::dvec3 color{0};
            for (int i = 0; i < 3; ++i) {
                const json& part = (*rgba)[static_cast<std::size_t>(i)];
                color[i] = part.is_number() ? to_linear(std::clamp(part.get<double>() / 255, 0.0, 1.0)) : 0;
            }
            label->color = color;
        }
    if (const json* properties = member(image_label, "properties"); properties != nullptr && properties->is_array())
        for (const json& entry : *properties)
            if (Label* label = label_of(entry))
                for (const char* name : {"name", "label", "class"})
                    if (label->name.empty()) label->name = text_of(entry, name);
    volume.labels = std::move(table);
}

void set_zarr_place(Volume& volume, const ZarrView& view, const LoadOptions& options) {
    if (!view.has_place) {
        set_place(volume, glm::dmat3(1), glm::dvec3(0), 1, "none: 1 mm assumed");
        if (!options.spacing)
            volume.notes.emplace_back(
                "The metadata do not contain a voxel spacing: 1 x 1 x 1 mm is assumed; give --spacing X Y Z.");
        return;
    }
    glm::dmat3 axes(1);
    glm::dvec3 origin{0};
    bool has_units = true;
    for (int i = 0; i < 3; ++i) {
        const auto& which = view.space[static_cast<std::size_t>(i)];
        if (!which) {
            axes[i][i] = std::abs(axes[0][0]);
            continue;
        }
        const ZarrAxis& axis = view.axes[*which];
        const auto millimetres = axis.unit.empty() ? std::nullopt : ome_millimetres(axis.unit);
        const bool is_none = axis.unit.empty() || axis.unit == "pixel" || axis.unit == "voxel";
        if (!millimetres && !is_none && !options.spacing)
            fail("{}: axis {}: unit '{}': expected a unit of length; give --spacing X Y Z", volume.name, axis.name,
                 axis.unit);
        has_units = has_units && millimetres;
        axes[i][i] = axis.scale * millimetres.value_or(1);
        origin[i] = axis.offset * millimetres.value_or(1);
        if (volume.length_unit.empty() && millimetres) volume.length_unit = axis.unit;
    }
    set_place(volume, axes, origin, 1, "coordinateTransformations");
    if (!has_units && !options.spacing)
        volume.notes.emplace_back("Some axes have no unit of length: mm are assumed; give --spacing X Y Z.");
}

Volume read_zarr(const std::string& path, const ZarrStore& store, const ZarrArray& array, const ZarrView& view,
                 const LoadOptions& options) {
    const ZarrShape fixed = fixed_indices(path, options, array, view);
    const auto dims = dims_of(array, view);
    const std::size_t bytes = checked_bytes(path, dims, array.item());
    check_memory(path, "its samples", bytes + bytes / array.item() * (sizeof(float) + (array.is_half ? 4 : 0)));
    const auto chunks = wanted_chunks(path, array, view, fixed);
    Volume volume;
    volume.name = path;
    volume.notes = view.notes;
    volume.geometry.dims = {static_cast<int>(dims[0]), static_cast<int>(dims[1]), static_cast<int>(dims[2])};
    volume.stored_type = array.is_half ? "float16" : array.is_bool ? "bool" : name_of(array.type);
    set_zarr_place(volume, view, options);

    ZarrTarget target(array, view, fixed);
    std::vector<bool> is_read(chunks.size());
    std::vector<std::string> keys;
    for (const ZarrChunk& chunk : chunks)
        keys.push_back(chunk.key);
    const auto sink_at = [&](const ZarrShape& origin) {
        const auto moved = [&origin](ZarrShape at) {
            for (std::size_t axis = 0; axis < at.size(); ++axis)
                at[axis] += origin[axis];
            return at;
        };
        return ZarrSink{
            [&target, moved](const ZarrShape& at, const ZarrShape& shape) { return target.needs(moved(at), shape); },
            [&target, moved](const ZarrPiece& piece) {
                target.take({moved(piece.origin), piece.shape, piece.data, piece.strides});
            }};
    };
    std::size_t done = 0;
    store.visit(keys, [&](std::size_t index, const std::string& packed) {
        report(options, 0.9 * static_cast<double>(done++) / static_cast<double>(chunks.size()), "reading chunks");
        is_read[index] = true;
        decode_zarr_chunk(store.shown(keys[index]), array, array.codecs, packed, array.chunk,
                          sink_at(chunks[index].origin));
    });
    const auto missing = static_cast<std::size_t>(std::ranges::count(is_read, false));
    for (std::size_t i = 0; i < chunks.size(); ++i)
        if (!is_read[i]) fill_zarr_piece(array, array.chunk, sink_at(chunks[i].origin));
    if (missing == chunks.size())
        volume.warnings.push_back(
            fmt::format("None of its {} chunks exists, the first would be {}: all samples are {}.", missing,
                        store.shown(keys[0]), array.shown_fill));
    else if (missing > 0)
        volume.notes.push_back(
            fmt::format("{} of its {} chunks are not stored: their samples are {}, the array's fill_value.", missing,
                        chunks.size(), array.shown_fill));

    StoredSamples stored{.type = array.type, .data = target.samples().data()};
    std::vector<float> floats;
    if (array.is_half) {
        floats.resize(bytes / 2);
        for (std::size_t i = 0; i < floats.size(); ++i) {
            std::uint16_t half = 0;
            std::memcpy(&half, target.samples().data() + 2 * i, 2);
            floats[i] = float_of_half(half);
        }
        stored.type = SampleType::Float32;
        stored.data = floats.data();
    }
    take_attributes(array, stored, volume);
    take_samples(stored, volume);
    if (view.labels) take_zarr_labels(*view.labels, volume);
    return volume;
}

ZarrArray array_at(const ZarrStore& store, const std::string& key) {
    const auto node = zarr_node(store, key);
    if (!node || !node->is_array) fail("{}: no Zarr array there (no .zarray or zarr.json)", store.shown(key));
    return zarr_array(*node);
}

/// A dataset's path inside its group.
std::string dataset_path(const std::string& where, const json& dataset) {
    std::string path = text_of(dataset, "path");
    if (path.empty() || path.starts_with('/') || path.find("..") != std::string::npos)
        fail("{}: a dataset with the path '{}': expected one inside its group", where, path);
    return path;
}

const json& checked_datasets(const std::string& where, const json& multiscale) {
    const json* datasets = member(multiscale, "datasets");
    if (datasets == nullptr || !datasets->is_array() || datasets->empty() || datasets->size() > 64)
        fail("{}: 'datasets': expected a list of 1 to 64 levels", where);
    return *datasets;
}

/// The levels of an image from fine to coarse, as OME-Zarr demands; others are sorted by the size of their arrays.
std::vector<const json*> levels_of(const ZarrStore& store, const ZarrNode& group, const json& multiscale) {
    std::vector<const json*> levels;
    std::vector<double> sizes;
    for (const json& dataset : checked_datasets(group.attributes_where, multiscale)) {
        levels.push_back(&dataset);
        try {
            const auto array = array_at(store, zarr_key(group.key, dataset_path(group.attributes_where, dataset)));
            sizes.push_back(1);
            for (const std::size_t size : array.shape)
                sizes.back() *= static_cast<double>(size);
        } catch (const Error&) {  // NOLINT(bugprone-empty-catch): it may be a level that is not read
        }
    }
    if (sizes.size() < levels.size() || std::ranges::is_sorted(sizes, std::greater())) return levels;
    std::vector<std::size_t> order(levels.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, std::greater(), [&](std::size_t i) { return sizes[i]; });
    std::vector<const json*> sorted;
    for (const std::size_t i : order)
        sorted.push_back(levels[i]);
    return sorted;
}

Volume load_multiscale(const std::string& path, const ZarrStore& store, const ZarrNode& group, const json& multiscale,
                       const LoadOptions& options) {
    const auto datasets = levels_of(store, group, multiscale);
    const std::size_t levels = datasets.size();
    if (options.level && (*options.level < 0 || static_cast<std::size_t>(*options.level) >= levels))
        fail("{}: --level {}: it has {} levels, numbered from 0, the finest", path, *options.level, levels);
    for (std::size_t level = static_cast<std::size_t>(options.level.value_or(0));; ++level) {
        const ZarrArray array =
            array_at(store, zarr_key(group.key, dataset_path(group.attributes_where, *datasets[level])));
        ZarrView view;
        view.axes = multiscale_axes(group.attributes_where, multiscale, array.shape.size());
        find_space(group.attributes_where, view);
        const bool of_level = apply_transformations(group.attributes_where, *datasets[level], view.axes);
        const bool of_all = apply_transformations(group.attributes_where, multiscale, view.axes);
        view.has_place = of_level || of_all;
        if (!options.level && level + 1 < levels) {
            try {
                checked_bytes(path, dims_of(array, view), array.item());
            } catch (const Error&) {
                continue;  // the next coarser one
            }
        }
        const json& ome = ome_attributes(group);
        if (const json* omero = member(ome, "omero"))
            if (const json* channels = member(*omero, "channels"); channels != nullptr && channels->is_array())
                for (const json& channel : *channels)
                    view.channel_names.push_back(text_of(channel, "label"));
        if (const json* labels = member(ome, "image-label")) view.labels = std::make_shared<const json>(*labels);
        if (level > 0 && !options.level)
            view.notes.push_back(fmt::format("Level {} of {} is read: the finer ones are too large.", level, levels));
        else if (levels > 1)
            view.notes.push_back(fmt::format("Level {} of 0..{} is read; --level chooses.", level, levels - 1));
        const auto labels = store.children(zarr_key(group.key, "labels"));
        if (!labels.empty())
            view.notes.push_back(
                fmt::format("It has labels: {}.", store.shown(zarr_key(group.key, "labels/" + labels[0]))));
        return read_zarr(path, store, array, view, options);
    }
}

/// An array without multiscales: its last three axes are space unless their names say otherwise.
Volume load_plain_array(const std::string& path, const ZarrStore& store, const ZarrArray& array,
                        const LoadOptions& options) {
    if (options.level)
        fail("{}: --level {}: this is one array, not an OME-Zarr image of several levels", path, *options.level);
    ZarrView view;
    const std::size_t count = array.shape.size();
    if (count < 2) fail("{}: an array with {} axis, expected at least 2", path, count);
    view.axes.resize(count);
    bool is_named = array.dimension_names.size() == count;
    std::size_t space = 0;
    for (std::size_t axis = 0; axis < count && is_named; ++axis) {
        view.axes[axis].name = array.dimension_names[axis];
        view.axes[axis].role = role_of("", view.axes[axis].name);
        is_named = view.axes[axis].role != ZarrRole::Other;
        space += view.axes[axis].role == ZarrRole::Space ? 1 : 0;
    }
    if (!is_named || space < 2)
        for (std::size_t axis = 0; axis < count; ++axis)
            view.axes[axis].role = axis + 3 >= count ? ZarrRole::Space : ZarrRole::Time;
    if (!is_named || space < 2)
        for (ZarrAxis& axis : view.axes)
            axis.name.clear();
    find_space(path, view);
    return read_zarr(path, store, array, view, options);
}

/// An image that has this array as one of its levels, in a folder above it: it knows the place.
std::optional<Volume> load_level_of_image(const std::string& path, const LoadOptions& options) {
    fs::path folder = fs::absolute(path).lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();
    std::string inside;
    for (int up = 0; up < 3 && folder.has_parent_path(); ++up) {
        inside = zarr_key(folder.filename().string(), inside);
        folder = folder.parent_path();
        if (!is_zarr_folder(folder.string())) continue;
        const auto store = zarr_folder(folder.string());
        const auto group = zarr_node(*store, "");
        if (!group) continue;
        const json* multiscales = member(ome_attributes(*group), "multiscales");
        if (multiscales == nullptr || !multiscales->is_array()) continue;
        for (const json& multiscale : *multiscales) {
            const json* datasets = member(multiscale, "datasets");
            if (datasets == nullptr || !datasets->is_array()) continue;
            const auto levels = levels_of(*store, *group, multiscale);
            for (std::size_t level = 0; level < levels.size(); ++level)
                if (text_of(*levels[level], "path") == inside) {
                    LoadOptions one = options;
                    one.level = static_cast<int>(level);
                    Volume volume = load_multiscale(path, *store, *group, multiscale, one);
                    return volume;
                }
        }
    }
    return std::nullopt;
}

std::string listed_names(const std::vector<std::string>& names) {
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(names.size(), 12); ++i)
        list += (i == 0 ? "" : ", ") + names[i];
    return list + (names.size() > 12 ? ", ..." : "");
}

std::vector<std::string> paths_in(const json* list) {
    std::vector<std::string> paths;
    if (list != nullptr && list->is_array())
        for (const json& entry : *list)
            paths.push_back(entry.is_string() ? entry.get<std::string>() : text_of(entry, "path"));
    return paths;
}

Volume load_group(const std::string& path, const ZarrStore& store, const ZarrNode& group, const LoadOptions& options,
                  int depth) {
    const json& ome = ome_attributes(group);
    const json* multiscales = member(ome, "multiscales");
    if (multiscales != nullptr && multiscales->is_array() && !multiscales->empty()) {
        std::size_t chosen = 0;
        const std::size_t count = multiscales->size();
        if (count > 1) {
            chosen = count;
            for (std::size_t i = 0; i < count; ++i)
                if (options.series == std::to_string(i) ||
                    (!options.series.empty() && options.series == text_of((*multiscales)[i], "name")))
                    chosen = i;
            if (chosen == count) fail("{}: it holds {} images; choose one with --series 0..{}", path, count, count - 1);
        }
        return load_multiscale(path, store, group, (*multiscales)[chosen], options);
    }
    const auto descend = [&](const std::string& name) {
        if (name.find("..") != std::string::npos || name.starts_with('/'))
            fail("{}: --series {}: expected a path inside it", path, name);
        const std::string key = zarr_key(group.key, name);
        const auto node = zarr_node(store, key);
        if (!node) fail("{}: no Zarr group or array there", store.shown(key));
        if (depth > 4) fail("{}: groups in groups without an image", store.shown(key));
        LoadOptions rest = options;
        rest.series.clear();
        if (node->is_array) return load_plain_array(path, store, zarr_array(*node), rest);
        return load_group(path, store, *node, rest, depth + 1);
    };
    if (!options.series.empty()) return descend(options.series);
    const auto refuse = [&](const std::string& what, const std::vector<std::string>& names) {
        if (names.empty()) fail("{}: {}, but names none", path, what);
        fail("{}: {}: {}; open one, such as {}, or give --series {}", path, what, listed_names(names),
             store.shown(zarr_key(group.key, names[0])), names[0]);
    };
    if (const json* plate = member(ome, "plate")) {
        auto wells = paths_in(member(*plate, "wells"));
        for (auto& well : wells)
            well += "/0";
        refuse("a plate, whose wells hold the images", wells);
    }
    if (const json* well = member(ome, "well")) refuse("a well of several images", paths_in(member(*well, "images")));
    if (member(ome, "labels") != nullptr) refuse("a group of labels", paths_in(member(ome, "labels")));
    auto names = store.children(group.key);
    std::erase(names, "OME");  // metadata only
    if (member(ome, "bioformats2raw.layout") != nullptr) {
        if (names.size() == 1) return descend(names[0]);
        refuse("a group of several images (bioformats2raw)", names);
    }
    if (names.empty()) fail("{}: a Zarr group without images and arrays", path);
    refuse("a Zarr group without 'multiscales', which holds", names);
    return {};  // not reached
}

}  // namespace

Volume load_zarr(const std::string& path, const LoadOptions& options) {
    try {
        std::error_code ignored;
        const bool is_folder = fs::is_directory(path, ignored);
        const auto store = is_folder ? zarr_folder(path) : zarr_zip(path);
        const auto node = zarr_node(*store, "");
        if (!node) fail("{}: no Zarr group or array at its top", path);
        if (!node->is_array) return load_group(path, *store, *node, options, 0);
        if (is_folder && !options.level)
            if (auto volume = load_level_of_image(path, options)) return std::move(*volume);
        return load_plain_array(path, *store, zarr_array(*node), options);
    } catch (const json::exception& problem) {
        fail("{}: its metadata: {}", path, tidy(problem.what()));
    }
}

}  // namespace edgesplat::detail
