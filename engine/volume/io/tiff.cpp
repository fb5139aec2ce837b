// Reads TIFF stacks: which page is which slice, component and frame, and how far apart voxels are, by ImageJ, OME-XML,
// tifffile, Zeiss LSM or, without any of them, page by page.
#include "engine/volume/io/tiff.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>

#include "engine/volume/io/ome.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/io/tiff_file.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;
using TiffFilePointer = std::shared_ptr<const TiffFile>;

/// Spacing in mm along x, y, z; 0: not given.
struct TiffPlace {
    glm::dvec3 spacing{0};
    glm::dvec3 origin{0};  ///< mm
    std::string source, unit;
    bool is_of_pages = false;  ///< every page says the spacing of its pixels
};

/// What is read: the planes of the chosen component and frame.
struct TiffStack {
    std::vector<std::optional<TiffPlane>> planes;  ///< per slice; none: the file lacks it
    std::size_t sample = 0;                        ///< within a pixel
    TiffPlace place;
    std::vector<double> calibration;  ///< value = sum of calibration[i] * (stored + shift)^i; empty: as stored
    double shift = 0;
    std::vector<std::string> notes, warnings;
};

/// Pages of slices, components and frames.
struct TiffSizes {
    std::size_t slices = 1, channels = 1, frames = 1;
};

double tiff_number(const std::string& path, std::string_view field, std::string_view text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        fail("{}: {}={}: expected a number", path, field, text);
    return value;
}

/// A length of a voxel in mm. Without --spacing it must be finite and above 0.
double tiff_length(const std::string& path, const LoadOptions& options, std::string_view field, double value,
                   double millimetres) {
    const double length = value * millimetres;
    if (std::isfinite(length) && length > 0) return length;
    if (options.spacing) return 0;
    fail("{}: {}: {}: expected a length above 0; give --spacing X Y Z", path, field, value);
}

bool is_usable(const TiffPage& page) {
    return !page.is_reduced && !page.is_mask;
}

std::string shape_of(const TiffFile& file, const TiffPage& page) {
    return fmt::format("{} x {} pixels, {} component{}, {}", page.width, page.height, page.samples,
                       page.samples == 1 ? "" : "s", name_of(tiff_sample_type(file, page)));
}

bool is_same_shape(const TiffPage& a, const TiffPage& b) {
    return a.width == b.width && a.height == b.height && a.samples == b.samples && a.bits == b.bits &&
           a.format == b.format && a.photometric == b.photometric;
}

/// Whether pages have the same distances of pixels, or one of them says nothing.
bool is_same_resolution(const TiffPage& a, const TiffPage& b) {
    const auto is_silent = [](const TiffPage& page) { return page.x_resolution == 0 && page.y_resolution == 0; };
    const auto is_near = [](double x, double y) { return std::abs(x - y) <= 1e-4 * std::abs(x); };
    return is_silent(a) || is_silent(b) ||
           (is_near(a.x_resolution, b.x_resolution) && is_near(a.y_resolution, b.y_resolution) &&
            a.resolution_unit == b.resolution_unit);
}

/// Fails unless the page's pixels can be read.
void check_page(const TiffPlane& plane) {
    const TiffPage& page = plane.description();
    if (page.width == 0 || page.height == 0) fail("{}: {} x {} pixels", plane.name(), page.width, page.height);
    if (page.samples < 1 || page.samples > 65535)
        fail("{}: {} samples per pixel, expected 1 to 65535", plane.name(), page.samples);
    if (page.planar != 1 && page.planar != 2)
        fail("{}: PlanarConfiguration {}, expected 1 or 2", plane.name(), page.planar);
    if (page.depth > 1)
        fail("{}: a tiled 3-D image of depth {}, which cannot be read; save it as a stack of pages", plane.name(),
             page.depth);
    if (page.offsets.tag == 0 || page.offsets.count == 0) fail("{}: it has no strips or tiles", plane.name());
    if (page.photometric == 32844 || page.photometric == 32845)
        fail("{}: logarithmic luminance (PhotometricInterpretation {}) is not read", plane.name(), page.photometric);
    if (page.is_metamorph)
        fail("{}: a MetaMorph stack, whose slices share one directory; save it as OME-TIFF", plane.name());
    (void)tiff_sample_type(*plane.file, page);
}

std::vector<std::string> component_names(const TiffPage& page, std::size_t channels,
                                         const std::vector<std::string>& channel_names) {
    std::vector<std::string> colours;
    if (page.photometric == 2 || (page.photometric == 6 && page.compression == 7))
        colours = {"red", "green", "blue"};
    else if (page.photometric <= 1 && page.samples == 2)
        colours = {"grey"};
    if (!colours.empty() && page.samples == colours.size() + 1) colours.emplace_back("alpha");
    std::vector<std::string> names;
    for (std::size_t channel = 0; channel < channels; ++channel)
        for (std::size_t sample = 0; sample < page.samples; ++sample) {
            std::string name = channel < channel_names.size() ? channel_names[channel] : "";
            if (sample < colours.size()) name += (name.empty() ? "" : " ") + colours[sample];
            names.push_back(name);
        }
    return names;
}

/// Chooses frame and component. `plane_at(index of slice, channel, frame)`: that plane, or none.
template <typename PlaneAt>
void choose_planes(TiffStack& stack, const std::string& path, const LoadOptions& options, const TiffSizes& sizes,
                   const TiffPage& page, const std::vector<std::string>& channel_names, const PlaneAt& plane_at) {
    const std::size_t samples = page.samples;
    if (sizes.channels > (std::size_t{1} << 24) / samples)
        fail("{}: {} channels of {} samples: too many", path, sizes.channels, samples);
    const std::size_t component =
        chosen_component(path, options, sizes.channels * samples, component_names(page, sizes.channels, channel_names));
    const std::size_t frame = chosen_frame(path, options, sizes.frames);
    stack.sample = component % samples;
    if (sizes.slices > kMaxVoxelsPerAxis)
        fail("{}: {} slices: an axis may have at most {} voxels", path, sizes.slices, kMaxVoxelsPerAxis);
    for (std::size_t z = 0; z < sizes.slices; ++z)
        stack.planes.push_back(plane_at(z, component / samples, frame));
}

// --- Resolution fields of plain TIFF ---

/// Whether this is a resolution, pixels per inch, that screens and printers have: programs write it without a meaning.
bool is_of_printing(double per_inch) {
    constexpr double kUsual[] = {72,  75,  90,  96,  100, 120, 144, 150, 180,  192,
                                 200, 240, 300, 350, 360, 400, 600, 720, 1200, 2400};
    return std::ranges::any_of(kUsual, [&](double usual) { return std::abs(per_inch / usual - 1) < 2e-3; });
}

