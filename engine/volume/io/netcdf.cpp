// Reads a variable of a netCDF file, classic or of version 4, through libnetcdf. Place and values follow the CF
// conventions: coordinate variables with units, scale_factor and add_offset, _FillValue, missing_value, valid range.
#include <netcdf.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>

#include "engine/volume/io/arrays.h"
#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/classic_netcdf.h"
#include "engine/volume/io/hdf5.h"
#include "engine/volume/io/readers.h"
#include "engine/volume/io/samples.h"

namespace edgesplat::detail {
namespace {

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

// An open file. Hold hdf5_mutex() while it exists: version 4 is stored as HDF5.
class NetcdfFile {
  public:
    explicit NetcdfFile(const std::string& path) : path_(path) {
        // libnetcdf 4.9 divides by 0 for an unknown type.
        if (ClassicNetcdf::is_classic(first_unpacked_bytes(path, 4))) (void)read_classic_netcdf(path);
        check(nc_open(path.c_str(), NC_NOWRITE, &id_));
    }
    ~NetcdfFile() { nc_close(id_); }
    NetcdfFile(const NetcdfFile&) = delete;
    NetcdfFile& operator=(const NetcdfFile&) = delete;

    int id() const { return id_; }
    void check(int status) const {
        if (status != NC_NOERR) fail("{}: cannot be read as netCDF: {}", path_, tidy(nc_strerror(status)));
    }

