// Orders frames by their positions: leaves out exact duplicates, chooses among frames at the same positions (--frame),
// and checks that the slices lie on one line, evenly spaced.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "engine/volume/io/dicom.h"

namespace edgesplat::detail {
namespace {

std::string place_text(const glm::dvec3& p) {
    return fmt::format("({:.3f}, {:.3f}, {:.3f})", p.x, p.y, p.z);
}

/// Numbers by their size, other texts by their letters; nothing comes first.
bool value_before(const std::string& a, const std::string& b) {
    char *a_end = nullptr, *b_end = nullptr;
    const double x = std::strtod(a.c_str(), &a_end), y = std::strtod(b.c_str(), &b_end);
    const bool numbers = !a.empty() && !b.empty() && *a_end == '\0' && *b_end == '\0';
    return numbers && x != y ? x < y : a < b;
}
struct ValuesBefore {
    bool operator()(const std::vector<std::string>& a, const std::vector<std::string>& b) const {
        return std::ranges::lexicographical_compare(a, b, value_before);
    }
};

std::string shown_value(const std::string& value) {
    std::string shown = value.empty() ? "none" : value;
    std::ranges::replace(shown, '\\', ' ');
    return shown;
}

/// Frames at several positions; a position may have several.
struct DicomPlaces {
    const std::string& name;
    const std::vector<DicomImage>& images;
    std::vector<DicomFrame> frames;
    std::vector<std::size_t> place;  ///< of each frame
    std::vector<std::size_t> count;  ///< frames at each place

    std::string name_of(const DicomFrame& frame) const {
        const DicomImage& image = images[frame.image];
        return image.frames.size() == 1 ? image.name() : fmt::format("frame {}", frame.index);
    }

    /// Sorts frames by height and finds the places.
    void find_places() {
        const glm::dvec3 normal = frames.front().plane.normal();
        const auto height = [&](const DicomFrame& frame) { return glm::dot(normal, *frame.position); };
        std::ranges::stable_sort(frames, {}, height);
        const glm::dvec2 spacing = frames.front().plane.spacing;
        const double pixel = std::min(spacing.x, spacing.y);
        const double same = std::max(0.01 * pixel, std::min(unit_along(normal), 0.1 * pixel));
        place.assign(frames.size(), 0);
        count.clear();
        double last = 0;
        for (std::size_t i = 0; i < frames.size(); ++i) {
            if (i == 0 || height(frames[i]) - last > same) {
                last = height(frames[i]);
                count.push_back(0);
            }
            place[i] = count.size() - 1;
            ++count.back();
        }
    }

    /// The unit of the last decimal along a direction; 0 if positions are not rounded.
    double unit_along(const glm::dvec3& direction) const {
        glm::dvec3 unit(1e9);  // the most decimals of each coordinate: trailing zeros are often left out
        for (const DicomFrame& frame : frames)
            unit = glm::min(unit, frame.rounding);
        return glm::dot(glm::abs(direction), unit) * (glm::length(unit) > 1e8 ? 0 : 1);
    }

    std::size_t most() const { return *std::ranges::max_element(count); }

    bool same_pixels(const DicomFrame& a, const DicomFrame& b) const {
        const DicomImage &x = images[a.image], &y = images[b.image];
        const DicomFile one(x.file), other(y.file);
        return one.transfer_syntax() == other.transfer_syntax() && x.layout.bits_stored == y.layout.bits_stored &&
               DicomPixels(one, x.layout).frame_bytes(a.index) == DicomPixels(other, y.layout).frame_bytes(b.index);
    }

