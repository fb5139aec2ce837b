// Reads VTK's XML files: image data (.vti), rectilinear grids with even coordinates (.vtr) and files that put several
// of these together (.pvti, .pvtr).
#include "engine/volume/io/vtk_xml.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <limits>
#include <map>

#include "engine/volume/io/samples.h"
#include "engine/volume/io/vtk_grid.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

template <std::size_t n, typename T>
std::array<T, n> vtk_attribute(const std::string& path, const pugi::xml_node& node, const char* name) {
    const std::string given = node.attribute(name).as_string();
    std::string_view text = given;
    std::array<T, n> numbers{};
    std::size_t found = 0;
    for (auto word = next_vtk_word(text); !word.empty(); word = next_vtk_word(text), ++found)
        if (found == n || !vtk_number(word, numbers[found])) {
            found = n + 1;
            break;
        }
    constexpr bool kWhole = std::is_integral_v<T>;
    if (found != n)
        fail("{}: {} of {} is '{}': expected {} {}numbers", path, name, node.name(), tidy(given.substr(0, 80)), n,
             kWhole ? "whole " : "");
    return numbers;
}

std::array<std::int64_t, 6> vtk_extent(const std::string& path, const pugi::xml_node& node, const char* name) {
    return vtk_attribute<6, std::int64_t>(path, node, name);
}

bool is_empty_extent(const std::array<std::int64_t, 6>& extent) {
    return extent[1] < extent[0] || extent[3] < extent[2] || extent[5] < extent[4];
}

// What the file is, if it is no grid that can be read.
[[noreturn]] void refuse_vtk_kind(const std::string& path, const pugi::xml_node& root, const std::string& type) {
    static const std::map<std::string, std::string> kinds{{"UnstructuredGrid", "an unstructured grid"},
                                                          {"PolyData", "a surface (polygons)"},
                                                          {"StructuredGrid", "a curvilinear grid"},
                                                          {"HyperTreeGrid", "a tree of cells"},
                                                          {"Table", "a table"},
                                                          {"vtkMultiBlockDataSet", "a list of several data sets"},
                                                          {"vtkPartitionedDataSet", "a list of data sets"},
                                                          {"vtkPartitionedDataSetCollection", "a list of data sets"},
                                                          {"vtkOverlappingAMR", "an adaptive grid"},
                                                          {"vtkNonOverlappingAMR", "an adaptive grid"},
                                                          {"vtkHierarchicalBoxDataSet", "an adaptive grid"}};
    std::string files;
    int count = 0;
    for (const auto& found : root.select_nodes(".//DataSet")) {
        const std::string file = found.node().attribute("file").as_string();
        if (file.empty() || ++count > 10) continue;
        files += fmt::format("{}{}", files.empty() ? "" : ", ", (fs::path(path).parent_path() / file).string());
    }
    if (!files.empty())
        fail("{}: a list of {} VTK files; open one of them: {}{}", path, count, files, count > 10 ? ", ..." : "");
    const auto known = kinds.find(type.starts_with('P') && kinds.contains(type.substr(1)) ? type.substr(1) : type);
    fail(
        "{}: a VTK file with {} ({}), not image data; resample it to an image, e.g. with ParaView's filter Resample To "
        "Image, and save it as .vti",
        path, known == kinds.end() ? "data" : known->second, type.empty() ? "no type" : type);
}

// A file and its grid element, or the parts of a parallel file.
class VtkXmlGrid {
  public:
    explicit VtkXmlGrid(const std::string& path) : file_(path) {
        type_ = file_.root().attribute("type").as_string();
        rectilinear_ = type_ == "RectilinearGrid" || type_ == "PRectilinearGrid";
        parallel_ = type_ == "PImageData" || type_ == "PRectilinearGrid";
        if (!rectilinear_ && !parallel_ && type_ != "ImageData") refuse_vtk_kind(path, file_.root(), type_);
        element_ = file_.root().child(type_.c_str());
        if (!element_) fail("{}: truncated or damaged: no element {}", path, type_);
        grid.extent = vtk_extent(path, element_, "WholeExtent");
        if (is_empty_extent(grid.extent))
            fail("{}: WholeExtent '{}' is empty", path, element_.attribute("WholeExtent").as_string());
        if (rectilinear_)
            grid.source = "coordinates";
        else
            read_place();
    }

    bool rectilinear() const { return rectilinear_; }
    std::size_t ratio() const { return parallel_ ? kBestPictureRatio : file_.ratio(); }

    /// Size of the file, or of the files of its parts.
    std::size_t stored_bytes() const {
        if (!parallel_) return file_.file_size();
        std::size_t bytes = 0;
        std::error_code error;
        for (const pugi::xml_node& piece : element_.children("Piece")) {
            const std::size_t size = fs::file_size(part_path(piece), error);
            if (!error) bytes += size;
        }
        return bytes;
    }

