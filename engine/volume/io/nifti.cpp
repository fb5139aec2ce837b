// Reads NIfTI-1, NIfTI-2 and Analyze 7.5.
#include <cmath>
#include <optional>

#include "engine/volume/io/binary_file.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

// Byte offsets of the fields, named as in nifti1.h and nifti2.h.
struct NiftiLayout {
    std::size_t header_size, dim, intent_code, datatype, bitpix, vox_offset, scl_slope, scl_inter, pixdim, qform_code,
        sform_code, quatern_b, srow_x, magic;
    bool wide;  // 64-bit offset, scale and places, 32-bit codes (NIfTI-2)
};
constexpr NiftiLayout kNifti1{348, 40, 68, 70, 72, 108, 112, 116, 76, 252, 254, 256, 280, 344, false};
constexpr NiftiLayout kNifti2{540, 16, 504, 12, 14, 168, 176, 184, 104, 344, 348, 352, 400, 4, true};

struct NiftiType {
    int code;
    const char* name;
    SampleType sample;
    std::size_t components;
    bool is_color = false;
};
constexpr std::array kNiftiTypes{
    NiftiType{2, "uint8", SampleType::UInt8, 1},           NiftiType{4, "int16", SampleType::Int16, 1},
    NiftiType{8, "int32", SampleType::Int32, 1},           NiftiType{16, "float32", SampleType::Float32, 1},
    NiftiType{32, "complex64", SampleType::Float32, 2},    NiftiType{64, "float64", SampleType::Float64, 1},
    NiftiType{128, "rgb24", SampleType::UInt8, 3, true},   NiftiType{256, "int8", SampleType::Int8, 1},
    NiftiType{512, "uint16", SampleType::UInt16, 1},       NiftiType{768, "uint32", SampleType::UInt32, 1},
    NiftiType{1024, "int64", SampleType::Int64, 1},        NiftiType{1280, "uint64", SampleType::UInt64, 1},
    NiftiType{1792, "complex128", SampleType::Float64, 2}, NiftiType{2304, "rgba32", SampleType::UInt8, 4, true}};

const NiftiType& nifti_type(const std::string& path, int datatype) {
    for (const NiftiType& type : kNiftiTypes)
        if (type.code == datatype) return type;
    const char* reason = "expected a datatype of nifti1.h";
    if (datatype == 0) reason = "the type of the voxels is unknown";
    if (datatype == 1) reason = "voxels of 1 bit are not read";
    if (datatype == 1536 || datatype == 2048) reason = "its 16 bytes per number differ from machine to machine";
    fail("{}: datatype {} in its header: {}", path, datatype, reason);
}

struct NiftiHeader : BinaryHeader {
    const NiftiLayout* layout = nullptr;
    bool analyze = false;
    bool single_file = false;  // the voxels follow the header
    std::array<std::int64_t, 8> dim{};

    // Fields whose size depends on the version.
    double real(std::size_t at, std::size_t index = 0) const {
        return layout->wide ? get<double>(at + 8 * index) : static_cast<double>(get<float>(at + 4 * index));
    }
    std::int64_t code(std::size_t at) const { return layout->wide ? get<std::int32_t>(at) : get<std::int16_t>(at); }
    std::size_t voxels_along(std::size_t axis) const { return static_cast<std::size_t>(dim[axis]); }
    int units() const { return layout->wide ? get<std::int32_t>(500) : get<std::uint8_t>(123); }
};

// Position of voxels in the file's unit: right, anterior, superior, or along the stored axes if there is no code.
struct NiftiPlace {
    glm::dmat3 axes{1};
    glm::dvec3 origin{0};
    std::string source;
    std::string problem;  // why it cannot be used
};

NiftiPlace sform_of(const NiftiHeader& header) {
    NiftiPlace place;
    place.source = fmt::format("sform (code {})", header.code(header.layout->sform_code));
    double product = 1;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const double value = header.real(header.layout->srow_x, static_cast<std::size_t>(4 * row + column));
            (column < 3 ? place.axes[column] : place.origin)[row] = value;
            if (!(std::abs(value) < 1e15))
                place.problem =
                    fmt::format("srow_{}[{}] in its header: {}, expected a length", "xyz"[row], column, value);
        }
    for (int axis = 0; axis < 3; ++axis)
        product *= glm::length(place.axes[axis]);
    if (place.problem.empty() && !(std::abs(glm::determinant(place.axes)) > 1e-6 * product))
        place.problem =
            "srow_x, srow_y, srow_z in its header: the three axes lie in one plane, expected a matrix "
            "with an inverse";
    return place;
}

