// Series and stacks in a set of DICOM files, and the choice among them (--series).
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

/// Frames that may make one volume.
struct DicomCandidate {
    std::string series, description;
    std::vector<DicomFrame> frames;
    std::set<std::size_t> files;
    std::size_t columns = 0, rows = 0, samples = 0;
    std::string patient;      ///< empty: no file says it
    bool is_inverse = false;  ///< MONOCHROME1
    bool localizer = true;    ///< all frames are
};

bool contradict(const std::string& a, const std::string& b) {
    return !a.empty() && !b.empty() && a != b;
}

bool fits_candidate(const DicomCandidate& candidate, const DicomImage& image, const DicomFrame& frame, bool by_stack) {
    const DicomFrame& first = candidate.frames.front();
    if (candidate.columns != image.columns || candidate.rows != image.rows ||
        candidate.samples != image.layout.samples || contradict(candidate.patient, image.patient) ||
        candidate.is_inverse != image.is_inverse() || first.position.has_value() != frame.position.has_value() ||
        (by_stack && first.plane.stack != frame.plane.stack))
        return false;
    // Across a whole row, slices may diverge by a hundredth of a pixel per pixel at most.
    const auto alike = [](const glm::dvec3& a, const glm::dvec3& b, std::size_t pixels) {
        return glm::length(a - b) <= 1e-2 * glm::length(a) / std::sqrt(static_cast<double>(pixels));
    };
    const DicomPlane &a = first.plane, &b = frame.plane;
    return alike(a.row * a.spacing.x, b.row * b.spacing.x, image.columns) &&
           alike(a.column * a.spacing.y, b.column * b.spacing.y, image.rows);
}

std::string direction_name(const DicomPlane& plane) {
    const glm::dvec3 normal = glm::abs(plane.normal());
    const double most = std::max({normal.x, normal.y, normal.z});
    const std::string name = most == normal.z ? "axial" : most == normal.y ? "coronal" : "sagittal";
    return most > 0.999 ? name : "oblique " + name;
}

/// Differences among candidates.
struct DicomDifferences {
    bool patient = false, folder = false;
};

std::string candidate_line(const DicomCandidate& candidate, const std::vector<DicomImage>& images, std::size_t number,
                           const DicomDifferences& differences) {
    const DicomFrame& first = candidate.frames.front();
    const std::size_t count = candidate.frames.size();
    std::string line = fmt::format("\n  {}: {} (", number, candidate.series.empty() ? "no UID" : candidate.series);
    if (count == candidate.files.size())
        line += fmt::format("{} file{}", count, count == 1 ? "" : "s");
    else
        line += fmt::format("{} frames in {} file{}", count, candidate.files.size(),
                            candidate.files.size() == 1 ? "" : "s");
    line += fmt::format(", {} x {} pixels", candidate.columns, candidate.rows);
    if (first.position)
        line += fmt::format(" of {:.6g} x {:.6g} mm, {}", first.plane.spacing.x, first.plane.spacing.y,
                            direction_name(first.plane));
    else
        line += ", no positions";
    if (!first.plane.stack.empty()) line += fmt::format(", stack {}", first.plane.stack);
    if (candidate.is_inverse) line += ", MONOCHROME1";
    if (differences.patient && !candidate.patient.empty()) line += ", patient " + candidate.patient;
    if (candidate.localizer) line += ", a localizer";
    if (!candidate.description.empty()) line += ", " + candidate.description;
    if (differences.folder)
        line += ", in " + std::filesystem::path(images[first.image].file).parent_path().string();
    else if (candidate.files.size() == 1)
        line += ", " + images[first.image].name();
    return line + ")";
}

