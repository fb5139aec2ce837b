// Segmentation objects (DICOM SEG): labels with names and colours. Each frame is one segment in one plane; frames
// without anything of a segment may be left out. Label maps have the segments' numbers as samples.
#include <algorithm>
#include <cmath>
#include <map>

#include "engine/image/srgb.h"
#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

/// A colour in linear light from CIELab numbers as DICOM scales them: 16 bits each, white point D50.
glm::dvec3 colour_of_lab(const std::vector<double>& stored) {
    const double l = stored[0] / 65535 * 100, a = stored[1] / 65535 * 255 - 128, b = stored[2] / 65535 * 255 - 128;
    const double fy = (l + 16) / 116, fx = fy + a / 500, fz = fy - b / 200;
    const auto inverse = [](double f) {
        return f > 6.0 / 29 ? f * f * f : 3 * (6.0 / 29) * (6.0 / 29) * (f - 4.0 / 29);
    };
    const double x = 0.96422 * inverse(fx), y = inverse(fy), z = 0.82521 * inverse(fz);
    // XYZ of D50 to linear sRGB, by Bradford's adaptation.
    const glm::dvec3 rgb(3.1338561 * x - 1.6168667 * y - 0.4906146 * z, -0.9787684 * x + 1.9161415 * y + 0.0334540 * z,
                         0.0719453 * x - 0.2289914 * y + 1.4052427 * z);
    return glm::clamp(rgb, 0.0, 1.0);
}

struct DicomSegments {
    const std::string& name;
    const DicomItem& data;
    std::map<int, Label> labels;  ///< by number

    void read() {
        for (const DicomItem& item : data.items(0x00620002)) {
            const auto number = item.number(0x00620004, "US");
            if (!number || !(*number >= 0) || !(*number <= 65535))
                fail("{}: a segment's number (0062,0004) is '{}', expected 0 to 65535", name, item.text(0x00620004));
            Label label;
            label.id = static_cast<std::uint64_t>(*number);
            label.value = static_cast<float>(*number);
            label.name = item.text(0x00620005);
            if (label.name.empty()) label.name = item.text(0x00620006);
            const auto lab = item.numbers(0x0062000d, "US");
            if (lab.size() == 3) label.color = colour_of_lab(lab);
            if (!labels.emplace(static_cast<int>(*number), std::move(label)).second)
                fail("{}: two segments have the number {} (0062,0004)", name, *number);
        }
        if (labels.empty()) fail("{}: a segmentation without segments (0062,0002)", name);
    }

    /// Colours of a label map's palette, for segments without a colour of their own.
    void add_palette() {
        const auto table = [&](DicomTag descriptor_tag, DicomTag data_tag) {
            const auto descriptor = data.numbers(descriptor_tag, "US");
            std::vector<double> entries;
            const DicomElement* element = data.find(data_tag);
            if (descriptor.size() != 3 || element == nullptr) return std::pair(0.0, entries);
            if (descriptor[2] <= 8 && element->value.size() < 2 * static_cast<std::size_t>(descriptor[0]))
                for (const char c : element->value)
                    entries.push_back(static_cast<unsigned char>(c) / 255.0);
            else
                for (const double entry : data.numbers(data_tag, "US"))
                    entries.push_back(entry / (descriptor[2] <= 8 ? 255.0 : 65535.0));
            return std::pair(descriptor[1], entries);
        };
        const std::array tables{table(0x00281101, 0x00281201), table(0x00281102, 0x00281202),
                                table(0x00281103, 0x00281203)};
        for (auto& [number, label] : labels) {
            if (label.color) continue;
            glm::dvec3 colour(0);
            bool all = true;
            for (int channel = 0; channel < 3; ++channel) {
                const auto& [first, entries] = tables.at(static_cast<std::size_t>(channel));
                const double at = number - first;
                all = all && at >= 0 && at < static_cast<double>(entries.size());
                if (!all) break;
                colour[channel] = to_linear(static_cast<double>(entries[static_cast<std::size_t>(at)]));
            }
            if (all) label.color = colour;
        }
    }

    std::string list() const {
        std::string text;
        int at = 0;
        for (const auto& [number, label] : labels) {
            text += fmt::format("{}{}: {}{}", at == 0 ? "" : ", ", at, number,
                                label.name.empty() ? "" : " (" + label.name + ")");
            ++at;
        }
        return text;
    }
};

/// Planes of the segmentation: where they are, and which of them each frame belongs to.
struct DicomSegmentPlanes {
    glm::dvec3 origin{0}, step{0};
    std::size_t count = 1;
    std::vector<std::size_t> plane;  ///< of each frame
};