TiffPlace plain_place(const TiffPage& page, std::vector<std::string>& notes) {
    TiffPlace place;
    const bool is_inch = page.resolution_unit == 2, is_cm = page.resolution_unit == 3;
    const double x = page.x_resolution, y = page.y_resolution;
    if ((!is_inch && !is_cm) || !(x > 0) || !(y > 0) || !std::isfinite(x) || !std::isfinite(y)) return place;
    const double millimetres = is_inch ? 25.4 : 10;
    // One pixel per unit is a writer's way to say nothing.
    if ((x == 1 && y == 1) || (is_of_printing(x * 25.4 / millimetres) && is_of_printing(y * 25.4 / millimetres))) {
        notes.push_back(fmt::format(
            "Its resolution, {} pixels per {}, is usual for screens and print: it is not taken as a voxel spacing.", x,
            is_inch ? "inch" : "cm"));
        return place;
    }
    place.spacing = {millimetres / x, millimetres / y, 0};
    place.is_of_pages = true;
    place.source = "XResolution, YResolution";
    place.unit = is_inch ? "inch" : "cm";
    return place;
}

// --- ImageJ ---

using ImageJFields = std::map<std::string, std::string>;

std::optional<ImageJFields> imagej_fields(const TiffPage& page) {
    for (const std::string& text : page.descriptions) {
        if (!text.starts_with("ImageJ=") && !text.starts_with("SCIFIO=")) continue;
        ImageJFields fields;
        for (std::size_t begin = 0; begin < text.size();) {
            const std::size_t end = std::min(text.find('\n', begin), text.size());
            const std::string line = text.substr(begin, end - begin);
            const std::size_t equals = line.find('=');
            if (equals != std::string::npos) fields.emplace(line.substr(0, equals), trimmed(line.substr(equals + 1)));
            begin = end + 1;
        }
        return fields;
    }
    return std::nullopt;
}

std::size_t imagej_count(const std::string& path, const ImageJFields& fields, const char* name) {
    const auto found = fields.find(name);
    if (found == fields.end()) return 1;
    const double value = tiff_number(path, std::string("ImageJ's ") + name, found->second);
    if (!(value >= 1) || value > 1e9 || value != std::floor(value))
        fail("{}: ImageJ's {}={}: expected a whole number of at least 1", path, name, found->second);
    return static_cast<std::size_t>(value);
}

/// Millimetres of ImageJ's unit; nullopt if it is none of length ("pixel").
std::optional<double> imagej_millimetres(const std::string& path, const LoadOptions& options, const std::string& unit) {
    static constexpr std::string_view kNone[] = {"", "pixel", "pixels", "null", "voxel", "voxels"};
    if (std::ranges::find(kNone, unit) != std::end(kNone)) return std::nullopt;
    if (const auto known = millimetres_in(unit)) return known;
    if (options.spacing) return std::nullopt;
    fail("{}: ImageJ's unit={}: expected a unit of length such as um, mm, inch or pixel; give --spacing X Y Z", path,
         unit);
}

/// `is_stack`: without a field "spacing" slices are one unit apart, as ImageJ reads it.
TiffPlace imagej_place(const std::string& path, const LoadOptions& options, const TiffPage& page,
                       const ImageJFields& fields, bool is_stack) {
    const auto text = [&](const char* name) {
        const auto found = fields.find(name);
        return found == fields.end() ? std::string() : found->second;
    };
    TiffPlace place;
    glm::dvec3 size{1, 1, is_stack ? 1 : 0};  // in the unit; ImageJ's default is 1
    const bool has_x = page.x_resolution != 0, has_y = page.y_resolution != 0;
    if (has_x) size.x = 1 / page.x_resolution;
    if (has_y) size.y = 1 / page.y_resolution;
    std::string unit = text("unit");
    if (unit.empty() && (has_x || has_y)) {
        const bool is_default = page.x_resolution == 72;  // as ImageJ reads it
        if (page.resolution_unit == 3) unit = "cm";
        if (page.resolution_unit == 2 && is_default) size.x = size.y = 1;
        if (page.resolution_unit == 2 && !is_default) unit = "inch";
    }
    if (const std::string spacing = text("spacing"); !spacing.empty()) {
        const double value = std::abs(tiff_number(path, "ImageJ's spacing", spacing));  // ImageJ ignores the sign
        size.z = value == 0 ? 1 : value;
        if (!std::isfinite(value)) (void)tiff_length(path, options, "ImageJ's spacing", value, 1);
    }
    const auto millimetres = imagej_millimetres(path, options, unit);
    place.source = "ImageJ's resolution, spacing and unit";
    if (!millimetres) {
        // Numbers of pixels: only their ratio means something.
        const bool is_one = size.x == 1 && size.y == 1 && (size.z == 0 || size.z == 1);
        place.source = is_one ? "" : "ImageJ's resolution and spacing, without unit: mm assumed";
        if (is_one) size.z = 1;
    } else {
        place.unit = unit;
    }
    const char* const units[] = {"unit", "yunit", "zunit"};
    const char* const origins[] = {"xorigin", "yorigin", "zorigin"};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string named = axis == 0 ? "" : text(units[axis]), own = named.empty() ? unit : named;
        const auto of_axis = imagej_millimetres(path, options, own);
        if (size[axis] != 0 && of_axis.has_value() != millimetres.has_value() && !options.spacing)
            fail("{}: ImageJ's {}={}, but unit={}: expected units of length or none; give --spacing X Y Z", path,
                 units[axis], own, unit);
        const double scale = of_axis.value_or(1);
        if (size[axis] != 0)
            place.spacing[axis] = tiff_length(path, options,
                                              axis == 0   ? "XResolution"
                                              : axis == 1 ? "YResolution"
                                                          : "ImageJ's spacing",
                                              size[axis], scale);
        if (const std::string origin = text(origins[axis]); !origin.empty()) {
            const double voxels = tiff_number(path, std::string("ImageJ's ") + origins[axis], origin);
            if (!std::isfinite(voxels)) fail("{}: ImageJ's {}={}: expected a number", path, origins[axis], origin);
            place.origin[axis] = -voxels * place.spacing[axis];
        }
    }
    return place;
}

