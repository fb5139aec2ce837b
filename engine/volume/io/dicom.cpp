// Reads DICOM files: a series of single slices in any order, multi-frame files, segmentation objects. Place, order and
// scale come from the headers' own fields (dicom_frames.cpp); GDCM only decodes compressed pixels.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <set>

#include "engine/volume/io/dicom.h"
#include "engine/volume/io/samples.h"

namespace edgesplat::detail {
namespace {

// Thrown for a file whose header is readable but whose pixels are not.
struct BrokenSlice {
    std::string file, reason;
};

void add_once(std::vector<std::string>& texts, const std::vector<std::string>& more) {
    for (const std::string& text : more)
        if (std::ranges::find(texts, text) == texts.end()) texts.push_back(text);
}

/// Converts a frame's stored samples. Returns how many are padding.
std::size_t scaled_samples(const DicomScale& scale, const std::vector<double>& stored, float* target) {
    std::size_t padded = 0;
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const double value = stored[i];
        if (scale.padding && value >= scale.padding->x && value <= scale.padding->y) {
            target[i] = std::numeric_limits<float>::quiet_NaN();
            ++padded;
        } else if (scale.table) {
            const double last = static_cast<double>(scale.table->size() - 1);
            const auto at = static_cast<std::size_t>(std::clamp(value - scale.table_first, 0.0, last));
            target[i] = static_cast<float>((*scale.table)[at]);
        } else {
            target[i] = static_cast<float>(scale.slope * value + scale.intercept);
        }
    }
    return padded;
}

/// The part of a picture that is a frame: all of it, or a tile of a mosaic.
void cut_tile(const DicomImage& image, const DicomFrame& frame, std::vector<double>& samples) {
    if (image.columns == image.layout.columns && image.rows == image.layout.rows) return;
    std::vector<double> tile;
    for (std::size_t y = 0; y < image.rows; ++y) {
        const auto first =
            samples.begin() + static_cast<std::ptrdiff_t>((frame.corner.y + y) * image.layout.columns + frame.corner.x);
        tile.insert(tile.end(), first, first + static_cast<std::ptrdiff_t>(image.columns));
    }
    samples = std::move(tile);
}

void read_frames(const std::string& name, const std::vector<DicomImage>& images, const DicomOrder& order,
                 std::size_t component, const LoadOptions& options, Volume& volume) {
    const auto& frames = order.frames;
    const DicomImage& first = images[frames.front().image];
    const std::size_t part = first.columns * first.rows;
    // Whole numbers that a float does not represent may be labels, which keep their numbers.
    const bool wide = std::ranges::all_of(frames, [&](const DicomFrame& frame) {
        const DicomLayout& layout = images[frame.image].layout;
        return frame.scale.plain() && !layout.is_float && layout.bits_stored > 24 && layout.samples == 1;
    });
    std::vector<std::int64_t> numbers;
    if (wide) {
        check_memory(name, "whole numbers", part * frames.size() * (sizeof(std::int64_t) + sizeof(float)));
        numbers.resize(part * frames.size());
    } else {
        volume.values.resize(part * frames.size());
    }
    std::unique_ptr<DicomFile> file;
    std::unique_ptr<DicomPixels> pixels;
    std::size_t opened = images.size(), last_frame = 0, padded = 0;
    std::vector<double> samples, picture;
    for (std::size_t i = 0; i < frames.size(); ++i) {
        report(options, 0.4 + 0.5 * static_cast<double>(i) / static_cast<double>(frames.size()),
               "reading DICOM slices");
        const DicomFrame& frame = frames[i];
        const DicomImage& image = images[frame.image];
        try {
            if (frame.image != opened) {
                pixels.reset();
                file = std::make_unique<DicomFile>(image.file);
                pixels = std::make_unique<DicomPixels>(*file, image.layout);
                picture.clear();
                opened = frame.image;
            }
            if (picture.empty() || frame.index != last_frame) pixels->read(frame.index, component, picture);
            last_frame = frame.index;
        } catch (const Error& error) {
            if (frames.size() == 1 || image.frames.size() > 1) throw;
            throw BrokenSlice{image.file, error.what()};
        }
        samples = picture;
        cut_tile(image, frame, samples);
        if (wide)
            std::ranges::transform(samples, numbers.begin() + static_cast<std::ptrdiff_t>(i * part),
                                   [](double value) { return static_cast<std::int64_t>(value); });
        else
            padded += scaled_samples(frame.scale, samples, volume.values.data() + i * part);
    }
    volume.geometry.dims = glm::ivec3(first.columns, first.rows, frames.size());
    if (wide) take_samples({.type = SampleType::Int64, .data = numbers.data()}, volume);
    if (padded > 0) {
        const glm::dvec2 padding = frames.front().scale.padding.value_or(glm::dvec2(0));
        volume.notes.push_back(fmt::format(
            "{} voxels have the stored value {} that PixelPaddingValue (0028,0120) declares: no data.", padded,
            padding.x == padding.y ? fmt::format("{}", padding.x) : fmt::format("{} to {}", padding.x, padding.y)));
    }
}

/// Says which slices are in another frame of reference or on another scale than the others.
void compare_slices(const std::vector<DicomImage>& images, const std::vector<DicomFrame>& frames, Volume& volume) {
    const auto name_of = [&](const DicomFrame& frame) {
        const DicomImage& image = images[frame.image];
        return image.frames.size() == 1 ? image.name() : fmt::format("frame {}", frame.index);
    };
    std::map<std::string, const DicomFrame*> references;
    std::set<std::size_t> files;
    for (const DicomFrame& frame : frames) {
        const std::string& reference = images[frame.image].frame_of_reference;
        if (reference.empty()) continue;
        references.emplace(reference, &frame);
        files.insert(frame.image);
    }
    if (references.size() > 1 && references.size() == files.size())  // as some programs write that hide names
        volume.notes.emplace_back("Each slice has a FrameOfReferenceUID (0020,0052) of its own: it is not used.");
    else if (references.size() > 1)
        volume.warnings.push_back(fmt::format(
            "Slices have {} different FrameOfReferenceUIDs (0020,0052), such as {} and {}: their positions may not "
            "belong together.",
            references.size(), name_of(*references.begin()->second), name_of(*references.rbegin()->second)));
    const auto silent = std::ranges::find(frames, false, &DicomFrame::says_scale);
    const auto count = std::ranges::count(frames, false, &DicomFrame::says_scale);
    if (count > 0 && static_cast<std::size_t>(count) < frames.size())
        volume.warnings.push_back(fmt::format(
            "{} of {} slices have neither RescaleSlope (0028,1053) nor RescaleIntercept (0028,1052), such as {}: their "
            "values are as stored, unlike the others'.",
            count, frames.size(), name_of(*silent)));
    const DicomFrame& first = frames.front();
    const auto other = std::ranges::find_if(
        frames, [&](const DicomFrame& f) { return !f.unit.empty() && !first.unit.empty() && f.unit != first.unit; });
    if (other != frames.end())
        volume.warnings.push_back(
            fmt::format("Slices differ in the unit of their values, RescaleType (0028,1054) or Units (0054,1001): {} "
                        "has {}, {} has {}.",
                        name_of(first), first.unit, name_of(*other), other->unit));
}

void read_volume(const std::string& name, const std::vector<DicomImage>& images, const LoadOptions& options,
                 Volume& volume) {
    DicomStack stack = choose_dicom_series(name, images, options, volume.warnings);
    if (!stack.note.empty()) volume.notes.push_back(stack.note);
    const DicomImage& some = images[stack.frames.front().image];
    volume.stored_type = some.layout.stored_type();
    const bool placed = stack.frames.front().position.has_value();
    DicomOrder order = placed ? order_dicom_frames(name, images, std::move(stack.frames), options, volume)
                              : order_dicom_pictures(name, images, std::move(stack.frames), options, volume);
    const DicomFrame& first = order.frames.front();
    const DicomImage& image = images[first.image];
    for (const DicomFrame& frame : order.frames) {
        add_once(volume.notes, images[frame.image].notes);
        add_once(volume.warnings, images[frame.image].warnings);
    }
    compare_slices(images, order.frames, volume);
    const DicomPlane& plane = first.plane;
    std::string source = placed            ? image.place
                         : image.spaced    ? "PixelSpacing (0028,0030), no position"
                         : options.spacing ? "none: --spacing"
                                           : "none: 1 mm assumed";
    if (placed && !image.spaced && !options.spacing) {
        source += ", pixels of 1 mm assumed";
        volume.warnings.push_back("The file does not say the spacing of its pixels (0028,0030): 1 mm is assumed.");
    }
    set_place(volume, {plane.row * plane.spacing.x, plane.column * plane.spacing.y, order.step},
              first.position.value_or(glm::dvec3(0)), 1, source);
    volume.in_patient = placed && image.in_patient;
    volume.length_unit = image.spaced ? "mm" : "";
    const std::size_t depth = order.frames.size(), even = order.heights.empty() ? depth : order.count;
    checked_bytes(name, {image.columns, image.rows, depth == even ? depth : depth + even}, sizeof(float));
    const std::size_t component = chosen_component(name, options, image.layout.samples);
    read_frames(name, images, order, component, options, volume);
    if (order.heights.empty()) return;
    volume.labels.reset();  // numbers in between are none
    volume.values = resampled_slices(volume.values, order.heights, even);
    volume.geometry.dims.z = static_cast<int>(even);
    volume.warnings.push_back(
        fmt::format("{}: {} unevenly spaced slices were resampled to {}, {:.6g} mm apart, by cubic interpolation.",
                    name, depth, even, order.heights.back() / static_cast<double>(even - 1)));
}

/// What cannot be read among the files, each with its reason.
struct LeftOut {
    std::vector<std::string> broken;  ///< messages
    std::vector<std::string> others;  ///< files that are no pictures, and what they are
};

Volume load_images_of(const std::string& name, std::vector<DicomImage> images, const LoadOptions& options,
                      LeftOut& left_out, const std::vector<std::string>& warnings) {
    while (true) {
        Volume volume;
        volume.name = name;
        volume.warnings = warnings;
        for (const std::string& reason : left_out.broken)
            volume.warnings.push_back(reason + ". The file was skipped.");
        if (!left_out.others.empty()) {
            const std::size_t shown = std::min<std::size_t>(left_out.others.size(), 8);
            volume.warnings.push_back(fmt::format(
                "Left out, as no pictures: {}{}.",
                fmt::join(left_out.others.begin(), left_out.others.begin() + static_cast<std::ptrdiff_t>(shown), ", "),
                left_out.others.size() > shown ? fmt::format(" and {} more", left_out.others.size() - shown) : ""));
        }
        try {
            read_volume(name, images, options, volume);
            return volume;
        } catch (const BrokenSlice& broken) {
            left_out.broken.push_back(broken.reason);
            std::erase_if(images, [&](const DicomImage& image) { return image.file == broken.file; });
        }
    }
}

}  // namespace