// The lengths of a voxel. A zero along an axis of one voxel is 1.
glm::dvec3 pixdim_of(const NiftiHeader& header, bool is_replaced, NiftiPlace& place) {
    glm::dvec3 lengths(1);
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis + 1);
        const double value = header.real(header.layout->pixdim, index);
        if (value != 0 && std::abs(value) < 1e15)
            lengths[axis] = std::abs(value);
        else if (!is_replaced && !(value == 0 && header.dim[index] == 1))
            place.problem =
                fmt::format("pixdim[{}] in its header: {}, expected a length above 0; give --spacing", index, value);
    }
    return lengths;
}

NiftiPlace qform_of(const NiftiHeader& header, bool is_replaced) {
    NiftiPlace place;
    place.source = fmt::format("qform (code {})", header.code(header.layout->qform_code));
    glm::dvec3 lengths = pixdim_of(header, is_replaced, place);
    std::array<double, 6> q{};
    for (std::size_t i = 0; i < q.size(); ++i) {
        q[i] = header.real(header.layout->quatern_b, i);
        if (!(std::abs(q[i]) < 1e15))
            place.problem = fmt::format(
                "{} in its header: {}, expected a number",
                std::array{"quatern_b", "quatern_c", "quatern_d", "qoffset_x", "qoffset_y", "qoffset_z"}[i], q[i]);
    }
    const double qfac = header.real(header.layout->pixdim);
    if (std::isnan(qfac)) place.problem = "pixdim[0] (qfac) in its header: nan, expected -1 or 1";
    glm::dvec3 v(q[0], q[1], q[2]);
    const double rest = 1 - glm::dot(v, v);
    // The fields are rounded: of a rotation by 180 degrees the square sum may exceed 1.
    if (rest < -1e-4)
        place.problem = fmt::format(
            "quatern_b, quatern_c, quatern_d in its header: {} {} {}, expected a sum of squares of at most 1", v.x, v.y,
            v.z);
    if (!place.problem.empty()) return place;
    if (rest < 0) v = glm::normalize(v);
    const double a = std::sqrt(std::max(rest, 0.0)), b = v.x, c = v.y, d = v.z;
    if (qfac < 0) lengths.z = -lengths.z;
    place.axes[0] = glm::dvec3(a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)) * lengths.x;
    place.axes[1] = glm::dvec3(2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)) * lengths.y;
    place.axes[2] = glm::dvec3(2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c) * lengths.z;
    place.origin = {q[3], q[4], q[5]};
    return place;
}

// SPM stores the origin, as a voxel numbered from 1, where Analyze 7.5 has free text. The bounds are SPM's own.
std::optional<glm::dvec3> spm_origin(const NiftiHeader& header) {
    constexpr std::size_t kOriginator = 253;
    glm::dvec3 voxel(0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto index = static_cast<std::size_t>(axis);
        const int value = header.get<std::int16_t>(kOriginator + 2 * index);
        if (value <= -header.dim[index + 1] || value >= 2 * header.dim[index + 1]) return std::nullopt;
        voxel[axis] = value;
    }
    if (voxel == glm::dvec3(0)) return std::nullopt;
    return voxel - 1.0;
}

NiftiPlace place_without_code(const NiftiHeader& header, bool is_replaced) {
    NiftiPlace place;
    place.source = header.analyze ? "pixdim (Analyze has no orientation)" : "pixdim (sform and qform code 0)";
    const glm::dvec3 lengths = pixdim_of(header, is_replaced, place);
    for (int axis = 0; axis < 3; ++axis)
        place.axes[axis][axis] = lengths[axis];
    if (const auto voxel = spm_origin(header); header.analyze && voxel) {
        place.origin = -(*voxel * lengths);
        place.source = "pixdim and originator (Analyze has no orientation)";
    }
    return place;
}

// The largest distance between a corner's two positions.
double corner_distance(const NiftiPlace& one, const NiftiPlace& other, const glm::ivec3& dims) {
    double most = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 index((corner & 1) * (dims.x - 1), (corner >> 1 & 1) * (dims.y - 1),
                               (corner >> 2) * (dims.z - 1));
        most = std::max(most, glm::length(one.axes * index + one.origin - other.axes * index - other.origin));
    }
    return most;
}