/// ImageJ's density calibration.
void imagej_calibration(TiffStack& stack, const std::string& path, const TiffPage& page, const ImageJFields& fields) {
    const auto function = fields.find("cf");
    const bool has_first = fields.contains("c0");
    if (function == fields.end() && !has_first) return;
    const double kind = function == fields.end() ? 0 : tiff_number(path, "ImageJ's cf", function->second);
    std::vector<double> coefficients;
    for (int i = 0; i < 8; ++i) {
        const auto found = fields.find(fmt::format("c{}", i));
        if (found == fields.end()) break;
        coefficients.push_back(tiff_number(path, "ImageJ's " + found->first, found->second));
        if (!std::isfinite(coefficients.back()))
            fail("{}: ImageJ's {}={}: expected a number", path, found->first, found->second);
    }
    constexpr double kNoFunction = 20;
    if (kind == kNoFunction || (coefficients.empty() && kind <= 3)) return;
    if (page.format == 3) {
        stack.notes.emplace_back("ImageJ's calibration is not applied to floats, as ImageJ does not.");
        return;
    }
    // 0 to 3: polynomials of degree 1 to 4; 15 to 18: of degree 5 to 8.
    const bool is_polynomial = (kind >= 0 && kind <= 3) || (kind >= 15 && kind <= 18);
    if (!is_polynomial) {
        stack.warnings.push_back(fmt::format(
            "ImageJ's calibration function {} is not a polynomial and not applied: values are as stored.", kind));
        return;
    }
    if (coefficients.empty()) return;
    // ImageJ holds signed numbers of 16 bits with an offset, which the function includes.
    stack.shift = page.format == 2 && page.bits == 16 ? 32768 : 0;
    if (coefficients.size() == 2 && coefficients[1] == 1 && coefficients[0] + stack.shift == 0) return;
    const auto unit = fields.find("vunit");
    stack.notes.push_back(fmt::format("ImageJ's calibration is applied: c0 = {}, c1 = {}{}{}.", coefficients[0],
                                      coefficients.size() > 1 ? coefficients[1] : 0,
                                      unit == fields.end() ? "" : ", in ", unit == fields.end() ? "" : unit->second));
    stack.calibration = std::move(coefficients);
}

// --- Stacks of one file ---

std::vector<std::size_t> usable_pages(const TiffFile& file, std::vector<std::string>& notes) {
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < file.pages().size(); ++i)
        if (is_usable(file.pages()[i])) usable.push_back(i);
    const std::size_t left_out = file.pages().size() - usable.size();
    if (usable.empty()) {  // nothing that they could be reduced from
        for (std::size_t i = 0; i < file.pages().size(); ++i)
            usable.push_back(i);
    } else if (left_out > 0) {
        notes.push_back(
            fmt::format("{} of its {} pages are reduced copies or masks and left out.", left_out, file.pages().size()));
    }
    return usable;
}

/// Pages of one shape: the only ones, or those that --series chooses.
std::vector<std::size_t> pages_of_one_shape(const TiffFile& file, const std::vector<std::size_t>& pages,
                                            const LoadOptions& options) {
    std::vector<std::vector<std::size_t>> groups;
    constexpr std::size_t kMostGroups = 64;
    for (const std::size_t page : pages) {
        const auto group = std::ranges::find_if(
            groups, [&](const auto& members) { return is_same_shape(file.pages()[members[0]], file.pages()[page]); });
        if (group != groups.end())
            group->push_back(page);
        else if (groups.size() < kMostGroups)
            groups.push_back({page});
        else
            fail("{}: its pages have more than {} shapes; expected slices of one size", file.path(), kMostGroups);
    }
    std::size_t chosen = 0;
    if (!options.series.empty()) {
        const auto& text = options.series;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), chosen);
        if (error != std::errc() || end != text.data() + text.size() || chosen >= groups.size())
            fail("{}: --series {}: expected 0..{}", file.path(), text, groups.size() - 1);
    } else if (groups.size() > 1) {
        std::string list;
        for (std::size_t i = 0; i < std::min<std::size_t>(groups.size(), 8); ++i)
            list += fmt::format("{}{}: {} page{} of {}", i == 0 ? "" : "; ", i, groups[i].size(),
                                groups[i].size() == 1 ? "" : "s", shape_of(file, file.pages()[groups[i][0]]));
        fail("{}: its pages differ, page {} from page {}; choose one kind with --series 0..{} ({}{})", file.path(),
             groups[1][0], groups[0][0], groups.size() - 1, list, groups.size() > 8 ? "; ..." : "");
    }
    return groups[chosen];
}

/// Offset of plane `index` of `count` that follow each other uncompressed after one directory.
std::uint64_t checked_plane_offset(const TiffFile& file, const TiffPage& page, std::size_t index, std::size_t count) {
    if (page.compression != 1 || !page.is_contiguous || page.tile_width > 0 || page.planar != 1)
        fail("{}: its header promises {} images after one directory, but that directory's pixels are not contiguous",
             file.path(), count);
    const std::uint64_t bytes = (page.width * page.samples * page.bits + 7) / 8 * page.height;
    std::uint64_t all = 0;
    if (__builtin_mul_overflow(bytes, count, &all) || page.first > file.size() || all > file.size() - page.first)
        fail("{}: truncated: its header promises {} images of {} bytes after byte {}, but the file has {}", file.path(),
             count, bytes, page.first, file.size());
    return page.first + bytes * index;
}

/// Planes in pages, or, if there is one page for `count` > 1 planes, after it.
TiffPlane plane_of(const TiffFilePointer& file, const std::vector<std::size_t>& pages, std::size_t index,
                   std::size_t count) {
    if (pages.size() == 1 && count > 1)
        return {file, pages[0], checked_plane_offset(*file, file->pages()[pages[0]], index, count)};
    return {file, pages[index], std::nullopt};
}

