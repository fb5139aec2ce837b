// Decodes the chunks of Zarr arrays.
#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "engine/files/codec_library_internal.h"
#include "engine/volume/io/zarr.h"

namespace edgesplat::detail {
namespace {

std::uint32_t crc32c_of(std::string_view bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> made{};
        for (std::uint32_t i = 0; i < 256; ++i) {
            made[i] = i;
            for (int bit = 0; bit < 8; ++bit)
                made[i] = (made[i] >> 1) ^ ((made[i] & 1) != 0 ? 0x82F63B78U : 0U);
        }
        return made;
    }();
    std::uint32_t crc = 0xFFFFFFFFU;
    for (const char c : bytes)
        crc = (crc >> 8) ^ table[(crc ^ static_cast<unsigned char>(c)) & 0xFF];
    return ~crc;
}

template <typename T>
T little(const char* at) {
    T value = 0;
    for (std::size_t i = sizeof(T); i-- > 0;)
        value = static_cast<T>(value << 8) | static_cast<unsigned char>(at[i]);
    return value;
}

std::string unpack_gzip(std::string_view packed, void* target, std::size_t bytes) {
    constexpr std::size_t kMost = std::numeric_limits<uInt>::max();
    if (packed.size() > kMost || bytes > kMost) return "gzip data above 4 GiB";
    z_stream stream{};
    stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = static_cast<Bytef*>(target);
    stream.avail_out = static_cast<uInt>(bytes);
    if (inflateInit2(&stream, 15 + 32) != Z_OK) return "zlib cannot start";  // 32: gzip or zlib by the header
    const int result = inflate(&stream, Z_FINISH);
    const bool is_whole = result == Z_STREAM_END && stream.avail_out == 0;
    inflateEnd(&stream);
    return is_whole ? "" : "truncated or damaged gzip or zlib data, or of another size";
}

std::string unpack_bz2(std::string_view packed, void* target, std::size_t bytes) {
    constexpr std::size_t kMost = std::numeric_limits<unsigned>::max();
    if (packed.size() > kMost || bytes > kMost) return "bzip2 data above 4 GiB";
    auto size = static_cast<unsigned>(bytes);
    const int result = BZ2_bzBuffToBuffDecompress(static_cast<char*>(target), &size, const_cast<char*>(packed.data()),
                                                  static_cast<unsigned>(packed.size()), 0, 0);
    return result == BZ_OK && size == bytes ? "" : "truncated or damaged bzip2 data, or of another size";
}

/// The bytes before the codecs from `first` on packed them: `expected` of them.
std::string unpacked(const std::string& where, const std::vector<ZarrCodec>& codecs, std::size_t first,
                     std::string_view bytes, std::size_t expected) {
    std::vector<std::size_t> sizes{expected};  // before each codec; 0: unknown
    for (std::size_t i = first; i < codecs.size(); ++i) {
        const bool is_sum = codecs[i].kind == ZarrCodec::Kind::Crc32c;
        if (!is_sum && sizes.back() == 0) fail("{}: two codecs that pack one after the other are not read", where);
        sizes.push_back(is_sum && sizes.back() != 0 ? sizes.back() + 4 : 0);
    }
    std::string now(bytes);
    for (std::size_t i = codecs.size(); i-- > first;) {
        const auto kind = codecs[i].kind;
        if (kind == ZarrCodec::Kind::Crc32c) {
            if (now.size() < 4) fail("{}: truncated: no checksum", where);
            const auto sum = little<std::uint32_t>(now.data() + now.size() - 4);
            now.resize(now.size() - 4);
            if (crc32c_of(now) != sum) fail("{}: damaged: its crc32c checksum is wrong", where);
            continue;
        }
        std::string target(sizes[i - first], '\0');
        const std::string reason = kind == ZarrCodec::Kind::Gzip ? unpack_gzip(now, target.data(), target.size())
                                   : kind == ZarrCodec::Kind::Bzip2
                                       ? unpack_bz2(now, target.data(), target.size())
                                       : codec_library().unpack(kind == ZarrCodec::Kind::Blosc  ? Codec::Blosc
                                                                : kind == ZarrCodec::Kind::Zstd ? Codec::Zstd
                                                                                                : Codec::Lz4,
                                                                now, target.data(), target.size());
        if (!reason.empty()) fail("{}: truncated or damaged: {}", where, reason);
        now = std::move(target);
    }
    if (now.size() != expected)
        fail("{}: {} bytes, expected {}: truncated, or the metadata are wrong", where, now.size(), expected);
    return now;
}

std::size_t voxels_of(const std::string& where, const ZarrShape& shape, std::size_t item) {
    std::size_t count = 1, bytes = 0;
    for (const std::size_t size : shape)
        if (__builtin_mul_overflow(count, size, &count)) fail("{}: chunks of more than 2^64 voxels", where);
    if (__builtin_mul_overflow(count, item, &bytes)) fail("{}: chunks of more than 2^64 bytes", where);
    check_memory(where, "a chunk", bytes);
    return count;
}

std::vector<std::ptrdiff_t> row_major(const ZarrShape& shape, std::size_t item) {
    std::vector<std::ptrdiff_t> strides(shape.size());
    auto stride = static_cast<std::ptrdiff_t>(item);
    for (std::size_t axis = shape.size(); axis-- > 0;) {
        strides[axis] = stride;
        stride *= static_cast<std::ptrdiff_t>(shape[axis]);
    }
    return strides;
}

void swap_words(std::string& bytes, std::size_t word) {
    for (std::size_t at = 0; at + word <= bytes.size(); at += word)
        std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                     bytes.begin() + static_cast<std::ptrdiff_t>(at + word));
}

