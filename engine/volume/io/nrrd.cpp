// Reads NRRD, including Slicer's segmentations. Place and units come from the header as the format's definition says:
// directions and origin in the named space, or spacings and axis mins and maxs.
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <numeric>

#include "engine/volume/io/nrrd_header.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/io/stored_data.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

/// What an axis of the array is for.
enum class NrrdAxis { Unknown, Space, Component, Frame };

struct NrrdKind {
    std::string_view name;
    NrrdAxis axis;
    std::size_t size;  // samples that this kind has; 0: any
};
constexpr std::array kNrrdKinds{NrrdKind{"domain", NrrdAxis::Space, 0},
                                NrrdKind{"space", NrrdAxis::Space, 0},
                                NrrdKind{"time", NrrdAxis::Frame, 0},
                                NrrdKind{"list", NrrdAxis::Component, 0},
                                NrrdKind{"point", NrrdAxis::Component, 0},
                                NrrdKind{"vector", NrrdAxis::Component, 0},
                                NrrdKind{"contravariant-vector", NrrdAxis::Component, 0},
                                NrrdKind{"covariant-vector", NrrdAxis::Component, 0},
                                NrrdKind{"normal", NrrdAxis::Component, 0},
                                NrrdKind{"stub", NrrdAxis::Component, 1},
                                NrrdKind{"scalar", NrrdAxis::Component, 1},
                                NrrdKind{"complex", NrrdAxis::Component, 2},
                                NrrdKind{"2-vector", NrrdAxis::Component, 2},
                                NrrdKind{"3-color", NrrdAxis::Component, 3},
                                NrrdKind{"rgb-color", NrrdAxis::Component, 3},
                                NrrdKind{"rgbcolor", NrrdAxis::Component, 3},
                                NrrdKind{"rgb", NrrdAxis::Component, 3},
                                NrrdKind{"hsv-color", NrrdAxis::Component, 3},
                                NrrdKind{"hsvcolor", NrrdAxis::Component, 3},
                                NrrdKind{"hsv", NrrdAxis::Component, 3},
                                NrrdKind{"xyz-color", NrrdAxis::Component, 3},
                                NrrdKind{"4-color", NrrdAxis::Component, 4},
                                NrrdKind{"rgba-color", NrrdAxis::Component, 4},
                                NrrdKind{"rgbacolor", NrrdAxis::Component, 4},
                                NrrdKind{"rgba", NrrdAxis::Component, 4},
                                NrrdKind{"3-vector", NrrdAxis::Component, 3},
                                NrrdKind{"3-gradient", NrrdAxis::Component, 3},
                                NrrdKind{"3-normal", NrrdAxis::Component, 3},
                                NrrdKind{"4-vector", NrrdAxis::Component, 4},
                                NrrdKind{"quaternion", NrrdAxis::Component, 4}};

std::string nrrd_lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// A file as its header describes it.
struct NrrdFile {
    Volume volume;  // everything except samples and limits
    StoredData data;
    StoredSelection selection;
    std::vector<std::size_t> dims;  // of the volume, then of the other axes
    std::vector<Label> segments;    // of the chosen layer
};

/// Reads the header's fields into a NrrdFile.
class NrrdReading {
  public:
    NrrdReading(const NrrdHeader& header, const LoadOptions& options) : header_(header), options_(options) {}

    NrrdFile read(const std::string& file) {
        out_.volume.name = header_.path;
        out_.volume.warnings = header_.warnings;
        take_array();
        take_data(file);
        take_axes();
        take_place();
        take_choice();
        return std::move(out_);
    }

  private:
    using Vectors = std::vector<std::optional<std::vector<double>>>;

    void take_array() {
        for (const char* needed : {"type", "dimension", "sizes", "encoding"})
            if (!header_.has(needed)) header_.refuse(needed, "missing");
        const auto axes = header_.whole("dimension", 0);
        if (axes < 1 || axes > 16) header_.refuse("dimension", fmt::format("{}, expected 1 to 16", axes));
        out_.data.path = header_.path;
        out_.data.type = type();
        out_.volume.stored_type = name_of(out_.data.type);
        out_.data.samples = 1;
        for (const auto& word : header_.words("sizes", static_cast<std::size_t>(axes))) {
            const auto size = header_.whole_in("sizes", word);
            if (size < 1) header_.refuse("sizes", fmt::format("{} must be at least 1", size));
            sizes_.push_back(static_cast<std::size_t>(size));
            if (__builtin_mul_overflow(out_.data.samples, sizes_.back(), &out_.data.samples) ||
                out_.data.samples > kMaxNrrdSamples)
                header_.refuse("sizes", fmt::format("'{}': at most 2^48 samples can be read", header_.value("sizes")));
        }
    }