bool take_imagej(TiffStack& stack, const TiffFilePointer& file, const LoadOptions& options) {
    const auto fields = imagej_fields(file->pages()[0]);
    if (!fields) return false;
    const std::string& path = file->path();
    const auto pages = pages_of_one_shape(*file, usable_pages(*file, stack.notes), options);
    const TiffPage& page = file->pages()[pages[0]];
    std::size_t images = imagej_count(path, *fields, "images");
    TiffSizes sizes{imagej_count(path, *fields, "slices"), imagej_count(path, *fields, "channels"),
                    imagej_count(path, *fields, "frames")};
    const bool has_sizes = fields->contains("slices") || fields->contains("channels") || fields->contains("frames");
    if (!fields->contains("images")) images = has_sizes ? sizes.slices * sizes.channels * sizes.frames : pages.size();
    if (!has_sizes) sizes.slices = images;
    // A colour image of ImageJ has its channels in one page.
    if (page.samples > 1 && sizes.channels == page.samples && sizes.slices * sizes.frames == pages.size()) {
        images = pages.size();
        sizes.channels = 1;
    }
    if (sizes.slices * sizes.channels * sizes.frames != images)
        fail("{}: ImageJ's images={}, but channels={}, slices={}, frames={}: expected their product", path, images,
             sizes.channels, sizes.slices, sizes.frames);
    if (fields->contains("SCIFIO") && (sizes.channels > 1 || sizes.frames > 1))
        fail("{}: SCIFIO's order of channels and frames is not read; save it as OME-TIFF", path);
    if (pages.size() != images && pages.size() != 1)
        fail("{}: ImageJ's images={}, but the file has {} pages", path, images, pages.size());
    check_page({file, pages[0], {}});
    choose_planes(stack, path, options, sizes, page, {}, [&](std::size_t z, std::size_t c, std::size_t t) {
        return plane_of(file, pages, (t * sizes.slices + z) * sizes.channels + c, images);
    });
    stack.place = imagej_place(path, options, page, *fields, true);
    imagej_calibration(stack, path, page, *fields);
    return true;
}

/// tifffile's description: {"shape": [24, 44, 40], "axes": "ZYX"}.
bool take_shaped(TiffStack& stack, const TiffFilePointer& file, const LoadOptions& options) {
    using nlohmann::json;
    const TiffPage& page = file->pages()[0];
    const std::string text = page.descriptions.empty() ? "" : page.descriptions[0];
    if (!text.starts_with('{')) return false;
    const json fields = json::parse(text, nullptr, false);
    if (!fields.is_object() || !fields.contains("shape") || !fields["shape"].is_array()) return false;
    std::vector<std::size_t> shape;
    for (const json& size : fields["shape"]) {
        if (!size.is_number_unsigned()) return false;
        shape.push_back(size.get<std::size_t>());
    }
    // The axes of a page are the last ones, with the samples before them if these are in planes of their own.
    std::vector<std::size_t> inside{page.height, page.width};
    if (page.samples > 1 && page.planar == 1) inside.push_back(page.samples);
    if (page.samples > 1 && page.planar == 2) inside.insert(inside.begin(), page.samples);
    if (shape.size() < inside.size() || !std::equal(inside.rbegin(), inside.rend(), shape.rbegin())) return false;
    shape.resize(shape.size() - inside.size());
    const std::string axes =
        fields.contains("axes") && fields["axes"].is_string() ? fields["axes"].get<std::string>() : std::string();
    std::size_t images = 1;
    for (const std::size_t size : shape)
        if (size == 0 || __builtin_mul_overflow(images, size, &images)) return false;
    auto pages = usable_pages(*file, stack.notes);
    const bool is_truncated = fields.contains("truncated") && fields["truncated"] == true;
    if (pages.size() != images && !(pages.size() == 1 && is_truncated)) {
        stack.notes.clear();
        return false;
    }
    pages = pages_of_one_shape(*file, pages, options);
    check_page({file, pages[0], {}});
    // Z is the slice, C the component; without a Z the last other axis is; the others are frames.
    const bool is_named = axes.size() == shape.size() + inside.size();
    std::optional<std::size_t> slice_axis, channel_axis;
    for (std::size_t axis = 0; axis < shape.size(); ++axis) {
        if (is_named && axes[axis] == 'Z') slice_axis = axis;
        if (is_named && axes[axis] == 'C') channel_axis = axis;
    }
    for (std::size_t axis = shape.size(); axis-- > 0 && !slice_axis;)
        if (axis != channel_axis && !(is_named && axes[axis] == 'T')) slice_axis = axis;
    TiffSizes sizes;
    for (std::size_t axis = 0; axis < shape.size(); ++axis)
        (axis == slice_axis ? sizes.slices : axis == channel_axis ? sizes.channels : sizes.frames) *= shape[axis];
    choose_planes(stack, file->path(), options, sizes, page, {}, [&](std::size_t z, std::size_t c, std::size_t t) {
        std::size_t index = 0, stride = 1;
        for (std::size_t axis = shape.size(); axis-- > 0;) {
            std::size_t at = axis == slice_axis ? z : c;
            if (axis != slice_axis && axis != channel_axis) {
                at = t % shape[axis];
                t /= shape[axis];
            }
            index += at * stride;
            stride *= shape[axis];
        }
        return plane_of(file, pages, index, images);
    });
    stack.place = plain_place(page, stack.notes);
    const auto number_of = [&](const char* name) {
        return fields.contains(name) && fields[name].is_number() ? fields[name].get<double>() : 0.0;
    };
    const std::string unit =
        fields.contains("unit") && fields["unit"].is_string() ? fields["unit"].get<std::string>() : std::string();
    if (const auto millimetres = millimetres_in(unit)) {
        if (page.x_resolution > 0 && page.y_resolution > 0)
            stack.place.spacing = {*millimetres / page.x_resolution, *millimetres / page.y_resolution, 0};
        stack.place.spacing.z = std::max(number_of("spacing"), 0.0) * *millimetres;
        stack.place.source = "XResolution, YResolution; spacing and unit of tifffile's description";
        stack.place.unit = unit;
    }
    return true;
}

// --- Zeiss LSM ---