std::vector<DicomCandidate> candidates_of(const std::vector<DicomImage>& images, std::vector<std::string>& warnings) {
    std::map<std::string, std::vector<std::size_t>> series;
    for (std::size_t i = 0; i < images.size(); ++i)
        series[images[i].series].push_back(i);
    std::vector<DicomCandidate> all;
    for (const auto& [uid, members] : series) {
        const auto is_localizer = [&](std::size_t i) { return images[i].localizer; };
        const bool mixed = std::ranges::any_of(members, is_localizer) && !std::ranges::all_of(members, is_localizer);
        std::vector<std::string> left_out;
        std::map<std::string, glm::dvec3> stacks;
        bool spread = false;  // some stack has several positions
        std::size_t count = 0;
        for (const std::size_t i : members)
            for (const DicomFrame& frame : images[i].frames) {
                const glm::dvec3 position = frame.position.value_or(glm::dvec3(0));
                const auto [stack, is_new] = stacks.emplace(frame.plane.stack, position);
                spread = spread || glm::length(stack->second - position) > 1e-3;
                ++count;
            }
        const bool by_stack = spread && stacks.size() < count;  // some files number slices so
        const std::size_t before = all.size();
        for (const std::size_t i : members) {
            if (mixed && images[i].localizer) {
                left_out.push_back(images[i].name());
                continue;
            }
            for (const DicomFrame& frame : images[i].frames) {
                auto at = std::find_if(
                    all.begin() + static_cast<std::ptrdiff_t>(before), all.end(),
                    [&](const DicomCandidate& c) { return fits_candidate(c, images[i], frame, by_stack); });
                if (at == all.end()) {
                    all.push_back({.series = uid,
                                   .description = images[i].description,
                                   .frames = {},
                                   .files = {},
                                   .columns = images[i].columns,
                                   .rows = images[i].rows,
                                   .samples = images[i].layout.samples,
                                   .patient = {},
                                   .is_inverse = images[i].is_inverse()});
                    at = all.end() - 1;
                }
                at->frames.push_back(frame);
                at->frames.back().image = i;
                at->files.insert(i);
                if (at->patient.empty()) at->patient = images[i].patient;
                at->localizer = at->localizer && images[i].localizer;
            }
        }
        if (!left_out.empty())
            warnings.push_back(
                fmt::format("Localizers were left out (ImageType (0008,0008)): {}.", fmt::join(left_out, ", ")));
    }
    return all;
}

}  // namespace

DicomStack choose_dicom_series(const std::string& name, const std::vector<DicomImage>& images,
                               const LoadOptions& options, std::vector<std::string>& warnings) {
    auto all = candidates_of(images, warnings);
    if (all.size() == 1 && options.series.empty()) return {std::move(all[0].frames), ""};
    std::set<std::string> series, folders;
    for (const DicomCandidate& candidate : all) {
        series.insert(candidate.series);
        folders.insert(std::filesystem::path(images[candidate.frames.front().image].file).parent_path().string());
    }
    DicomDifferences differences{.folder = folders.size() > 1};
    for (const DicomCandidate& candidate : all)
        differences.patient = differences.patient || candidate.patient != all[0].patient;
    std::string list;
    std::vector<std::size_t> chosen;
    for (std::size_t i = 0; i < all.size(); ++i) {
        list += candidate_line(all[i], images, i, differences);
        if (options.series == std::to_string(i))
            chosen = {i};
        else if (!options.series.empty() && options.series == all[i].series)
            chosen.push_back(i);
    }
    // Without a choice, localizers are not meant.
    if (options.series.empty()) {
        for (std::size_t i = 0; i < all.size(); ++i)
            if (!all[i].localizer) chosen.push_back(i);
        if (chosen.size() == 1)
            warnings.push_back(
                fmt::format("Localizers were left out (ImageType (0008,0008)); --series chooses them:{}", list));
    }
    const std::string what =
        series.size() == all.size()
            ? fmt::format("{} DICOM series", all.size())
            : fmt::format(
                  "{} DICOM stacks, which differ in series, number of pixels, orientation, pixel spacing, patient "
                  "(0010,0020), MONOCHROME1 (0028,0004) or Stack ID (0020,9056)",
                  all.size());
    if (chosen.size() == 1) {
        auto& one = all[chosen[0]];
        std::string note;
        if (all.size() > 1) note = fmt::format("Series {} of {} was chosen: {}.", chosen[0], all.size(), one.series);
        return {std::move(one.frames), note};
    }
    if (options.series.empty()) fail("{}: holds {}; choose one with --series:{}", name, what, list);
    if (chosen.empty()) fail("{}: --series {} is none of its {} series:{}", name, options.series, all.size(), list);
    fail("{}: --series {} has several stacks; choose one by its number:{}", name, options.series, list);
}

}  // namespace edgesplat::detail