    /// All arrays with samples.
    std::vector<VtkArray> arrays() const {
        std::vector<VtkArray> found;
        for (const bool of_cells : {false, true}) {
            const pugi::xml_node group = group_of(first(), of_cells, parallel_);
            const std::string_view scalars = group.attribute("Scalars").as_string();
            for (const pugi::xml_node& node : group.children()) {
                if (!is_array(node)) continue;
                VtkArray array;
                array.name = node.attribute("Name").as_string();
                array.of_cells = of_cells;
                array.is_scalars = !array.name.empty() && array.name == scalars;
                array.type_name = node.attribute("type").as_string();
                array.type = VtkXmlFile::type_of(node);
                array.components = components_of(file_.path(), node);
                found.push_back(array);
            }
        }
        return found;
    }

    /// Calls work(file, element Piece) for all parts.
    template <typename Work>
    void for_parts(const Work& work) const {
        for (const pugi::xml_node& piece : element_.children("Piece")) {
            if (!parallel_) {
                work(file_, piece);
                continue;
            }
            if (is_empty_extent(vtk_extent(file_.path(), piece, "Extent"))) continue;
            const std::string path = part_path(piece);
            std::error_code error;
            if (!fs::is_regular_file(path, error)) fail("{}: its part {}: no such file", file_.path(), path);
            const VtkXmlGrid part(path);
            if (part.parallel_ || part.rectilinear_ != rectilinear_)
                fail("{}: its part {} is of type {}: expected {}", file_.path(), path, part.type_, type_.substr(1));
            if (!rectilinear_ &&
                (glm::any(glm::notEqual(part.grid.spacing, grid.spacing)) ||
                 glm::any(glm::notEqual(part.grid.origin, grid.origin)) || part.grid.direction != grid.direction))
                fail("{}: its part {} has another Origin, Spacing or Direction", file_.path(), path);
            part.for_parts(work);
        }
    }

    static pugi::xml_node find(const pugi::xml_node& piece, const VtkArray& array) {
        for (const pugi::xml_node& node : group_of(piece, array.of_cells, false).children())
            if (is_array(node) && array.name == node.attribute("Name").as_string()) return node;
        return {};
    }
    static std::size_t components_of(const std::string& path, const pugi::xml_node& node) {
        const auto attribute = node.attribute("NumberOfComponents");
        std::int64_t components = 1;
        if (attribute && (!vtk_number(attribute.as_string(), components) || components < 1 || components > 65536))
            fail("{}: array '{}': NumberOfComponents '{}': expected 1 to 65536", path,
                 node.attribute("Name").as_string(), attribute.as_string());
        return static_cast<std::size_t>(components);
    }

    VtkGrid grid;

  private:
    // Files of VTK before 4.2 write DataArray, parallel ones PDataArray.
    static bool is_array(const pugi::xml_node& node) {
        const std::string_view name = node.name();
        return name == "DataArray" || name == "PDataArray" || name == "Array" || name == "PArray";
    }
    static pugi::xml_node group_of(const pugi::xml_node& parent, bool of_cells, bool parallel) {
        return parent.child(parallel ? (of_cells ? "PCellData" : "PPointData") : (of_cells ? "CellData" : "PointData"));
    }
    std::string part_path(const pugi::xml_node& piece) const {
        return (fs::path(file_.path()).parent_path() / piece.attribute("Source").as_string()).string();
    }
    // The element that names the arrays.
    pugi::xml_node first() const {
        if (parallel_) return element_;
        for (const pugi::xml_node& piece : element_.children("Piece"))
            if (!is_empty_extent(vtk_extent(file_.path(), piece, "Extent"))) return piece;
        fail("{}: truncated or damaged: no element Piece with samples", file_.path());
    }
    void read_place() {
        const auto numbers = [&](const char* name, const glm::dvec3& otherwise) {
            if (!element_.attribute(name)) return otherwise;
            const auto found = vtk_attribute<3, double>(file_.path(), element_, name);
            return glm::dvec3(found[0], found[1], found[2]);
        };
        grid.origin = numbers("Origin", glm::dvec3(0));
        grid.spacing = numbers("Spacing", glm::dvec3(1));
        grid.source = element_.attribute("Spacing") ? "Origin, Spacing" : "none: 1 mm assumed";
        if (element_.attribute("Direction")) return set_direction(element_);
        // VTK leaves the direction out of parallel files; those of the parts have it.
        for (const pugi::xml_node& piece : element_.children("Piece")) {
            std::error_code error;
            if (!parallel_ || !fs::is_regular_file(part_path(piece), error)) continue;
            const VtkXmlFile part(part_path(piece));
            if (part.root().child("ImageData").attribute("Direction")) set_direction(part.root().child("ImageData"));
            return;
        }
    }
    void set_direction(const pugi::xml_node& element) {
        const auto rows = vtk_attribute<9, double>(file_.path(), element, "Direction");
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                grid.direction[column][row] = rows[static_cast<std::size_t>(3 * row + column)];
        grid.source += ", Direction";
    }

