// Reads MRC and CCP4 maps: MRC2014, older MRC files, and those of IMOD.
#include <cmath>
#include <numbers>
#include <optional>

#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/half.h"

namespace edgesplat::detail {
namespace {

constexpr std::size_t kMrcHeader = 1024;
// Byte offsets of the fields, named as in MRC2014.
constexpr std::size_t kMrcN = 0, kMrcMode = 12, kMrcStart = 16, kMrcM = 28, kMrcCell = 40, kMrcAngles = 52,
                      kMrcMap = 64, kMrcDmin = 76, kMrcDmax = 80, kMrcIspg = 88, kMrcNsymbt = 92, kMrcImodStamp = 152,
                      kMrcImodFlags = 156, kMrcOrigin = 196, kMrcSignature = 208, kMrcMachst = 212;

struct MrcMode {
    int code;
    const char* name;
    SampleType sample;
    std::size_t components;
};
constexpr std::array kMrcModes{
    MrcMode{0, "int8", SampleType::Int8, 1},       MrcMode{1, "int16", SampleType::Int16, 1},
    MrcMode{2, "float32", SampleType::Float32, 1}, MrcMode{6, "uint16", SampleType::UInt16, 1},
    MrcMode{12, "float16", SampleType::UInt16, 1},  // unpacked here
    MrcMode{16, "rgb24", SampleType::UInt8, 3},    MrcMode{101, "uint4", SampleType::UInt8, 1}};

struct MrcHeader : BinaryHeader {
    std::int32_t whole(std::size_t at, std::size_t index = 0) const { return get<std::int32_t>(at + 4 * index); }
    double real(std::size_t at, std::size_t index = 0) const { return static_cast<double>(get<float>(at + 4 * index)); }
    bool is_imod() const { return whole(kMrcImodStamp) == 1146047817; }
    int imod_flags() const { return is_imod() ? whole(kMrcImodFlags) : 0; }
    // Whether the numbers make sense in this byte order.
    bool is_plausible() const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (whole(kMrcN, axis) < 1 || whole(kMrcN, axis) >= 1 << 24 || whole(kMrcMap, axis) < 0 ||
                whole(kMrcMap, axis) > 3)
                return false;
        return whole(kMrcMode) >= 0 && whole(kMrcMode) <= 200;
    }
};

// Finds the byte order: by the machine stamp, unless the numbers make sense in the other order alone.
std::optional<MrcHeader> mrc_header(const std::string& path, std::vector<std::string>& notes) {
    MrcHeader header;
    header.bytes = first_unpacked_bytes(path, kMrcHeader);
    if (header.bytes.size() < kMrcHeader) return std::nullopt;
    const bool is_big = header.bytes[kMrcMachst] == 0x11, is_little = header.bytes[kMrcMachst] == 0x44;
    header.swapped = is_big != (std::endian::native == std::endian::big);
    if (header.is_plausible()) return header;
    header.swapped = !header.swapped;
    if (!header.is_plausible()) return std::nullopt;
    if (is_big || is_little)
        notes.emplace_back("The machine stamp contradicts the header's numbers: the other byte order is used.");
    return header;
}

// Steps along the axes a, b, c of the cell, and where they come from; Angstrom.
struct MrcCell {
    glm::dmat3 steps{1};
    bool is_known = true;
};

// mapc, mapr, maps: the axis of the cell, from 0, along which columns, rows and sections follow each other.
std::array<int, 3> mrc_order(const MrcHeader& header, Volume& volume) {
    std::array<int, 3> order{};
    int seen = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        order[axis] = header.whole(kMrcMap, axis) - 1;
        seen |= 1 << std::max(order[axis] + 1, 0);
    }
    if (seen == 1) {
        volume.notes.emplace_back("mapc, mapr and maps are 0: columns, rows and sections are taken for x, y and z.");
        return {0, 1, 2};
    }
    if (seen != 0b1110)
        fail("{}: mapc, mapr, maps in its header: {} {} {}, expected 1, 2 and 3 in some order", volume.name,
             order[0] + 1, order[1] + 1, order[2] + 1);
    return order;
}

