// Reads the metadata of Zarr arrays.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

#include "engine/volume/io/zarr.h"

namespace edgesplat::detail {
namespace {

using nlohmann::json;

constexpr bool kHostIsLittle = std::endian::native == std::endian::little;

/// A value as text for messages, shortened.
std::string shown_json(const json& value) {
    const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    return text.size() > 80 ? text.substr(0, 77) + "..." : text;
}

json parsed_json(const std::string& where, const std::string& text) {
    json value = json::parse(text, nullptr, false);
    if (!value.is_object()) fail("{}: not a JSON object", where);
    return value;
}

const json& zarr_field(const std::string& where, const json& object, const char* name) {
    const auto found = object.find(name);
    if (found == object.end()) fail("{}: it has no field '{}'", where, name);
    return *found;
}

ZarrShape zarr_shape(const std::string& where, const json& object, const char* name, std::size_t least) {
    const json& list = zarr_field(where, object, name);
    ZarrShape shape;
    bool is_good = list.is_array() && list.size() <= 32;
    for (std::size_t i = 0; is_good && i < list.size(); ++i) {
        is_good = list[i].is_number_unsigned() && list[i].get<std::uint64_t>() < std::uint64_t{1} << 48 &&
                  list[i].get<std::uint64_t>() >= least;
        if (is_good) shape.push_back(list[i].get<std::size_t>());
    }
    if (!is_good)
        fail("{}: '{}': {}: expected at most 32 whole numbers of at least {}", where, name, shown_json(list), least);
    return shape;
}

std::string zarr_text(const std::string& where, const json& object, const char* name) {
    const json& value = zarr_field(where, object, name);
    if (!value.is_string()) fail("{}: '{}': {}: expected a text", where, name, shown_json(value));
    return value.get<std::string>();
}

/// The type by its name in v3, or by kind and bytes in v2.
void set_type(ZarrArray& array, const std::string& name) {
    if (name == "float16") {
        array.type = SampleType::UInt16;
        array.is_half = true;
    } else if (name == "bool") {
        array.is_bool = true;
    } else if (!sample_type_named(name, array.type)) {
        fail("{}: samples of type {}: expected whole numbers or floats of 8 to 64 bits", array.where, name);
    }
}

/// Bytes of a sample in this machine's order.
template <typename T>
std::string bytes_of_value(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

template <typename T>
std::string bytes_of_whole(const ZarrArray& array, const json& value) {
    if (value.is_boolean()) return bytes_of_value(static_cast<T>(value.get<bool>() ? 1 : 0));
    bool is_inside = false;
    T number{};
    if (value.is_number_unsigned()) {
        is_inside = value.get<std::uint64_t>() <= static_cast<std::uint64_t>(std::numeric_limits<T>::max());
        number = static_cast<T>(value.get<std::uint64_t>());
    } else if (value.is_number_integer()) {
        const auto whole = value.get<std::int64_t>();
        is_inside = std::is_signed_v<T> && whole >= static_cast<std::int64_t>(std::numeric_limits<T>::min());
        number = static_cast<T>(whole);
    } else if (value.is_number_float()) {
        const auto real = value.get<double>();
        // Both limits are exact as double, or the next power of 2.
        is_inside = real == std::floor(real) && real >= static_cast<double>(std::numeric_limits<T>::min()) &&
                    real < std::ldexp(1.0, std::numeric_limits<T>::digits);
        if (is_inside) number = static_cast<T>(real);
    }
    if (!is_inside)
        fail("{}: 'fill_value': {}: expected a value of the type of the samples", array.where, shown_json(value));
    return bytes_of_value(number);
}

std::uint16_t half_of(double value) {
    if (std::isnan(value)) return 0x7E00;
    const std::uint16_t sign = std::signbit(value) ? 0x8000 : 0;
    const double magnitude = std::abs(value);
    if (magnitude >= 65520) return sign | 0x7C00;
    int exponent = 0;
    (void)std::frexp(magnitude, &exponent);
    const int shift = std::max(exponent - 11, -24);
    const auto mantissa = static_cast<int>(std::nearbyint(std::ldexp(magnitude, -shift)));
    // A mantissa of 2^11 after rounding carries into the exponent by itself.
    return static_cast<std::uint16_t>(sign |
                                      (mantissa + (magnitude >= std::ldexp(1.0, -14) ? (shift + 24) * 1024 : 0)));
}

std::string bytes_of_float(const ZarrArray& array, const json& value) {
    double number = 0;
    if (value.is_number()) {
        number = value.get<double>();
    } else if (value.is_boolean()) {
        number = value.get<bool>() ? 1 : 0;
    } else if (value.is_string()) {
        const auto text = value.get<std::string>();
        if (text == "NaN") {
            number = std::numeric_limits<double>::quiet_NaN();
        } else if (text == "Infinity" || text == "-Infinity") {
            number = text.starts_with('-') ? -std::numeric_limits<double>::infinity()
                                           : std::numeric_limits<double>::infinity();
        } else {
            // The bits in hexadecimal, the most significant first.
            std::uint64_t bits = 0;
            const auto [end, error] = std::from_chars(text.data() + std::min<std::size_t>(2, text.size()),
                                                      text.data() + text.size(), bits, 16);
            if (!text.starts_with("0x") || error != std::errc() || end != text.data() + text.size() ||
                text.size() != 2 + 2 * array.item())
                fail("{}: 'fill_value': {}: expected a number, NaN, Infinity or the bits of a float", array.where,
                     shown_json(value));
            if (array.item() == 8) return bytes_of_value(bits);
            if (array.item() == 4) return bytes_of_value(static_cast<std::uint32_t>(bits));
            return bytes_of_value(static_cast<std::uint16_t>(bits));
        }
    } else {
        fail("{}: 'fill_value': {}: expected a number", array.where, shown_json(value));
    }
    if (array.is_half) return bytes_of_value(half_of(number));
    if (array.type == SampleType::Float32) return bytes_of_value(static_cast<float>(number));
    return bytes_of_value(number);
}

void set_fill(ZarrArray& array, const json& value) {
    array.shown_fill = shown_json(value);
    if (value.is_null()) {
        array.shown_fill = "0 (its fill_value is null)";
        array.fill.assign(array.item(), '\0');
        return;
    }
    if (array.is_half) {
        array.fill = bytes_of_float(array, value);
        return;
    }
    switch (array.type) {
        case SampleType::Int8:
            array.fill = bytes_of_whole<std::int8_t>(array, value);
            break;
        case SampleType::UInt8:
            array.fill = bytes_of_whole<std::uint8_t>(array, value);
            break;
        case SampleType::Int16:
            array.fill = bytes_of_whole<std::int16_t>(array, value);
            break;
        case SampleType::UInt16:
            array.fill = bytes_of_whole<std::uint16_t>(array, value);
            break;
        case SampleType::Int32:
            array.fill = bytes_of_whole<std::int32_t>(array, value);
            break;
        case SampleType::UInt32:
            array.fill = bytes_of_whole<std::uint32_t>(array, value);
            break;
        case SampleType::Int64:
            array.fill = bytes_of_whole<std::int64_t>(array, value);
            break;
        case SampleType::UInt64:
            array.fill = bytes_of_whole<std::uint64_t>(array, value);
            break;
        case SampleType::Float32:
        case SampleType::Float64:
            array.fill = bytes_of_float(array, value);
            break;
    }
}

std::optional<ZarrCodec::Kind> packing_named(std::string name) {
    if (name.starts_with("numcodecs.")) name.erase(0, 10);
    using Kind = ZarrCodec::Kind;
    if (name == "blosc") return Kind::Blosc;
    if (name == "zstd") return Kind::Zstd;
    if (name == "lz4") return Kind::Lz4;
    if (name == "gzip" || name == "zlib") return Kind::Gzip;
    if (name == "bz2") return Kind::Bzip2;
    if (name == "crc32c") return Kind::Crc32c;
    return std::nullopt;
}

constexpr const char* kKnownCodecs = "blosc, zstd, lz4, gzip, zlib, bz2 or crc32c";

void set_v2(ZarrArray& array, const json& fields) {
    const json& type = zarr_field(array.where, fields, "dtype");
    const std::string name = type.is_string() ? type.get<std::string>() : "";
    const char* const kinds = "iufb";
    if (name.size() != 3 || std::string_view("<>|=").find(name[0]) == std::string_view::npos ||
        std::string_view(kinds).find(name[1]) == std::string_view::npos || name[2] < '1' || name[2] > '8')
        fail("{}: 'dtype': {}: expected whole numbers or floats of 8 to 64 bits, such as <u2", array.where,
             shown_json(type));
    const int bits = 8 * (name[2] - '0');
    set_type(array, name[1] == 'b'   ? std::string(bits == 8 ? "bool" : "bool of several bytes")
                    : name[1] == 'i' ? fmt::format("int{}", bits)
                    : name[1] == 'u' ? fmt::format("uint{}", bits)
                                     : fmt::format("float{}", bits));
    if (const auto filters = fields.find("filters");
        filters != fields.end() && !filters->is_null() && !(filters->is_array() && filters->empty()))
        fail("{}: 'filters': {}: filters are not read; expected none", array.where, shown_json(*filters));
    const std::string order = fields.contains("order") ? zarr_text(array.where, fields, "order") : "C";
    if (order != "C" && order != "F") fail("{}: 'order': {}: expected C or F", array.where, order);
    if (order == "F") {
        ZarrCodec transpose{.kind = ZarrCodec::Kind::Transpose};
        for (std::size_t axis = array.shape.size(); axis-- > 0;)
            transpose.order.push_back(axis);
        array.codecs.push_back(transpose);
    }
    array.codecs.push_back({.kind = ZarrCodec::Kind::Bytes,
                            .is_swapped = name[0] == '<' ? !kHostIsLittle : name[0] == '>' && kHostIsLittle});
    if (const auto compressor = fields.find("compressor"); compressor != fields.end() && !compressor->is_null()) {
        if (!compressor->is_object())
            fail("{}: 'compressor': {}: expected an object with an id", array.where, shown_json(*compressor));
        const std::string id = zarr_text(array.where, *compressor, "id");
        const auto kind = packing_named(id);
        if (!kind) fail("{}: compressor '{}': expected {}", array.where, id, kKnownCodecs);
        array.codecs.push_back({.kind = *kind});
    }
    const std::string separator =
        fields.contains("dimension_separator") ? zarr_text(array.where, fields, "dimension_separator") : ".";
    if (separator != "." && separator != "/")
        fail("{}: 'dimension_separator': '{}': expected '.' or '/'", array.where, separator);
    array.separator = separator[0];
}

/// A codec, or an extension of the format, as {"name": ..., "configuration": {...}} or as its name alone.
std::string v3_name(const std::string& where, const json& value, const char* what) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_object() && value.contains("name") && value["name"].is_string())
        return value["name"].get<std::string>();
    fail("{}: '{}': {}: expected an object with a name", where, what, shown_json(value));
}

json v3_configuration(const std::string& where, const json& value) {
    if (!value.is_object() || !value.contains("configuration")) return json::object();
    if (!value["configuration"].is_object())
        fail("{}: 'configuration': {}: expected an object", where, shown_json(value["configuration"]));
    return value["configuration"];
}

std::vector<ZarrCodec> v3_codecs(const std::string& where, const json& list, std::size_t item, ZarrShape shape,
                                 int depth) {
    if (!list.is_array() || list.empty() || list.size() > 16)
        fail("{}: 'codecs': {}: expected a list of 1 to 16 codecs", where, shown_json(list));
    std::vector<ZarrCodec> codecs;
    bool has_bytes = false;
    for (const json& entry : list) {
        const std::string name = v3_name(where, entry, "codecs");
        const json settings = v3_configuration(where, entry);
        ZarrCodec codec;
        if (name == "transpose") {
            codec.kind = ZarrCodec::Kind::Transpose;
            const json order = settings.contains("order") ? settings["order"] : json();
            if (order == "F" || order == "C") {
                for (std::size_t axis = 0; axis < shape.size(); ++axis)
                    codec.order.push_back(order == "F" ? shape.size() - 1 - axis : axis);
            } else {
                codec.order = zarr_shape(where, settings, "order", 0);
            }
            ZarrShape sorted = codec.order;
            std::ranges::sort(sorted);
            bool is_permutation = sorted.size() == shape.size();
            for (std::size_t axis = 0; is_permutation && axis < sorted.size(); ++axis)
                is_permutation = sorted[axis] == axis;
            if (!is_permutation || has_bytes)
                fail("{}: codec transpose: order {}: expected the {} axes, before the bytes", where, shown_json(order),
                     shape.size());
            ZarrShape turned;
            for (const std::size_t axis : codec.order)
                turned.push_back(shape[axis]);
            shape = turned;
        } else if (name == "bytes" || name == "endian" || name == "sharding_indexed") {
            if (has_bytes) fail("{}: codec {}: the samples are already bytes", where, name);
            has_bytes = true;
            if (name == "sharding_indexed") {
                if (depth >= 2) fail("{}: shards in shards in shards are not read", where);
                codec.kind = ZarrCodec::Kind::Sharding;
                codec.inner_shape = zarr_shape(where, settings, "chunk_shape", 1);
                if (codec.inner_shape.size() != shape.size())
                    fail("{}: sharding_indexed: chunk_shape has {} axes, expected {}", where, codec.inner_shape.size(),
                         shape.size());
                for (std::size_t axis = 0; axis < shape.size(); ++axis)
                    if (shape[axis] % codec.inner_shape[axis] != 0)
                        fail(
                            "{}: sharding_indexed: chunks of {} voxels in shards of {} along axis {}: expected a "
                            "divisor",
                            where, codec.inner_shape[axis], shape[axis], axis);
                codec.inner =
                    v3_codecs(where, zarr_field(where, settings, "codecs"), item, codec.inner_shape, depth + 1);
                codec.index = v3_codecs(where, zarr_field(where, settings, "index_codecs"), 8, {1}, 9);
                for (const ZarrCodec& one : codec.index)
                    if (one.kind != ZarrCodec::Kind::Bytes && one.kind != ZarrCodec::Kind::Crc32c)
                        fail("{}: sharding_indexed: an index that is packed is not read; expected bytes and crc32c",
                             where);
                const std::string place =
                    settings.contains("index_location") ? zarr_text(where, settings, "index_location") : "end";
                if (place != "end" && place != "start")
                    fail("{}: sharding_indexed: index_location '{}': expected start or end", where, place);
                codec.index_at_end = place == "end";
            } else {
                const std::string endian = settings.contains("endian") ? zarr_text(where, settings, "endian") : "";
                if (endian != "little" && endian != "big" && (item > 1 || !endian.empty()))
                    fail("{}: codec bytes: endian '{}': expected little or big", where, endian);
                codec.is_swapped = item > 1 && (endian == "little") != kHostIsLittle;
            }
        } else {
            const auto kind = packing_named(name);
            if (!kind)
                fail("{}: codec '{}': expected transpose, bytes, sharding_indexed, {}", where, name, kKnownCodecs);
            if (!has_bytes) fail("{}: codec {}: expected after the codec bytes", where, name);
            codec.kind = *kind;
        }
        codecs.push_back(std::move(codec));
    }
    if (!has_bytes) fail("{}: 'codecs': expected bytes or sharding_indexed among them", where);
    return codecs;
}

void set_v3(ZarrArray& array, const json& fields) {
    set_type(array, v3_name(array.where, zarr_field(array.where, fields, "data_type"), "data_type"));
    const auto storage = fields.find("storage_transformers");
    if (storage != fields.end() && !(storage->is_array() && storage->empty()))
        fail("{}: 'storage_transformers': {}: expected none", array.where, shown_json(*storage));
    const json encoding = fields.contains("chunk_key_encoding") ? fields["chunk_key_encoding"] : json("default");
    const std::string name = v3_name(array.where, encoding, "chunk_key_encoding");
    if (name != "default" && name != "v2")
        fail("{}: 'chunk_key_encoding': '{}': expected default or v2", array.where, name);
    if (name == "default") array.key_prefix = "c";
    const json settings = v3_configuration(array.where, encoding);
    const std::string separator = settings.contains("separator") ? zarr_text(array.where, settings, "separator")
                                  : name == "default"            ? "/"
                                                                 : ".";
    if (separator != "." && separator != "/")
        fail("{}: 'chunk_key_encoding': separator '{}': expected '.' or '/'", array.where, separator);
    array.separator = separator[0];
    array.codecs = v3_codecs(array.where, zarr_field(array.where, fields, "codecs"), array.item(), array.chunk, 0);
    if (const auto names = fields.find("dimension_names"); names != fields.end() && names->is_array())
        for (const json& one : *names)
            array.dimension_names.push_back(one.is_string() ? one.get<std::string>() : "");
}

}  // namespace

