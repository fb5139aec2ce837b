// Reads a DICOM series: files in any order, sorted by the positions of their slices. GDCM (through ITK) decodes each
// file and applies slope and intercept. Sheared stacks (gantry tilt) need no resampling: the shear is in the third axis
// of index_to_world. Unevenly spaced slices are refused, or resampled on request.
#include <itkGDCMImageIO.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <map>

#include "engine/volume/io/itk.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

struct Slice {
    std::string file, series, description;
    std::vector<std::size_t> dims;
    VolumeGeometry geometry;
    std::size_t components = 1;
    std::string stored_type;
    bool has_position = false;
    double instance = -1;         // Instance Number, -1: none
    double declared_spacing = 0;  // Spacing Between Slices, else Slice Thickness; 0: none
};

itk::GDCMImageIO::Pointer opened(const std::string& file, std::string& chatter) {
    check_dicom_is_whole(file);
    auto io = itk::GDCMImageIO::New();
    std::string reason;
    {
        OutputCapture capture;
        try {
            io->SetFileName(file);
            io->ReadImageInformation();
        } catch (const itk::ExceptionObject& error) {
            reason = error.GetDescription();
        } catch (const std::exception& error) {
            reason = error.what();
        }
        chatter = capture.text();
    }
    if (!reason.empty()) fail("{}: cannot be read as DICOM: {}", file, tidy(reason + " " + chatter));
    // GDCM leaves missing pixels uninitialised and only prints a message.
    if (chatter.find("Incomplete Pixel Data") != std::string::npos)
        fail("{}: truncated: the pixel data end before the last pixel", file);
    return io;
}

std::string tag(itk::GDCMImageIO& io, const char* name) {
    std::string value;
    io.GetValueFromTag(name, value);
    while (!value.empty() && (value.back() == ' ' || value.back() == '\0'))
        value.pop_back();
    while (!value.empty() && value.front() == ' ')
        value.erase(0, 1);
    return value;
}

double number(const std::string& text, double otherwise) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    return end == text.c_str() || !std::isfinite(value) ? otherwise : value;
}

Slice read_header(const std::string& file) {
    std::string chatter;
    const auto io = opened(file, chatter);
    Slice slice;
    slice.file = file;
    slice.series = tag(*io, "0020|000e");
    slice.description = tag(*io, "0008|103e");
    slice.dims = dims_of(*io);
    while (slice.dims.size() < 3)
        slice.dims.push_back(1);
    slice.geometry = geometry_of(*io);
    slice.components = io->GetNumberOfComponents();
    const auto bits = tag(*io, "0028|0100");
    const bool is_signed = tag(*io, "0028|0103") == "1";
    slice.stored_type =
        bits.empty() ? std::string(name_of(sample_type_of(*io, file))) : (is_signed ? "int" : "uint") + bits;
    slice.has_position = !tag(*io, "0020|0032").empty();
    slice.instance = number(tag(*io, "0020|0013"), -1);
    slice.declared_spacing = number(tag(*io, "0018|0088"), number(tag(*io, "0018|0050"), 0));
    return slice;
}

void read_voxels(const Slice& slice, std::size_t component, float* target, std::size_t voxels) {
    std::string chatter;
    const auto io = opened(slice.file, chatter);
    const auto type = sample_type_of(*io, slice.file);
    std::vector<std::byte> buffer(io->GetImageSizeInBytes());
    if (buffer.size() != voxels * slice.components * size_of(type))
        fail("{}: {} bytes of pixels where {} were expected", slice.file, buffer.size(),
             voxels * slice.components * size_of(type));
    std::string reason;
    {
        OutputCapture capture;
        try {
            set_full_region(*io);
            io->Read(buffer.data());
        } catch (const itk::ExceptionObject& error) {
            reason = error.GetDescription();
        } catch (const std::exception& error) {
            reason = error.what();
        }
        if (!reason.empty()) reason += " " + capture.text();
    }
    if (!reason.empty()) fail("{}: cannot decode its pixels: {}", slice.file, tidy(reason));
    convert_samples(type, buffer.data(), component, slice.components, voxels, target);
}

std::string text_of(const glm::dvec3& p) {
    return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x, p.y, p.z);
}
std::string file_name(const Slice& slice) {
    return std::filesystem::path(slice.file).filename().string();
}