    SampleType type() const {
        using T = SampleType;
        static const std::map<std::string, SampleType> types = {
            {"signed char", T::Int8},   {"int8", T::Int8},           {"int8_t", T::Int8},
            {"uchar", T::UInt8},        {"unsigned char", T::UInt8}, {"uint8", T::UInt8},
            {"uint8_t", T::UInt8},      {"short", T::Int16},         {"short int", T::Int16},
            {"signed short", T::Int16}, {"int16", T::Int16},         {"signed short int", T::Int16},
            {"int16_t", T::Int16},      {"ushort", T::UInt16},       {"unsigned short", T::UInt16},
            {"uint16", T::UInt16},      {"uint16_t", T::UInt16},     {"unsigned short int", T::UInt16},
            {"int", T::Int32},          {"signed int", T::Int32},    {"int32", T::Int32},
            {"int32_t", T::Int32},      {"uint", T::UInt32},         {"unsigned int", T::UInt32},
            {"uint32", T::UInt32},      {"uint32_t", T::UInt32},     {"longlong", T::Int64},
            {"long long", T::Int64},    {"long long int", T::Int64}, {"signed long long", T::Int64},
            {"int64", T::Int64},        {"int64_t", T::Int64},       {"signed long long int", T::Int64},
            {"ulonglong", T::UInt64},   {"uint64", T::UInt64},       {"unsigned long long", T::UInt64},
            {"uint64_t", T::UInt64},    {"float", T::Float32},       {"unsigned long long int", T::UInt64},
            {"double", T::Float64}};
        const auto found = types.find(nrrd_lower(header_.value("type")));
        if (found == types.end())
            header_.refuse("type", fmt::format("'{}' cannot be read, expected a number type such as uint8, short or "
                                               "float",
                                               header_.value("type")));
        return found->second;
    }

    void take_data(const std::string& file) {
        StoredData& data = out_.data;
        const auto encoding = nrrd_lower(header_.value("encoding"));
        if (encoding == "raw")
            data.encoding = StoredEncoding::Raw;
        else if (encoding == "gzip" || encoding == "gz")
            data.encoding = StoredEncoding::Deflate;
        else if (encoding == "bzip2" || encoding == "bz2")
            data.encoding = StoredEncoding::Bzip2;
        else if (encoding == "hex")
            data.encoding = StoredEncoding::Hex;
        else if (encoding == "ascii" || encoding == "text" || encoding == "txt")
            data.encoding = StoredEncoding::Text;
        else
            header_.refuse("encoding",
                           fmt::format("'{}', expected raw, gzip, bzip2, hex or ascii", header_.value("encoding")));
        const auto endian = nrrd_lower(header_.value("endian"));
        const bool matters = size_of(data.type) > 1 && data.encoding != StoredEncoding::Text;
        if (header_.has("endian") ? endian != "little" && endian != "big" : matters)
            header_.refuse("endian", fmt::format("{}, expected little or big",
                                                 header_.has("endian") ? fmt::format("'{}'", header_.value("endian"))
                                                                       : "missing"));
        data.swapped = matters && (endian == "little") != (std::endian::native == std::endian::little);

        const auto lines = header_.whole("lineskip", 0), bytes = header_.whole("byteskip", 0);
        if (lines < 0) header_.refuse("lineskip", fmt::format("{} is not a count of lines", lines));
        if (bytes < -1) header_.refuse("byteskip", fmt::format("{} is neither -1 nor a count of bytes", bytes));
        if (bytes > kMaxSkip || lines > kMaxSkip) header_.refuse("byteskip", "more than 2^40 to skip");
        data.line_skip = static_cast<std::size_t>(lines);
        data.at_end = bytes == -1;
        data.byte_skip = static_cast<std::size_t>(std::max(bytes, 0LL));
        const bool text = data.encoding == StoredEncoding::Text || data.encoding == StoredEncoding::Hex;
        if (data.at_end && text) header_.refuse("byteskip", "-1 is defined for binary data only");

        const bool detached = header_.has("datafile");
        if (detached) {
            take_file_names();
        } else {
            data.offset = header_.bytes;
            data.files = {file};
        }
        if (detached) data.header = file;
        const auto name = nrrd_lower(data.files.front().filename().string());
        if (detached && (name.ends_with(".nii") || name.ends_with(".nii.gz")) && bytes == 0 && lines == 0)
            out_.volume.notes.emplace_back(
                "Its data file is a NIfTI file and the header has no 'byte skip', so the NIfTI header is read as "
                "voxels, as the NRRD header says; 'byte skip: -1' would skip it.");
    }