DicomSegmentPlanes planes_of(const std::string& name, const DicomImage& image) {
    const auto& frames = image.frames;
    const DicomFrame& first = frames.front();
    const glm::dvec3 normal = first.plane.normal();
    std::vector<std::pair<double, std::size_t>> heights;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        if (!frames[i].position) fail("{}: frame {} of the segmentation has no position (0020,0032)", name, i);
        if (glm::length(frames[i].plane.row - first.plane.row) > 1e-3 ||
            glm::length(frames[i].plane.column - first.plane.column) > 1e-3 ||
            glm::length(frames[i].plane.spacing - first.plane.spacing) > 1e-3 * first.plane.spacing.x)
            fail("{}: frames 0 and {} of the segmentation differ in orientation or pixel spacing", name, i);
        heights.emplace_back(glm::dot(normal, *frames[i].position), i);
    }
    std::ranges::sort(heights);
    const double same = 0.01 * std::min(first.plane.spacing.x, first.plane.spacing.y);
    const double total = heights.back().first - heights.front().first;
    const auto& lowest = *frames[heights.front().second].position;
    const auto& highest = *frames[heights.back().second].position;
    double least = total;
    for (std::size_t i = 1; i < heights.size(); ++i) {
        const double gap = heights[i].first - heights[i - 1].first;
        if (gap > same) least = std::min(least, gap);
    }
    DicomSegmentPlanes out;
    out.origin = lowest;
    const double declared = std::abs(first.declared_spacing);
    out.plane.assign(frames.size(), 0);
    if (total <= same) {
        const double thickness = declared > 0 ? declared : first.thickness > 0 ? first.thickness : 1;
        out.step = normal * thickness;
        return out;
    }
    // Empty planes have no frames: the spacing is the one that is declared, if all heights are multiples of it, else
    // the least gap.
    const auto fits = [&](double spacing) {
        return std::ranges::all_of(heights, [&](const auto& height) {
            const double at = (height.first - heights.front().first) / spacing;
            return std::abs(at - std::round(at)) <= 0.05;
        });
    };
    double spacing = 0;
    for (const double candidate : {declared, least, first.thickness}) {
        if (spacing != 0 || !(candidate > same) || !(candidate < 1.5 * least)) continue;
        const double even = total / std::round(total / candidate);
        if (std::abs(even - candidate) <= 0.02 * candidate && fits(even)) spacing = even;
    }
    if (spacing == 0)
        fail(
            "{}: the planes of the segmentation are not evenly spaced: the least gap is {:.6g} mm, "
            "SpacingBetweenSlices (0018,0088) is {}",
            name, least, declared > 0 ? fmt::format("{:.6g}", declared) : "not given");
    const double steps = std::round(total / spacing);
    if (!(steps < static_cast<double>(kMaxVoxelsPerAxis)))
        fail("{}: the segmentation has {} planes, expected at most {}", name, steps + 1, kMaxVoxelsPerAxis);
    out.count = static_cast<std::size_t>(steps) + 1;
    out.step = (highest - lowest) / steps;
    for (const auto& [height, i] : heights) {
        const double at = std::round((height - heights.front().first) / spacing);
        const glm::dvec3 aside = *frames[i].position - lowest - out.step * at;
        if (!(glm::length(aside - normal * glm::dot(normal, aside)) <=
              0.1 * std::min(first.plane.spacing.x, first.plane.spacing.y)))
            fail("{}: the planes of the segmentation do not lie on one line: frame {} is {:.4g} mm aside", name, i,
                 glm::length(aside));
        out.plane[i] = static_cast<std::size_t>(at);
    }
    return out;
}

}  // namespace