std::vector<Slice> chosen_series(const std::string& name, std::vector<Slice> slices, const LoadOptions& options,
                                 std::vector<std::string>& notes) {
    std::map<std::string, std::vector<Slice>> series;
    for (auto& slice : slices)
        series[slice.series].push_back(std::move(slice));
    if (series.size() == 1 && options.series.empty()) return std::move(series.begin()->second);
    std::string list;
    std::size_t number_of = 0;
    for (const auto& [uid, members] : series) {
        if (!options.series.empty() && (options.series == uid || options.series == std::to_string(number_of))) {
            if (series.size() > 1)
                notes.push_back(fmt::format("Series {} of {} was chosen: {}.", number_of, series.size(), uid));
            return members;
        }
        list += fmt::format("\n  {}: {} ({} files{}{})", number_of++, uid.empty() ? "no UID" : uid, members.size(),
                            members[0].description.empty() ? "" : ", ", members[0].description);
    }
    if (options.series.empty())
        fail("{}: holds {} DICOM series; choose one with --series:{}", name, series.size(), list);
    fail("{}: --series {} is none of its {} series:{}", name, options.series, series.size(), list);
}

void check_alike(const std::string& name, const std::vector<Slice>& slices) {
    const auto& first = slices.front();
    for (const auto& slice : slices) {
        if (slice.dims[2] != 1)
            fail("{}: {} holds {} frames: a multi-frame file can only be read by itself", name, file_name(slice),
                 slice.dims[2]);
        if (slice.dims[0] != first.dims[0] || slice.dims[1] != first.dims[1] || slice.components != first.components)
            fail("{}: {} has {} x {} pixels, {} has {} x {}", name, file_name(first), first.dims[0], first.dims[1],
                 file_name(slice), slice.dims[0], slice.dims[1]);
        for (int axis = 0; axis < 2; ++axis) {
            const auto a = first.geometry.index_to_world_axes[axis], b = slice.geometry.index_to_world_axes[axis];
            // Across a whole row, slices may diverge by a hundredth of a pixel per pixel at most.
            if (!(glm::length(a - b) <=
                  1e-2 * glm::length(a) / std::max(1.0, std::sqrt(static_cast<double>(first.dims[0])))))
                fail("{}: {} and {} differ in orientation or pixel spacing: {} and {} per pixel of axis {}", name,
                     file_name(first), file_name(slice), text_of(a), text_of(b), axis);
        }
    }
}

// Sorts by instance number, for files without positions (e.g. secondary captures).
glm::dvec3 step_by_instance(const std::string& name, std::vector<Slice>& slices, std::vector<std::string>& notes) {
    std::sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) { return a.instance < b.instance; });
    for (std::size_t i = 0; i < slices.size(); ++i) {
        if (slices[i].instance < 0)
            fail("{}: {} has neither a position (0020,0032) nor an instance number (0020,0013)", name,
                 file_name(slices[i]));
        if (i > 0 && slices[i].instance - slices[i - 1].instance != slices[1].instance - slices[0].instance)
            fail("{}: instance numbers {} and {} ({}, {}) are not one step apart: a slice is missing", name,
                 slices[i - 1].instance, slices[i].instance, file_name(slices[i - 1]), file_name(slices[i]));
    }
    if (slices.size() > 1 && slices[0].instance == slices[1].instance)
        fail("{}: {} and {} have the same instance number and no positions", name, file_name(slices[0]),
             file_name(slices[1]));
    const double spacing = slices[0].declared_spacing > 0 ? slices[0].declared_spacing : 1;
    notes.push_back(
        fmt::format("No positions in the files: slices are in order of their instance numbers, {} mm apart{}.", spacing,
                    slices[0].declared_spacing > 0 ? "" : " (assumed)"));
    const auto& axes = slices[0].geometry.index_to_world_axes;
    return spacing * glm::normalize(glm::cross(axes[0], axes[1]));
}

// Spacing of the slices of a series.
struct Stack {
    glm::dvec3 step{0};           // step from one slice to the next, mm
    std::vector<double> heights;  // height of each slice along the normal, mm from the first; empty: evenly spaced
    std::size_t count = 0;        // number of slices after resampling
};

