// What legacy and XML files of VTK share: the choice of an array, the place of its samples, numbers as text. Internal
// to engine/volume/io.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// An array of samples at the points or in the cells of a grid.
struct VtkArray {
    std::string name;
    bool of_cells = false;
    bool is_scalars = false;         ///< marked as the scalars to show
    std::string type_name;           ///< as in the file
    std::optional<SampleType> type;  ///< not set: samples that cannot be read, such as texts
    std::size_t components = 1;
};

/// Whether the array says which samples of the others are valid.
bool is_vtk_mask(const VtkArray& array);
/// Whether a value of a mask says that the sample there is no data.
bool vtk_mask_hides(const VtkArray& mask, unsigned char value);
/// The index of the array to read: the one that options.inner names ("NAME", "PointData/NAME" or "CellData/NAME"), else
/// the scalars, else the only one. Otherwise fails with what to type. Notes which arrays were left.
std::size_t chosen_vtk_array(const std::string& path, const LoadOptions& options, const std::vector<VtkArray>& arrays,
                             Volume& volume);

/// A grid of points: first and last index along each axis, and their place.
struct VtkGrid {
    std::array<std::int64_t, 6> extent{};  ///< first and last index along x, y, z
    glm::dvec3 origin{0}, spacing{1};      ///< place of index 0, steps; spacing may be negative for coordinates
    glm::dmat3 direction{1};
    std::string source;  ///< geometry_source of the volume
};

/// Points or cells along each axis. Fails if the extent is empty.
std::vector<std::size_t> vtk_dims(const std::string& path, const std::array<std::int64_t, 6>& extent, bool of_cells);
/// Fails unless the spacing is finite and above 0; a spacing of 0 along an axis with one point becomes 1.
void check_vtk_spacing(const std::string& path, VtkGrid& grid, Volume& volume);
/// Sets geometry of the volume: samples at points, or half a cell in.
void set_vtk_place(const std::string& path, const VtkGrid& grid, bool of_cells, Volume& volume);
/// Sets spacing and origin of an axis from the coordinates of its points; fails if they are uneven. `precision`: their
/// relative error.
void set_vtk_coordinates(const std::string& path, int axis, const std::vector<double>& coordinates, double precision,
                         VtkGrid& grid, Volume& volume);

/// Whether the whole text is one number; sets `value` (nan and inf are numbers).
bool vtk_number(std::string_view text, double& value);
bool vtk_number(std::string_view text, std::int64_t& value);
/// Takes the next word from the text; empty at its end.
std::string_view next_vtk_word(std::string_view& text);
/// Takes `count` numbers from the text and returns them as samples in host byte order. `what` names them in messages.
std::vector<std::byte> vtk_text_samples(const std::string& path, const std::string& what, SampleType type,
                                        std::size_t count, std::string_view& text);
/// Samples of any type as doubles.
std::vector<double> vtk_doubles(SampleType type, const std::byte* samples, std::size_t count, bool swapped);

}  // namespace edgesplat::detail