bool take_lsm(TiffStack& stack, const TiffFilePointer& file, const LoadOptions& options) {
    const TiffPage& page = file->pages()[0];
    if (!page.lsm) return false;
    const std::string& path = file->path();
    if (page.lsm->count < 90)
        fail("{}: Zeiss LSM information of {} bytes, expected at least 90", path, page.lsm->count);
    const std::string info = file->bytes(page.lsm->at, 90);
    const auto number = [&](auto value, std::size_t at) {
        std::memcpy(&value, info.data() + at, sizeof value);
        return value;
    };
    if (file->is_swapped() || (number(std::uint32_t{}, 0) & 0xFFFFFF00U) != 0x00494C00U)
        if (number(std::uint32_t{}, 0) != 0x0300494CU && number(std::uint32_t{}, 0) != 0x0400494CU)
            fail("{}: Zeiss LSM information without its signature", path);
    if (file->size() > 0xFFFFFFFFULL) fail("{}: Zeiss LSM above 4 GiB, whose offsets are not whole, is not read", path);
    const auto pages = pages_of_one_shape(*file, usable_pages(*file, stack.notes), options);
    const TiffPage& first = file->pages()[pages[0]];
    const std::int32_t slices = number(std::int32_t{}, 16), frames = number(std::int32_t{}, 24);
    const auto kind = number(std::uint16_t{}, 88);
    if (kind != 0 && kind != 3 && kind != 6 && kind != 7)
        fail("{}: a Zeiss LSM of scan type {}: only stacks and time series of slices in x and y are read", path, kind);
    if (slices < 1 || frames < 1 ||
        static_cast<std::uint64_t>(slices) * static_cast<std::uint64_t>(frames) != pages.size())
        fail("{}: Zeiss LSM: {} slices, {} frames, but {} pages", path, slices, frames, pages.size());
    check_page({file, pages[0], {}});
    const TiffSizes sizes{static_cast<std::size_t>(slices), 1, static_cast<std::size_t>(frames)};
    choose_planes(stack, path, options, sizes, first, {}, [&](std::size_t z, std::size_t, std::size_t t) {
        return TiffPlane{file, pages[t * sizes.slices + z], std::nullopt};
    });
    for (int axis = 0; axis < 3; ++axis) {
        const double metres = number(double{}, static_cast<std::size_t>(40 + 8 * axis));
        if (axis == 2 && metres == 0 && slices == 1) continue;
        stack.place.spacing[axis] = tiff_length(path, options, "Zeiss LSM's VoxelSize", metres, 1000);
    }
    stack.place.source = "Zeiss LSM's VoxelSizeX, Y, Z";
    stack.place.unit = "m";
    return true;
}

// --- OME-TIFF ---

/// The files that hold an image's planes, opened once.
class OmeFiles {
  public:
    OmeFiles(std::string path, TiffFilePointer own, std::string uuid)
        : path_(std::move(path)), own_(std::move(own)), uuid_(std::move(uuid)) {}

    TiffFilePointer of(const OmeTiffData& data) {
        const std::string own_name = fs::path(path_).filename().string();
        const bool is_own = (data.file.empty() && data.uuid.empty()) || data.file == own_name ||
                            (!data.uuid.empty() && data.uuid == uuid_);
        if (is_own) {
            if (!own_) fail("{}: OME-XML: TiffData names no file", path_);
            return own_;
        }
        if (data.file.empty())
            fail("{}: OME-XML: its planes are in the file with UUID {}, whose name it does not give", path_, data.uuid);
        auto& file = files_[data.file];
        if (!file) {
            const fs::path place = fs::path(path_).parent_path() / fs::path(data.file).filename();
            std::error_code ignored;
            if (fs::path(data.file).has_parent_path() || !fs::is_regular_file(place, ignored))
                fail("{}: OME-XML: some of its planes are in the file {}, which is not in the same folder", path_,
                     data.file);
            file = std::make_shared<const TiffFile>(place.string());
        }
        return file;
    }

  private:
    std::string path_;
    TiffFilePointer own_;
    std::string uuid_;
    std::map<std::string, TiffFilePointer> files_;
};

const OmeImage& chosen_image(const std::string& path, const OmeDocument& document, const LoadOptions& options) {
    const auto& images = document.images;
    if (images.empty()) fail("{}: its OME-XML describes no image", path);
    if (options.series.empty()) {
        if (images.size() == 1) return images[0];
        std::string list;
        for (std::size_t i = 0; i < std::min<std::size_t>(images.size(), 12); ++i)
            list += fmt::format("{}{}: {} {} x {} x {}", i == 0 ? "" : ", ", i, images[i].name, images[i].x,
                                images[i].y, images[i].z);
        fail("{}: it holds {} images; choose one with --series 0..{} ({}{})", path, images.size(), images.size() - 1,
             list, images.size() > 12 ? ", ..." : "");
    }
    for (std::size_t i = 0; i < images.size(); ++i)
        if (options.series == std::to_string(i)) return images[i];
    for (const OmeImage& image : images)
        if (options.series == image.id || options.series == image.name) return image;
    fail("{}: --series {}: expected 0..{} or the name of an image", path, options.series, images.size() - 1);
}

TiffPlace ome_place(const std::string& path, const LoadOptions& options, const OmeImage& image) {
    TiffPlace place;
    const OmeImage::Length* const lengths[] = {&image.size_x, &image.size_y, &image.size_z};
    const char* const names[] = {"PhysicalSizeX", "PhysicalSizeY", "PhysicalSizeZ"};
    // Lengths, and axes that are measured in pixels.
    std::optional<std::string> with_unit, without_unit;
    for (int axis = 0; axis < 3; ++axis) {
        const OmeImage::Length& length = *lengths[axis];
        if (length.value.empty()) continue;
        const std::string field = fmt::format("OME-XML: {}", names[axis]);
        const double value = tiff_number(path, field, length.value);
        const auto millimetres = ome_millimetres(length.unit);
        const bool is_in_pixels = length.unit == "pixel" || length.unit == "reference frame";
        if (!millimetres && !is_in_pixels && !options.spacing)
            fail("{}: {}Unit='{}': expected a unit of length; give --spacing X Y Z", path, field, length.unit);
        (is_in_pixels ? without_unit : with_unit) = fmt::format("{}Unit='{}'", names[axis], length.unit);
        if (with_unit && without_unit && !options.spacing)
            fail("{}: OME-XML: {}, but {}: expected units of length for all axes; give --spacing X Y Z", path,
                 *without_unit, *with_unit);
        place.spacing[axis] = tiff_length(path, options, field, value, millimetres.value_or(1));
        if (place.unit.empty()) place.unit = length.unit;
    }
    if (place.spacing != glm::dvec3(0)) place.source = "OME-XML's PhysicalSize";
    if (without_unit) {
        place.source += fmt::format(" in '{}': mm assumed", place.unit);
        place.unit.clear();
    }
    return place;
}

/// OME's sample type by name: bits and TIFF's SampleFormat.
void check_ome_type(const std::string& path, const OmeImage& image, const TiffPage& page) {
    struct Type {
        std::string_view name;
        std::uint64_t bits, format;
    };
    static constexpr Type kTypes[] = {{"int8", 8, 2},   {"uint8", 8, 1},   {"int16", 16, 2}, {"uint16", 16, 1},
                                      {"int32", 32, 2}, {"uint32", 32, 1}, {"float", 32, 3}, {"double", 64, 3}};
    for (const Type& type : kTypes) {
        if (type.name != image.type) continue;
        const bool is_plain = page.format == 1 || page.format == 4;
        if (page.bits > type.bits || (page.says_format && !is_plain && page.format != type.format) ||
            (type.format == 3 && page.bits != type.bits && page.format != 3))
            fail("{}: OME-XML says Type='{}', but the pages have {} bits, SampleFormat {}", path, image.type, page.bits,
                 page.format);
    }
}