void set_nifti_place(const NiftiHeader& header, const LoadOptions& options, Volume& volume) {
    const NiftiLayout& at = *header.layout;
    const std::string& path = volume.name;
    const bool is_replaced = options.spacing.has_value();
    const bool has_sform = !header.analyze && header.code(at.sform_code) > 0;
    const bool has_qform = !header.analyze && header.code(at.qform_code) > 0;

    double millimetres = 1;
    if (header.analyze) {
        std::string unit = header.bytes.substr(56, 4);  // vox_units, up to its 0
        unit.resize(std::min(unit.find('\0'), unit.size()));
        if (const auto known = millimetres_in(unit)) {
            volume.length_unit = trimmed(unit);
            millimetres = *known;
        }
    } else {
        constexpr std::array<const char*, 4> kNames{"", "m", "mm", "um"};
        constexpr std::array<double, 4> kMillimetres{1, 1e3, 1, 1e-3};
        const auto unit = static_cast<std::size_t>(header.units() & 7);
        if (unit < kNames.size()) {
            volume.length_unit = kNames[unit];
            millimetres = kMillimetres[unit];
        } else {
            volume.warnings.push_back(
                fmt::format("xyzt_units {}: no unit of length is defined for it; mm are assumed.", unit));
        }
    }

    NiftiPlace place = has_sform   ? sform_of(header)
                       : has_qform ? qform_of(header, is_replaced)
                                   : place_without_code(header, is_replaced);
    if (!place.problem.empty()) fail("{}: {}", path, place.problem);
    if (has_sform && has_qform) {
        const NiftiPlace other = qform_of(header, false);
        const double apart = corner_distance(place, other, volume.geometry.dims) * millimetres;
        const double voxel = std::cbrt(std::abs(glm::determinant(place.axes))) * millimetres;
        if (!other.problem.empty())
            volume.notes.push_back(fmt::format("{} is used; the qform is not valid: {}.", place.source, other.problem));
        else if (apart > 0.1 * voxel)
            volume.notes.push_back(fmt::format("{} is used; {} puts a corner of the volume up to {:.4g} mm elsewhere.",
                                               place.source, other.source, apart));
    }
    // Of a file with an sform alone, pixdim should be the lengths of its steps.
    for (int axis = 0; has_sform && !has_qform && axis < 3; ++axis) {
        const double stated = header.real(at.pixdim, static_cast<std::size_t>(axis + 1));
        const double length = glm::length(place.axes[axis]);
        if (stated > 0 && std::abs(stated - length) > 0.01 * length)
            volume.notes.push_back(
                fmt::format("{} is used: its steps along axis {} are {:.6g} long, pixdim says {:.6g}.", place.source,
                            axis, length, stated));
    }
    if (!has_sform)
        for (std::size_t axis = 1; axis <= 3; ++axis)
            if (const double value = header.real(at.pixdim, axis); value < 0)
                volume.warnings.push_back(
                    fmt::format("pixdim[{}] is {}: a length has no sign; its absolute value is used.", axis, value));

    volume.in_patient = has_sform || has_qform;
    if (volume.in_patient) {  // from right-anterior-superior to left-posterior-superior
        const glm::dmat3 flip(-1, 0, 0, 0, -1, 0, 0, 0, 1);
        place.axes = flip * place.axes;
        place.origin = flip * place.origin;
    } else {
        volume.notes.emplace_back(
            header.analyze ? "Analyze files do not define which side is left: the axes are used as stored."
                           : "sform_code and qform_code are 0: which side is left is not defined, and the axes are "
                             "used as stored.");
    }
    set_place(volume, place.axes, place.origin, millimetres, place.source);
}

void read_dims(const std::string& path, NiftiHeader& header) {
    const NiftiLayout& at = *header.layout;
    auto& dim = header.dim;
    for (std::size_t axis = 0; axis < 8; ++axis)
        dim[axis] = at.wide ? header.get<std::int64_t>(at.dim + axis * 8) : header.get<std::int16_t>(at.dim + axis * 2);
    if (dim[0] < 1 || dim[0] > 7) fail("{}: its header says {} axes (dim[0]), expected 1 to 7", path, dim[0]);
    if (dim[1] == -1) fail("{}: dim[1] = -1 in its header: FreeSurfer's data on a surface, not on a grid", path);
    if (dim[0] == 1) fail("{}: its data have 1 axis; a volume needs 3, or 2 for a single slice", path);
    for (std::size_t axis = 1; axis < 8; ++axis) {
        if (static_cast<std::int64_t>(axis) > dim[0]) dim[axis] = 1;
        if (axis > 3 && dim[axis] == 0) dim[axis] = 1;  // some Analyze writers leave them 0
        if (dim[axis] < 1 || dim[axis] > std::numeric_limits<std::int32_t>::max())
            fail("{}: its header says dim[{}] = {}, expected at least 1", path, axis, dim[axis]);
    }
}