    void take_file_names() {
        const auto folder = fs::path(header_.path).parent_path();
        const std::string value = header_.value("datafile");
        std::vector<std::string> names;
        // Axes that each file has; the following ones are spread over the files.
        auto axes = static_cast<long long>(sizes_.size()) - 1;
        const bool list = value.starts_with("LIST") && (value.size() == 4 || value[4] == ' ');
        const auto percent = value.find('%');
        if (list) {
            names = header_.listed_files;
            if (names.empty()) header_.refuse("datafile", "LIST without any file");
            if (const auto text = trimmed(value.substr(4)); !text.empty()) axes = header_.whole_in("datafile", text);
        } else if (percent != std::string::npos && value.find_first_of(" \t", percent) != std::string::npos) {
            const auto end = value.find_first_of(" \t", percent);
            std::vector<long long> numbers;
            for (const auto& word : NrrdHeader::split(value.substr(end)))
                numbers.push_back(header_.whole_in("datafile", word));
            if (numbers.size() != 3 && numbers.size() != 4)
                header_.refuse("datafile", fmt::format("'{}', expected a name with one number like %03d, then first, "
                                                       "last, step and perhaps the axes in a file",
                                                       value));
            if (numbers.size() == 4) axes = numbers[3];
            names = names_of_pattern(header_.path, "NRRD field 'data file'", value.substr(0, end), numbers[0],
                                     numbers[1], numbers[2]);
        } else {
            out_.data.files = {folder / value};
            return;
        }
        if (axes < 1 || axes > static_cast<long long>(sizes_.size()))
            header_.refuse("datafile", fmt::format("files of {} axes, expected 1 to {}", axes, sizes_.size()));
        std::size_t needed = 1;
        for (auto axis = static_cast<std::size_t>(axes); axis < sizes_.size(); ++axis)
            needed *= sizes_[axis];
        const bool slabs = axes == static_cast<long long>(sizes_.size());
        if (slabs ? sizes_.back() % names.size() != 0 : names.size() != needed)
            header_.refuse("datafile", fmt::format("{} files, expected {}", names.size(),
                                                   slabs ? fmt::format("a divisor of {}", sizes_.back())
                                                         : fmt::format("{}", needed)));
        for (const auto& name : names)
            out_.data.files.push_back(folder / name);
    }

    /// The axis that a kind stands for, from its name.
    NrrdAxis axis_of_kind(const std::string& name, std::size_t size) const {
        const auto kind = nrrd_lower(name);
        if (kind == "???" || kind == "none") return NrrdAxis::Unknown;
        // "3D-masked-symmetric-matrix" and its short forms
        if (kind.starts_with("2d-") || kind.starts_with("3d-")) return NrrdAxis::Component;
        const auto found = std::ranges::find(kNrrdKinds, kind, &NrrdKind::name);
        if (found == kNrrdKinds.end()) header_.refuse("kinds", fmt::format("'{}' is no kind of axis", name));
        if (found->size != 0 && found->size != size)
            header_.refuse("kinds", fmt::format("an axis of kind {} has {} samples, not {}", name, found->size, size));
        return found->axis;
    }

