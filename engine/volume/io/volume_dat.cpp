// Reads .dat files: headers of Voreen and Inviwo, which are lines of "key: value", and files that begin with three
// 16-bit dims (TU Wien).
#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "engine/volume/io/mapped_file.h"
#include "engine/volume/io/samples.h"
#include "engine/volume/io/vtk_grid.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

std::string dat_lower(std::string_view text) {
    std::string lower;
    for (const char c : text)
        lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower;
}

// The header: keys in lower case.
class DatHeader {
  public:
    explicit DatHeader(const std::string& path) : path_(path) {
        std::ifstream file(path, std::ios::binary);
        std::string line;
        while (values_.size() < 1000 && std::getline(file, line)) {
            if (line.size() > 4096)
                fail("{}: a line of {} characters: no header of Voreen or Inviwo", path, line.size());
            line = trimmed(line);
            if (line.starts_with('#') || line.starts_with('/')) continue;
            const auto colon = line.find(':');
            if (colon == std::string::npos) continue;
            std::string key = dat_lower(trimmed(line.substr(0, colon)));
            std::string value = trimmed(line.substr(colon + 1));
            // "TransformMatrix: row0 1 0 0 0"
            if (key == "transformmatrix") {
                const auto blank = std::min(value.find_first_of(" \t"), value.size());
                key += dat_lower(value.substr(0, blank));
                value = trimmed(value.substr(blank));
            }
            if (key == "datfile") ++datasets_;
            values_[key] = value;
        }
    }

    bool has(const std::string& key) const { return values_.contains(key) && !values_.at(key).empty(); }
    /// The value of the first of these keys that is there; "" if none is.
    std::string text(std::initializer_list<const char*> keys) const {
        for (const char* key : keys)
            if (has(key)) return values_.at(key);
        return "";
    }
    template <std::size_t n>
    std::array<double, n> numbers(const std::string& key) const {
        std::array<double, n> found{};
        const std::string given = values_.at(key);
        std::string_view rest = given;
        std::size_t count = 0;
        for (auto word = next_vtk_word(rest); !word.empty() && word.front() != '#'; word = next_vtk_word(rest), ++count)
            if (count >= n || !vtk_number(word, found[count]) || !std::isfinite(found[count])) {
                count = n + 1;
                break;
            }
        if (count != n) fail("{}: {} is '{}': expected {} numbers", path_, key, tidy(given.substr(0, 80)), n);
        return found;
    }
    glm::dvec3 vector(const std::string& key) const {
        const auto found = numbers<3>(key);
        return {found[0], found[1], found[2]};
    }
    std::size_t count(const std::string& key, std::size_t otherwise) const {
        if (!has(key)) return otherwise;
        const double number = numbers<1>(key)[0];
        if (number < 0 || number != std::floor(number) || number > 1e15)
            fail("{}: {} is '{}': expected a whole number", path_, key, values_.at(key));
        return static_cast<std::size_t>(number);
    }
    std::size_t datasets() const { return datasets_; }

  private:
    const std::string& path_;
    std::map<std::string, std::string> values_;
    std::size_t datasets_ = 0;
};

struct DatFormat {
    SampleType type = SampleType::UInt8;
    std::size_t components = 1;
};