bool is_dicom(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char head[132] = {};
    file.read(head, sizeof(head));
    if (file.gcount() >= 132 && std::string_view(head + 128, 4) == "DICM") return true;
    return begins_with_dicom_elements(path);
}

Volume load_dicom(const std::string& name, const std::vector<std::string>& unsorted, const LoadOptions& options) {
    std::vector<std::string> files = unsorted;  // folders list them in any order, but numbers of series must stay
    std::ranges::sort(files);
    std::vector<DicomImage> images;
    std::vector<std::string> segmentations, warnings;
    LeftOut left_out;
    for (std::size_t i = 0; i < files.size(); ++i) {
        report(options, 0.4 * static_cast<double>(i) / static_cast<double>(files.size()), "reading DICOM headers");
        try {
            const DicomFile file(files[i]);
            const std::string own = std::filesystem::path(files[i]).filename().string();
            if (is_dicom_directory(file.data())) {
                if (files.size() > 1) {
                    left_out.others.push_back(own + " (a DICOMDIR)");
                    continue;
                }
                const auto listed = files_of_dicom_directory(files[i], warnings);
                Volume volume = load_dicom(name, listed, options);
                volume.warnings.insert(volume.warnings.begin(), warnings.begin(), warnings.end());
                return volume;
            }
            if (is_dicom_segmentation(file.data())) {
                if (files.size() == 1) return load_dicom_segmentation(name, file, options);
                segmentations.push_back(files[i]);
                continue;
            }
            if (const auto kind = dicom_kind_without_pictures(file.data()); !kind.empty() && files.size() > 1) {
                left_out.others.push_back(fmt::format("{} ({})", own, kind));
                continue;
            }
            images.push_back(read_dicom_image(file));
        } catch (const Error& error) {
            if (files.size() == 1) throw;
            left_out.broken.emplace_back(error.what());
        }
    }
    if (images.empty() && segmentations.size() == 1 && left_out.broken.empty()) {
        Volume volume = load_dicom_segmentation(name, DicomFile(segmentations[0]), options);
        return volume;
    }
    for (const std::string& file : segmentations)
        left_out.others.push_back(std::filesystem::path(file).filename().string() +
                                  " (a segmentation, which is read by itself)");
    if (images.empty())
        fail("{}: none of its {} DICOM files can be read: {}", name, files.size(),
             left_out.broken.empty() ? left_out.others.front() : left_out.broken.front());
    try {
        return load_images_of(name, std::move(images), options, left_out, warnings);
    } catch (const Error& error) {
        if (left_out.broken.empty()) throw;
        fail("{}; skipped: {}", error.what(), fmt::join(left_out.broken, "; "));
    }
}

}  // namespace edgesplat::detail
