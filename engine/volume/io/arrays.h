// Arrays inside container files (HDF5, netCDF): which one to read, and which of its axes are space. Internal to
// engine/volume/io.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/load_volume.h"

namespace edgesplat::detail {

/// An array of a file.
struct NamedArray {
    std::string name;                   ///< as the user types it, e.g. "/group/data"
    std::vector<std::uint64_t> extent;  ///< slowest axis first
    std::string type;                   ///< e.g. "uint16", for messages
    bool is_volume = false;             ///< whether it may be meant when no name is given
};

/// Index of the array named `options.inner`, or of the only volume. Fails with a list of the arrays, and what to type.
std::size_t chosen_array(const std::string& path, const LoadOptions& options, const std::vector<NamedArray>& arrays);

/// Roles of an array's axes.
struct ArrayAxes {
    std::vector<std::size_t> space;  ///< up to three axes, slowest first
    /// World axis of each index axis, fastest first: {0, 1, 2} unless the file names its axes otherwise.
    std::array<int, 3> world{0, 1, 2};
    std::optional<std::size_t> component;
    std::vector<std::size_t> frames;  ///< all other axes longer than 1, slowest first
    bool named = false;               ///< by the file
};

/// A warning if the fastest of three unnamed axes is so short that it may be one of colours; "" otherwise. `extent`:
/// of these axes, slowest first; `shape`: of the array, as a message shows it.
std::string colour_warning(const std::array<std::uint64_t, 3>& extent, std::string_view shape);
/// The same for an array whose file names no axes.
std::string colour_warning(const NamedArray& array, const ArrayAxes& axes);

/// The box of an array to read: one component and frame, the whole of space. The slowest axis of a volume of one or
/// two axes is missing in `space`. Fails if a choice is open. Axes of length 1 are ignored.
struct ArrayBox {
    std::vector<std::uint64_t> low, size;  ///< of each axis
    glm::ivec3 dims{1};                    ///< x, y, z
};
ArrayBox chosen_box(const std::string& path, const LoadOptions& options, const NamedArray& array,
                    const ArrayAxes& axes);

/// Roles by convention: the last three axes longer than 1 are z, y, x; if there is one more, and the last has 2 to 4
/// elements, that is the component. `letters`: a lower-case letter for each axis (x, y, z, c, t or
/// another), if the file names them.
ArrayAxes axes_of(const NamedArray& array, const std::string& letters);

}  // namespace edgesplat::detail