/// A sink for the transposed array: its axis i is axis order[i] of `sink`'s.
ZarrSink turned(const ZarrSink& sink, const ZarrShape& order) {
    const auto back = [order](const auto& list) {
        auto result = list;
        for (std::size_t axis = 0; axis < order.size(); ++axis)
            result[order[axis]] = list[axis];
        return result;
    };
    return {[&sink, back](const ZarrShape& origin, const ZarrShape& shape) {
                return sink.needs(back(origin), back(shape));
            },
            [&sink, back](const ZarrPiece& piece) {
                sink.take({back(piece.origin), back(piece.shape), piece.data, back(piece.strides)});
            }};
}

/// A sink for a chunk of a shard.
ZarrSink shifted(const ZarrSink& sink, const ZarrShape& by) {
    const auto moved = [by](ZarrShape origin) {
        for (std::size_t axis = 0; axis < by.size(); ++axis)
            origin[axis] += by[axis];
        return origin;
    };
    return {
        [&sink, moved](const ZarrShape& origin, const ZarrShape& shape) { return sink.needs(moved(origin), shape); },
        [&sink, moved](const ZarrPiece& piece) {
            sink.take({moved(piece.origin), piece.shape, piece.data, piece.strides});
        }};
}

void decode_from(const std::string& where, const ZarrArray& array, const std::vector<ZarrCodec>& codecs,
                 std::size_t first, std::string_view bytes, const ZarrShape& shape, const ZarrSink& sink);

