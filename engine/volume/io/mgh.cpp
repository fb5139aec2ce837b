// Reads FreeSurfer's MGH and its gzip form MGZ. All numbers are big-endian.
#include <cmath>

#include "engine/volume/io/binary_file.h"

namespace edgesplat::detail {
namespace {

constexpr std::size_t kMghData = 284;  // bytes before the samples
// Byte offsets of the fields.
constexpr std::size_t kMghDims = 4, kMghType = 20, kMghGood = 28, kMghDelta = 30, kMghAxes = 42, kMghCenter = 78;

BinaryHeader mgh_header(const std::string& path) {
    return {.bytes = first_unpacked_bytes(path, kMghData), .swapped = std::endian::native == std::endian::little};
}

SampleType mgh_type(const std::string& path, int type) {
    switch (type) {
        case 0:
            return SampleType::UInt8;
        case 1:
            return SampleType::Int32;
        case 3:
            return SampleType::Float32;
        case 4:
            return SampleType::Int16;
        case 10:
            return SampleType::UInt16;
        default:
            fail("{}: type {} in its header: expected 0 (uchar), 1 (int), 3 (float), 4 (short) or 10 (ushort)", path,
                 type);
    }
}

void set_mgh_place(const BinaryHeader& header, const LoadOptions& options, Volume& volume) {
    // FreeSurfer's place of files without one: coronal slices of 1 mm around 0.
    glm::dvec3 spacing(1), center(0);
    glm::dmat3 directions(glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0));
    const bool is_good = header.get<std::int16_t>(kMghGood) > 0;
    for (int axis = 0; is_good && axis < 3; ++axis) {
        const auto number = [&](std::size_t at) {
            const float value = header.get<float>(at);
            if (!(std::abs(value) < 1e15F))
                fail("{}: the geometry in its header, at byte {}: {}, expected a number", volume.name, at, value);
            return static_cast<double>(value);
        };
        const auto index = static_cast<std::size_t>(axis);
        spacing[axis] = number(kMghDelta + 4 * index);
        center[axis] = number(kMghCenter + 4 * index);
        for (std::size_t row = 0; row < 3; ++row)
            directions[axis][static_cast<int>(row)] = number(kMghAxes + 12 * index + 4 * row);
        if (!(spacing[axis] > 0)) {
            if (!options.spacing)
                fail("{}: spacing {} of axis {} in its header: expected a length above 0 mm; give --spacing",
                     volume.name, spacing[axis], axis);
            spacing[axis] = 1;
        }
    }
    if (!(std::abs(glm::determinant(directions)) > 1e-6))
        fail("{}: the directions in its header (Mdc): three axes in one plane", volume.name);
    // From right-anterior-superior to left-posterior-superior.
    const glm::dmat3 flip(-1, 0, 0, 0, -1, 0, 0, 0, 1);
    glm::dmat3 axes = flip * directions;
    for (int axis = 0; axis < 3; ++axis)
        axes[axis] *= spacing[axis];
    // The centre is that of voxel dims / 2, which for even dims lies half a voxel beside the volume's.
    const glm::dvec3 origin = flip * center - axes * (glm::dvec3(volume.geometry.dims) / 2.0);
    volume.in_patient = is_good;
    volume.length_unit = is_good ? "mm" : "";
    set_place(volume, axes, origin, 1, is_good ? "Mdc and c_ras (goodRASFlag 1)" : "none: 1 mm assumed");
    if (!is_good)
        volume.warnings.emplace_back(
            "goodRASFlag is 0: the file has no place; coronal slices of 1 mm are assumed, as FreeSurfer does.");
}

}  // namespace

bool is_mgh(const std::string& path) {
    const BinaryHeader header = mgh_header(path);
    if (header.bytes.size() < kMghData) return false;
    // Newer versions of FreeSurfer store an intent above the version.
    const auto version = header.get<std::uint32_t>(0);
    if ((version & 0xffU) != 1 || version > 0xffff || header.get<std::uint32_t>(kMghType) > 10) return false;
    for (std::size_t axis = 0; axis < 4; ++axis)
        if (header.get<std::int32_t>(kMghDims + 4 * axis) < 1) return false;
    return header.get<std::uint16_t>(kMghGood) <= 1;
}

Volume load_mgh(const std::string& path, const LoadOptions& options) {
    const BinaryHeader header = mgh_header(path);
    if (header.bytes.size() < kMghData)
        fail("{}: {} bytes are too few for an MGH header ({})", path, header.bytes.size(), kMghData);
    if (const auto version = header.get<std::uint32_t>(0); (version & 0xffU) != 1 || version > 0xffff)
        fail("{}: not an MGH file: version {}, expected 1", path, version);
    std::vector<std::size_t> dims;
    for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto side = header.get<std::int32_t>(kMghDims + 4 * axis);
        if (side < 1)
            fail("{}: {} {} in its header, expected at least 1", path,
                 std::array{"width", "height", "depth", "nframes"}[axis], side);
        dims.push_back(static_cast<std::size_t>(side));
    }
    const SampleType type = mgh_type(path, header.get<std::int32_t>(kMghType));
    const std::size_t frames = dims[3];
    dims.pop_back();
    const std::size_t bytes = checked_bytes(path, dims, size_of(type));
    const std::size_t frame = chosen_frame(path, options, frames);
    Volume volume;
    volume.name = path;
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    set_mgh_place(header, options, volume);
    // Scan parameters and tags follow the last frame.
    std::vector<std::string> ignored;
    const auto data =
        read_block({.path = path, .file = path, .offset = block_offset(path, kMghData, frame, bytes), .bytes = bytes},
                   options, ignored);
    report(options, 0.7, "converting voxels");
    take_samples({.type = type, .data = data.data(), .swapped = header.swapped}, volume);
    return volume;
}

}  // namespace edgesplat::detail