// Throws the error for two slices with uneven spacing.
[[noreturn]] void refuse_spacing(const std::string& name, const std::vector<Slice>& slices,
                                 const std::vector<double>& gaps, double usual) {
    const auto odd = static_cast<std::size_t>(
        std::ranges::max_element(gaps, {}, [&](double gap) { return std::abs(gap - usual); }) - gaps.begin());
    auto others = gaps;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(odd));
    const auto [least, most] = std::ranges::minmax(others.empty() ? gaps : others);
    const std::string rest =
        most - least > 1e-6 * usual ? fmt::format("{:.6g} to {:.6g} mm", least, most) : fmt::format("{:.6g} mm", least);
    const auto &before = slices[odd], &after = slices[odd + 1];
    fail(
        "{}: uneven slice spacing: {} at {} and {} at {} are {:.6g} mm apart, the others {}{}; --resample "
        "interpolates evenly spaced slices",
        name, file_name(before), text_of(before.geometry.origin), file_name(after), text_of(after.geometry.origin),
        gaps[odd], rest, gaps[odd] > 1.5 * usual ? " (a slice may be missing)" : "");
}

// Sorts along the normal and checks that the positions lie on one line, evenly spaced unless `resample` is set.
Stack stack_by_position(const std::string& name, std::vector<Slice>& slices, bool resample,
                        std::vector<std::string>& notes) {
    const auto& axes = slices[0].geometry.index_to_world_axes;
    const auto row = glm::normalize(axes[0]);
    const auto normal = glm::normalize(glm::cross(axes[0], axes[1]));
    const auto height = [&](const Slice& slice) { return glm::dot(normal, slice.geometry.origin); };
    std::stable_sort(slices.begin(), slices.end(),
                     [&](const Slice& a, const Slice& b) { return height(a) < height(b); });
    const auto way = slices.back().geometry.origin - slices.front().geometry.origin;
    const double total = glm::dot(normal, way);
    std::vector<double> heights, gaps;
    for (const Slice& slice : slices)
        heights.push_back(height(slice) - height(slices.front()));
    for (std::size_t i = 1; i < slices.size(); ++i)
        gaps.push_back(heights[i] - heights[i - 1]);
    auto sorted = gaps;
    // The lower median: missing slices make gaps wider.
    const std::size_t middle = (sorted.size() - 1) / 2;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(middle), sorted.end());
    const double usual = sorted[middle];
    bool even = true;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const auto &before = slices[i - 1], &here = slices[i];
        const auto where = fmt::format("{} at {} and {} at {}", file_name(before), text_of(before.geometry.origin),
                                       file_name(here), text_of(here.geometry.origin));
        if (!(gaps[i - 1] > 1e-3 * std::max(usual, 1e-3)))
            fail(
                "{}: two slices at the same position: {}; a series with several frames, echoes or phases must be split",
                name, where);
        const double ideal = total * static_cast<double>(i) / static_cast<double>(gaps.size());
        even = even && std::abs(gaps[i - 1] - usual) <= 0.01 * usual && std::abs(heights[i] - ideal) <= 0.05 * usual;
        const auto aside = here.geometry.origin - slices.front().geometry.origin - way * (heights[i] / total);
        if (!(glm::length(aside - normal * glm::dot(normal, aside)) <=
              0.05 * std::min(glm::length(axes[0]), glm::length(axes[1]))))
            fail("{}: the slices do not lie on one line: {} is {:.4g} mm aside ({})", name, file_name(here),
                 glm::length(aside), where);
    }
    if (!even && !resample) refuse_spacing(name, slices, gaps, usual);
    Stack stack;
    const double steps = even ? static_cast<double>(gaps.size()) : std::max(std::round(total / usual), 1.0);
    const auto step = way / steps;
    const double spacing = total / steps;
    if (!even) {
        stack.heights = std::move(heights);
        stack.count = static_cast<std::size_t>(steps) + 1;
    }
    const auto lean = step - normal * spacing;
    if (glm::length(lean) > 1e-3 * spacing) {
        const double degrees = std::atan2(glm::length(lean), spacing) * 180 / 3.14159265358979323846;
        notes.push_back(
            fmt::format("The stack of slices is sheared by {:.2f} degrees ({:.4g} mm along rows, {:.4g} mm along "
                        "columns per slice: gantry tilt). It is kept exactly in the direction matrix.",
                        degrees, glm::dot(lean, row), glm::dot(lean, glm::normalize(axes[1]))));
        stack.step = step;
    } else {
        stack.step = normal * spacing;
    }
    return stack;
}

}  // namespace