MrcCell mrc_cell(const MrcHeader& header, const std::array<int, 3>& order, const LoadOptions& options, Volume& volume) {
    MrcCell cell;
    glm::dvec3 lengths(0), angles(90);
    int zeros = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        const double length = header.real(kMrcCell, index), angle = header.real(kMrcAngles, index);
        const int samples = header.whole(kMrcM, index);
        if (!(length >= 0 && length < 1e15))
            fail("{}: cella.{} in its header: {}, expected a length in Angstrom", volume.name, "xyz"[axis], length);
        if (samples < 0) fail("{}: m{} in its header: {}, expected at least 1", volume.name, "xyz"[axis], samples);
        if (!(angle >= 0 && angle < 180))
            fail("{}: cellb.{} in its header: {}, expected an angle above 0 and below 180 degrees", volume.name,
                 std::array{"alpha", "beta", "gamma"}[index], angle);
        if (angle != 0) angles[axis] = angle;  // some writers leave them 0
        if (length == 0 || samples == 0)
            ++zeros;
        else
            lengths[axis] = length / samples;
    }
    // The thickness of a single slice is often left 0.
    for (int axis = 0; zeros > 0 && axis < 3; ++axis) {
        const double known = std::max({lengths.x, lengths.y, lengths.z});
        if (lengths[order[static_cast<std::size_t>(axis)]] > 0 || volume.geometry.dims[axis] > 1 || known == 0)
            continue;
        lengths[order[static_cast<std::size_t>(axis)]] = known;
        --zeros;
    }
    if (zeros > 0 && zeros < 3 && !options.spacing)
        fail("{}: cella {} {} {} and m {} {} {} in its header give an axis without length; give --spacing", volume.name,
             header.real(kMrcCell, 0), header.real(kMrcCell, 1), header.real(kMrcCell, 2), header.whole(kMrcM, 0),
             header.whole(kMrcM, 1), header.whole(kMrcM, 2));
    if (zeros > 0) {
        lengths = glm::dvec3(1);
        cell.is_known = false;
    }
    const glm::dvec3 radians = angles * (std::numbers::pi / 180);
    const auto cosine = [&](int axis) { return angles[axis] == 90 ? 0.0 : std::cos(radians[axis]); };
    const double sine = angles[2] == 90 ? 1.0 : std::sin(radians[2]);
    // a along x, b in the plane of x and y.
    glm::dvec3 c(cosine(1), (cosine(0) - cosine(1) * cosine(2)) / sine, 0);
    const double rest = 1 - c.x * c.x - c.y * c.y;
    if (!(rest > 1e-6))
        fail("{}: cellb {} {} {} in its header: these angles make no cell", volume.name, angles.x, angles.y, angles.z);
    c.z = std::sqrt(rest);
    cell.steps = glm::dmat3(glm::dvec3(1, 0, 0) * lengths.x, glm::dvec3(cosine(2), sine, 0) * lengths.y, c * lengths.z);
    return cell;
}

void set_mrc_place(const MrcHeader& header, const LoadOptions& options, Volume& volume) {
    const auto order = mrc_order(header, volume);
    const MrcCell cell = mrc_cell(header, order, options, volume);
    glm::dmat3 axes(1);
    glm::dvec3 start(0), origin(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        axes[axis] = cell.steps[order[index]];
        start += axes[axis] * static_cast<double>(header.whole(kMrcStart, index));
        origin[axis] = header.real(kMrcOrigin, index);
        // Files without signature have other data there.
        if (header.bytes.compare(kMrcSignature, 3, "MAP") != 0) origin[axis] = 0;
        if (!(std::abs(origin[axis]) < 1e15))
            fail("{}: origin.{} in its header: {}, expected a length in Angstrom", volume.name, "xyz"[axis],
                 origin[axis]);
    }
    // IMOD stores the place of 0 relative to the first voxel, unless this flag is set.
    if (header.is_imod() && (header.imod_flags() & 4) == 0) origin = -origin;
    const bool uses_origin = origin != glm::dvec3(0);
    if (uses_origin && start != glm::dvec3(0) && glm::length(origin - start) > 0.1 * glm::length(axes[0]))
        volume.notes.push_back(
            fmt::format("The header has two places of the first voxel: origin ({:.6g}, {:.6g}, {:.6g}) is used, not "
                        "nxstart, nystart, nzstart ({:.6g}, {:.6g}, {:.6g}); Angstrom.",
                        origin.x, origin.y, origin.z, start.x, start.y, start.z));
    std::string source = cell.is_known ? "cella" : "none: 1 Angstrom assumed";
    if (uses_origin) source += cell.is_known ? " and origin" : ", origin";
    if (!uses_origin && start != glm::dvec3(0)) source += cell.is_known ? " and nxstart" : ", nxstart";
    volume.length_unit = "Angstrom";
    constexpr double kAngstrom = 1e-7;  // mm
    set_place(volume, axes, uses_origin ? origin : start, kAngstrom, source);
    if (!cell.is_known && !options.spacing)
        volume.warnings.emplace_back(
            "The header has no cell (cella or mx is 0): voxels of 1 Angstrom are assumed; give --spacing.");
}

// Whether the bytes of mode 0 are unsigned. MRC2014 says signed, older files are mostly unsigned.
bool has_unsigned_bytes(const MrcHeader& header, Volume& volume) {
    if (header.is_imod()) return (header.imod_flags() & 1) == 0;
    const double low = header.real(kMrcDmin), high = header.real(kMrcDmax);
    if (!(low >= 0 && high > 127 && high <= 255)) return false;
    volume.notes.push_back(
        fmt::format("Mode 0 is read as unsigned bytes: the header says {} to {} (dmin, dmax).", low, high));
    return true;
}