DatFormat dat_format(const std::string& path, const DatHeader& header) {
    struct Name {
        std::string_view name;
        SampleType type;
    };
    static constexpr std::array kNames{
        Name{"uchar", SampleType::UInt8},      Name{"char", SampleType::Int8},     Name{"ushort", SampleType::UInt16},
        Name{"ushort_12", SampleType::UInt16}, Name{"short", SampleType::Int16},   Name{"uint", SampleType::UInt32},
        Name{"int", SampleType::Int32},        Name{"float", SampleType::Float32}, Name{"double", SampleType::Float64},
        Name{"uint64", SampleType::UInt64},    Name{"int64", SampleType::Int64}};
    DatFormat format;
    const std::string given = header.text({"format"});
    std::string name = dat_lower(given);
    // Inviwo: Vec3FLOAT32; Voreen: Vector3(float).
    for (const char* vector : {"vec", "vector"})
        if (name.starts_with(vector) && name.size() > std::string_view(vector).size()) {
            const std::size_t length = std::string_view(vector).size();
            const char digit = name[length];
            if (digit < '1' || digit > '4') continue;
            format.components = static_cast<std::size_t>(digit - '0');
            name = name.substr(length + 1);
            std::erase_if(name, [](char c) { return c == '(' || c == ')'; });
        }
    const std::string model = dat_lower(header.text({"objectmodel"}));
    static const std::map<std::string, std::size_t> models{{"i", 1}, {"", 1}, {"la", 2}, {"rgb", 3}, {"rgba", 4}};
    if (const auto of_model = models.find(model); of_model != models.end())
        format.components = std::max(format.components, of_model->second);
    else if (model.starts_with("tensor"))
        format.components = 6;
    const auto* known = std::ranges::find(kNames, std::string_view(name), &Name::name);
    SampleType type{};
    if (known != kNames.end())
        format.type = known->type;
    else if (sample_type_named(name, type))
        format.type = type;
    else
        fail("{}: Format is '{}': expected UCHAR, USHORT, FLOAT, UINT8 to FLOAT64 or Vec2 to Vec4 of these", path,
             tidy(given.substr(0, 40)));
    return format;
}

bool dat_swapped(const std::string& path, const DatHeader& header) {
    const std::string order = dat_lower(header.text({"byteorder", "endian", "endianness"}));
    const bool big = order.starts_with("big") || order == "msb", little = order.starts_with("little") || order == "lsb";
    if (!order.empty() && !big && !little)
        fail("{}: ByteOrder is '{}': expected LittleEndian or BigEndian", path, tidy(order.substr(0, 40)));
    return big != (std::endian::native == std::endian::big);
}

// Rows of an affine matrix.
glm::dmat4 dat_matrix(const std::string& path, const DatHeader& header, const char* key, int first) {
    glm::dmat4 matrix(1);
    for (int row = 0; row < 4; ++row) {
        const std::string name = key + std::to_string(row + first);
        if (!header.has(name)) continue;
        const auto numbers = header.numbers<4>(name);
        for (int column = 0; column < 4; ++column)
            matrix[column][row] = numbers[static_cast<std::size_t>(column)];
    }
    if (matrix[0][3] != 0 || matrix[1][3] != 0 || matrix[2][3] != 0 || matrix[3][3] != 1)
        fail("{}: {} has a last row {} {} {} {}: expected 0 0 0 1", path, key, matrix[0][3], matrix[1][3], matrix[2][3],
             matrix[3][3]);
    return matrix;
}

double dat_millimetres(const std::string& path, const DatHeader& header, Volume& volume) {
    std::array<std::string, 3> units;
    const std::string all = header.text({"axisunits"});
    std::string_view rest = all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        units[axis] = next_vtk_word(rest);
        if (const auto own = header.text({("axis" + std::to_string(axis + 1) + "unit").c_str()}); !own.empty())
            units[axis] = own;
    }
    if (units[0].empty() && units[1].empty() && units[2].empty()) return 1;
    if (units[0] != units[1] || units[1] != units[2])
        fail("{}: units of the axes are '{}', '{}' and '{}': expected one unit", path, units[0], units[1], units[2]);
    const auto length = millimetres_in(units[0]);
    if (!length) {
        volume.notes.push_back(
            fmt::format("The unit of the axes, '{}', is no length: mm are assumed.", tidy(units[0])));
        return 1;
    }
    volume.length_unit = units[0];
    return *length;
}