NiftiHeader nifti_header(const std::string& path, const std::string& header_file) {
    NiftiHeader header;
    header.bytes.resize(kNifti2.header_size);
    header.bytes.resize(PlainOrGzip(path, header_file).read(header.bytes.data(), header.bytes.size()));
    if (header.bytes.size() < kNifti1.header_size)
        fail("{}: {} bytes are too few for a NIfTI or Analyze header (348)", path, header.bytes.size());
    for (const bool swapped : {true, false}) {
        header.swapped = swapped;
        const auto size = header.get<std::int32_t>(0);
        if (size == 348) header.layout = &kNifti1;
        if (size == 540 && header.bytes.size() == kNifti2.header_size) header.layout = &kNifti2;
        if (header.layout != nullptr) break;
    }
    if (header.layout == nullptr)
        fail("{}: not a NIfTI or Analyze file: its header begins with neither 348 nor 540", path);
    const NiftiLayout& at = *header.layout;
    const std::string magic = header.bytes.substr(at.magic, at.wide ? 8 : 3);
    const std::string version = at.wide ? std::string("2\0\r\n\x1a\n", 6) : "1";
    header.single_file = magic == "n+" + version;
    const bool is_pair = magic == "ni" + version;
    header.analyze = !at.wide && magic[0] != 'n';
    if (!header.single_file && !is_pair && !header.analyze)
        fail("{}: the magic of its header ({} bytes) is neither n+{} nor ni{}: not a NIfTI file, or damaged", path,
             at.header_size, version[0], version[0]);
    if (const auto code = header.code(at.intent_code); !header.analyze && code >= 3000 && code < 3100)
        fail("{}: intent_code {} in its header: a CIFTI matrix, not a volume", path, code);
    read_dims(path, header);
    return header;
}

bool has_ending(const std::string& path, const std::string& ending) {
    std::string end = path.substr(path.size() - std::min(path.size(), ending.size()));
    std::ranges::transform(end, end.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return end == ending;
}

// "x.hdr.gz", "x.HDR" -> the existing one of "x.img", "x.img.gz", "x.IMG", ...
std::string partner(const std::string& path, const std::string& ending) {
    const std::string stem = path.substr(0, path.size() - (has_ending(path, ".gz") ? 7 : 4));
    std::string upper = ending;
    std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    for (const std::string& name : {stem + ending, stem + ending + ".gz", stem + upper, stem + upper + ".GZ"})
        if (fs::is_regular_file(name)) return name;
    fail("{}: its second file {}{} (or {}{}.gz) is missing", path, stem, ending, stem, ending);
}

bool is_named_as(const std::string& path, const std::string& ending) {
    return has_ending(path, ending) || has_ending(path, ending + ".gz");
}

// Where the voxels begin. Some writers leave vox_offset 0, or forget the 4 bytes that say whether extensions follow:
// then the file's size must tell. `bytes`: of all voxels.
std::size_t voxel_offset(const NiftiHeader& header, const std::string& file, std::size_t bytes, Volume& volume) {
    const NiftiLayout& at = *header.layout;
    const std::string& path = volume.name;
    const double offset =
        at.wide ? static_cast<double>(header.get<std::int64_t>(at.vox_offset)) : header.real(at.vox_offset);
    if (!(offset >= 0 && offset < 1e15) || offset != std::floor(offset))
        fail("{}: vox_offset {} in its header: expected a whole number of bytes", path, offset);
    const auto stated = static_cast<std::size_t>(offset);
    const std::size_t least = at.header_size + 4;
    if (!header.single_file || stated >= least) return stated;
    if (stated != 0 && stated != at.header_size)
        fail("{}: vox_offset {} in its header points into the header, expected at least {}", path, stated, least);
    const std::size_t size = PlainOrGzip(path, file).read_rest();
    for (const std::size_t begin : {least, at.header_size})
        if (size - std::min(size, begin) == bytes) {
            volume.notes.push_back(fmt::format(
                "vox_offset is {}; the voxels begin at byte {}, as the size of the file says.", stated, begin));
            return begin;
        }
    fail("{}: vox_offset {} in its header points into the header, expected at least {}; its {} bytes are not {} + {}",
         path, stated, least, size, least, bytes);
}

// Scale of the samples; SPM stores it in a field that Analyze 7.5 leaves free.
void set_nifti_scale(const NiftiHeader& header, StoredSamples& stored, Volume& volume) {
    const double slope = header.real(header.layout->scl_slope), intercept = header.real(header.layout->scl_inter);
    if (!std::isfinite(slope) || slope == 0) return;
    if (header.analyze) {
        if (slope == 1 || std::abs(slope) < 1e-30 || std::abs(slope) > 1e30) return;
        stored.slope = slope;
        volume.notes.push_back(fmt::format("Values are multiplied by {}, the scale of SPM's Analyze files.", slope));
        return;
    }
    if (!std::isfinite(intercept))
        fail("{}: scl_inter in its header: {} with scl_slope {}, expected a number", volume.name, intercept, slope);
    stored.slope = slope;
    stored.intercept = intercept;
}

}  // namespace