  private:
    std::string path_;
    int id_ = -1;
};

struct Variable {
    int group = 0, id = 0, type = NC_NAT;
    std::string name;       // with its groups, e.g. "/group/name"
    std::vector<int> dims;  // identifiers, slowest first
    std::vector<std::string> dim_names;
    std::vector<std::uint64_t> extent;
};

std::optional<SampleType> sample_type_of_netcdf(int type) {
    switch (type) {
        case NC_BYTE:
            return SampleType::Int8;
        case NC_UBYTE:
            return SampleType::UInt8;
        case NC_SHORT:
            return SampleType::Int16;
        case NC_USHORT:
            return SampleType::UInt16;
        case NC_INT:
            return SampleType::Int32;
        case NC_UINT:
            return SampleType::UInt32;
        case NC_INT64:
            return SampleType::Int64;
        case NC_UINT64:
            return SampleType::UInt64;
        case NC_FLOAT:
            return SampleType::Float32;
        case NC_DOUBLE:
            return SampleType::Float64;
        default:
            return std::nullopt;
    }
}

std::string text_of_attribute(const Variable& variable, const char* name) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    constexpr std::size_t kMost = 65536;
    if (nc_inq_att(variable.group, variable.id, name, &type, &length) != NC_NOERR) return "";
    if (type == NC_STRING && length == 1) {
        char* text = nullptr;
        if (nc_get_att_string(variable.group, variable.id, name, &text) != NC_NOERR || text == nullptr) return "";
        std::string result = text;
        nc_free_string(1, &text);
        return result;
    }
    if (type != NC_CHAR || length == 0 || length > kMost) return "";
    std::string text(length, '\0');
    if (nc_get_att_text(variable.group, variable.id, name, text.data()) != NC_NOERR) return "";
    return text.substr(0, text.find('\0'));
}

std::vector<double> numbers_of_attribute(const Variable& variable, const char* name) {
    nc_type type = NC_NAT;
    std::size_t length = 0;
    constexpr std::size_t kMost = 1024;
    if (nc_inq_att(variable.group, variable.id, name, &type, &length) != NC_NOERR || !sample_type_of_netcdf(type) ||
        length == 0 || length > kMost)
        return {};
    std::vector<double> numbers(length);
    if (nc_get_att_double(variable.group, variable.id, name, numbers.data()) != NC_NOERR) return {};
    return numbers;
}

void add_variables(const NetcdfFile& file, int group, const std::string& prefix, int depth,
                   std::vector<Variable>& found) {
    constexpr int kDeepest = 32;
    constexpr std::size_t kMost = 100'000;
    int count = 0;
    file.check(nc_inq_varids(group, &count, nullptr));
    std::vector<int> ids(static_cast<std::size_t>(count));
    if (count > 0) file.check(nc_inq_varids(group, &count, ids.data()));
    for (const int id : ids) {
        Variable variable{.group = group, .id = id};
        char name[NC_MAX_NAME + 1] = {};
        int axes = 0;
        file.check(nc_inq_varname(group, id, name));
        file.check(nc_inq_vartype(group, id, &variable.type));
        file.check(nc_inq_varndims(group, id, &axes));
        variable.name = prefix + name;
        variable.dims.resize(static_cast<std::size_t>(axes));
        if (axes > 0) file.check(nc_inq_vardimid(group, id, variable.dims.data()));
        for (const int dim : variable.dims) {
            std::size_t length = 0;
            file.check(nc_inq_dim(group, dim, name, &length));
            variable.dim_names.emplace_back(name);
            variable.extent.push_back(length);
        }
        if (found.size() < kMost) found.push_back(std::move(variable));
    }
    int groups = 0;
    if (nc_inq_grps(group, &groups, nullptr) != NC_NOERR || groups < 1 || depth >= kDeepest) return;
    std::vector<int> children(static_cast<std::size_t>(groups));
    file.check(nc_inq_grps(group, &groups, children.data()));
    for (const int child : children) {
        char name[NC_MAX_NAME + 1] = {};
        file.check(nc_inq_grpname(child, name));
        add_variables(file, child, prefix + name + "/", depth + 1, found);
    }
}

// The coordinate variable of an axis: of the same name as the dimension, in the variable's group or one above it.
const Variable* coordinates_of(const std::vector<Variable>& all, const Variable& variable, std::size_t axis) {
    const Variable* best = nullptr;
    for (const Variable& other : all) {
        const bool coordinate = other.dims.size() == 1 && other.dims[0] == variable.dims[axis] &&
                                other.name.substr(other.name.rfind('/') + 1) == variable.dim_names[axis];
        if (coordinate && (best == nullptr || other.name.size() > best->name.size())) best = &other;
    }
    return best;
}

bool is_time_unit(const std::string& unit) {
    return lower(unit).find(" since ") != std::string::npos;
}

// x, y, z, t or another letter, from what CF defines for an axis, else from the dimension's name.
char letter_of(const Variable* coordinates, const std::string& dim_name) {
    if (coordinates != nullptr) {
        const std::string axis = lower(text_of_attribute(*coordinates, "axis"));
        if (axis.size() == 1 && std::string_view("xyzt").find(axis[0]) != std::string_view::npos) return axis[0];
        const std::string unit = lower(text_of_attribute(*coordinates, "units")),
                          name = lower(text_of_attribute(*coordinates, "standard_name"));
        if (is_time_unit(unit) || name == "time") return 't';
        if (unit.starts_with("degree") && unit.find("_e") != std::string::npos) return 'x';
        if (unit.starts_with("degree") && unit.find("_n") != std::string::npos) return 'y';
        if (name.ends_with("_x_coordinate") || name == "longitude" || name == "grid_longitude") return 'x';
        if (name.ends_with("_y_coordinate") || name == "latitude" || name == "grid_latitude") return 'y';
        const std::string up = lower(text_of_attribute(*coordinates, "positive"));
        if (up == "up" || up == "down") return 'z';
    }
    const std::string name = lower(dim_name);
    for (const std::string_view x : {"x", "lon", "longitude", "xspace", "nx", "rlon"})
        if (name == x) return 'x';
    for (const std::string_view y : {"y", "lat", "latitude", "yspace", "ny", "rlat"})
        if (name == y) return 'y';
    for (const std::string_view z : {"z", "lev", "level", "depth", "height", "plev", "zspace", "nz", "altitude"})
        if (name == z) return 'z';
    return name == "time" || name == "t" ? 't' : '?';
}

// Whether greater coordinates are farther down: CF's attribute says so, or units of pressure.
bool points_down(const Variable& coordinates) {
    const std::string positive = lower(text_of_attribute(coordinates, "positive"));
    if (!positive.empty()) return positive == "down";
    const std::string unit = lower(text_of_attribute(coordinates, "units"));
    for (const std::string_view pressure : {"pa", "hpa", "kpa", "pascal", "hectopascal", "bar", "mbar", "millibar",
                                            "mb", "dbar", "decibar", "atm", "atmosphere"})
        if (unit == pressure || unit == std::string(pressure) + "s") return true;
    return false;
}

struct AxisPlace {
    double first = 0, step = 1;
    std::string unit;
    bool known = false;
};

// First value and step of an axis; fails if the coordinates are not evenly spaced.
AxisPlace place_of_axis(const std::string& path, const NetcdfFile& file, const Variable* coordinates,
                        std::uint64_t count) {
    AxisPlace place;
    if (coordinates == nullptr || !sample_type_of_netcdf(coordinates->type) || coordinates->extent[0] != count)
        return place;
    place.unit = text_of_attribute(*coordinates, "units");
    std::vector<double> values(count);
    file.check(nc_get_var_double(coordinates->group, coordinates->id, values.data()));
    for (const double value : values)
        if (!std::isfinite(value)) fail("{}: {}: a coordinate is {}", path, coordinates->name, value);
    place.known = true;
    if (points_down(*coordinates))
        for (double& value : values)
            value = -value;
    place.first = values[0];
    if (count == 1) return place;
    place.step = (values.back() - values.front()) / static_cast<double>(count - 1);
    const double largest = std::max(std::abs(values.front()), std::abs(values.back()));
    const double rounding = coordinates->type == NC_DOUBLE ? 1e-12 : 1e-6;
    const double sign = points_down(*coordinates) ? -1 : 1;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double even = place.first + place.step * static_cast<double>(i);
        if (!(std::abs(values[i] - even) <= 1e-3 * std::abs(place.step) + rounding * largest) || place.step == 0)
            fail(
                "{}: {}: uneven coordinates: {} where {:.9g} would be even; interpolate them to even ones, or choose a "
                "variable with even ones",
                path, coordinates->name, sign * values[i], sign * even);
    }
    return place;
}