    /// Leaves out frames that repeat another one at the same place: with equal pixels and, if `strictly`, equal
    /// attributes.
    void leave_out_duplicates(bool strictly, std::vector<std::string>& warnings) {
        std::vector<std::string> left_out;
        std::vector<bool> out(frames.size(), false);
        for (std::size_t i = 0; i < frames.size(); ++i)
            for (std::size_t j = i + 1; j < frames.size() && place[j] == place[i]; ++j) {
                if (out[i] || out[j] || images[frames[i].image].columns != images[frames[i].image].layout.columns)
                    continue;
                if (frames[i].image == frames[j].image && frames[i].index == frames[j].index) continue;
                if (strictly && frames[i].distinctions != frames[j].distinctions) continue;
                if (!(frames[i].scale == frames[j].scale) || !same_pixels(frames[i], frames[j])) continue;
                out[j] = true;
                left_out.push_back(fmt::format("{} (as {})", name_of(frames[j]), name_of(frames[i])));
            }
        if (left_out.empty()) return;
        auto kept = frames;
        kept.clear();
        for (std::size_t i = 0; i < frames.size(); ++i)
            if (!out[i]) kept.push_back(frames[i]);
        if (!strictly && std::ranges::any_of(counts_of(kept), [](std::size_t n) { return n > 1; })) return;
        frames = std::move(kept);
        find_places();
        const std::size_t shown = std::min<std::size_t>(left_out.size(), 8);
        const std::size_t rest = left_out.size() - shown;
        left_out.resize(shown);
        warnings.push_back(fmt::format("Duplicates with the same position and pixels were left out: {}{}.",
                                       fmt::join(left_out, ", "), rest > 0 ? fmt::format(" and {} more", rest) : ""));
    }

    std::vector<std::size_t> counts_of(const std::vector<DicomFrame>& kept) const {
        DicomPlaces other{name, images, kept, {}, {}};
        other.find_places();
        return other.count;
    }

    std::string value(const DicomFrame& frame, int attribute) const {
        const std::string* found = frame.distinction(attribute);
        return found == nullptr ? "" : *found;
    }

