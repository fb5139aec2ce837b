// Reads MINC1 (netCDF) and MINC2 (HDF5): place and scale from the header of either.
#include "engine/volume/io/minc.h"

#include <cmath>

#include "engine/volume/io/binary_file.h"

namespace edgesplat::detail {
namespace {

// An axis of the volume among the image's dimensions.
struct MincAxis {
    const MincDimension* dimension = nullptr;  // nullptr: a single slice
    std::size_t size = 1, stride = 0;          // samples from one voxel to the next
    int world = 0;                             // 0, 1, 2 for xspace, yspace, zspace
};

struct MincParts {
    std::vector<MincAxis> space;  // slowest first: k, j, i
    MincAxis time, vector;
};

MincParts minc_parts(const std::string& path, const MincImage& image) {
    MincParts parts;
    std::size_t stride = 1;
    for (auto dimension = image.dimensions.rbegin(); dimension != image.dimensions.rend(); ++dimension) {
        MincAxis axis{&*dimension, dimension->length, stride};
        stride *= dimension->length;
        const std::string& name = dimension->name;
        if (name == "xspace" || name == "yspace" || name == "zspace") {
            axis.world = name[0] - 'x';
            for (const MincAxis& other : parts.space)
                if (other.world == axis.world) fail("{}: two dimensions of its image are {}", path, name);
            parts.space.insert(parts.space.begin(), axis);
        } else if (name == "time" || name == "vector_dimension") {
            (name == "time" ? parts.time : parts.vector) = axis;
        } else if (dimension->length > 1) {
            fail("{}: dimension {} of its image, expected xspace, yspace, zspace, time or vector_dimension", path,
                 tidy(name));
        }
    }
    if (parts.space.size() < 2)
        fail("{}: its image has {} of the dimensions xspace, yspace, zspace; a volume needs 3, or 2 for a single slice",
             path, parts.space.size());
    if (parts.space.size() == 2)
        parts.space.insert(parts.space.begin(), MincAxis{.world = 3 - parts.space[0].world - parts.space[1].world});
    return parts;
}

double minc_number(const std::string& path, const MincDimension& dimension, const char* name, double absent) {
    const auto found = dimension.attributes.numbers.find(name);
    if (found == dimension.attributes.numbers.end()) return absent;
    if (found->second.size() != 1 || !(std::abs(found->second[0]) < 1e15))
        fail("{}: {}:{}: {}, expected one number", path, dimension.name, name, fmt::join(found->second, " "));
    return found->second[0];
}

std::string minc_text(const MincDimension& dimension, const char* name) {
    const auto found = dimension.attributes.texts.find(name);
    return found == dimension.attributes.texts.end() ? "" : found->second;
}

void set_minc_place(const MincParts& parts, const LoadOptions& options, Volume& volume) {
    const std::string& path = volume.name;
    glm::dmat3 axes(1);
    glm::dvec3 origin(0);
    bool has_steps = false;
    for (int column = 0; column < 3; ++column) {
        const MincAxis& axis = parts.space[static_cast<std::size_t>(2 - column)];
        glm::dvec3 direction(0);
        direction[axis.world] = 1;
        axes[column] = direction;
        if (axis.dimension == nullptr) continue;
        const MincDimension& dimension = *axis.dimension;
        if (minc_text(dimension, "spacing").starts_with("irregular"))
            fail("{}: {}:spacing is irregular: its slices are not evenly spaced", path, dimension.name);
        if (const std::string alignment = minc_text(dimension, "alignment");
            alignment.starts_with("start") || alignment.starts_with("end"))
            volume.warnings.push_back(
                fmt::format("{}:alignment is {}: the position of voxels is taken for that of their centres.",
                            dimension.name, alignment));
        double millimetres = 1;
        if (const std::string unit = minc_text(dimension, "units"); !unit.empty()) {
            const auto known = millimetres_in(unit);
            millimetres = known.value_or(1);
            if (!known)
                volume.warnings.push_back(fmt::format("{}:units '{}' is no known unit of length; mm are assumed.",
                                                      dimension.name, tidy(unit)));
            volume.length_unit = known ? unit : "";
        }
        has_steps = has_steps || dimension.attributes.numbers.contains("step");
        double step = minc_number(path, dimension, "step", 1) * millimetres;
        const double start = minc_number(path, dimension, "start", 0) * millimetres;
        if (step == 0) {
            if (!options.spacing) fail("{}: {}:step is 0, expected a length; give --spacing", path, dimension.name);
            step = 1;
        }
        if (const auto cosines = dimension.attributes.numbers.find("direction_cosines");
            cosines != dimension.attributes.numbers.end()) {
            const auto& c = cosines->second;
            const double length = c.size() == 3 ? glm::length(glm::dvec3(c[0], c[1], c[2])) : 0;
            if (!(length > 1e-6 && length < 1e6))
                fail("{}: {}:direction_cosines: {}, expected a direction", path, dimension.name, fmt::join(c, " "));
            direction = glm::dvec3(c[0], c[1], c[2]);
            if (std::abs(length - 1) > 1e-6) direction /= length;
        }
        axes[column] = direction * step;
        origin += direction * start;
    }
    // x is right, y is anterior.
    const glm::dmat3 flip(-1, 0, 0, 0, -1, 0, 0, 0, 1);
    volume.in_patient = true;
    set_place(volume, flip * axes, flip * origin, 1,
              has_steps ? "step, start, direction_cosines" : "none: 1 mm assumed");
    if (!has_steps && !options.spacing)
        volume.warnings.emplace_back("The dimensions have no step: voxels of 1 mm are assumed; give --spacing.");
}

double minc_value(SampleType type, bool swapped, const char* data) {
    std::array<char, 8> raw{};
    const std::size_t size = size_of(type);
    std::memcpy(raw.data(), data, size);
    if (swapped) std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    const auto as = [&](auto value) {
        std::memcpy(&value, raw.data(), sizeof value);
        return static_cast<double>(value);
    };
    switch (type) {
        case SampleType::Int8:
            return as(std::int8_t{});
        case SampleType::UInt8:
            return as(std::uint8_t{});
        case SampleType::Int16:
            return as(std::int16_t{});
        case SampleType::UInt16:
            return as(std::uint16_t{});
        case SampleType::Int32:
            return as(std::int32_t{});
        case SampleType::UInt32:
            return as(std::uint32_t{});
        case SampleType::Int64:
            return as(std::int64_t{});
        case SampleType::UInt64:
            return as(std::uint64_t{});
        case SampleType::Float32:
            return as(float{});
        case SampleType::Float64:
            return as(double{});
    }
    return 0;
}

bool is_float(SampleType type) {
    return type == SampleType::Float32 || type == SampleType::Float64;
}

// The stored values that image-min and image-max belong to.
glm::dvec2 minc_valid_range(const std::string& path, const MincImage& image) {
    if (image.valid_range.empty()) {
        const double bits = 8 * static_cast<double>(size_of(image.type));
        const bool is_signed = name_of(image.type).front() == 'i';
        const double low = is_signed ? -std::exp2(bits - 1) : 0;
        return {low, low + std::exp2(bits) - 1};
    }
    const auto [low, high] = std::minmax(image.valid_range[0], image.valid_range[1]);
    if (!(high > low) || !std::isfinite(low) || !std::isfinite(high))
        fail("{}: image:valid_range: {} {}, expected two different numbers", path, low, high);
    return {low, high};
}

// Samples of the chosen part, x fastest, still as stored, and for each slice of image-max its scale.
void set_minc_values(const MincImage& image, const MincParts& parts, std::size_t first, std::size_t samples,
                     Volume& volume) {
    const std::string& path = volume.name;
    std::vector<double> low = image.low, high = image.high;
    if (low.empty() && high.empty()) {  // MINC's defaults
        low = {0};
        high = {1};
        if (!is_float(image.type))
            volume.notes.emplace_back(
                "There is no image-min and image-max: the valid range is read as 0 to 1, as MINC defines it.");
    }
    if (low.size() != high.size() || samples % low.size() != 0)
        fail("{}: {} entries of image-min, {} of image-max: expected the same number, one per slice", path, low.size(),
             high.size());
    const auto [k, j, i] = std::tie(parts.space[0], parts.space[1], parts.space[2]);
    const std::size_t item = size_of(image.type), count = volume.geometry.voxel_count();
    const std::vector<char> data = image.read();
    std::vector<char> ordered(count * item);
    std::vector<std::size_t> slices(low.size() > 1 ? count : 0);
    std::size_t to = 0;
    for (std::size_t z = 0; z < k.size; ++z)
        for (std::size_t y = 0; y < j.size; ++y)
            for (std::size_t x = 0; x < i.size; ++x, ++to) {
                const std::size_t from = first + z * k.stride + y * j.stride + x * i.stride;
                std::memcpy(&ordered[to * item], &data[from * item], item);
                if (!slices.empty()) slices[to] = from / (samples / low.size());
            }
    const StoredSamples stored{.type = image.type, .data = ordered.data(), .swapped = image.swapped};
    if (is_float(image.type)) return take_samples(stored, volume);  // stored as they are

    const glm::dvec2 range = minc_valid_range(path, image);
    std::vector<double> slope(low.size()), intercept(low.size());
    bool is_scaled = false;
    for (std::size_t s = 0; s < low.size(); ++s) {
        if (!std::isfinite(low[s]) || !std::isfinite(high[s]))
            fail("{}: image-min {}, image-max {} of slice {}: expected numbers", path, low[s], high[s], s);
        slope[s] = (high[s] - low[s]) / (range.y - range.x);
        intercept[s] = low[s] - range.x * slope[s];
        is_scaled = is_scaled || slope[s] != 1 || intercept[s] != 0;
    }
    std::size_t invalid = 0;
    const auto value_at = [&](std::size_t n) { return minc_value(image.type, image.swapped, &ordered[n * item]); };
    const auto is_invalid = [&](double value) { return value < range.x || value > range.y; };
    if (!image.valid_range.empty())
        for (std::size_t n = 0; n < count; ++n)
            invalid += is_invalid(value_at(n)) ? 1U : 0U;
    if (!is_scaled && invalid == 0) return take_samples(stored, volume);
    volume.stored_type = name_of(image.type);
    volume.values.resize(count);
    for (std::size_t n = 0; n < count; ++n) {
        const double value = value_at(n);
        const std::size_t s = slices.empty() ? 0 : slices[n];
        volume.values[n] = invalid > 0 && is_invalid(value) ? std::numeric_limits<float>::quiet_NaN()
                                                            : static_cast<float>(value * slope[s] + intercept[s]);
    }
    if (invalid > 0)
        volume.notes.push_back(
            fmt::format("{} samples are outside of valid_range ({} to {}): no data.", invalid, range.x, range.y));
}

}  // namespace

bool is_minc(const std::string& path) {
    const std::string head = first_unpacked_bytes(path, 1 << 16);
    const bool is_netcdf = head.starts_with("CDF\1") || head.starts_with("CDF\2");
    return (is_netcdf && head.find("yspace") != std::string::npos && head.find("image") != std::string::npos) ||
           (head.starts_with("\x89HDF") && head.find("minc-2.0") != std::string::npos);
}

Volume load_minc(const std::string& path, const LoadOptions& options) {
    Volume volume;
    volume.name = path;
    const MincImage image = first_unpacked_bytes(path, 4) == "\x89HDF" ? minc2_image(path) : minc1_image(path);
    std::vector<std::size_t> dims;
    for (const MincDimension& dimension : image.dimensions)
        dims.push_back(dimension.length);
    const MincParts parts = minc_parts(path, image);
    const std::size_t frame = chosen_frame(path, options, parts.time.size);
    const std::size_t component = chosen_component(path, options, parts.vector.size);
    const std::size_t bytes = checked_bytes(
        path, {parts.space[2].size, parts.space[1].size, parts.space[0].size, parts.time.size, parts.vector.size},
        size_of(image.type));
    check_stored_size(path, bytes, std::filesystem::file_size(path));
    volume.geometry.dims = glm::ivec3(parts.space[2].size, parts.space[1].size, parts.space[0].size);
    if (parts.space[0].dimension == nullptr)
        volume.notes.emplace_back("The file holds a 2-D image: it is read as a volume of one slice, 1 mm thick.");
    set_minc_place(parts, options, volume);
    report(options, 0.3, "reading voxels");
    set_minc_values(image, parts, frame * parts.time.stride + component * parts.vector.stride,
                    bytes / size_of(image.type), volume);
    return volume;
}

}  // namespace edgesplat::detail