std::optional<ZarrNode> zarr_node(const ZarrStore& store, const std::string& key) {
    ZarrNode node{.key = key};
    const std::string v3 = zarr_key(key, "zarr.json");
    if (const auto text = store.text(v3)) {
        node.version = 3;
        node.where = node.attributes_where = store.shown(v3);
        node.metadata = parsed_json(node.where, *text);
        const json& format = zarr_field(node.where, node.metadata, "zarr_format");
        if (format != 3) fail("{}: 'zarr_format': {}: expected 3", node.where, shown_json(format));
        const std::string type = zarr_text(node.where, node.metadata, "node_type");
        if (type != "array" && type != "group")
            fail("{}: 'node_type': '{}': expected array or group", node.where, type);
        node.is_array = type == "array";
        node.attributes = node.metadata.contains("attributes") ? node.metadata["attributes"] : json::object();
        if (!node.attributes.is_object()) fail("{}: 'attributes': expected an object", node.where);
        return node;
    }
    const auto array = store.text(zarr_key(key, ".zarray")), group = store.text(zarr_key(key, ".zgroup")),
               attributes = store.text(zarr_key(key, ".zattrs"));
    if (!array && !group && !attributes) return std::nullopt;
    node.is_array = array.has_value();
    node.where = store.shown(zarr_key(key, array ? ".zarray" : group ? ".zgroup" : ".zattrs"));
    if (array || group) {
        node.metadata = parsed_json(node.where, array ? *array : *group);
        const json& format = zarr_field(node.where, node.metadata, "zarr_format");
        if (format != 2) fail("{}: 'zarr_format': {}: expected 2", node.where, shown_json(format));
    }
    node.attributes = json::object();
    node.attributes_where = store.shown(zarr_key(key, ".zattrs"));
    if (attributes) node.attributes = parsed_json(node.attributes_where, *attributes);
    return node;
}