    /// Attributes in which frames at one place differ.
    std::vector<int> varying() const {
        std::vector<int> out;
        for (int attribute = 0; attribute < dicom_attribute_count(); ++attribute) {
            bool varies = false;
            for (std::size_t i = 1; i < frames.size() && !varies; ++i)
                varies = place[i] == place[i - 1] && value(frames[i], attribute) != value(frames[i - 1], attribute);
            if (varies) out.push_back(attribute);
        }
        return out;
    }
};

/// A division of frames into groups, each with one frame at a place.
struct DicomDivision {
    std::vector<std::size_t> group;   ///< of each frame
    std::vector<std::string> values;  ///< of each group, as text
    std::string by;                   ///< names of the attributes
};

std::optional<DicomDivision> divided_by(const DicomPlaces& places, const std::vector<int>& attributes) {
    std::map<std::vector<std::string>, std::size_t, ValuesBefore> keys;
    std::vector<std::vector<std::string>> key_of;
    for (const DicomFrame& frame : places.frames) {
        std::vector<std::string> key;
        for (const int attribute : attributes)
            key.push_back(places.value(frame, attribute));
        keys[key] = 0;
        key_of.push_back(std::move(key));
        if (keys.size() > places.most()) return std::nullopt;
    }
    DicomDivision out;
    std::size_t number = 0;
    for (auto& [key, group] : keys) {
        group = number++;
        std::string text;
        for (const std::string& value : key)
            text += (text.empty() ? "" : " and ") + shown_value(value);
        out.values.push_back(text);
    }
    std::set<std::pair<std::size_t, std::size_t>> taken;
    for (std::size_t i = 0; i < key_of.size(); ++i) {
        out.group.push_back(keys[key_of[i]]);
        if (!taken.insert({out.group.back(), places.place[i]}).second) return std::nullopt;
    }
    for (const int attribute : attributes)
        out.by += fmt::format("{}{}", out.by.empty() ? "" : " and ", dicom_attribute_name(attribute));
    return out;
}

/// Whether an attribute has the same values at every place, but several in one group: the groups mix what it divides.
bool contradicted_by(const DicomPlaces& places, const std::vector<std::size_t>& group, int attribute) {
    std::vector<std::vector<std::string>> at_place(places.count.size());
    std::map<std::size_t, std::set<std::string>> in_group;
    for (std::size_t i = 0; i < places.frames.size(); ++i) {
        at_place[places.place[i]].push_back(places.value(places.frames[i], attribute));
        in_group[group[i]].insert(at_place[places.place[i]].back());
    }
    for (auto& values : at_place)
        std::ranges::sort(values);
    return std::ranges::all_of(at_place, [&](const auto& values) { return values == at_place.front(); }) &&
           std::ranges::any_of(in_group, [](const auto& values) { return values.second.size() > 1; });
}

/// The n-th frame at each place in the order of an attribute that differs from slice to slice, too.
std::optional<DicomDivision> divided_by_rank(const DicomPlaces& places, int attribute, const std::vector<int>& firm) {
    if (std::ranges::any_of(places.count, [&](std::size_t n) { return n != places.most(); })) return std::nullopt;
    DicomDivision out;
    out.group.resize(places.frames.size());
    std::vector<std::string> low(places.most()), high(places.most());
    for (std::size_t first = 0; first < places.frames.size(); first += places.most()) {
        std::vector<std::size_t> order(places.most());
        std::iota(order.begin(), order.end(), first);
        const auto key = [&](std::size_t i) { return places.value(places.frames[i], attribute); };
        std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return value_before(key(a), key(b)); });
        for (std::size_t rank = 0; rank < order.size(); ++rank) {
            const std::string own = key(order[rank]);
            if (rank > 0 && own == key(order[rank - 1])) return std::nullopt;
            out.group[order[rank]] = rank;
            if (first == 0 || value_before(own, low[rank])) low[rank] = own;
            if (first == 0 || value_before(high[rank], own)) high[rank] = own;
        }
    }
    if (std::ranges::any_of(firm, [&](int other) { return contradicted_by(places, out.group, other); }))
        return std::nullopt;
    for (std::size_t rank = 0; rank < low.size(); ++rank)
        out.values.push_back(low[rank] == high[rank] ? shown_value(low[rank])
                                                     : shown_value(low[rank]) + " to " + shown_value(high[rank]));
    out.by = dicom_attribute_name(attribute);
    return out;
}

std::optional<DicomDivision> division_of(const DicomPlaces& places) {
    const auto varying = places.varying();
    for (const int attribute : varying)
        if (auto division = divided_by(places, {attribute})) return division;
    std::vector<int> firm = varying;
    std::erase_if(firm, [](int attribute) { return attribute >= dicom_first_loose_attribute(); });
    for (std::size_t a = 0; a < firm.size(); ++a)
        for (std::size_t b = a + 1; b < firm.size(); ++b)
            if (auto division = divided_by(places, {firm[a], firm[b]})) return division;
    for (std::size_t a = 0; a < firm.size(); ++a)
        for (std::size_t b = a + 1; b < firm.size(); ++b)
            for (std::size_t c = b + 1; c < firm.size(); ++c)
                if (auto division = divided_by(places, {firm[a], firm[b], firm[c]})) return division;
    for (const int attribute : varying)
        if (auto division = divided_by_rank(places, attribute, firm)) return division;
    return std::nullopt;
}

