// Header-less files, described on the command line.
#include <bit>
#include <charconv>
#include <cstring>
#include <fstream>

#include "engine/volume/load_internal.h"

namespace edgesplat::detail {
namespace {

constexpr const char* kForm = "expected DXxDYxDZ:TYPE:little|big[:sx,sy,sz[:skip]], e.g. 64x64x64:uint8:little";

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const auto end = std::min(text.find(separator, begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

template <typename T>
T parsed(std::string_view text, const std::string& raw) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        fail("--raw {}: '{}' is not a number; {}", raw, text, kForm);
    return value;
}

void swap_bytes(std::vector<char>& data, std::size_t size) {
    for (std::size_t i = 0; i + size <= data.size(); i += size)
        std::reverse(data.begin() + static_cast<std::ptrdiff_t>(i),
                     data.begin() + static_cast<std::ptrdiff_t>(i + size));
}

}  // namespace

Volume load_raw(const std::string& path, const LoadOptions& options) {
    const auto parts = split(options.raw, ':');
    if (parts.size() < 3 || parts.size() > 5) fail("--raw {}: {}", options.raw, kForm);
    const auto sides = split(parts[0], 'x');
    if (sides.size() != 3) fail("--raw {}: '{}' is not three dims; {}", options.raw, parts[0], kForm);
    std::vector<std::size_t> dims;
    for (const auto side : sides)
        dims.push_back(parsed<std::size_t>(side, options.raw));
    SampleType type{};
    if (!sample_type_named(parts[1], type))
        fail(
            "--raw {}: type '{}' is none of int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64",
            options.raw, parts[1]);
    if (parts[2] != "little" && parts[2] != "big")
        fail("--raw {}: byte order '{}' is neither little nor big", options.raw, parts[2]);
    glm::dvec3 spacing(1);
    if (parts.size() > 3) {
        const auto lengths = split(parts[3], ',');
        if (lengths.size() != 3) fail("--raw {}: '{}' is not three spacings; {}", options.raw, parts[3], kForm);
        for (int axis = 0; axis < 3; ++axis) {
            spacing[axis] = parsed<double>(lengths[static_cast<std::size_t>(axis)], options.raw);
            if (!(spacing[axis] > 0)) fail("--raw {}: spacing {} must be above 0", options.raw, spacing[axis]);
        }
    }
    const std::size_t skip = parts.size() > 4 ? parsed<std::size_t>(parts[4], options.raw) : 0;
    (void)chosen_component(path, options, 1);
    (void)chosen_frame(path, options, 1);

    const std::size_t bytes = checked_bytes(path, dims, size_of(type));
    const std::size_t size = std::filesystem::file_size(path);
    if (skip > size || size - skip < bytes)
        fail("{}: {} bytes, but --raw {} needs {} after skipping {}", path, size, options.raw, bytes, skip);
    Volume volume;
    if (size - skip > bytes) {
        const auto spare = size - skip - bytes;
        if (skip == 0)
            fail("{}: {} bytes more than --raw {} needs: wrong dims or type, or a header (give its size as skip)", path,
                 spare, options.raw);
        volume.notes.push_back(fmt::format("{} bytes after the last voxel were not used.", spare));
    }
    volume.name = path;
    volume.stored_type = name_of(type);
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    for (int axis = 0; axis < 3; ++axis)
        volume.geometry.index_to_world_axes[axis][axis] = spacing[axis];
    volume.values.resize(volume.geometry.voxel_count());

    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(skip));
    const std::size_t slice = dims[0] * dims[1];
    const bool swap = (parts[2] == "little") != (std::endian::native == std::endian::little);
    std::vector<char> buffer(slice * size_of(type));
    for (std::size_t z = 0; z < dims[2]; ++z) {
        report(options, 0.9 * static_cast<double>(z) / static_cast<double>(dims[2]), "reading voxels");
        if (!file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())))
            fail("{}: truncated or unreadable at slice {}", path, z);
        if (swap) swap_bytes(buffer, size_of(type));
        convert_samples(type, buffer.data(), 0, 1, slice, volume.values.data() + z * slice);
    }
    return volume;
}

}  // namespace edgesplat::detail