Volume load_dicom_segmentation(const std::string& name, const DicomFile& file, const LoadOptions& options) {
    const DicomItem& data = file.data();
    const DicomImage image = read_dicom_image(file);
    const std::string type = data.text(0x00620001);
    const bool label_map = type == "LABELMAP", fractional = type == "FRACTIONAL";
    if (!label_map && !fractional && type != "BINARY")
        fail("{}: SegmentationType (0062,0001) is '{}', expected BINARY, FRACTIONAL or LABELMAP", name, type);
    if (image.layout.samples != 1 || image.layout.is_float)
        fail("{}: a segmentation's pixels have {} components of {}, expected one whole number", name,
             image.layout.samples, image.layout.stored_type());
    DicomSegments segments{name, data, {}};
    segments.read();
    if (label_map) segments.add_palette();
    (void)chosen_frame(name, options, 1);
    if (!options.series.empty() && options.series != "0" && options.series != image.series)
        fail("{}: --series {}: the file has one series, {}", name, options.series, image.series);
    std::optional<int> only;
    if (options.component) {
        if (*options.component < 0 || static_cast<std::size_t>(*options.component) >= segments.labels.size())
            fail("{}: --component {}: the segmentation has {} segments, numbered from 0 ({})", name, *options.component,
                 segments.labels.size(), segments.list());
        only = std::next(segments.labels.begin(), *options.component)->first;
    }
    double most = 1;
    if (fractional) {
        most = data.number(0x0062000e, "US").value_or(0);
        if (!(most >= 1))
            fail("{}: MaximumFractionalValue (0062,000e) is '{}', expected at least 1", name, data.text(0x0062000e));
    }

    Volume volume;
    volume.name = name;
    volume.stored_type = image.layout.stored_type();
    volume.warnings = image.warnings;
    const DicomSegmentPlanes planes = planes_of(name, image);
    const DicomPlane& plane = image.frames.front().plane;
    volume.geometry.dims = glm::ivec3(image.columns, image.rows, planes.count);
    checked_bytes(name, {image.columns, image.rows, planes.count}, sizeof(float));
    volume.geometry.index_to_world_axes = {plane.row * plane.spacing.x, plane.column * plane.spacing.y, planes.step};
    volume.geometry.origin = planes.origin;
    volume.geometry_source = image.place;
    volume.length_unit = "mm";
    volume.in_patient = true;
    volume.values.assign(volume.geometry.voxel_count(), 0.0F);

    const DicomPixels pixels(file, image.layout);
    const std::size_t part = image.columns * image.rows;
    std::vector<double> samples;
    std::map<std::pair<int, int>, std::size_t> overlaps;
    const bool fractions = fractional && only;
    std::vector<int> unnamed;
    std::size_t above = 0;  // fractions
    for (std::size_t i = 0; i < image.frames.size(); ++i) {
        report(options, 0.2 + 0.7 * static_cast<double>(i) / static_cast<double>(image.frames.size()),
               "reading segments");
        const int number = image.frames[i].segment;
        if (!label_map && !segments.labels.contains(number))
            fail("{}: frame {} belongs to segment {} (0062,000b), which SegmentSequence (0062,0002) lacks", name, i,
                 number);
        if (!label_map && only && number != *only) continue;
        pixels.read(i, 0, samples);
        float* const target = volume.values.data() + planes.plane[i] * part;
        for (std::size_t v = 0; v < part; ++v) {
            if (fractional && samples[v] > most) ++above;
            if (label_map) {
                const int found = static_cast<int>(samples[v]);
                if (found != 0 && !segments.labels.contains(found)) {
                    Label label;
                    label.id = static_cast<std::uint64_t>(found);
                    label.value = static_cast<float>(found);
                    segments.labels.emplace(found, label);
                    unnamed.push_back(found);
                }
                if (!only || found == *only) target[v] = static_cast<float>(found);
            } else if (fractions) {
                target[v] = static_cast<float>(samples[v] / most);
            } else if (samples[v] > 0 && samples[v] >= most / 2) {
                const int before = static_cast<int>(target[v]);
                if (before != 0 && before != number) ++overlaps[{std::min(before, number), std::max(before, number)}];
                target[v] = static_cast<float>(std::max(before, number));
            }
        }
    }
    if (above > 0)
        volume.warnings.push_back(
            fmt::format("{} stored fractions are above MaximumFractionalValue (0062,000e), which is {}.", above, most));
    if (!unnamed.empty())
        volume.warnings.push_back(fmt::format("{} labels occur that SegmentSequence (0062,0002) lacks, such as {}.",
                                              unnamed.size(), unnamed.front()));
    for (const auto& [pair, count] : overlaps)
        volume.warnings.push_back(fmt::format(
            "Segments {} and {} overlap in {} voxels, which show {}; --component 0..{} reads one segment ({}).",
            pair.first, pair.second, count, pair.second, segments.labels.size() - 1, segments.list()));
    if (fractions) {
        volume.notes.push_back(
            fmt::format("Fractions of segment {} ({}), from 0 to 1.", *only, segments.labels.at(*only).name));
        return volume;
    }
    if (fractional)
        volume.notes.push_back(fmt::format(
            "Fractional segments: a label is where its fraction is at least one half; --component 0..{} reads the "
            "fractions of one segment ({}).",
            segments.labels.size() - 1, segments.list()));
    auto table = std::make_shared<LabelTable>();
    if (!segments.labels.contains(0)) table->labels.push_back({});
    for (const auto& [number, label] : segments.labels)
        if (!only || number == *only || number == 0) table->labels.push_back(label);
    volume.labels = std::move(table);
    return volume;
}

}  // namespace edgesplat::detail