/// Chooses among the frames at each place.
void choose_group(DicomPlaces& places, const LoadOptions& options, Volume& volume) {
    if (places.most() == 1) {
        (void)chosen_frame(places.name, options, 1);
        return;
    }
    const auto division = division_of(places);
    if (!division) {
        std::string differ;
        for (const int attribute : places.varying())
            differ += fmt::format("{}{}", differ.empty() ? "" : ", ", dicom_attribute_name(attribute));
        const auto [least, most] = std::ranges::minmax_element(places.count);
        const auto crowded = static_cast<std::size_t>(most - places.count.begin());
        std::string names;
        for (std::size_t i = 0; i < places.frames.size(); ++i)
            if (places.place[i] == crowded) names += (names.empty() ? "" : ", ") + places.name_of(places.frames[i]);
        // Their order in the file is no reason: frames of several volumes may alternate or follow in any order.
        const bool one_file = std::ranges::all_of(
            places.frames, [&](const DicomFrame& frame) { return frame.image == places.frames.front().image; });
        fail("{}: {} slices at the same position ({}){}, which no attribute divides into volumes; {}", places.name,
             *least == *most ? std::to_string(*most) : fmt::format("{} to {}", *least, *most), names,
             differ.empty() ? "" : "; they differ in " + differ,
             one_file ? "write the frames of one volume into a file of their own"
                      : "put the files of one volume into a folder of their own");
    }
    const std::size_t count = division->values.size();
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 16); ++i)
        list += fmt::format("{}{}: {}", i == 0 ? "" : ", ", i, division->values[i]);
    if (count > 16) list += fmt::format(", ... {}: {}", count - 1, division->values.back());
    const std::string what = fmt::format("{} frames at the same position, at {} position{}, which differ in {}", count,
                                         places.count.size(), places.count.size() == 1 ? "" : "s", division->by);
    if (!options.frame) fail("{}: {}; choose one with --frame 0..{} ({})", places.name, what, count - 1, list);
    if (*options.frame < 0 || static_cast<std::size_t>(*options.frame) >= count)
        fail("{}: --frame {}: {}, numbered from 0 ({})", places.name, *options.frame, what, list);
    const auto chosen = static_cast<std::size_t>(*options.frame);
    std::vector<DicomFrame> kept;
    for (std::size_t i = 0; i < places.frames.size(); ++i)
        if (division->group[i] == chosen) kept.push_back(places.frames[i]);
    places.frames = std::move(kept);
    places.find_places();
    volume.notes.push_back(
        fmt::format("Frame {} of {} by {}: {}.", chosen, count, division->by, division->values[chosen]));
}

// ---------------------------------------------------------------------------------------------------------------------
// Spacing.

/// Throws the error for two slices with uneven spacing.
[[noreturn]] void refuse_spacing(const DicomPlaces& places, const std::vector<double>& gaps, double usual) {
    const auto odd = static_cast<std::size_t>(
        std::ranges::max_element(gaps, {}, [&](double gap) { return std::abs(gap - usual); }) - gaps.begin());
    auto others = gaps;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(odd));
    const auto [least, most] = std::ranges::minmax(others.empty() ? gaps : others);
    const std::string rest =
        most - least > 1e-6 * usual ? fmt::format("{:.6g} to {:.6g} mm", least, most) : fmt::format("{:.6g} mm", least);
    const auto &before = places.frames[odd], &after = places.frames[odd + 1];
    fail(
        "{}: uneven slice spacing: {} at {} and {} at {} are {:.6g} mm apart, the others {}{}; --resample "
        "interpolates evenly spaced slices",
        places.name, places.name_of(before), place_text(*before.position), places.name_of(after),
        place_text(*after.position), gaps[odd], rest, gaps[odd] > 1.5 * usual ? " (a slice may be missing)" : "");
}

/// Whether heights are those of an even stack, rounded to whole units. A spacing that is declared as a whole number and
/// a multiple of the unit would leave no unevenness.
bool even_but_rounded(const std::vector<double>& heights, double unit, const DicomFrame& first) {
    const std::size_t count = heights.size();
    const double mean = heights.back() / static_cast<double>(count - 1);
    if (!(unit > 0) || unit > 0.5 * mean || count > 20000) return false;
    const double declared = std::abs(first.declared_spacing);
    if (declared > 0 && first.whole_spacing && std::abs(declared - mean) < 0.05 * mean) return false;
    double least = heights.back(), most = 0;
    for (std::size_t i = 1; i < count; ++i) {
        least = std::min(least, heights[i] - heights[i - 1]);
        most = std::max(most, heights[i] - heights[i - 1]);
    }
    if (most - least > unit * 1.001) return false;
    // Slopes of lines that pass all heights at half a unit at most.
    double low = 0, high = heights.back();
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t j = i + 1; j < count; ++j) {
            const double steps = static_cast<double>(j - i), rise = heights[j] - heights[i];
            low = std::max(low, (rise - 1.001 * unit) / steps);
            high = std::min(high, (rise + 1.001 * unit) / steps);
        }
    return low <= high;
}

}  // namespace