void set_netcdf_place(const std::string& path, const NetcdfFile& file, const std::vector<Variable>& all,
                      const Variable& variable, const ArrayAxes& axes, Volume& volume) {
    std::array<AxisPlace, 3> places;
    for (std::size_t i = 0; i < axes.space.size(); ++i) {
        const std::size_t axis = axes.space[axes.space.size() - 1 - i];
        places.at(i) = place_of_axis(path, file, coordinates_of(all, variable, axis), variable.extent[axis]);
    }
    glm::dmat3 steps(0);
    glm::dvec3 origin(0);
    const std::size_t count = axes.space.size();
    const auto all_of_first = [&](const auto& test) {
        return std::all_of(places.begin(), places.begin() + count, test);
    };
    const bool lengths = all_of_first([](const AxisPlace& p) { return p.known && millimetres_in(p.unit); });
    const bool alike = all_of_first([&](const AxisPlace& p) { return p.known && p.unit == places[0].unit; });
    for (std::size_t i = 0; i < 3; ++i) {
        const int column = static_cast<int>(i), row = axes.world.at(i);
        const bool used = i < count && (lengths || alike);
        const double scale = used && lengths ? *millimetres_in(places.at(i).unit) : 1;
        // Without a common unit, the axes keep their directions: latitudes often descend.
        steps[column][row] = used ? places.at(i).step * scale : std::copysign(1, places.at(i).step);
        origin[row] = used ? places.at(i).first * scale : 0;
        if (i < count && places.at(i).known && !lengths)
            volume.length_unit +=
                (volume.length_unit.empty() ? "" : ", ") + (places.at(i).unit.empty() ? "none" : places.at(i).unit);
    }
    if (lengths && count > 0) volume.length_unit = places[0].unit;
    set_place(volume, steps, origin, 1, lengths || alike ? "coordinate variables" : "none: 1 mm assumed");
    if (!lengths && alike)
        volume.notes.push_back(
            fmt::format("The coordinates ({}) are no lengths: one unit is drawn as 1 mm.", volume.length_unit));
    if (!lengths && !alike && !volume.length_unit.empty())
        volume.notes.push_back(
            fmt::format("The axes have no common unit of length ({}): 1 x 1 x 1 mm is assumed; give "
                        "--spacing X Y Z.",
                        volume.length_unit));
}

