// A VTK XML file: its document, and the data of its arrays. Internal to engine/volume/io.
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/volume/io/mapped_file.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

class VtkXmlFile {
  public:
    /// Reads the document up to the appended data. Throws Error if it is no VTK XML file.
    explicit VtkXmlFile(const std::string& path);

    const std::string& path() const { return path_; }
    /// The element VTKFile.
    pugi::xml_node root() const { return document_.child("VTKFile"); }
    /// Whether samples are in the other byte order than this machine's. Those of text arrays are not.
    bool swapped(const pugi::xml_node& array) const;
    /// The type that an array's `type` names; not set: none that can be read.
    static std::optional<SampleType> type_of(const pugi::xml_node& array);
    /// Maximum ratio of samples to stored bytes, see check_stored_size.
    std::size_t ratio() const;
    std::size_t file_size() const { return file_.bytes().size(); }
    /// The `count` samples of an array (DataArray), all components.
    std::vector<std::byte> samples(const pugi::xml_node& array, std::size_t count) const;

  private:
    enum class Compressor { None, Zlib, Lz4, Lzma };
    struct Blob;
    std::vector<std::byte> unpacked(const std::string& what, Blob& blob, std::size_t bytes) const;
    void unpack_block(const std::string& what, const std::vector<std::byte>& packed, std::byte* to,
                      std::size_t bytes) const;

    std::string path_;
    MappedFile file_;
    pugi::xml_document document_;
    std::string_view appended_;  ///< after the underscore
    bool has_appended_ = false, appended_is_base64_ = false, big_endian_ = false;
    std::size_t word_ = 4;  ///< bytes of a number before the data
    Compressor compressor_ = Compressor::None;
};

}  // namespace edgesplat::detail