void take_ome(TiffStack& stack, const std::string& path, const TiffFilePointer& own, const OmeDocument& document,
              const LoadOptions& options) {
    const OmeImage& image = chosen_image(path, document, options);
    if (image.order.size() != 5 || !image.order.starts_with("XY") || image.order.find('Z') == std::string::npos ||
        image.order.find('C') == std::string::npos || image.order.find('T') == std::string::npos)
        fail("{}: OME-XML: DimensionOrder='{}': expected XYCZT or another order of its letters", path, image.order);
    if (image.samples < 1 || image.c % image.samples != 0)
        fail("{}: OME-XML: SizeC='{}' in groups of SamplesPerPixel='{}'", path, image.c, image.samples);
    const TiffSizes sizes{image.z, image.c / image.samples, image.t};
    std::uint64_t total = 0;
    if (__builtin_mul_overflow(sizes.slices * sizes.channels, sizes.frames, &total) || total > 1ULL << 40)
        fail("{}: OME-XML: {} x {} x {} planes", path, image.z, image.c, image.t);
    OmeFiles files(path, own, document.uuid);
    auto data = image.data;
    if (data.empty()) data.emplace_back();
    const auto first_file = files.of(data[0]);
    const std::size_t first_page = data[0].directory.value_or(0);
    if (first_page >= first_file->pages().size())
        fail("{}: OME-XML: TiffData IFD='{}', but {} has {} pages", path, first_page, first_file->path(),
             first_file->pages().size());
    const TiffPage& page = first_file->pages()[first_page];
    check_page({first_file, first_page, {}});
    if (page.samples != image.samples)
        fail("{}: OME-XML: SamplesPerPixel='{}', but its pages have {}", path, image.samples, page.samples);
    check_ome_type(path, image, page);
    choose_planes(stack, path, options, sizes, page, image.channels,
                  [](std::size_t, std::size_t, std::size_t) { return std::optional<TiffPlane>(); });
    const std::size_t component = options.component ? static_cast<std::size_t>(*options.component) : 0;
    const std::size_t channel = component / image.samples;
    const std::size_t frame = options.frame ? static_cast<std::size_t>(*options.frame) : 0;
    std::uint64_t steps = 0;
    for (const OmeTiffData& part : data) {
        const auto file = files.of(part);
        const std::uint64_t begin = part.directory.value_or(0), pages = file->pages().size();
        const std::uint64_t count =
            part.planes.value_or(part.directory || part.z + part.c + part.t > 0 ? 1 : std::min(pages, total));
        if (begin > pages || count > pages - begin)
            fail("{}: OME-XML: TiffData IFD='{}' with {} planes, but {} has {} pages", path, begin, count, file->path(),
                 pages);
        if (part.z >= sizes.slices || part.c >= sizes.channels || part.t >= sizes.frames)
            fail("{}: OME-XML: TiffData FirstZ='{}' FirstC='{}' FirstT='{}' lies outside of {} x {} x {} planes", path,
                 part.z, part.c, part.t, sizes.slices, sizes.channels, sizes.frames);
        steps += count;
        if (steps > 1ULL << 26) fail("{}: OME-XML: its TiffData list too many planes", path);
        std::uint64_t z = part.z, c = part.c, t = part.t;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (c == channel && t == frame) {
                if (stack.planes[z]) fail("{}: OME-XML: two TiffData hold the same plane, slice {}", path, z);
                stack.planes[z] = TiffPlane{file, static_cast<std::size_t>(begin + i), std::nullopt};
            }
            // The next plane in DimensionOrder.
            bool has_next = false;
            for (const char letter : image.order.substr(2)) {
                auto& at = letter == 'Z' ? z : letter == 'C' ? c : t;
                if (++at < (letter == 'Z' ? sizes.slices : letter == 'C' ? sizes.channels : sizes.frames)) {
                    has_next = true;
                    break;
                }
                at = 0;
            }
            if (!has_next && i + 1 < count)
                fail("{}: OME-XML: TiffData with {} planes goes beyond the image's {} planes", path, count, total);
        }
    }
    std::size_t missing = 0;
    for (const auto& plane : stack.planes) {
        missing += plane ? 0 : 1;
        if (!plane) continue;
        const TiffPage& here = plane->description();
        if (here.width != image.x || here.height != image.y)
            fail("{}: OME-XML: SizeX='{}' SizeY='{}', but {} has {} x {} pixels", path, image.x, image.y, plane->name(),
                 here.width, here.height);
    }
    const std::size_t pages = own ? std::ranges::count_if(own->pages(), is_usable) : 0;
    if (document.images.size() == 1 && image.data.size() <= 1 && first_file == own && pages > total)
        stack.warnings.push_back(fmt::format(
            "OME-XML describes {} planes, but the file has {} pages: those beyond are left out.", total, pages));
    if (missing == stack.planes.size()) fail("{}: OME-XML: no TiffData holds the chosen component and frame", path);
    if (missing > 0)
        stack.warnings.push_back(fmt::format("{} of its {} slices are not in the file: they contain no data.", missing,
                                             stack.planes.size()));
    stack.place = ome_place(path, options, image);
}

/// The OME-XML of a file: in its first page, or in the companion file that this names.
std::optional<OmeDocument> ome_document(const TiffFile& file) {
    for (const std::string& text : file.pages()[0].descriptions) {
        if (!is_ome_xml(text)) continue;
        OmeDocument document = read_ome_xml(file.path(), text);
        if (document.metadata_file.empty()) return document;
        const fs::path name = document.metadata_file;
        const fs::path companion = fs::path(file.path()).parent_path() / name.filename();
        std::error_code ignored;
        if (name.has_parent_path() || !fs::is_regular_file(companion, ignored))
            fail("{}: its OME-XML is in the file {}, which is not in the same folder", file.path(), name.string());
        const std::uint64_t size = fs::file_size(companion);
        check_memory(companion.string(), "its XML", size);
        std::ifstream in(companion, std::ios::binary);
        std::string xml(static_cast<std::size_t>(size), '\0');
        in.read(xml.data(), static_cast<std::streamsize>(size));
        OmeDocument other = read_ome_xml(companion.string(), xml);
        if (other.uuid.empty() || other.uuid != document.uuid) other.uuid = document.uuid;
        return other;
    }
    return std::nullopt;
}