bool is_dicom(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    char head[132] = {};
    file.read(head, sizeof(head));
    if (file.gcount() >= 132 && std::string_view(head + 128, 4) == "DICM") return true;
    return begins_with_dicom_elements(path);
}

namespace {

// Thrown for a file whose header is readable but whose pixels are not.
struct BrokenSlice {
    std::string file, reason;
};

void read_stack(const std::string& name, std::vector<Slice>& slices, const LoadOptions& options, Volume& volume) {
    const auto& first = slices.front();
    volume.geometry = first.geometry;
    volume.in_patient = first.has_position;
    volume.stored_type = first.stored_type;
    std::size_t depth = first.dims[2];
    Stack stack;
    if (slices.size() > 1) {
        check_alike(name, slices);
        const bool positions = std::all_of(slices.begin(), slices.end(), [](const Slice& s) { return s.has_position; });
        if (positions)
            stack = stack_by_position(name, slices, options.resample, volume.notes);
        else
            stack.step = step_by_instance(name, slices, volume.notes);
        volume.geometry = slices.front().geometry;
        volume.geometry.index_to_world_axes[2] = stack.step;
        depth = slices.size();
    } else if (depth == 1) {
        volume.notes.push_back("One DICOM file with one slice; give the folder to read a whole series.");
    } else {
        volume.notes.push_back(fmt::format("A multi-frame DICOM file: {} frames, {:.4g} mm apart according to GDCM.",
                                           depth, volume.geometry.spacing().z));
    }
    const std::size_t even = stack.heights.empty() ? depth : stack.count;
    checked_bytes(name, {first.dims[0], first.dims[1], depth == even ? depth : depth + even}, sizeof(float));
    const auto component = chosen_component(name, options, first.components);
    volume.values.resize(first.dims[0] * first.dims[1] * depth);
    const std::size_t part = volume.values.size() / slices.size();
    for (std::size_t i = 0; i < slices.size(); ++i) {
        report(options, 0.4 + 0.5 * static_cast<double>(i) / static_cast<double>(slices.size()),
               "reading DICOM slices");
        try {
            read_voxels(slices[i], component, volume.values.data() + i * part, part);
        } catch (const Error& error) {
            if (slices.size() == 1) throw;
            throw BrokenSlice{slices[i].file, error.what()};
        }
    }
    volume.geometry.dims.z = static_cast<int>(even);
    if (stack.heights.empty()) return;
    volume.values = resampled_slices(volume.values, stack.heights, even);
    volume.warnings.push_back(
        fmt::format("{}: {} unevenly spaced slices were resampled to {}, {:.6g} mm apart, by cubic interpolation.",
                    name, depth, even, stack.heights.back() / static_cast<double>(even - 1)));
}

}  // namespace

Volume load_dicom(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options) {
    std::vector<Slice> slices;
    std::vector<std::string> left_out;
    for (std::size_t i = 0; i < files.size(); ++i) {
        report(options, 0.4 * static_cast<double>(i) / static_cast<double>(files.size()), "reading DICOM headers");
        try {
            slices.push_back(read_header(files[i]));
        } catch (const Error& error) {
            if (files.size() == 1) throw;
            left_out.emplace_back(error.what());
        }
    }
    if (slices.empty()) fail("{}: none of its {} DICOM files can be read: {}", name, files.size(), left_out.front());
    try {
        std::vector<std::string> notes;
        slices = chosen_series(name, std::move(slices), options, notes);
        (void)chosen_frame(name, options, 1);
        while (true) {
            Volume volume;
            volume.name = name;
            volume.notes = notes;
            for (const std::string& reason : left_out)
                volume.warnings.push_back(reason + ". The file was skipped.");
            try {
                read_stack(name, slices, options, volume);
                return volume;
            } catch (const BrokenSlice& broken) {
                left_out.push_back(broken.reason);
                std::erase_if(slices, [&](const Slice& slice) { return slice.file == broken.file; });
            }
        }
    } catch (const Error& error) {
        if (left_out.empty()) throw;
        fail("{}; skipped: {}", error.what(), fmt::join(left_out, "; "));
    }
}

}  // namespace edgesplat::detail