// The basis spans the whole grid, from the outer face of the first voxels to that of the last. Without an offset the
// grid is centred.
void place_dat(const std::string& path, const DatHeader& header, const std::vector<std::size_t>& dims, Volume& volume) {
    const glm::dvec3 size(dims[0], dims[1], dims[2]);
    glm::dvec3 spacing(1);
    std::string source = "none: 1 mm assumed";
    for (const char* key : {"slicethickness", "spacing"})
        if (header.has(key)) {
            spacing = header.vector(key);
            source = key == std::string_view("spacing") ? "Spacing" : "SliceThickness";
            if (!(spacing.x > 0 && spacing.y > 0 && spacing.z > 0))
                fail("{}: {} {} {} {}: expected lengths above 0", path, source, spacing.x, spacing.y, spacing.z);
        }
    glm::dmat3 basis(1);
    for (int axis = 0; axis < 3; ++axis)
        basis[axis][axis] = spacing[axis] * size[axis];
    if (header.has("basisvector1") && header.has("basisvector2") && header.has("basisvector3")) {
        // The lines are the rows of the matrix whose columns are the vectors: Inviwo writes and reads them so.
        for (int row = 0; row < 3; ++row) {
            const glm::dvec3 numbers = header.vector("basisvector" + std::to_string(row + 1));
            for (int column = 0; column < 3; ++column)
                basis[column][row] = numbers[column];
        }
        source = "BasisVector1..3";
    }
    glm::dvec3 corner = -0.5 * (basis[0] + basis[1] + basis[2]);
    if (header.has("offset")) {
        corner = header.vector("offset");
        source += ", Offset";
    }
    glm::dmat4 world(1);
    if (header.has("worldvector1") || header.has("worldvector2") || header.has("worldvector3")) {
        world = dat_matrix(path, header, "worldvector", 1);
        source += ", WorldVector1..4";
    } else if (header.has("transformmatrixrow0") || header.has("transformmatrixrow1")) {
        world = dat_matrix(path, header, "transformmatrixrow", 0);
        source += ", TransformMatrix";
    }
    glm::dmat3 axes;
    for (int axis = 0; axis < 3; ++axis)
        axes[axis] = glm::dmat3(world) * basis[axis] / size[axis];
    const double voxel = std::abs(glm::determinant(axes));
    if (!std::isfinite(voxel) || !(voxel > 0))
        fail("{}: {} span a volume of {}: expected axes that do not lie in one plane", path, source, voxel * size.x);
    const glm::dvec3 first = glm::dvec3(world * glm::dvec4(corner, 1)) + axes * glm::dvec3(0.5);
    set_place(volume, axes, first, dat_millimetres(path, header, volume), source);
}

// DataRange of the stored numbers means ValueRange.
void scale_dat(const DatHeader& header, StoredSamples& stored, std::size_t samples, const std::byte* all) {
    if (!header.has("valuerange")) return;
    const auto value = header.numbers<2>("valuerange");
    std::array<double, 2> data{};
    if (header.has("datarange")) {
        data = header.numbers<2>("datarange");
    } else if (dat_lower(header.text({"format"})) == "ushort_12") {
        data = {0, 4095};
    } else {
        // Inviwo takes the range of the stored numbers.
        std::vector<float> numbers(samples);
        convert_stored({.type = stored.type, .data = all, .stride = 1, .swapped = stored.swapped}, samples,
                       numbers.data());
        data = {std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest()};
        for (const float number : numbers)
            if (std::isfinite(number)) data = {std::min<double>(data[0], number), std::max<double>(data[1], number)};
    }
    if (data == value || data[0] == data[1]) return;
    stored.slope = (value[1] - value[0]) / (data[1] - data[0]);
    stored.intercept = value[0] - stored.slope * data[0];
}

// TU Wien's files: three 16-bit dims, and 16-bit samples with 12 bits. nullopt for other files.
std::optional<std::array<std::size_t, 3>> wien_dims(const std::string& path, std::string_view head) {
    if (!dat_lower(path).ends_with(".dat") || head.size() < 8) return std::nullopt;
    std::array<std::size_t, 3> dims{};
    std::size_t bytes = 2;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto low = static_cast<unsigned char>(head[2 * axis]),
                   high = static_cast<unsigned char>(head[2 * axis + 1]);
        const std::size_t side = low + 256UL * high;
        dims[axis] = side;
        bytes *= dims[axis];
    }
    std::error_code error;
    if (bytes == 0 || fs::file_size(path, error) != bytes + 6 || error) return std::nullopt;
    return dims;
}

Volume load_wien(const std::string& path, const std::array<std::size_t, 3>& sides) {
    const std::vector<std::size_t> dims(sides.begin(), sides.end());
    checked_bytes(path, dims, 2);
    const MappedFile file(path);
    Volume volume;
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    volume.geometry_source = "none: 1 mm assumed";
    take_samples({.type = SampleType::UInt16,
                  .data = file.bytes().data() + 6,
                  .swapped = std::endian::native == std::endian::big},
                 volume);
    return volume;
}

}  // namespace