    VtkXmlFile file_;
    std::string type_;
    bool rectilinear_ = false, parallel_ = false;
    pugi::xml_node element_;
};

// Puts the samples of all parts together.
class VtkParts {
  public:
    VtkParts(const std::string& path, const VtkGrid& grid, const VtkArray& array, std::size_t component,
             bool rectilinear)
        : path_(path),
          grid_(grid),
          array_(array),
          component_(component),
          rectilinear_(rectilinear),
          dims_(vtk_dims(path, grid.extent, array.of_cells)) {
        voxels_ = dims_[0] * dims_[1] * dims_[2];
        const auto points = vtk_dims(path, grid.extent, false);
        for (std::size_t axis = 0; rectilinear && axis < 3; ++axis)
            coordinates_[axis].assign(points[axis], std::numeric_limits<double>::quiet_NaN());
    }

    void add(const VtkXmlFile& file, const pugi::xml_node& piece) {
        const auto extent = vtk_extent(file.path(), piece, "Extent");
        if (is_empty_extent(extent)) return;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (extent[2 * axis] < grid_.extent[2 * axis] || extent[2 * axis + 1] > grid_.extent[2 * axis + 1])
                fail("{}: Extent {} {} of a Piece along {} leaves WholeExtent {} {}", file.path(), extent[2 * axis],
                     extent[2 * axis + 1], "xyz"[axis], grid_.extent[2 * axis], grid_.extent[2 * axis + 1]);
        if (rectilinear_) add_coordinates(file, piece, extent);
        const pugi::xml_node node = VtkXmlGrid::find(piece, array_);
        if (!node) fail("{}: a Piece without the array '{}'", file.path(), array_.name);
        const auto type = VtkXmlFile::type_of(node);
        const std::size_t components = VtkXmlGrid::components_of(file.path(), node);
        if (type != array_.type)
            fail("{}: array '{}' is of type {} in one Piece and {} in another", file.path(), array_.name,
                 array_.type_name, node.attribute("type").as_string());
        if (components != array_.components)
            fail("{}: array '{}' has {} components in one Piece and {} in another", file.path(), array_.name,
                 array_.components, components);
        const auto dims = vtk_dims(file.path(), extent, array_.of_cells);
        const std::size_t count = dims[0] * dims[1] * dims[2];
        auto samples = file.samples(node, count * components);
        const std::size_t size = size_of(*type);
        if (count == voxels_) {
            whole_ = std::move(samples);
            stride_ = components;
            first_ = component_ * size;
            swapped_ = file.swapped(node);
            covered_.assign(voxels_, true);
        } else {
            if (whole_.size() != voxels_ * size) {
                whole_.assign(voxels_ * size, std::byte{0});
                covered_.assign(voxels_, false);
                first_ = 0;
                stride_ = 1;
            }
            place_samples(extent, dims, [&](std::size_t from, std::size_t to) {
                const std::byte* sample = samples.data() + (from * components + component_) * size;
                if (file.swapped(node))
                    std::reverse_copy(sample, sample + size, whole_.data() + to * size);
                else
                    std::copy_n(sample, size, whole_.data() + to * size);
                covered_[to] = true;
            });
        }
        add_masks(file, piece, extent, dims, count);
    }

    void finish(VtkGrid& grid, Volume& volume) {
        const auto missing = static_cast<std::size_t>(std::ranges::count(covered_, false));
        if (covered_.empty() || missing > 0)
            fail("{}: its pieces leave {} of {} samples of WholeExtent out", path_,
                 covered_.empty() ? voxels_ : missing, voxels_);
        for (int axis = 0; axis < 3; ++axis)
            if (rectilinear_)
                set_vtk_coordinates(path_, axis, coordinates_[static_cast<std::size_t>(axis)], precision_, grid,
                                    volume);
        if (!rectilinear_) check_vtk_spacing(path_, grid, volume);
        set_vtk_place(path_, grid, array_.of_cells, volume);
        take_samples({.type = *array_.type, .data = whole_.data() + first_, .stride = stride_, .swapped = swapped_},
                     volume);
        for (std::size_t i = 0; i < hidden_.size(); ++i)
            if (hidden_[i]) volume.values[i] = std::numeric_limits<float>::quiet_NaN();
    }