    /// Decides for every axis whether it is space, components or frames.
    void take_axes() {
        const std::size_t count = sizes_.size();
        axes_.assign(count, NrrdAxis::Unknown);
        kinds_.assign(count, "???");
        if (header_.has("kinds")) kinds_ = header_.words("kinds", count);
        for (std::size_t i = 0; i < count; ++i)
            axes_[i] = axis_of_kind(kinds_[i], sizes_[i]);
        spacings_ = header_.numbers("spacings", count);
        if (header_.has("spacedirections")) {
            directions_ = header_.vectors("spacedirections");
            if (directions_.size() != count)
                header_.refuse("spacedirections", fmt::format("{} of them for {} axes", directions_.size(), count));
            for (std::size_t i = 0; i < count; ++i)
                take_direction(i);
        } else {
            take_axes_without_directions();
        }
        spatial_.clear();
        for (std::size_t i = 0; i < count; ++i)
            if (axes_[i] == NrrdAxis::Space) spatial_.push_back(i);
        if (spatial_.size() > 3)
            fail("{}: NRRD data with {} axes in space: at most 3 can be read", header_.path, spatial_.size());
        if (spatial_.size() < 2)
            fail("{}: its data have {} {} in space; a volume needs 3, or 2 for a single slice", header_.path,
                 spatial_.size(), spatial_.size() == 1 ? "axis" : "axes");
    }

    void take_direction(std::size_t i) {
        auto& direction = directions_[i];
        const bool said_other = axes_[i] == NrrdAxis::Component || axes_[i] == NrrdAxis::Frame;
        if (direction && said_other) {
            // Some writers give "(nan,nan,nan)" or "(0,0,0)" instead of "none".
            const bool empty = std::ranges::all_of(*direction, [](double c) { return std::isnan(c) || c == 0; });
            const bool time = axes_[i] == NrrdAxis::Frame && direction->size() == 4;
            if (!empty && !time)
                header_.refuse("spacedirections",
                               fmt::format("axis {} has a direction, but its kind is {}", i, kinds_[i]));
            direction.reset();
        }
        if (direction && direction->size() == 4) {
            const bool in_time = (*direction)[3] != 0;
            const bool in_space = (*direction)[0] != 0 || (*direction)[1] != 0 || (*direction)[2] != 0;
            if (in_time && in_space)
                header_.refuse("spacedirections", fmt::format("axis {} runs through space and time", i));
            if (in_time) direction.reset();
        }
        if (direction) {
            if (std::ranges::any_of(*direction, [](double c) { return std::isnan(c); }))
                header_.refuse("spacedirections", fmt::format("the direction of axis {} is not a number", i));
            // As NRRD's own library: which of the two would hold is not defined.
            for (const char* other : {"spacings", "axismins", "axismaxs"})
                if (!std::isnan(header_.numbers(other, sizes_.size())[i]))
                    header_.refuse(other, fmt::format("axis {} has a number and one of 'space directions', expected "
                                                      "nan",
                                                      i));
            axes_[i] = NrrdAxis::Space;
        } else if (axes_[i] != NrrdAxis::Component) {
            axes_[i] = NrrdAxis::Frame;
        }
    }

    void take_axes_without_directions() {
        const std::size_t count = sizes_.size();
        const bool colour_sized = count >= 3 && sizes_[0] >= 2 && sizes_[0] <= 4 &&
                                  std::all_of(sizes_.begin() + 1, sizes_.end(), [](auto n) { return n > 8; });
        if (colour_sized && count <= 4 && !header_.has("kinds") && !header_.has("spacings") &&
            !(count == 4 && options_.frame && !options_.component)) {
            // Ambiguous: space, or a colour picture.
            if (!options_.component)
                fail(
                    "{}: its header does not say whether the first axis of {} is colour or space: choose a colour "
                    "with --component 0..{}{}, or add 'kinds: {}' to the header",
                    header_.path, sizes_[0], sizes_[0] - 1,
                    count == 4 ? fmt::format(", or the last axis with --frame 0..{}", sizes_[3] - 1) : "",
                    count == 4 ? "vector domain domain domain' or 'kinds: domain domain domain time"
                               : "domain domain domain");
            axes_[0] = NrrdAxis::Component;
        }
        const auto in_space = [&] {
            return std::ranges::count_if(axes_, [](NrrdAxis a) { return a == NrrdAxis::Space; });
        };
        for (std::size_t i = 0; i < count; ++i) {
            if (axes_[i] != NrrdAxis::Unknown) continue;
            // "nan" is the spacing of axes that are not in space, such as colour.
            const bool no_length = header_.has("spacings") && std::isnan(spacings_[i]);
            if (no_length && (count > 3 || (i == 0 && sizes_[i] <= 4 && sizes_[i] > 1)))
                axes_[i] = i == 0 ? NrrdAxis::Component : NrrdAxis::Frame;
            else
                axes_[i] = NrrdAxis::Space;
        }
        for (std::size_t i = count; i-- > 3 && in_space() > 3;)
            if (axes_[i] == NrrdAxis::Space) axes_[i] = NrrdAxis::Frame;
    }