bool is_nifti(const std::string& path) {
    using namespace std::string_view_literals;
    const std::string bytes = first_unpacked_bytes(path, kNifti1.header_size);
    if (bytes.size() < kNifti1.header_size) return false;
    const std::string_view head = bytes, size = head.substr(0, 4);
    const std::string_view one = head.substr(kNifti1.magic, 3), two = head.substr(kNifti2.magic, 3);
    if (size == "\x5c\1\0\0"sv || size == "\0\0\1\x5c"sv) return one == "n+1" || one == "ni1";
    return (size == "\x1c\2\0\0"sv || size == "\0\0\2\x1c"sv) && (two == "n+2" || two == "ni2");
}

Volume load_nifti(const std::string& path, const LoadOptions& options) {
    std::string header_file = path, data_file = path;
    if (is_named_as(path, ".img")) header_file = partner(path, ".hdr");
    if (is_named_as(path, ".hdr")) data_file = partner(path, ".img");
    NiftiHeader header = nifti_header(path, header_file);
    if (header.single_file) data_file = header_file;
    if (!header.single_file && data_file == header_file) {
        if (header.analyze) fail("{}: an Analyze header without voxels; expected a pair .hdr and .img", path);
        header.single_file = true;  // "ni1" in a file that is no .hdr
    }

    Volume volume;
    volume.name = path;
    const NiftiType& type = nifti_type(path, header.get<std::int16_t>(header.layout->datatype));
    volume.stored_type = type.name;
    const auto along = [&](std::size_t axis) { return header.voxels_along(axis); };
    const std::size_t voxel_bytes = type.components * size_of(type.sample);
    const std::size_t bytes = checked_bytes(path, {along(1), along(2), along(3)}, voxel_bytes);
    volume.geometry.dims = glm::ivec3(header.dim[1], header.dim[2], header.dim[3]);
    if (header.dim[0] == 2)
        volume.notes.emplace_back("The file holds a 2-D image: it is read as a volume of one slice.");
    const int bitpix = header.get<std::int16_t>(header.layout->bitpix);
    if (bitpix != 0 && static_cast<std::size_t>(bitpix) != 8 * voxel_bytes)
        volume.notes.push_back(
            fmt::format("bitpix {} contradicts datatype {} ({}), which is used.", bitpix, type.code, type.name));
    set_nifti_place(header, options, volume);

    // Axis 5 is components, as are the parts of colours and complex numbers. The other axes are frames.
    std::size_t frames = 1, blocks = 1;
    for (const std::size_t axis : {4, 5, 6, 7})
        if (__builtin_mul_overflow(blocks, along(axis), &blocks) || blocks > std::size_t{1} << 40)
            fail("{}: dim[4] to dim[7] in its header: {} {} {} {}, more than 2^40 blocks", path, along(4), along(5),
                 along(6), along(7));
    frames = blocks / along(5);
    const std::size_t component = chosen_component(path, options, along(5) * type.components);
    const std::size_t frame = chosen_frame(path, options, frames);
    const std::size_t index =
        frame % along(4) + along(4) * (component / type.components + along(5) * (frame / along(4)));
    const std::size_t all = block_offset(path, 0, blocks, bytes);

    const std::size_t first = voxel_offset(header, data_file, all, volume);
    const auto data = read_block({.path = path,
                                  .file = data_file,
                                  .offset = block_offset(path, first, index, bytes),
                                  .bytes = bytes,
                                  .after = (blocks - 1 - index) * bytes},
                                 options, volume.notes);
    StoredSamples stored{.type = type.sample,
                         .data = data.data() + component % type.components * size_of(type.sample),
                         .stride = type.components,
                         .swapped = header.swapped};
    if (!type.is_color) set_nifti_scale(header, stored, volume);
    report(options, 0.7, "converting voxels");
    take_samples(stored, volume);
    return volume;
}

}  // namespace edgesplat::detail