bool is_volume_dat(const std::string& path, std::string_view head) {
    if (wien_dims(path, head)) return true;
    if (head.find('\0') != std::string_view::npos) return false;
    const std::string lower = "\n" + dat_lower(head);
    const auto has = [&](const char* key) {
        auto at = lower.find(key);
        if (at == std::string::npos) return false;
        at = lower.find_first_not_of(" \t", at + std::string_view(key).size());
        return at != std::string::npos && lower[at] == ':';
    };
    return (has("\nobjectfilename") || has("\nrawfile") || has("\ndatfile")) &&
           (has("\nresolution") || has("\ndimensions") || has("\ndatfile"));
}

Volume load_volume_dat(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    std::string start(64, '\0');
    std::ifstream(path, std::ios::binary).read(start.data(), static_cast<std::streamsize>(start.size()));
    if (const auto dims = wien_dims(path, start)) {
        (void)chosen_component(path, options, 1);
        (void)chosen_frame(path, options, 1);
        return load_wien(path, *dims);
    }
    const DatHeader header(path);
    if (header.datasets() > 0)
        fail("{}: a list of {} .dat files; open one of them, such as {}", path, header.datasets(),
             header.text({"datfile"}));
    const char* resolution = header.has("resolution") ? "resolution" : "dimensions";
    const std::string data_name = header.text({"objectfilename", "rawfile"});
    if (!header.has(resolution) || data_name.empty() || !header.has("format"))
        fail("{}: truncated: a header of Voreen or Inviwo needs ObjectFileName or RawFile, Resolution and Format",
             path);
    std::vector<std::size_t> dims;
    for (const double n : header.numbers<3>(resolution)) {
        if (!(n >= 1) || n != std::floor(n) || n > 1e9)
            fail("{}: Resolution with {}: expected whole numbers of at least 1", path, n);
        dims.push_back(static_cast<std::size_t>(n));
    }
    const std::string grid = dat_lower(header.text({"gridtype"}));
    if (!grid.empty() && !grid.starts_with("equidistant") && !grid.starts_with("uniform") &&
        !grid.starts_with("cartesian") && !grid.starts_with("regular"))
        fail("{}: GridType is '{}': expected EQUIDISTANT", path, tidy(grid.substr(0, 40)));
    DatFormat format = dat_format(path, header);
    const std::size_t frames = header.count("sequences", 1), offset = header.count("byteoffset", 0);
    if (frames == 0) fail("{}: Sequences is 0: expected at least 1", path);
    const fs::path data = fs::path(path).parent_path() / data_name;
    std::error_code error;
    if (!fs::is_regular_file(data, error))
        fail("{}: its data file {} {}", path, data.string(), error ? error.message() : "is not a file");
    const MappedFile file(data.string());
    const std::size_t stored_bytes = file.bytes().size(), left = stored_bytes - std::min(offset, stored_bytes);
    auto all_dims = dims;
    all_dims.push_back(frames);
    Volume volume;
    // Old files call samples with one component RGBA, too.
    if (format.components > 1 && left == checked_bytes(path, all_dims, size_of(format.type))) {
        volume.notes.push_back(
            fmt::format("ObjectModel or Format says {} components, but the data file has one.", format.components));
        format.components = 1;
    }
    const std::size_t voxel = format.components * size_of(format.type);
    const std::size_t needed = checked_bytes(path, all_dims, voxel);
    if (left < needed)
        fail("{}: its data file {} has {} bytes after ByteOffset {}, expected {}: truncated", path, data.string(), left,
             offset, needed);
    const std::size_t component = chosen_component(path, options, format.components);
    const std::size_t frame = chosen_frame(path, options, frames);
    if (left > needed)
        volume.notes.push_back(fmt::format("{} bytes after the last voxel were not used.", left - needed));
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    place_dat(path, header, dims, volume);
    const std::size_t voxels = volume.geometry.voxel_count();
    const auto* first = reinterpret_cast<const std::byte*>(file.bytes().data()) + offset + frame * voxels * voxel;
    StoredSamples stored{.type = format.type,
                         .data = first + component * size_of(format.type),
                         .stride = format.components,
                         .swapped = dat_swapped(path, header)};
    scale_dat(header, stored, voxels * format.components, first);
    report(options, 0.3, "reading voxels");
    take_samples(stored, volume);
    return volume;
}

}  // namespace edgesplat::detail