    /// Millimetres in a unit; unknown units count as mm, with a warning. Remembers its name.
    double millimetres(const std::string& unit) {
        if (trimmed(unit).empty()) return 1;
        auto& name = out_.volume.length_unit;
        const auto known = millimetres_in(unit);
        if (!known) {
            const auto warning = fmt::format("The unit '{}' is no known length: mm are assumed.", unit);
            if (std::ranges::find(out_.volume.warnings, warning) == out_.volume.warnings.end())
                out_.volume.warnings.push_back(warning);
            return 1;
        }
        if (name.empty())
            name = unit;
        else if (name != unit && !name.ends_with(", " + unit))
            name += ", " + unit;
        return *known;
    }

    /// Signs that turn the space's axes to left, back, up. Sets `in_patient`.
    glm::dvec3 to_lps() {
        std::string space = nrrd_lower(header_.value("space"));
        std::erase_if(space, [](char c) { return c == '-' || c == ' ' || c == '_'; });
        struct Space {
            std::string_view name, abbreviation;
            bool patient;
            glm::dvec3 signs;
        };
        static const std::array spaces{Space{"rightanteriorsuperior", "ras", true, {-1, -1, 1}},
                                       Space{"leftanteriorsuperior", "las", true, {1, -1, 1}},
                                       Space{"leftposteriorsuperior", "lps", true, {1, 1, 1}},
                                       Space{"scannerxyz", "", false, {1, 1, 1}},
                                       Space{"3drighthanded", "", false, {1, 1, 1}},
                                       Space{"3dlefthanded", "", false, {1, 1, 1}}};
        if (space.empty()) return {1, 1, 1};
        const bool flat = space == "rightup" || space == "rightdown";
        const auto dimension = header_.whole("spacedimension", 0);
        for (const Space& known : spaces) {
            const bool timed = space == std::string(known.name) + "time" ||
                               (!known.abbreviation.empty() && space == std::string(known.abbreviation) + "t") ||
                               (known.name == "scannerxyz" && space == "scannerxyzt");
            if (!timed && space != known.name && (known.abbreviation.empty() || space != known.abbreviation)) continue;
            space_dimension_ = timed ? 4 : 3;
            if (dimension != 0 && dimension != static_cast<long long>(space_dimension_))
                header_.refuse("spacedimension",
                               fmt::format("{}, but {} has {}", dimension, header_.value("space"), space_dimension_));
            out_.volume.in_patient = known.patient && !directions_.empty();
            return out_.volume.in_patient ? known.signs : glm::dvec3(1);
        }
        if (!flat)
            header_.refuse("space", fmt::format("'{}' is no known space, expected right-anterior-superior (RAS), "
                                                "left-anterior-superior (LAS), left-posterior-superior (LPS), "
                                                "scanner-xyz, 3D-right-handed or 3D-left-handed, or one of these "
                                                "with -time",
                                                header_.value("space")));
        space_dimension_ = 2;
        return {1, 1, 1};
    }

