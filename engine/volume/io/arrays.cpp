#include "engine/volume/io/arrays.h"

#include <algorithm>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

std::string listed_arrays(const std::string& path, const std::vector<NamedArray>& arrays) {
    constexpr std::size_t kMost = 40;
    std::string list;
    for (std::size_t i = 0; i < std::min(arrays.size(), kMost); ++i) {
        std::vector<std::uint64_t> fast_first(arrays[i].extent.rbegin(), arrays[i].extent.rend());
        list += fmt::format("\n  {}:{}  ({}, {})", path, arrays[i].name, fmt::join(fast_first, " x "), arrays[i].type);
    }
    if (arrays.size() > kMost) list += fmt::format("\n  and {} more", arrays.size() - kMost);
    return list;
}

std::string without_slash(const std::string& name) {
    return name.starts_with('/') ? name.substr(1) : name;
}

}  // namespace

std::size_t chosen_array(const std::string& path, const LoadOptions& options, const std::vector<NamedArray>& arrays) {
    if (arrays.empty()) fail("{}: contains no array of numbers", path);
    if (!options.inner.empty()) {
        const auto found = std::ranges::find_if(
            arrays, [&](const NamedArray& array) { return without_slash(array.name) == without_slash(options.inner); });
        if (found != arrays.end()) return static_cast<std::size_t>(found - arrays.begin());
        fail("{}: contains no array '{}'; it contains{}", path, options.inner, listed_arrays(path, arrays));
    }
    std::vector<NamedArray> volumes;
    std::size_t last = 0;
    for (std::size_t i = 0; i < arrays.size(); ++i)
        if (arrays[i].is_volume) {
            volumes.push_back(arrays[i]);
            last = i;
        }
    if (volumes.size() == 1) return last;
    if (volumes.empty())
        fail("{}: contains no array with three axes; name one to read it as a slice:{}", path,
             listed_arrays(path, arrays));
    fail("{}: contains {} arrays; name one:{}", path, volumes.size(), listed_arrays(path, volumes));
}

std::string colour_warning(const std::array<std::uint64_t, 3>& extent, std::string_view shape) {
    constexpr std::uint64_t kMostColours = 4;
    if (extent[2] > kMostColours || extent[0] <= kMostColours || extent[1] <= kMostColours) return "";
    return fmt::format("The last axis of shape {} has {} entries: it is read as x, although it may be colours.", shape,
                       extent[2]);
}

std::string colour_warning(const NamedArray& array, const ArrayAxes& axes) {
    if (axes.named || axes.component || axes.space.size() != 3) return "";
    return colour_warning({array.extent[axes.space[0]], array.extent[axes.space[1]], array.extent[axes.space[2]]},
                          fmt::format("({})", fmt::join(array.extent, ", ")));
}

ArrayAxes axes_of(const NamedArray& array, const std::string& letters) {
    ArrayAxes axes;
    const std::size_t count = array.extent.size();
    // Names count only if x, y and z occur at most once, and x and y do.
    const auto occurs = [&](char letter) { return std::ranges::count(letters, letter); };
    const bool named = letters.size() == count && occurs('x') == 1 && occurs('y') == 1 && occurs('z') <= 1;
    std::vector<std::size_t> long_axes;
    for (std::size_t axis = 0; axis < count; ++axis) {
        const char letter = named ? letters[axis] : ' ';
        if (named && (letter == 'x' || letter == 'y' || letter == 'z'))
            axes.space.push_back(axis);
        else if (named && letter == 'c')
            axes.component = axis;
        else if (array.extent[axis] > 1)
            long_axes.push_back(axis);
    }
    if (!named) {
        constexpr std::uint64_t kMostColours = 4;
        if (long_axes.size() > 3 && array.extent[long_axes.back()] <= kMostColours) {
            axes.component = long_axes.back();
            long_axes.pop_back();
        }
        const std::size_t spatial = std::min<std::size_t>(long_axes.size(), 3);
        axes.space.assign(long_axes.end() - static_cast<std::ptrdiff_t>(spatial), long_axes.end());
        long_axes.resize(long_axes.size() - spatial);
        // Axes of length 1 that belong to a thin volume: (1, 40, 44) is one slice.
        for (std::size_t axis = count; axes.space.size() < 3 && axis-- > 0;)
            if (array.extent[axis] == 1 && std::ranges::find(axes.space, axis) == axes.space.end() && count <= 3)
                axes.space.push_back(axis);
        std::ranges::sort(axes.space);
    }
    axes.frames = long_axes;
    axes.named = named;
    // Named axes may be stored in any order; a missing one is the thin axis.
    if (named) {
        std::array<bool, 3> taken{};
        const std::size_t spatial = axes.space.size();
        for (std::size_t i = 0; i < spatial; ++i) {
            const char letter = letters[axes.space[spatial - 1 - i]];
            axes.world.at(i) = letter - 'x';
            taken.at(static_cast<std::size_t>(axes.world.at(i))) = true;
        }
        for (std::size_t i = spatial; i < 3; ++i) {
            axes.world.at(i) = static_cast<int>(std::ranges::find(taken, false) - taken.begin());
            taken.at(static_cast<std::size_t>(axes.world.at(i))) = true;
        }
    }
    return axes;
}

ArrayBox chosen_box(const std::string& path, const LoadOptions& options, const NamedArray& array,
                    const ArrayAxes& axes) {
    ArrayBox box;
    box.low.assign(array.extent.size(), 0);
    box.size.assign(array.extent.size(), 1);
    std::vector<std::size_t> dims{1, 1, 1};
    for (std::size_t i = 0; i < axes.space.size(); ++i) {
        const std::size_t axis = axes.space[axes.space.size() - 1 - i];
        box.size[axis] = array.extent[axis];
        dims[i] = array.extent[axis];
    }
    checked_bytes(path, dims, sizeof(double));
    box.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    const std::size_t components = axes.component ? array.extent[*axes.component] : 1;
    if (axes.component) box.low[*axes.component] = chosen_component(path, options, components);
    if (!axes.component) (void)chosen_component(path, options, 1);
    std::size_t frames = 1;
    for (const std::size_t axis : axes.frames)
        if (__builtin_mul_overflow(frames, array.extent[axis], &frames)) fail("{}: too many frames", path);
    std::size_t frame = chosen_frame(path, options, frames);
    for (auto axis = axes.frames.rbegin(); axis != axes.frames.rend(); ++axis) {
        box.low[*axis] = frame % array.extent[*axis];
        frame /= array.extent[*axis];
    }
    return box;
}

}  // namespace edgesplat::detail
