// OME-Zarr images and plain Zarr arrays (v2 and v3), in folders and zip archives. Internal to engine/volume/io.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/files/sample_type_internal.h"
#include "engine/volume/io/readers.h"

namespace edgesplat::detail {

/// Whether a folder or a zip archive holds Zarr's metadata.
bool is_zarr_folder(const std::string& path);
bool is_zarr_zip(const std::string& path);
Volume load_zarr(const std::string& path, const LoadOptions& options);

/// The files of a hierarchy by keys such as "0/c/1/2/3".
class ZarrStore {
  public:
    ZarrStore() = default;
    ZarrStore(const ZarrStore&) = delete;
    ZarrStore& operator=(const ZarrStore&) = delete;
    virtual ~ZarrStore() = default;
    /// A metadata file; nullopt if there is none.
    virtual std::optional<std::string> text(const std::string& key) const = 0;
    /// Calls `take` with the index and content of each key that exists, in any order.
    virtual void visit(const std::vector<std::string>& keys,
                       const std::function<void(std::size_t index, const std::string& bytes)>& take) const = 0;
    /// Names of the groups and arrays in a group.
    virtual std::vector<std::string> children(const std::string& key) const = 0;
    /// A key as users know it.
    virtual std::string shown(const std::string& key) const = 0;
};

std::unique_ptr<ZarrStore> zarr_folder(const std::string& path);
/// Reads the archive's list and its metadata files.
std::unique_ptr<ZarrStore> zarr_zip(const std::string& path);
std::string zarr_key(const std::string& group, const std::string& name);

/// A group or array, with its metadata and attributes.
struct ZarrNode {
    std::string key, where;        ///< where: the metadata file, for messages
    std::string attributes_where;  ///< the file of the attributes
    int version = 2;
    bool is_array = false;
    nlohmann::json metadata, attributes;
};
std::optional<ZarrNode> zarr_node(const ZarrStore& store, const std::string& key);

using ZarrShape = std::vector<std::size_t>;

struct ZarrCodec {
    enum class Kind { Transpose, Bytes, Sharding, Blosc, Zstd, Lz4, Gzip, Bzip2, Crc32c };
    Kind kind = Kind::Bytes;
    ZarrShape order;          ///< Transpose
    bool is_swapped = false;  ///< Bytes: not in this machine's byte order
    ZarrShape inner_shape;    ///< Sharding
    std::vector<ZarrCodec> inner, index;
    bool index_at_end = true;
};

/// An array's description, completely checked.
struct ZarrArray {
    std::string key, where, attributes_where;
    ZarrShape shape, chunk;
    SampleType type = SampleType::UInt8;
    bool is_half = false, is_bool = false;  ///< half: UInt16 until it is converted
    std::string fill;                       ///< bytes of a sample that no chunk holds
    std::string shown_fill;
    std::vector<ZarrCodec> codecs;
    std::string key_prefix;  ///< "" or "c" before the indices of a chunk
    char separator = '.';
    nlohmann::json attributes;
    std::vector<std::string> dimension_names;  ///< empty: not given

    std::size_t item() const { return size_of(type); }
};
ZarrArray zarr_array(const ZarrNode& node);

/// Samples of a box of the array: `strides` in bytes.
struct ZarrPiece {
    ZarrShape origin, shape;
    const char* data = nullptr;
    std::vector<std::ptrdiff_t> strides;
};
struct ZarrSink {
    std::function<bool(const ZarrShape& origin, const ZarrShape& shape)> needs;
    std::function<void(const ZarrPiece& piece)> take;
};
/// Decodes a chunk; origins are relative to it. Throws Error naming `where`.
void decode_zarr_chunk(const std::string& where, const ZarrArray& array, const std::vector<ZarrCodec>& codecs,
                       std::string_view bytes, const ZarrShape& shape, const ZarrSink& sink);
/// A box of fill values.
void fill_zarr_piece(const ZarrArray& array, const ZarrShape& shape, const ZarrSink& sink);

}  // namespace edgesplat::detail