    void take_place() {
        const glm::dvec3 signs = to_lps();
        auto& dims = out_.volume.geometry.dims;
        dims = glm::ivec3(1);
        for (std::size_t i = 0; i < spatial_.size(); ++i) {
            const std::size_t size = sizes_[spatial_[i]];
            if (size > kMaxPackedVoxelsPerAxis)
                header_.refuse("sizes", fmt::format("{}: expected 1 to {}", size, kMaxPackedVoxelsPerAxis));
            dims[static_cast<int>(i)] = static_cast<int>(size);
        }
        if (header_.has("space") && directions_.empty())
            out_.volume.warnings.push_back(
                fmt::format("The header names the space {} but no 'space directions': the axes are not the patient's.",
                            header_.value("space")));
        if (spatial_.size() == 2)
            out_.volume.notes.emplace_back(
                "The file holds a 2-D image: it is read as a volume of one slice, 1 mm thick.");
        glm::dmat3 axes(0.0);
        glm::dvec3 origin(0.0);
        std::string_view source = "space directions";
        if (directions_.empty())
            source = place_from_spacings(axes, origin);
        else
            place_from_directions(axes, origin);
        for (int axis = 0; axis < 3; ++axis)
            axes[axis] *= signs;
        if (spatial_.size() == 2) {
            const glm::dvec3 normal = glm::cross(axes[0], axes[1]);
            const double length = glm::length(normal);
            axes[2] = length > 0 ? normal / length : glm::dvec3(0, 0, 1);
        }
        set_place(out_.volume, axes, origin * signs, 1, source);
        if (header_.has("oldmin") || header_.has("oldmax"))
            out_.volume.notes.push_back(
                fmt::format("Values are as stored; before quantization they were {} to {} (old min, old max).",
                            header_.has("oldmin") ? header_.value("oldmin") : "?",
                            header_.has("oldmax") ? header_.value("oldmax") : "?"));
    }

    /// Of a vector field in `space_dimension_` components: x, y, z.
    glm::dvec3 in_space(const std::string& field, const std::vector<double>& vector) const {
        if (vector.size() != space_dimension_)
            header_.refuse(field,
                           fmt::format("a vector of {} components, expected {}", vector.size(), space_dimension_));
        glm::dvec3 out(0.0);
        for (std::size_t i = 0; i < std::min<std::size_t>(vector.size(), 3); ++i)
            out[static_cast<int>(i)] = vector[i];
        return out;
    }

    glm::dvec3 space_origin() {
        if (!header_.has("spaceorigin")) return glm::dvec3(0.0);
        const auto vectors = header_.vectors("spaceorigin");
        if (vectors.size() != 1 || !vectors[0]) header_.refuse("spaceorigin", "expected one vector like (0,0,0)");
        const auto origin = in_space("spaceorigin", *vectors[0]);
        for (int axis = 0; axis < 3; ++axis)
            if (std::isnan(origin[axis])) header_.refuse("spaceorigin", "it is not a number");
        return origin;
    }

    void set_space_dimension() {
        if (space_dimension_ == 0) {
            const auto given = std::ranges::find_if(directions_, [](const auto& d) { return d.has_value(); });
            space_dimension_ = static_cast<std::size_t>(header_.whole(
                "spacedimension", given == directions_.end() ? 3 : static_cast<long long>((*given)->size())));
        }
        if (space_dimension_ < 2 || space_dimension_ > 4)
            header_.refuse("spacedimension", fmt::format("{}, expected 2 to 4", space_dimension_));
    }

    /// Millimetres along each axis of the space.
    glm::dvec3 space_units() {
        glm::dvec3 scale(1.0);
        if (header_.has("spaceunits")) {
            const auto units = header_.words("spaceunits", space_dimension_);
            for (std::size_t i = 0; i < std::min<std::size_t>(units.size(), 3); ++i)
                scale[static_cast<int>(i)] = millimetres(units[i]);
        } else if (header_.has("units")) {
            // The definition has 'units' for axes without direction only; some writers give them nevertheless.
            const auto units = header_.words("units", sizes_.size());
            const std::string& unit = units[spatial_[0]];
            for (const std::size_t axis : spatial_)
                if (units[axis] != unit)
                    header_.refuse("units", "different units for axes with 'space directions', expected 'space units'");
            scale = glm::dvec3(millimetres(unit));
        }
        return scale;
    }

    void place_from_directions(glm::dmat3& axes, glm::dvec3& origin) {
        set_space_dimension();
        const glm::dvec3 scale = space_units();
        for (std::size_t i = 0; i < spatial_.size(); ++i) {
            const auto step = in_space("spacedirections", *directions_[spatial_[i]]);
            if (step == glm::dvec3(0.0))
                header_.refuse("spacedirections", fmt::format("the direction of axis {} has no length", spatial_[i]));
            axes[static_cast<int>(i)] = step * scale;
        }
        if (!header_.has("spaceorigin"))
            out_.volume.notes.emplace_back("No 'space origin': the first voxel is placed at 0, 0, 0.");
        origin = space_origin() * scale;
    }