/// Tiff files of several pages without further description: pages are slices.
void take_pages(TiffStack& stack, const TiffFilePointer& file, const LoadOptions& options) {
    const auto pages = pages_of_one_shape(*file, usable_pages(*file, stack.notes), options);
    check_page({file, pages[0], {}});
    const TiffPage& page = file->pages()[pages[0]];
    choose_planes(stack, file->path(), options, {pages.size(), 1, 1}, page, {},
                  [&](std::size_t z, std::size_t, std::size_t) {
                      return TiffPlane{file, pages[z], std::nullopt};
                  });
    stack.place = plain_place(page, stack.notes);
}

TiffStack stack_of_file(const std::string& path, const LoadOptions& options) {
    TiffStack stack;
    const auto file = std::make_shared<const TiffFile>(path);
    if (const auto document = ome_document(*file))
        take_ome(stack, path, file, *document, options);
    else if (!take_imagej(stack, file, options) && !take_lsm(stack, file, options) &&
             !take_shaped(stack, file, options))
        take_pages(stack, file, options);
    return stack;
}

/// Files with one page each, in this order.
TiffStack stack_of_files(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options) {
    TiffStack stack;
    std::vector<TiffPlane> planes;
    std::vector<std::string> notes;
    for (const std::string& path : files) {
        const auto file = std::make_shared<const TiffFile>(path);
        const auto pages = usable_pages(*file, notes);
        const auto fields = imagej_fields(file->pages()[0]);
        if (pages.size() > 1 || (fields && imagej_count(path, *fields, "images") > 1))
            fail("{}: {} holds several images: a stack can only be read by itself", name, path);
        planes.push_back({file, pages[0], std::nullopt});
        check_page(planes.back());
        const TiffPage &here = planes.back().description(), &first = planes[0].description();
        if (!is_same_shape(here, first))
            fail("{}: {} has {}; the slices before it {}", name, path, shape_of(*file, here),
                 shape_of(*planes[0].file, first));
    }
    if (!notes.empty()) stack.notes.push_back(fmt::format("{}: {}", files[0], notes[0]));
    const TiffFile& file = *planes[0].file;
    const TiffPage& page = planes[0].description();
    choose_planes(stack, name, options, {planes.size(), 1, 1}, page, {},
                  [&](std::size_t z, std::size_t, std::size_t) { return planes[z]; });
    if (const auto fields = imagej_fields(file.pages()[0])) {
        stack.place = imagej_place(file.path(), options, page, *fields, false);
        imagej_calibration(stack, file.path(), page, *fields);
        return stack;
    }
    stack.place = plain_place(page, stack.notes);
    for (const std::string& text : page.descriptions)
        if (is_ome_xml(text))
            if (const OmeDocument document = read_ome_xml(file.path(), text); document.images.size() == 1)
                stack.place = ome_place(file.path(), options, document.images[0]);
    return stack;
}

// --- Values ---

/// GDAL's scale and offset of a sample: calibration {offset, scale}.
void gdal_calibration(TiffStack& stack, const std::string& path, const TiffPage& page) {
    pugi::xml_document xml;
    if (page.gdal_metadata.empty() || !xml.load_buffer(page.gdal_metadata.data(), page.gdal_metadata.size())) return;
    double scale = 1, offset = 0;
    for (const pugi::xml_node item : xml.child("GDALMetadata").children("Item")) {
        const std::string_view role = item.attribute("role").value();
        if ((role != "scale" && role != "offset") || item.attribute("sample").as_ullong() != stack.sample) continue;
        (role == "scale" ? scale : offset) =
            tiff_number(path, fmt::format("GDAL's {}", role), trimmed(item.text().get()));
    }
    if (!std::isfinite(scale) || !std::isfinite(offset) || scale == 0)
        fail("{}: GDAL's scale {} and offset {}: expected finite numbers", path, scale, offset);
    if (scale == 1 && offset == 0) return;
    stack.calibration = {offset, scale};
    stack.notes.push_back(fmt::format("GDAL's scale {} and offset {} are applied.", scale, offset));
}

std::optional<double> declared_fill(const std::string& path, const TiffPage& page) {
    const std::string text = trimmed(page.no_data);
    if (text.empty()) return std::nullopt;
    const double value = tiff_number(path, "GDAL_NODATA", text.starts_with('+') ? text.substr(1) : text);
    return std::isnan(value) ? std::nullopt : std::optional(value);
}

void add_page_notes(TiffStack& stack, const TiffPage& page) {
    if (page.photometric == 3) stack.notes.emplace_back("A palette image: samples are its indices, not its colours.");
    if (page.photometric == 0 && page.format != 1 && page.format != 4)
        stack.warnings.emplace_back(
            "Its lowest values are displayed white (MinIsWhite), which is not undone for signed numbers and floats.");
    else if (page.photometric == 0)
        stack.notes.push_back(
            fmt::format("MinIsWhite is undone: samples are 2^{} - 1 minus what is stored.", page.bits));
    if (page.is_geo) stack.notes.emplace_back("GeoTIFF's scale of pixels (ModelPixelScale) is ignored.");
    if (page.has_missing)
        stack.warnings.emplace_back("A sparse file: some of its strips or tiles are absent, their samples are 0.");
}

/// World axes of a page's columns and rows, x to the right and y down, by the field Orientation.
std::array<glm::dvec3, 2> page_directions(std::uint64_t orientation) {
    const bool is_transposed = orientation >= 5;
    // From left to right, from top to bottom: where the first row or column is on the other side, against it.
    const bool from_right = orientation == 2 || orientation == 3 || orientation == 6 || orientation == 7;
    const bool from_bottom = orientation == 3 || orientation == 4 || orientation == 7 || orientation == 8;
    const glm::dvec3 across(from_right ? -1 : 1, 0, 0), down(0, from_bottom ? -1 : 1, 0);
    return is_transposed ? std::array{down, across} : std::array{across, down};
}