// The value of samples that were never written, if the variable declares none of its own; bytes have no such value.
std::optional<double> default_fill(const Variable& variable) {
    for (const char* declared : {"_FillValue", "valid_range", "valid_min", "valid_max"})
        if (!numbers_of_attribute(variable, declared).empty()) return std::nullopt;
    int unfilled = 0;
    if (nc_inq_var_fill(variable.group, variable.id, &unfilled, nullptr) != NC_NOERR || unfilled != 0)
        return std::nullopt;
    switch (variable.type) {
        case NC_SHORT:
            return NC_FILL_SHORT;
        case NC_USHORT:
            return NC_FILL_USHORT;
        case NC_INT:
            return NC_FILL_INT;
        case NC_UINT:
            return NC_FILL_UINT;
        case NC_INT64:
            return static_cast<double>(NC_FILL_INT64);
        case NC_UINT64:
            return static_cast<double>(NC_FILL_UINT64);
        case NC_FLOAT:
            return NC_FILL_FLOAT;
        case NC_DOUBLE:
            return NC_FILL_DOUBLE;
        default:
            return std::nullopt;
    }
}

// Samples outside of valid_min, valid_max and valid_range, or equal to a missing value, contain no data.
void mark_invalid(const Variable& variable, const StoredSamples& stored, std::vector<float>& values) {
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    const auto range = numbers_of_attribute(variable, "valid_range");
    const auto least = numbers_of_attribute(variable, "valid_min"), most = numbers_of_attribute(variable, "valid_max");
    if (range.size() == 2) {
        low = range[0];
        high = range[1];
    }
    if (least.size() == 1) low = least[0];
    if (most.size() == 1) high = most[0];
    const auto missing = numbers_of_attribute(variable, "missing_value");
    if (!std::isfinite(low) && !std::isfinite(high) && missing.empty()) return;
    // The attributes speak of stored numbers.
    std::vector<float> raw(values.size());
    StoredSamples plain = stored;
    plain.slope = 1;
    plain.intercept = 0;
    convert_stored(plain, raw.size(), raw.data());
    const auto as_float = [](double value) { return static_cast<float>(value); };
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_missing = std::ranges::any_of(missing, [&](double value) { return raw[i] == as_float(value); });
        if (is_missing || raw[i] < as_float(low) || raw[i] > as_float(high))
            values[i] = std::numeric_limits<float>::quiet_NaN();
    }
}

std::vector<NamedArray> arrays_of_netcdf(const std::vector<Variable>& variables, std::vector<std::size_t>& places) {
    std::vector<NamedArray> arrays;
    for (std::size_t i = 0; i < variables.size(); ++i) {
        const Variable& v = variables[i];
        const auto type = sample_type_of_netcdf(v.type);
        const bool empty = std::ranges::find(v.extent, 0U) != v.extent.end();
        if (!type || v.dims.empty() || empty) continue;
        const std::string own_name = v.name.substr(v.name.rfind('/') + 1);
        if (v.dims.size() == 1 && own_name == v.dim_names[0]) continue;  // coordinates
        bool bounds = false;
        for (const Variable& other : variables)
            bounds = bounds || text_of_attribute(other, "bounds") == own_name;
        const auto thick = std::ranges::count_if(v.extent, [](std::uint64_t n) { return n > 1; });
        arrays.push_back({v.name.substr(1), v.extent, std::string(name_of(*type)), thick >= 3 && !bounds});
        places.push_back(i);
    }
    return arrays;
}

}  // namespace

