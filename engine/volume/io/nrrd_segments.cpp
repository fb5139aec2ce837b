// Slicer's segmentations (.seg.nrrd): key/value pairs such as Segment0_Name describe the numbers of a NRRD.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "engine/image/srgb.h"
#include "engine/volume/io/nrrd_header.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

constexpr std::size_t kMaxSegments = 65536;

// "0.5 0.68 0.5", sRGB from 0 to 1, to linear light.
std::optional<glm::dvec3> segment_color(const std::string& text) {
    glm::dvec3 color;
    const char *at = text.data(), *const end = at + text.size();
    for (int channel = 0; channel < 3; ++channel) {
        while (at < end && *at == ' ')
            ++at;
        double srgb = 0;
        const auto [stop, error] = std::from_chars(at, end, srgb);
        if (error != std::errc() || !(srgb >= 0 && srgb <= 1)) return std::nullopt;
        color[channel] = to_linear(srgb);
        at = stop;
    }
    return color;
}

}  // namespace

std::vector<std::vector<Label>> nrrd_segments(const NrrdHeader& header) {
    std::vector<std::vector<Label>> layers;
    const auto& pairs = header.key_values;
    // Numbers may be missing where a segment was deleted.
    std::set<std::size_t> numbers;
    constexpr std::string_view kStart = "Segment";
    for (const auto& [key, value] : pairs) {
        std::size_t number = 0;
        const char* const begin = key.data() + kStart.size();
        if (!key.starts_with(kStart)) continue;
        const auto [end, error] = std::from_chars(begin, key.data() + key.size(), number);
        if (error == std::errc() && *end == '_' && number < kMaxSegments) numbers.insert(number);
    }
    for (const std::size_t i : numbers) {
        const auto prefix = fmt::format("{}{}_", kStart, i);
        const auto text = [&](const char* name) {
            const auto found = pairs.find(prefix + name);
            return found == pairs.end() ? "" : trimmed(found->second);
        };
        // Slicer before 4.11 wrote neither number nor layer: every segment is a mask in a layer of its own.
        const auto number = [&](const char* name, long long otherwise, long long least) {
            const std::string digits = text(name);
            if (digits.empty()) return otherwise;
            long long value = 0;
            const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
            if (error != std::errc() || end != digits.data() + digits.size() || value < least)
                fail("{}: {}{}: '{}', expected a whole number", header.path, prefix, name, digits);
            return value;
        };
        const bool old = text("LabelValue").empty();
        const auto layer = number("Layer", old ? static_cast<long long>(i) : 0, 0);
        if (layer >= static_cast<long long>(kMaxSegments))
            fail("{}: {}Layer: {}, expected at most {}", header.path, prefix, layer, kMaxSegments - 1);
        const auto id = number("LabelValue", 1, std::numeric_limits<long long>::min());
        std::string name = text("Name");
        if (name.empty()) name = text("ID");
        if (layers.size() <= static_cast<std::size_t>(layer)) layers.resize(static_cast<std::size_t>(layer) + 1);
        layers[static_cast<std::size_t>(layer)].push_back({.id = static_cast<std::uint64_t>(id),
                                                           .value = static_cast<float>(id),
                                                           .name = std::move(name),
                                                           .color = segment_color(text("Color"))});
    }
    return layers;
}

void name_segments(const std::vector<Label>& segments, Volume& volume) {
    auto table = std::make_shared<LabelTable>();
    if (volume.labels) {
        *table = *volume.labels;  // ids beyond 2^24
    } else {
        std::vector<float> values;
        float last = std::nanf("");
        for (const float value : volume.values) {
            if (value == last) continue;
            last = value;
            const auto at = std::ranges::lower_bound(values, value);
            if (at != values.end() && *at == value) continue;
            if (value != std::round(value) || values.size() == kMaxSegments) {
                volume.warnings.emplace_back(
                    "The header names segments, but the samples are not labels: the names were not used.");
                return;
            }
            values.insert(at, value);
        }
        for (const float value : values)
            table->labels.push_back({.id = static_cast<std::uint64_t>(static_cast<std::int64_t>(value)),
                                     .value = value,
                                     .name = {},
                                     .color = {}});
        table->is_signed = !values.empty() && values.front() < 0;
    }
    std::string empty;
    std::map<std::uint64_t, std::string> names;
    for (const Label& segment : segments) {
        const auto [first, is_new] = names.emplace(segment.id, segment.name);
        if (!is_new)
            volume.warnings.push_back(
                fmt::format("The segments '{}' and '{}' have the same LabelValue {}: they cannot be told apart.",
                            first->second, segment.name, static_cast<std::int64_t>(segment.id)));
        const auto found = std::ranges::find(table->labels, segment.id, &Label::id);
        if (found == table->labels.end()) {
            empty += (empty.empty() ? "" : ", ") + segment.name;
            continue;
        }
        found->name = segment.name;
        found->color = segment.color;
    }
    if (!empty.empty()) volume.notes.push_back(fmt::format("Segments without voxels: {}.", empty));
    volume.labels = std::move(table);
}

}  // namespace edgesplat::detail
