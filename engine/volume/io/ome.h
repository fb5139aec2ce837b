// The parts of OME's data model that bear on place and order: OME-XML of TIFF files, units. Internal to
// engine/volume/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgesplat::detail {

/// Millimetres in a unit of OME-XML (symbols, where "Mm" and "mm" differ) or of OME-Zarr (names, "micrometer");
/// nullopt for others, such as "pixel".
std::optional<double> ome_millimetres(std::string_view unit);

/// Consecutive planes of an image and the directories that hold them.
struct OmeTiffData {
    std::optional<std::uint64_t> directory;  ///< the first one's number in the file
    std::optional<std::uint64_t> planes;
    std::uint64_t z = 0, c = 0, t = 0;  ///< of the first plane
    std::string file, uuid;             ///< empty: not given
};

struct OmeImage {
    std::string id, name, order, type;
    std::uint64_t x = 0, y = 0, z = 0, c = 0, t = 0;
    std::uint64_t samples = 1;          ///< components per directory
    std::vector<std::string> channels;  ///< names, possibly empty
    struct Length {
        std::string value, unit;  ///< empty value: not given
    };
    Length size_x, size_y, size_z;  ///< of a voxel
    std::vector<OmeTiffData> data;
};

struct OmeDocument {
    std::string uuid;
    std::string metadata_file;  ///< not empty: the images are described there
    std::vector<OmeImage> images;
};

/// Whether a text looks like OME-XML.
bool is_ome_xml(std::string_view text);
/// Throws Error if the XML is broken or a number in it is none.
OmeDocument read_ome_xml(const std::string& path, const std::string& text);

}  // namespace edgesplat::detail