bool is_netcdf4(const std::string& path) {
    const Hdf5File file = Hdf5File::open(path);
    return file.has_attribute("_NCProperties") || file.has_attribute("_nc3_strict") ||
           file.has_attribute("Conventions");
}

Volume load_netcdf(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    check_netcdf_is_whole(path);
    const std::lock_guard lock(hdf5_mutex());
    const NetcdfFile file(path);
    std::vector<Variable> variables;
    add_variables(file, file.id(), "/", 0, variables);
    std::vector<std::size_t> places;
    const auto arrays = arrays_of_netcdf(variables, places);
    const std::size_t chosen = chosen_array(path, options, arrays);
    const Variable& variable = variables[places[chosen]];
    std::string letters;
    for (std::size_t axis = 0; axis < variable.dims.size(); ++axis)
        letters += letter_of(coordinates_of(variables, variable, axis), variable.dim_names[axis]);
    // An unnamed axis beside x and y is z, if there is one only.
    if (letters.find('z') == std::string::npos && std::ranges::count(letters, '?') == 1)
        letters[letters.find('?')] = 'z';
    const ArrayAxes axes = axes_of(arrays[chosen], letters);
    const ArrayBox box = chosen_box(path, options, arrays[chosen], axes);

    Volume volume;
    volume.name = path;
    volume.geometry.dims = box.dims;
    SampleType type = *sample_type_of_netcdf(variable.type);
    // Before netCDF 4 had unsigned bytes, an attribute said so.
    const std::string is_unsigned = lower(text_of_attribute(variable, "_Unsigned"));
    if (is_unsigned == "true" && type == SampleType::Int8) type = SampleType::UInt8;
    if (is_unsigned == "true" && type == SampleType::Int16) type = SampleType::UInt16;
    if (is_unsigned == "true" && type == SampleType::Int32) type = SampleType::UInt32;
    volume.stored_type = name_of(type);
    set_netcdf_place(path, file, variables, variable, axes, volume);
    const std::size_t bytes = volume.geometry.voxel_count() * size_of(type);
    check_memory(path, variable.name, bytes + volume.geometry.voxel_count() * sizeof(float));
    check_stored_size(path, bytes, std::filesystem::file_size(path), kBestDeflateRatio * kPlainRatio);
    report(options, 0.1, "reading voxels");
    const auto buffer = std::make_unique<std::byte[]>(bytes);
    const std::vector<std::size_t> low(box.low.begin(), box.low.end()), size(box.size.begin(), box.size.end());
    file.check(nc_get_vara(variable.group, variable.id, low.data(), size.data(), buffer.get()));
    StoredSamples stored{.type = type, .data = buffer.get()};
    const auto one = [&](const char* name) -> std::optional<double> {
        const auto numbers = numbers_of_attribute(variable, name);
        return numbers.size() == 1 ? std::optional(numbers.front()) : std::nullopt;
    };
    stored.slope = one("scale_factor").value_or(1);
    stored.intercept = one("add_offset").value_or(0);
    if (!std::isfinite(stored.slope) || !std::isfinite(stored.intercept) || stored.slope == 0)
        fail("{}: {}: scale_factor {} and add_offset {}, expected finite numbers, the first not 0", path, variable.name,
             stored.slope, stored.intercept);
    stored.fill = one("_FillValue");
    if (!stored.fill) stored.fill = default_fill(variable);
    if (stored.fill && is_unsigned == "true" && *stored.fill < 0)
        stored.fill = *stored.fill + std::ldexp(1.0, static_cast<int>(8 * size_of(type)));
    if (const auto warning = colour_warning(arrays[chosen], axes); !warning.empty()) volume.warnings.push_back(warning);
    take_samples(stored, volume);
    mark_invalid(variable, stored, volume.values);
    if (arrays.size() > 1)
        volume.notes.push_back(fmt::format("The variable {} of {} was read.", arrays[chosen].name, arrays.size()));
    return volume;
}

}  // namespace edgesplat::detail
