// Reads raw files, described on the command line.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "engine/volume/io/samples.h"
#include "engine/volume/io/stored_data.h"

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

struct RawForm {
    std::vector<std::size_t> dims;
    SampleType type = SampleType::UInt8;
    bool swapped = false;
    glm::dvec3 spacing{1};
    bool has_spacing = false;
    std::size_t skip = 0;
};

RawForm form_of(const std::string& path, const LoadOptions& options) {
    RawForm form;
    const auto parts = split(options.raw, ':');
    if (parts.size() < 3 || parts.size() > 5) fail("--raw {}: {}", options.raw, kForm);
    const auto sides = split(parts[0], 'x');
    if (sides.size() != 3) fail("--raw {}: '{}' is not three dims; {}", options.raw, parts[0], kForm);
    for (const auto side : sides)
        form.dims.push_back(parsed<std::size_t>(side, options.raw));
    if (!sample_type_named(parts[1], form.type))
        fail(
            "--raw {}: type '{}' is none of int8, uint8, int16, uint16, int32, uint32, int64, uint64, float32, float64",
            options.raw, parts[1]);
    if (parts[2] != "little" && parts[2] != "big")
        fail("--raw {}: byte order '{}' is neither little nor big", options.raw, parts[2]);
    form.swapped = (parts[2] == "little") != (std::endian::native == std::endian::little);
    if (parts.size() > 3) {
        form.has_spacing = true;
        const auto lengths = split(parts[3], ',');
        if (lengths.size() != 3) fail("--raw {}: '{}' is not three spacings; {}", options.raw, parts[3], kForm);
        for (int axis = 0; axis < 3; ++axis) {
            form.spacing[axis] = parsed<double>(lengths[static_cast<std::size_t>(axis)], options.raw);
            if (!(form.spacing[axis] > 0) || !std::isfinite(form.spacing[axis]))
                fail("--raw {}: spacing {} must be a length above 0", options.raw, form.spacing[axis]);
        }
    }
    if (parts.size() > 4) form.skip = parsed<std::size_t>(parts[4], options.raw);
    (void)chosen_component(path, options, 1);
    (void)chosen_frame(path, options, 1);

    return form;
}

/// `bytes`: size of all voxels.
StoredData stored_of(const RawForm& form, std::size_t bytes, const std::string& path, const LoadOptions& options,
                     Volume& volume) {
    const std::size_t size = std::filesystem::file_size(path);
    if (form.skip > size || size - form.skip < bytes)
        fail("{}: {} bytes, but --raw {} needs {} after skipping {}", path, size, options.raw, bytes, form.skip);
    if (size - form.skip > bytes) {
        const auto spare = size - form.skip - bytes;
        if (form.skip == 0)
            fail("{}: {} bytes more than --raw {} needs: wrong dims or type, or a header (give its size as skip)", path,
                 spare, options.raw);
        volume.notes.push_back(fmt::format("{} bytes after the last voxel were not used.", spare));
    }
    volume.name = path;
    volume.stored_type = name_of(form.type);
    volume.geometry.dims = glm::ivec3(form.dims[0], form.dims[1], form.dims[2]);
    glm::dmat3 axes(1.0);
    for (int axis = 0; axis < 3; ++axis)
        axes[axis][axis] = form.spacing[axis];
    set_place(volume, axes, glm::dvec3(0.0), 1, form.has_spacing ? "--raw" : "none: 1 mm assumed");
    StoredData data;
    data.path = path;
    data.files = {path};
    data.type = form.type;
    data.swapped = form.swapped;
    data.offset = form.skip;
    data.may_continue = true;  // named above
    data.samples = bytes / size_of(form.type);
    return data;
}

StoredSelection selection_of(const RawForm& form) {
    return {.first = 0, .step = {1, form.dims[0], form.dims[0] * form.dims[1]}};
}

}  // namespace

FileLayout raw_layout(const std::string& path, const LoadOptions& options, Volume& description) {
    const RawForm form = form_of(path, options);
    std::size_t voxels = 1;
    for (const auto side : form.dims) {
        if (side < 1 || side > kMaxPackedVoxelsPerAxis || voxels > kMaxPackedVoxels / side)
            fail("--raw {}: dims {} x {} x {}: expected 1 to {} along each axis, and at most 2^40 in all", options.raw,
                 form.dims[0], form.dims[1], form.dims[2], kMaxPackedVoxelsPerAxis);
        voxels *= side;
    }
    const auto data = stored_of(form, voxels * size_of(form.type), path, options, description);
    return *layout_of_stored(data, selection_of(form), description);
}

Volume load_raw(const std::string& path, const LoadOptions& options) {
    const RawForm form = form_of(path, options);
    Volume volume;
    const auto data = stored_of(form, checked_bytes(path, form.dims, size_of(form.type)), path, options, volume);
    read_stored(data, selection_of(form), volume, options);
    return volume;
}

}  // namespace edgesplat::detail