ZarrArray zarr_array(const ZarrNode& node) {
    ZarrArray array{
        .key = node.key, .where = node.where, .attributes_where = node.attributes_where, .attributes = node.attributes};
    array.shape = zarr_shape(node.where, node.metadata, "shape", 1);
    if (node.version == 2) {
        array.chunk = zarr_shape(node.where, node.metadata, "chunks", 1);
    } else {
        const json& grid = zarr_field(node.where, node.metadata, "chunk_grid");
        if (const std::string name = v3_name(node.where, grid, "chunk_grid"); name != "regular")
            fail("{}: 'chunk_grid': '{}': expected regular", node.where, name);
        array.chunk = zarr_shape(node.where, v3_configuration(node.where, grid), "chunk_shape", 1);
    }
    if (array.shape.empty() || array.chunk.size() != array.shape.size())
        fail("{}: {} axes, but chunks of {}: expected the same, at least 1", node.where, array.shape.size(),
             array.chunk.size());
    node.version == 2 ? set_v2(array, node.metadata) : set_v3(array, node.metadata);
    if (const auto names = node.attributes.find("_ARRAY_DIMENSIONS");
        array.dimension_names.empty() && names != node.attributes.end() && names->is_array())
        for (const json& one : *names)
            array.dimension_names.push_back(one.is_string() ? one.get<std::string>() : "");
    if (!array.dimension_names.empty() && array.dimension_names.size() != array.shape.size())
        fail("{}: {} names for {} axes", node.attributes_where, array.dimension_names.size(), array.shape.size());
    const auto fill = node.metadata.find("fill_value");
    set_fill(array, fill == node.metadata.end() ? json() : *fill);
    return array;
}

}  // namespace edgesplat::detail