    std::string_view place_from_spacings(glm::dmat3& axes, glm::dvec3& origin) {
        const std::size_t count = sizes_.size();
        const auto mins = header_.numbers("axismins", count), maxs = header_.numbers("axismaxs", count);
        const auto centers =
            header_.has("centers") ? header_.words("centers", count) : std::vector<std::string>(count, "???");
        const auto units = header_.has("units") ? header_.words("units", count) : std::vector<std::string>(count, "");
        bool from_spacings = false, from_limits = false;
        std::vector<std::size_t> unknown;
        for (std::size_t i = 0; i < spatial_.size(); ++i) {
            const std::size_t axis = spatial_[i];
            const auto center = nrrd_lower(centers[axis]);
            if (center != "cell" && center != "node" && center != "???" && center != "none")
                header_.refuse("centers", fmt::format("'{}', expected cell or node", centers[axis]));
            const bool node = center == "node";
            const auto size = static_cast<double>(sizes_[axis]);
            const double steps = node ? size - 1 : size;
            const bool limited = !std::isnan(mins[axis]) && !std::isnan(maxs[axis]) && steps > 0;
            double step = limited ? (maxs[axis] - mins[axis]) / steps : 1;
            if (limited && step == 0) header_.refuse("axismaxs", fmt::format("axis {} has no length", axis));
            if (header_.has("spacings")) {
                const double spacing = spacings_[axis];
                if (spacing <= 0)
                    header_.refuse("spacings", fmt::format("{} for axis {}, expected a length above 0", spacing, axis));
                if (limited && std::abs(std::abs(step) - spacing) > 1e-3 * spacing)
                    out_.volume.warnings.push_back(
                        fmt::format("The spacing {} of axis {} contradicts its axis mins and maxs, which give {}; the "
                                    "spacing was used.",
                                    spacing, axis, std::abs(step)));
                if (!std::isnan(spacing)) {
                    step = std::copysign(spacing, step);
                    from_spacings = true;
                }
            }
            from_limits = from_limits || limited;
            if (!limited && std::isnan(spacings_[axis]) && sizes_[axis] > 1) unknown.push_back(axis);
            if ((limited || !std::isnan(mins[axis])) && !node && center != "cell" && !said_cell_) {
                out_.volume.notes.emplace_back(
                    "No 'centers': axis mins and maxs are taken as the outer faces of cells.");
                said_cell_ = true;
            }
            const double scale = millimetres(units[axis]);
            const int column = static_cast<int>(i);
            axes[column][column] = step * scale;
            const double half = node ? 0 : step / 2;
            if (!std::isnan(mins[axis]))
                origin[column] = (mins[axis] + half) * scale;
            else if (!std::isnan(maxs[axis]))
                origin[column] = (maxs[axis] - half - (size - 1) * step) * scale;
        }
        const bool some_known = from_spacings || from_limits || header_.has("spacings");
        if (some_known && !unknown.empty() && !options_.spacing)
            header_.refuse("spacings", fmt::format("the spacing of axis {} is unknown; give --spacing", unknown[0]));
        if (!some_known) out_.volume.notes.emplace_back("The header has no spacing: 1 mm is assumed.");
        if (header_.has("spaceorigin")) {
            set_space_dimension();
            origin = space_origin() * space_units();
        }
        return from_spacings ? "spacings" : from_limits ? "axis mins and maxs" : "none: 1 mm assumed";
    }