void decode_shard(const std::string& where, const ZarrArray& array, const std::vector<ZarrCodec>& codecs,
                  std::size_t first, std::string_view packed, const ZarrShape& shape, const ZarrSink& sink) {
    const ZarrCodec& shard = codecs[first];
    for (std::size_t i = first + 1; i < codecs.size(); ++i)
        if (codecs[i].kind != ZarrCodec::Kind::Crc32c)
            fail("{}: shards that are packed as a whole are not read", where);
    std::string checked;
    if (first + 1 < codecs.size()) {
        const std::size_t sums = 4 * (codecs.size() - first - 1);
        if (packed.size() < sums) fail("{}: truncated: a shard of {} bytes", where, packed.size());
        checked = unpacked(where, codecs, first + 1, packed, packed.size() - sums);
        packed = checked;
    }
    ZarrShape grid;
    for (std::size_t axis = 0; axis < shape.size(); ++axis)
        grid.push_back(shape[axis] / shard.inner_shape[axis]);
    const std::size_t count = voxels_of(where, grid, 16);
    std::size_t index_bytes = 16 * count, sums = 0;
    for (const ZarrCodec& codec : shard.index)
        sums += codec.kind == ZarrCodec::Kind::Crc32c ? 4 : 0;
    if (packed.size() < index_bytes + sums)
        fail("{}: truncated: a shard of {} bytes, but its index alone has {}", where, packed.size(),
             index_bytes + sums);
    const std::size_t bytes_at = static_cast<std::size_t>(
        std::ranges::find(shard.index, ZarrCodec::Kind::Bytes, &ZarrCodec::kind) - shard.index.begin());
    std::string index = unpacked(
        where, shard.index, bytes_at + 1,
        packed.substr(shard.index_at_end ? packed.size() - index_bytes - sums : 0, index_bytes + sums), index_bytes);
    if (shard.index[bytes_at].is_swapped) swap_words(index, 8);
    ZarrShape at(shape.size(), 0);
    for (std::size_t i = 0; i < count; ++i) {
        ZarrShape origin = at;
        for (std::size_t axis = 0; axis < at.size(); ++axis)
            origin[axis] *= shard.inner_shape[axis];
        for (std::size_t axis = at.size(); axis-- > 0;) {
            if (++at[axis] < grid[axis]) break;
            at[axis] = 0;
        }
        const ZarrSink inside = shifted(sink, origin);
        if (!inside.needs(ZarrShape(shape.size(), 0), shard.inner_shape)) continue;
        std::uint64_t begin = 0, size = 0;
        std::memcpy(&begin, index.data() + 16 * i, 8);
        std::memcpy(&size, index.data() + 16 * i + 8, 8);
        if (begin == ~std::uint64_t{0} && size == ~std::uint64_t{0}) {
            fill_zarr_piece(array, shard.inner_shape, inside);
            continue;
        }
        if (begin > packed.size() || size > packed.size() - begin)
            fail("{}: truncated: its index puts a chunk at byte {} with {} bytes, but the shard has {}", where, begin,
                 size, packed.size());
        decode_from(where, array, shard.inner, 0, packed.substr(begin, size), shard.inner_shape, inside);
    }
}

void decode_from(const std::string& where, const ZarrArray& array, const std::vector<ZarrCodec>& codecs,
                 std::size_t first, std::string_view bytes, const ZarrShape& shape, const ZarrSink& sink) {
    const ZarrCodec& codec = codecs[first];
    if (codec.kind == ZarrCodec::Kind::Transpose) {
        ZarrShape coded;
        for (const std::size_t axis : codec.order)
            coded.push_back(shape[axis]);
        return decode_from(where, array, codecs, first + 1, bytes, coded, turned(sink, codec.order));
    }
    if (codec.kind == ZarrCodec::Kind::Sharding) return decode_shard(where, array, codecs, first, bytes, shape, sink);
    const std::size_t size = voxels_of(where, shape, array.item()) * array.item();
    std::string samples = unpacked(where, codecs, first + 1, bytes, size);
    if (codec.is_swapped) swap_words(samples, array.item());
    sink.take({ZarrShape(shape.size(), 0), shape, samples.data(), row_major(shape, array.item())});
}

}  // namespace

void decode_zarr_chunk(const std::string& where, const ZarrArray& array, const std::vector<ZarrCodec>& codecs,
                       std::string_view bytes, const ZarrShape& shape, const ZarrSink& sink) {
    decode_from(where, array, codecs, 0, bytes, shape, sink);
}

void fill_zarr_piece(const ZarrArray& array, const ZarrShape& shape, const ZarrSink& sink) {
    sink.take({ZarrShape(shape.size(), 0), shape, array.fill.data(), std::vector<std::ptrdiff_t>(shape.size(), 0)});
}

}  // namespace edgesplat::detail