DicomOrder order_dicom_frames(const std::string& name, const std::vector<DicomImage>& images,
                              std::vector<DicomFrame> frames, const LoadOptions& options, Volume& volume) {
    DicomPlaces places{name, images, std::move(frames), {}, {}};
    places.find_places();
    if (places.most() > 1) places.leave_out_duplicates(true, volume.warnings);
    if (places.most() > 1 && places.varying().size() <= 1) places.leave_out_duplicates(false, volume.warnings);
    choose_group(places, options, volume);

    const DicomFrame first = places.frames.front();
    const glm::dvec3 row = first.plane.row, column = first.plane.column, normal = first.plane.normal();
    DicomOrder order;
    const std::size_t count = places.frames.size();
    if (count == 1) {
        const double declared = std::abs(first.declared_spacing);
        const double thickness = declared > 0 ? declared : first.thickness > 0 ? first.thickness : 1;
        order.step = normal * thickness;
        volume.notes.push_back(fmt::format(
            "One slice, {:.6g} mm thick{}{}.", thickness, declared > 0 || first.thickness > 0 ? "" : " (assumed)",
            images[first.image].frames.size() == 1 && images.size() == 1 ? "; give the folder to read a whole series"
                                                                         : ""));
        order.frames = std::move(places.frames);
        return order;
    }
    std::vector<double> heights, gaps;
    for (const DicomFrame& frame : places.frames)
        heights.push_back(glm::dot(normal, *frame.position - *first.position));
    for (std::size_t i = 1; i < count; ++i)
        gaps.push_back(heights[i] - heights[i - 1]);
    auto sorted = gaps;
    // The lower median: missing slices make gaps wider.
    const std::size_t middle = (sorted.size() - 1) / 2;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(middle), sorted.end());
    const double usual = sorted[middle], total = heights.back();
    const glm::dvec3 way = *places.frames.back().position - *first.position;
    const double unit = places.unit_along(normal);
    bool even = true;
    for (std::size_t i = 1; i < count; ++i) {
        const auto &before = places.frames[i - 1], &here = places.frames[i];
        const double ideal = total * static_cast<double>(i) / static_cast<double>(gaps.size());
        even = even && std::abs(gaps[i - 1] - usual) <= 0.01 * usual && std::abs(heights[i] - ideal) <= 0.05 * usual;
        const glm::dvec3 aside = *here.position - *first.position - way * (heights[i] / total);
        const glm::dvec3 lateral = aside - normal * glm::dot(normal, aside);
        const double allowed = 0.05 * std::min(first.plane.spacing.x, first.plane.spacing.y) +
                               1.5 * std::min(places.unit_along(row) + places.unit_along(column),
                                              0.2 * std::min(first.plane.spacing.x, first.plane.spacing.y));
        if (!(glm::length(lateral) <= allowed))
            fail("{}: the slices do not lie on one line: {} is {:.4g} mm aside ({} at {} and {} at {})", name,
                 places.name_of(here), glm::length(lateral), places.name_of(before), place_text(*before.position),
                 places.name_of(here), place_text(*here.position));
    }
    if (!even && even_but_rounded(heights, unit, first)) {
        even = true;
        volume.notes.push_back(
            fmt::format("Positions are rounded to {:.3g} mm: the slices are taken as evenly spaced.", unit));
    }
    if (!even && !options.resample) refuse_spacing(places, gaps, usual);
    const double steps = even ? static_cast<double>(gaps.size()) : std::max(std::round(total / usual), 1.0);
    const glm::dvec3 step = way / steps;
    const double spacing = total / steps;
    if (!even) {
        order.heights = std::move(heights);
        order.count = static_cast<std::size_t>(steps) + 1;
    }
    const glm::dvec3 lean = step - normal * spacing;
    order.step = step;
    if (glm::length(lean) > 1e-3 * spacing) {
        const double degrees = std::atan2(glm::length(lean), spacing) * 180 / 3.14159265358979323846;
        volume.notes.push_back(
            fmt::format("The stack of slices is sheared by {:.2f} degrees ({:.4g} mm along rows, {:.4g} mm along "
                        "columns per slice: gantry tilt). It is kept exactly in the direction matrix.",
                        degrees, glm::dot(lean, row), glm::dot(lean, column)));
    }
    const double declared = std::abs(first.declared_spacing);
    if (declared > 0 && std::abs(declared - spacing) > 0.02 * spacing)
        volume.notes.push_back(fmt::format(
            "SpacingBetweenSlices (0018,0088) is {:.6g} mm, but the positions are {:.6g} mm apart, which counts.",
            declared, spacing));
    order.frames = std::move(places.frames);
    return order;
}