    /// Chooses component and frame.
    void take_choice() {
        std::vector<std::size_t> strides(sizes_.size(), 1);
        for (std::size_t i = 1; i < sizes_.size(); ++i)
            strides[i] = strides[i - 1] * sizes_[i - 1];
        auto& selection = out_.selection;
        for (std::size_t i = 0; i < 3; ++i)
            if (i < spatial_.size()) selection.step[i] = strides[spatial_[i]];
        // The slices of a single slice are as far apart as its samples.
        if (spatial_.size() == 2) selection.step[2] = selection.step[1] * sizes_[spatial_[1]];

        std::optional<std::size_t> component, frame;
        for (std::size_t i = 0; i < sizes_.size(); ++i) {
            if (axes_[i] == NrrdAxis::Space || sizes_[i] == 1) continue;
            auto& place = axes_[i] == NrrdAxis::Component ? component : frame;
            if (place)
                fail(
                    "{}: NRRD data with {} axes: axes {} and {} are both {}; beside space, one axis of components "
                    "and one of frames can be read",
                    header_.path, sizes_.size(), *place, i, &place == &frame ? "frames" : "components");
            place = i;
        }
        const auto layers = nrrd_segments(header_);
        // A list may be frames, and an axis of unknown kind components: the user knows.
        const bool list = component && nrrd_lower(kinds_[*component]) == "list" && layers.empty();
        const bool unknown = frame && (kinds_[*frame] == "???" || nrrd_lower(kinds_[*frame]) == "domain");
        if ((list && !frame && options_.frame && !options_.component) ||
            (unknown && !component && options_.component && !options_.frame))
            std::swap(component, frame);
        if (layers.size() > 1 && component && !options_.component) fail_with_layers(layers, sizes_[*component]);
        const std::size_t c = chosen_component(header_.path, options_, component ? sizes_[*component] : 1);
        const std::size_t f = chosen_frame(header_.path, options_, frame ? sizes_[*frame] : 1);
        selection.first = (component ? c * strides[*component] : 0) + (frame ? f * strides[*frame] : 0);
        if (c < layers.size()) out_.segments = layers[c];
        for (int axis = 0; axis < 3; ++axis)
            out_.dims.push_back(static_cast<std::size_t>(out_.volume.geometry.dims[axis]));
        for (const auto& extra : {component, frame})
            if (extra) out_.dims.push_back(sizes_[*extra]);
    }

    [[noreturn]] void fail_with_layers(const std::vector<std::vector<Label>>& layers, std::size_t count) const {
        std::string text;
        for (std::size_t i = 0; i < std::min<std::size_t>(layers.size(), 8); ++i) {
            text += fmt::format("{}{}:", i == 0 ? "" : "; ", i);
            for (std::size_t k = 0; k < std::min<std::size_t>(layers[i].size(), 8); ++k)
                text += fmt::format("{} {}", k == 0 ? "" : ",", layers[i][k].name);
            if (layers[i].size() > 8) text += " ...";
        }
        fail("{}: a segmentation with {} layers; choose one with --component 0..{} ({}{})", header_.path, count,
             count - 1, text, layers.size() > 8 ? "; ..." : "");
    }

    static constexpr std::size_t kMaxNrrdSamples = std::size_t{1} << 48;
    static constexpr long long kMaxSkip = 1LL << 40;
    const NrrdHeader& header_;
    const LoadOptions& options_;
    NrrdFile out_;
    std::vector<std::size_t> sizes_, spatial_;  // spatial_: axes in space, in the order of the file
    std::vector<NrrdAxis> axes_;
    std::vector<std::string> kinds_;
    std::vector<double> spacings_;
    Vectors directions_;  // empty: the header has none
    std::size_t space_dimension_ = 0;
    bool said_cell_ = false;
};

}  // namespace

std::optional<FileLayout> nrrd_layout(const std::string& path, Volume& description) {
    const NrrdHeader header = nrrd_header(path, path);
    NrrdFile file = NrrdReading(header, {}).read(path);
    if (file.data.samples > kMaxPackedVoxels)
        fail("{}: dims {}: at most 2^40 voxels", path, fmt::join(file.dims, " x "));
    auto layout = layout_of_stored(file.data, file.selection, file.volume);
    if (!layout || !file.segments.empty()) return std::nullopt;
    description = std::move(file.volume);
    return layout;
}

Volume load_nrrd(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    std::optional<TemporaryFolder> folder;
    const std::string file = without_gzip(path, folder);
    NrrdFile read = NrrdReading(nrrd_header(path, file), options).read(file);
    checked_bytes(path, read.dims, size_of(read.data.type));
    read_stored(read.data, read.selection, read.volume, options);
    if (!read.segments.empty()) name_segments(read.segments, read.volume);
    return std::move(read.volume);
}

}  // namespace edgesplat::detail