  private:
    // work(index in the piece, index in the whole).
    template <typename Work>
    void place_samples(const std::array<std::int64_t, 6>& extent, const std::vector<std::size_t>& dims,
                       const Work& work) const {
        std::array<std::size_t, 3> low{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            low[axis] =
                std::min(static_cast<std::size_t>(extent[2 * axis] - grid_.extent[2 * axis]), dims_[axis] - dims[axis]);
        std::size_t from = 0;
        for (std::size_t z = 0; z < dims[2]; ++z)
            for (std::size_t y = 0; y < dims[1]; ++y)
                for (std::size_t x = 0; x < dims[0]; ++x)
                    work(from++, ((low[2] + z) * dims_[1] + low[1] + y) * dims_[0] + low[0] + x);
    }

    void add_masks(const VtkXmlFile& file, const pugi::xml_node& piece, const std::array<std::int64_t, 6>& extent,
                   const std::vector<std::size_t>& dims, std::size_t count) {
        for (const char* name : {"vtkGhostType", "vtkValidPointMask"}) {
            VtkArray mask;
            mask.name = name;
            mask.of_cells = array_.of_cells;
            const pugi::xml_node node = VtkXmlGrid::find(piece, mask);
            if (!node || name == array_.name) continue;
            mask.type = VtkXmlFile::type_of(node);
            mask.components = VtkXmlGrid::components_of(file.path(), node);
            if (!is_vtk_mask(mask)) continue;
            const auto values = file.samples(node, count);
            hidden_.resize(voxels_);
            place_samples(extent, dims, [&](std::size_t from, std::size_t to) {
                hidden_[to] = hidden_[to] || vtk_mask_hides(mask, static_cast<unsigned char>(values[from]));
            });
        }
    }

    void add_coordinates(const VtkXmlFile& file, const pugi::xml_node& piece,
                         const std::array<std::int64_t, 6>& extent) {
        const auto points = vtk_dims(file.path(), extent, false);
        std::size_t axis = 0;
        for (const pugi::xml_node& node : piece.child("Coordinates").children()) {
            if (axis == 3) break;
            const auto type = VtkXmlFile::type_of(node);
            if (!type || VtkXmlGrid::components_of(file.path(), node) != 1)
                fail("{}: Coordinates of type '{}': expected numbers", file.path(), node.attribute("type").as_string());
            const bool text = std::string_view(node.attribute("format").as_string("ascii")) == "ascii";
            precision_ = std::max(precision_, text || type == SampleType::Float32 ? 2.4e-7 : 1e-12);
            const auto samples = file.samples(node, points[axis]);
            const auto numbers = vtk_doubles(*type, samples.data(), points[axis], file.swapped(node));
            std::ranges::copy(numbers, coordinates_[axis].begin() + (extent[2 * axis] - grid_.extent[2 * axis]));
            ++axis;
        }
        if (axis < 3) fail("{}: a Piece with Coordinates of {} axes, expected 3", file.path(), axis);
    }

    const std::string& path_;
    const VtkGrid& grid_;
    const VtkArray& array_;
    std::size_t component_ = 0;
    bool rectilinear_ = false;
    std::vector<std::size_t> dims_;
    std::size_t voxels_ = 0;
    std::array<std::vector<double>, 3> coordinates_;
    double precision_ = 0;
    std::vector<std::byte> whole_;
    std::size_t first_ = 0, stride_ = 1;
    bool swapped_ = false;
    std::vector<bool> covered_, hidden_;
};

}  // namespace

Volume load_vtk_xml(const std::string& path, const LoadOptions& options) {
    report(options, 0.0, "reading header");
    VtkXmlGrid file(path);
    Volume volume;
    const auto arrays = file.arrays();
    const VtkArray& array = arrays[chosen_vtk_array(path, options, arrays, volume)];
    if (!array.type)
        fail("{}: array '{}' of type {} cannot be read; expected numbers", path, array.name, array.type_name);
    const auto dims = vtk_dims(path, file.grid.extent, array.of_cells);
    const std::size_t needed = checked_bytes(path, dims, array.components * size_of(*array.type));
    check_stored_size(path, needed, file.stored_bytes(), file.ratio());
    const auto component = chosen_component(path, options, array.components);
    (void)chosen_frame(path, options, 1);
    report(options, 0.1, "reading voxels");
    VtkParts parts(path, file.grid, array, component, file.rectilinear());
    file.for_parts([&](const VtkXmlFile& part, const pugi::xml_node& piece) { parts.add(part, piece); });
    report(options, 0.7, "converting voxels");
    parts.finish(file.grid, volume);
    return volume;
}

}  // namespace edgesplat::detail