DicomOrder order_dicom_pictures(const std::string& name, const std::vector<DicomImage>& images,
                                std::vector<DicomFrame> frames, const LoadOptions& options, Volume& volume) {
    DicomOrder order;
    const DicomFrame first = frames.front();
    const double declared = std::abs(first.declared_spacing);
    const double thickness = declared > 0 ? declared : first.thickness;
    order.step = first.plane.normal() * (thickness > 0 ? thickness : 1);
    std::ranges::stable_sort(frames, [](const DicomFrame& a, const DicomFrame& b) {
        return a.instance != b.instance ? a.instance < b.instance : a.index < b.index;
    });
    const std::size_t count = frames.size();
    if (count == 1 || options.frame) {
        const std::size_t chosen = chosen_frame(name, options, count);
        order.frames = {frames[chosen]};
        volume.notes.push_back(count == 1 ? "One picture without position: a volume of one slice."
                                          : fmt::format("Frame {} of {}: a volume of one slice.", chosen, count));
        return order;
    }
    const auto name_of = [&](const DicomFrame& frame) { return images[frame.image].name(); };
    const bool single =
        std::ranges::all_of(frames, [&](const DicomFrame& f) { return images[f.image].frames.size() == 1; });
    if (!options.spacing && (!single || !(thickness > 0)))
        fail(
            "{}: {} frames without positions (0020,0032): a film over time or single pictures, no volume; --frame "
            "0..{} reads one of them, --spacing X Y Z (mm) reads them as the slices of a volume",
            name, count, count - 1);
    if (single) {
        for (std::size_t i = 0; i < count; ++i) {
            if (frames[i].instance < 0)
                fail("{}: {} has neither a position (0020,0032) nor an instance number (0020,0013)", name,
                     name_of(frames[i]));
            if (i > 0 && frames[i].instance == frames[i - 1].instance)
                fail("{}: {} and {} have the same instance number and no positions", name, name_of(frames[i - 1]),
                     name_of(frames[i]));
            if (i > 0 && frames[i].instance - frames[i - 1].instance != frames[1].instance - frames[0].instance)
                fail("{}: instance numbers {} and {} ({}, {}) are not one step apart: a slice is missing", name,
                     frames[i - 1].instance, frames[i].instance, name_of(frames[i - 1]), name_of(frames[i]));
        }
        volume.notes.push_back(fmt::format(
            "No positions in the files: slices are in the order of their instance numbers, {:.6g} mm apart.",
            options.spacing ? options.spacing->z : thickness));
    } else {
        volume.notes.push_back("No positions in the file: its frames are read as slices because --spacing is given.");
    }
    order.frames = std::move(frames);
    return order;
}

}  // namespace edgesplat::detail