/// Sets the geometry. An unknown distance between slices is assumed to be that of pixels.
void set_stack_place(Volume& volume, const TiffStack& stack, std::uint64_t orientation, const LoadOptions& options) {
    glm::dvec3 spacing = stack.place.spacing;
    const bool is_known = spacing.x > 0 && spacing.y > 0;
    if (!is_known && spacing != glm::dvec3(0) && !options.spacing)
        fail("{}: its header gives the voxel spacing along some axes only ({} x {} x {} mm); give --spacing X Y Z",
             volume.name, spacing.x, spacing.y, spacing.z);
    volume.length_unit = stack.place.unit;
    // The grid stays in the box that it has without orientation.
    const auto place = [&](const glm::dvec3& steps, const glm::dvec3& origin, const std::string& source) {
        const auto directions = page_directions(orientation);
        const glm::dmat3 axes(directions[0] * steps.x, directions[1] * steps.y, glm::dvec3(0, 0, steps.z));
        glm::dvec3 first = origin;
        for (int axis = 0; axis < 2; ++axis)
            first -= glm::min(axes[axis], 0.0) * static_cast<double>(volume.geometry.dims[axis] - 1);
        set_place(volume, axes, first, 1, source);
    };
    if (orientation != 1)
        volume.notes.push_back(fmt::format(
            "Orientation (274) is {}: the directions of its columns and rows are as that field says.", orientation));
    if (!is_known) {
        place(glm::dvec3(1), glm::dvec3(0), "none: 1 mm assumed");
        if (!options.spacing)
            volume.notes.emplace_back(
                "The header does not contain a voxel spacing: 1 x 1 x 1 mm is assumed; give --spacing X Y Z.");
        return;
    }
    std::string source = stack.place.source.empty() ? "none: 1 mm assumed" : stack.place.source;
    if (!(spacing.z > 0)) {
        spacing.z = spacing.x;
        if (volume.geometry.dims.z > 1 && !options.spacing) {
            volume.warnings.push_back(fmt::format(
                "The header does not contain a slice spacing: {} mm, that of the pixels, is assumed; give --spacing X "
                "Y Z.",
                spacing.z));
            source += "; slices: none, as pixels assumed";
        }
    }
    if (stack.place.source.empty() && !options.spacing)
        volume.notes.emplace_back(
            "The header does not contain a unit of length: 1 x 1 x 1 mm is assumed; give --spacing X Y Z.");
    place(spacing, stack.place.origin, source);
}

void read_stack_samples(Volume& volume, const TiffStack& stack, const TiffPlane& first, SampleType type,
                        const LoadOptions& options) {
    const std::size_t pixels =
        static_cast<std::size_t>(volume.geometry.dims.x) * static_cast<std::size_t>(volume.geometry.dims.y);
    const std::size_t slice_bytes = pixels * size_of(type), slices = stack.planes.size();
    StoredSamples stored{.type = type, .fill = declared_fill(first.file->path(), first.description())};
    const auto& coefficients = stack.calibration;
    const bool is_linear = !coefficients.empty() && coefficients.size() <= 2;
    if (is_linear) {
        stored.slope = coefficients.size() > 1 ? coefficients[1] : 0;
        stored.intercept = coefficients[0] + stored.slope * stack.shift;
    }
    const bool is_whole = needs_all(stored);
    std::vector<unsigned char> samples(is_whole ? slice_bytes * slices : slice_bytes);
    if (!is_whole) volume.values.resize(pixels * slices);
    TiffPixels reader;
    for (std::size_t z = 0; z < slices; ++z) {
        report(options, 0.9 * static_cast<double>(z) / static_cast<double>(slices), "reading slices");
        if (!stack.planes[z]) continue;
        unsigned char* target = samples.data() + (is_whole ? z * slice_bytes : 0);
        reader.read(*stack.planes[z], stack.sample, target);
        stored.data = target;
        if (!is_whole) convert_stored(stored, pixels, volume.values.data() + z * pixels);
    }
    if (is_whole) {
        stored.data = samples.data();
        take_samples(stored, volume);
    }
    if (coefficients.size() > 2)
        for (float& value : volume.values) {
            const double x = static_cast<double>(value) + stack.shift;
            double sum = 0;
            for (std::size_t i = coefficients.size(); i-- > 0;)
                sum = sum * x + coefficients[i];
            value = static_cast<float>(sum);
        }
    for (std::size_t z = 0; z < slices; ++z)
        if (!stack.planes[z])
            std::fill_n(volume.values.data() + z * pixels, pixels, std::numeric_limits<float>::quiet_NaN());
}

}  // namespace

Volume load_tiff(const std::string& name, const std::vector<std::string>& files, const LoadOptions& options) {
    TiffStack stack = files.size() == 1 ? stack_of_file(files[0], options) : stack_of_files(name, files, options);
    const auto first = *std::ranges::find_if(stack.planes, [](const auto& plane) { return plane.has_value(); });
    const TiffPage& page = first->description();
    const SampleType type = tiff_sample_type(*first->file, page);
    std::uint64_t stored = 0;
    for (const auto& plane : stack.planes) {
        if (!plane) continue;
        check_page(*plane);
        const TiffPage& here = plane->description();
        if (!is_same_shape(here, page))
            fail("{}: {} has {}; the slices before it {}", name, plane->name(), shape_of(*plane->file, here),
                 shape_of(*first->file, page));
        if (here.orientation != page.orientation)
            fail("{}: {} has Orientation (274) {}, the slices before it {}", name, plane->name(), here.orientation,
                 page.orientation);
        if (stack.place.is_of_pages && !options.spacing && !is_same_resolution(here, page))
            fail(
                "{}: {} has XResolution {} and YResolution {} (ResolutionUnit {}), the slices before it {} and "
                "{} ({}); give --spacing X Y Z",
                name, plane->name(), here.x_resolution, here.y_resolution, here.resolution_unit, page.x_resolution,
                page.y_resolution, page.resolution_unit);
        stored += plane->raw_at ? page.width * page.height * 8 : std::min(here.stored, plane->file->size());
    }
    const std::size_t slices = stack.planes.size();
    const std::size_t bytes = checked_bytes(name, {page.width, page.height, slices}, size_of(type));
    const bool is_sparse = page.has_missing;
    if (!is_sparse && page.bits >= 8)
        check_stored_size(name, bytes, stored, page.compression == 1 ? kPlainRatio : kBestPictureRatio);
    Volume volume;
    volume.name = name;
    volume.geometry.dims = {static_cast<int>(page.width), static_cast<int>(page.height), static_cast<int>(slices)};
    volume.stored_type = page.format == 3 && page.bits < 32 ? fmt::format("float{}", page.bits) : name_of(type);
    gdal_calibration(stack, first->file->path(), page);
    add_page_notes(stack, page);
    volume.notes = stack.notes;
    volume.warnings = stack.warnings;
    if (slices == 1) volume.notes.emplace_back("The file holds one image: it is read as a volume of one slice.");
    set_stack_place(volume, stack, page.orientation, options);
    read_stack_samples(volume, stack, *first, type, options);
    return volume;
}

}  // namespace edgesplat::detail