// Samples that are no type of C++ become one that is.
std::vector<char> unpacked(const MrcHeader& header, int mode, const glm::ivec3& dims, std::vector<char> data) {
    if (mode == 12) {
        std::vector<float> values(data.size() / 2);
        for (std::size_t i = 0; i < values.size(); ++i) {
            const auto at = [&](std::size_t byte) { return static_cast<unsigned char>(data[2 * i + byte]); };
            const bool is_big = header.swapped == (std::endian::native == std::endian::little);
            values[i] = float_of_half(static_cast<std::uint16_t>(is_big ? at(0) << 8 | at(1) : at(1) << 8 | at(0)));
        }
        data.resize(values.size() * sizeof(float));
        std::memcpy(data.data(), values.data(), data.size());
    } else if (mode == 101) {  // the first of two in the low half; every row begins with a new byte
        const auto columns = static_cast<std::size_t>(dims.x), row_bytes = (columns + 1) / 2;
        std::vector<char> values;
        values.reserve(data.size() * 2);
        for (std::size_t row = 0; row < data.size() / row_bytes; ++row)
            for (std::size_t x = 0; x < columns; ++x) {
                const auto byte = static_cast<unsigned char>(data[row * row_bytes + x / 2]);
                values.push_back(static_cast<char>(x % 2 == 0 ? byte & 15 : byte >> 4));
            }
        data = std::move(values);
    }
    return data;
}

const MrcMode& mrc_mode(const std::string& path, int code) {
    for (const MrcMode& mode : kMrcModes)
        if (mode.code == code) return mode;
    if (code == 3 || code == 4) fail("{}: mode {} in its header: a Fourier transform, not a map", path, code);
    fail("{}: mode {} in its header, expected 0, 1, 2, 6, 12, 16 or 101", path, code);
}

}  // namespace

bool is_mrc(const std::string& path) {
    const std::string head = first_unpacked_bytes(path, kMrcHeader);
    return head.size() == kMrcHeader && head.compare(kMrcSignature, 3, "MAP") == 0;
}

Volume load_mrc(const std::string& path, const LoadOptions& options) {
    Volume volume;
    volume.name = path;
    const auto found = mrc_header(path, volume.notes);
    if (!found)
        fail(
            "{}: not an MRC or CCP4 map: nx, ny, nz, mode, mapc, mapr, maps in its header are out of range, or the "
            "file is shorter than 1024 bytes",
            path);
    const MrcHeader& header = *found;
    const MrcMode& mode = mrc_mode(path, header.whole(kMrcMode));
    if ((header.imod_flags() & 16) != 0 && mode.code == 0)
        fail("{}: imodFlags {} in its header: bytes of two samples are read in mode 101 only", path,
             header.imod_flags());
    std::vector<std::size_t> dims;
    for (std::size_t axis = 0; axis < 3; ++axis)
        dims.push_back(static_cast<std::size_t>(header.whole(kMrcN, axis)));

    // Space groups 401 to 630: a stack of volumes of mz sections each.
    std::size_t frames = 1;
    const int group = header.whole(kMrcIspg);
    if (group >= 401 && group <= 630) {
        const int sections = header.whole(kMrcM, 2);
        if (sections < 1 || dims[2] % static_cast<std::size_t>(sections) != 0)
            fail("{}: ispg {} in its header: a stack of volumes, but nz {} is no multiple of mz {}", path, group,
                 dims[2], sections);
        frames = dims[2] / static_cast<std::size_t>(sections);
        dims[2] = static_cast<std::size_t>(sections);
    } else if (group == 0 && dims[2] > 1) {
        volume.notes.emplace_back(
            "ispg is 0: a stack of images by MRC2014, although many programs write it for volumes; read as a volume.");
    }
    const std::size_t frame = chosen_frame(path, options, frames);
    const std::size_t component = chosen_component(path, options, mode.components);
    const std::size_t item = mode.code == 12 ? 4 : size_of(mode.sample) * mode.components;  // unpacked
    const std::size_t voxels = checked_bytes(path, dims, item) / item;
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    volume.stored_type = mode.name;
    set_mrc_place(header, options, volume);

    const int extended = header.whole(kMrcNsymbt);
    if (extended < 0) fail("{}: nsymbt in its header: {} bytes, expected at least 0", path, extended);
    const std::size_t bytes =
        mode.code == 101 ? (dims[0] + 1) / 2 * dims[1] * dims[2] : voxels * size_of(mode.sample) * mode.components;
    const auto data = unpacked(
        header, mode.code, volume.geometry.dims,
        read_block({.path = path,
                    .file = path,
                    .offset = block_offset(path, kMrcHeader + static_cast<std::size_t>(extended), frame, bytes),
                    .bytes = bytes,
                    .after = (frames - 1 - frame) * bytes},
                   options, volume.notes));
    StoredSamples stored{
        .type = mode.sample, .data = data.data() + component, .stride = mode.components, .swapped = header.swapped};
    if (mode.code == 0 && has_unsigned_bytes(header, volume)) {
        stored.type = SampleType::UInt8;
        volume.stored_type = "uint8";
    }
    if (mode.code == 12) {
        stored.type = SampleType::Float32;
        stored.swapped = false;
    }
    report(options, 0.7, "converting voxels");
    take_samples(stored, volume);
    return volume;
}

}  // namespace edgesplat::detail
