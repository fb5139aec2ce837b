#include "engine/volume/io/stored_data.h"

#include <bzlib.h>
#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>

#include "engine/volume/io/samples.h"

namespace edgesplat::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kChunk = 1 << 20;

/// The bytes of a data file after unpacking.
class StoredBytes {
  public:
    explicit StoredBytes(const StoredData& data, const fs::path& file)
        : data_(data), in_(file, std::ios::binary), name_(file.string()) {
        if (!in_) fail("{}: its data file {} cannot be read", data.path, name_);
        in_.seekg(static_cast<std::streamoff>(data.offset));
        std::string line;
        for (std::size_t i = 0; i < data.line_skip; ++i)
            if (!in_.ignore(std::numeric_limits<std::streamsize>::max(), '\n') || in_.eof())
                fail("{}: it ends before the {} lines to skip", data.path, data.line_skip);
    }
    virtual ~StoredBytes() = default;
    StoredBytes(const StoredBytes&) = delete;
    StoredBytes& operator=(const StoredBytes&) = delete;

    /// Reads up to `count` bytes; fewer only at the end.
    virtual std::size_t read(char* to, std::size_t count) = 0;
    virtual void skip(std::size_t count) {
        std::vector<char> part(std::min(count, kChunk));
        while (count > 0) {
            const std::size_t got = read(part.data(), std::min(count, part.size()));
            if (got == 0) fail("{}: truncated: it ends before the bytes to skip", data_.path);
            count -= got;
        }
    }
    std::size_t position() { return static_cast<std::size_t>(in_.tellg()); }

  protected:
    std::size_t read_file(char* to, std::size_t count) {
        in_.read(to, static_cast<std::streamsize>(count));
        return static_cast<std::size_t>(in_.gcount());
    }
    const StoredData& data_;
    std::ifstream in_;
    std::string name_;
};

class RawBytes final : public StoredBytes {
  public:
    using StoredBytes::StoredBytes;
    std::size_t read(char* to, std::size_t count) override { return read_file(to, count); }
    void skip(std::size_t count) override { in_.seekg(static_cast<std::streamoff>(count), std::ios::cur); }
};

class DeflateBytes final : public StoredBytes {
  public:
    DeflateBytes(const StoredData& data, const fs::path& file) : StoredBytes(data, file), packed_(kChunk / 4) {
        if (inflateInit2(&stream_, 15 + 32) != Z_OK) fail("{}: zlib cannot be started", data.path);
    }
    ~DeflateBytes() override { inflateEnd(&stream_); }

    std::size_t read(char* to, std::size_t count) override {
        stream_.next_out = reinterpret_cast<Bytef*>(to);
        std::size_t left = count;
        while (left > 0) {
            const auto most = static_cast<unsigned>(std::min(left, std::size_t{1} << 30));
            stream_.avail_out = most;
            if (stream_.avail_in == 0) {
                stream_.avail_in = static_cast<unsigned>(read_file(packed_.data(), packed_.size()));
                stream_.next_in = reinterpret_cast<Bytef*>(packed_.data());
                if (stream_.avail_in == 0) break;
            }
            if (ended_) {
                // gzip allows members one after the other; everything else after the end is padding.
                if (*stream_.next_in != 0x1f || inflateReset(&stream_) != Z_OK) break;
                ended_ = false;
            }
            const int status = inflate(&stream_, Z_NO_FLUSH);
            left -= most - stream_.avail_out;
            ended_ = status == Z_STREAM_END;
            if (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR)
                fail("{}: damaged compressed data: {}", data_.path, stream_.msg == nullptr ? "unknown" : stream_.msg);
        }
        return count - left;
    }
    bool at_end() const { return ended_; }

  private:
    std::vector<char> packed_;
    z_stream stream_{};
    bool ended_ = false;
};

class Bzip2Bytes final : public StoredBytes {
  public:
    Bzip2Bytes(const StoredData& data, const fs::path& file) : StoredBytes(data, file), packed_(kChunk / 4) { start(); }
    ~Bzip2Bytes() override { BZ2_bzDecompressEnd(&stream_); }

    std::size_t read(char* to, std::size_t count) override {
        stream_.next_out = to;
        std::size_t left = count;
        while (left > 0) {
            const auto most = static_cast<unsigned>(std::min(left, std::size_t{1} << 30));
            stream_.avail_out = most;
            if (stream_.avail_in == 0) {
                stream_.avail_in = static_cast<unsigned>(read_file(packed_.data(), packed_.size()));
                stream_.next_in = packed_.data();
                if (stream_.avail_in == 0) break;
            }
            if (ended_) {
                if (*stream_.next_in != 'B') break;
                BZ2_bzDecompressEnd(&stream_);
                const bz_stream old = stream_;
                start();
                stream_.next_in = old.next_in;
                stream_.avail_in = old.avail_in;
                stream_.next_out = old.next_out;
                stream_.avail_out = old.avail_out;
            }
            const int status = BZ2_bzDecompress(&stream_);
            left -= most - stream_.avail_out;
            ended_ = status == BZ_STREAM_END;
            if (status != BZ_OK && status != BZ_STREAM_END) fail("{}: damaged bzip2 data", data_.path);
        }
        return count - left;
    }

  private:
    void start() {
        stream_ = {};
        ended_ = false;
        if (BZ2_bzDecompressInit(&stream_, 0, 0) != BZ_OK) fail("{}: bzip2 cannot be started", data_.path);
    }
    std::vector<char> packed_;
    bz_stream stream_{};
    bool ended_ = false;
};

/// Characters of a text file, buffered.
class TextBytes : public StoredBytes {
  public:
    TextBytes(const StoredData& data, const fs::path& file) : StoredBytes(data, file), part_(kChunk / 16) {
        in_.seekg(static_cast<std::streamoff>(data.byte_skip), std::ios::cur);
    }

  protected:
    static constexpr int kEnd = -1;
    int next() {
        if (at_ == got_) {
            got_ = read_file(part_.data(), part_.size());
            at_ = 0;
            if (got_ == 0) return kEnd;
        }
        return static_cast<unsigned char>(part_[at_++]);
    }

  private:
    std::vector<char> part_;
    std::size_t at_ = 0, got_ = 0;
};

class HexBytes final : public TextBytes {
  public:
    using TextBytes::TextBytes;
    std::size_t read(char* to, std::size_t count) override {
        for (std::size_t i = 0; i < count; ++i) {
            const int high = digit(), low = high == kEnd ? kEnd : digit();
            if (low == kEnd) return i;
            to[i] = static_cast<char>(high * 16 + low);
        }
        return count;
    }

  private:
    int digit() {
        int c = next();
        while (c != kEnd && std::isspace(c) != 0)
            c = next();
        if (c == kEnd) return kEnd;
        if (std::isxdigit(c) == 0) fail("{}: a character with code {} among its hexadecimal digits", data_.path, c);
        return std::isdigit(c) != 0 ? c - '0' : std::tolower(c) - 'a' + 10;
    }
};

/// Numbers as text become samples of the type, in this machine's byte order.
class NumberBytes final : public TextBytes {
  public:
    using TextBytes::TextBytes;
    std::size_t read(char* to, std::size_t count) override {
        const std::size_t item = size_of(data_.type);
        for (std::size_t i = 0; i + item <= count; i += item) {
            const std::string_view text = word();
            if (text.empty()) return i;
            store(text, to + i);
        }
        return count;
    }

  private:
    std::string_view word() {
        int c = next();
        while (c != kEnd && is_between(c))
            c = next();
        std::size_t length = 0;
        for (; c != kEnd && !is_between(c); c = next()) {
            if (length == word_.size()) fail("{}: its data contain a word that is no number", data_.path);
            word_[length++] = static_cast<char>(c);
        }
        std::string_view text(word_.data(), length);
        if (text.starts_with('+')) text.remove_prefix(1);
        return text;
    }
    static bool is_between(int c) { return c == ',' || std::isspace(c) != 0; }

    template <typename T>
    void put(std::string_view text, char* to) const {
        T value{};
        const char* const end = text.data() + text.size();
        double wide = 0;
        auto result = std::from_chars(text.data(), end, wide);
        bool good = result.ec == std::errc() && result.ptr == end;
        if constexpr (std::is_integral_v<T>) {
            result = std::from_chars(text.data(), end, value);
            // "3.0" is 3
            good = result.ec == std::errc() && (result.ptr == end || (good && wide == static_cast<double>(value)));
        } else {
            if (result.ec == std::errc::result_out_of_range && result.ptr == end) {
                wide = std::strtod(std::string(text).c_str(), nullptr);  // 0 or infinite
                good = true;
            }
            value = static_cast<T>(wide);
        }
        if (!good)
            fail("{}: its data contain '{}', expected numbers of type {}", data_.path, text.substr(0, 40),
                 name_of(data_.type));
        std::memcpy(to, &value, sizeof(T));
    }

    void store(std::string_view text, char* to) const {
        switch (data_.type) {
            case SampleType::Int8:
                return put<signed char>(text, to);
            case SampleType::UInt8:
                return put<unsigned char>(text, to);
            case SampleType::Int16:
                return put<std::int16_t>(text, to);
            case SampleType::UInt16:
                return put<std::uint16_t>(text, to);
            case SampleType::Int32:
                return put<std::int32_t>(text, to);
            case SampleType::UInt32:
                return put<std::uint32_t>(text, to);
            case SampleType::Int64:
                return put<std::int64_t>(text, to);
            case SampleType::UInt64:
                return put<std::uint64_t>(text, to);
            case SampleType::Float32:
                return put<float>(text, to);
            case SampleType::Float64:
                return put<double>(text, to);
        }
    }
    std::array<char, 400> word_{};
};

std::unique_ptr<StoredBytes> opened(const StoredData& data, const fs::path& file) {
    switch (data.encoding) {
        case StoredEncoding::Raw:
            return std::make_unique<RawBytes>(data, file);
        case StoredEncoding::Deflate:
            return std::make_unique<DeflateBytes>(data, file);
        case StoredEncoding::Bzip2:
            return std::make_unique<Bzip2Bytes>(data, file);
        case StoredEncoding::Hex:
            return std::make_unique<HexBytes>(data, file);
        case StoredEncoding::Text:
            return std::make_unique<NumberBytes>(data, file);
    }
    return nullptr;
}

bool is_text(StoredEncoding encoding) {
    return encoding == StoredEncoding::Text || encoding == StoredEncoding::Hex;
}

/// Opens a file at its first sample.
std::unique_ptr<StoredBytes> opened_at_data(const StoredData& data, const fs::path& file, std::size_t share) {
    auto bytes = opened(data, file);
    std::size_t skip = is_text(data.encoding) ? 0 : data.byte_skip;  // TextBytes skips characters
    if (data.at_end) {
        std::size_t total = 0;
        if (data.encoding == StoredEncoding::Raw) {
            total = fs::file_size(file) - std::min(bytes->position(), static_cast<std::size_t>(fs::file_size(file)));
        } else {
            std::vector<char> part(kChunk);
            for (std::size_t got = part.size(); got > 0; total += got)
                got = bytes->read(part.data(), part.size());
            bytes = opened(data, file);
        }
        if (total < share) fail("{}: truncated: {} of {} bytes of voxels", data.path, total, share);
        skip = total - share;
    }
    bytes->skip(skip);
    return bytes;
}

/// All samples, one file after the other.
class StoredStream {
  public:
    explicit StoredStream(const StoredData& data) : data_(data), share_(data.bytes() / data.files.size()) {}

    void read(char* to, std::size_t count) {
        while (count > 0) {
            if (left_ == 0) {
                bytes_ = opened_at_data(data_, data_.files[file_++], share_);
                left_ = share_;
            }
            const std::size_t part = std::min(count, left_);
            // In parts, because text is converted number by number and the end is reported in bytes.
            const std::size_t got = bytes_->read(to, part);
            if (got < part) fail("{}: truncated: {} of {} bytes of voxels", data_.path, share_ - left_ + got, share_);
            left_ -= part;
            to += part;
            count -= part;
        }
    }
    void skip(std::size_t count) {
        if (data_.encoding == StoredEncoding::Raw) {  // files that are skipped need not be opened
            while (count > 0) {
                if (left_ == 0) {
                    bytes_ = opened_at_data(data_, data_.files[file_++], share_);
                    left_ = share_;
                }
                const std::size_t part = std::min(count, left_);
                bytes_->skip(part);
                left_ -= part;
                count -= part;
            }
            return;
        }
        std::vector<char> part(std::min(count, kChunk));
        for (; count > 0; count -= std::min(count, part.size()))
            read(part.data(), std::min(count, part.size()));
    }
    /// Bytes after the last sample in the last file, at most kSpare + 1.
    std::size_t spare() {
        std::array<char, kSpare + 1> more{};
        const bool known = is_text(data_.encoding) || data_.at_end || data_.may_continue;
        return known || !bytes_ ? 0 : bytes_->read(more.data(), more.size());
    }
    static constexpr std::size_t kSpare = 16;

  private:
    const StoredData& data_;
    std::size_t share_, file_ = 0, left_ = 0;
    std::unique_ptr<StoredBytes> bytes_;
};

std::size_t first_byte(const StoredData& data) {
    return opened_at_data(data, data.files.front(), data.bytes())->position();
}

}  // namespace

void check_stored(const StoredData& data) {
    std::size_t stored = 0;
    for (const auto& file : data.files) {
        std::error_code error;
        const auto type = fs::status(file, error).type();
        if (type != fs::file_type::regular)
            fail("{}: its data file {} {}", data.path, file.string(),
                 type == fs::file_type::not_found ? "does not exist"
                 : error                          ? error.message()
                                                  : "is not a file");
        if (!data.header.empty() && fs::equivalent(file, data.header, error))
            fail("{}: its data file is the header itself", data.path);
        stored += fs::file_size(file);
    }
    if (data.samples % data.files.size() != 0)
        fail("{}: {} samples cannot be divided among {} data files", data.path, data.samples, data.files.size());
    // A number as text takes a digit and a blank. bzip2 packs zeros by more than any useful bound.
    const std::size_t needed = is_text(data.encoding) ? data.samples : data.bytes();
    if (data.encoding == StoredEncoding::Bzip2) return;
    check_stored_size(data.path, needed, stored,
                      data.encoding == StoredEncoding::Deflate ? kBestDeflateRatio : std::size_t{1});
    if (data.encoding != StoredEncoding::Raw) return;
    const std::size_t share = data.bytes() / data.files.size();
    for (const auto& file : data.files) {
        const std::size_t size = fs::file_size(file), from = data.offset + (data.at_end ? 0 : data.byte_skip);
        if (size < from || size - from < share)
            fail("{}: truncated: {} holds {} of {} bytes of voxels", data.path, file.filename().string(),
                 size - std::min(size, from), share);
    }
}

void read_stored(const StoredData& data, const StoredSelection& selection, Volume& volume, const LoadOptions& options) {
    check_stored(data);
    const glm::ivec3& dims = volume.geometry.dims;
    const auto nx = static_cast<std::size_t>(dims.x), ny = static_cast<std::size_t>(dims.y);
    const std::size_t voxels = volume.geometry.voxel_count(), item = size_of(data.type), step = selection.step[0];
    const bool even = selection.step[1] == step * nx && selection.step[2] == step * nx * ny;
    const std::size_t begin = even ? selection.first - selection.first % step : 0;
    const std::size_t count = even ? voxels * step : data.samples;
    if (volume.stored_type.empty()) volume.stored_type = name_of(data.type);
    StoredSamples stored{.type = data.type,
                         .stride = step,
                         .swapped = data.swapped && data.encoding != StoredEncoding::Text,
                         .slope = data.slope,
                         .intercept = data.intercept};
    const bool as_a_whole = needs_all(stored);
    StoredStream stream(data);
    report(options, 0.05, "reading voxels");
    try {
        stream.skip(begin * item);
        if (even && !as_a_whole) {
            const std::size_t part = std::max<std::size_t>(kChunk / (step * item), 1);
            const auto buffer = std::make_unique_for_overwrite<char[]>(std::min(part, voxels) * step * item);
            stored.data = buffer.get() + (selection.first - begin) * item;
            for (std::size_t done = 0; done < voxels; done += part) {
                const std::size_t now = std::min(part, voxels - done);
                stream.read(buffer.get(), now * step * item);
                if (done == 0) volume.values.resize(voxels);  // a file of another content has failed by now
                convert_stored(stored, now, volume.values.data() + done);
                report(options, 0.05 + 0.8 * static_cast<double>(done) / static_cast<double>(voxels), "reading voxels");
            }
        } else {
            auto buffer = std::make_unique_for_overwrite<char[]>(count * item);
            for (std::size_t done = 0; done < count; done += kChunk) {
                stream.read(buffer.get() + done * item, std::min(kChunk, count - done) * item);
                report(options, 0.05 + 0.6 * static_cast<double>(done) / static_cast<double>(count), "reading voxels");
            }
            stored.data = buffer.get() + (selection.first - begin) * item;
            if (!even) {
                auto gathered = std::make_unique_for_overwrite<char[]>(voxels * item);
                char* to = gathered.get();
                for (std::size_t z = 0; z < static_cast<std::size_t>(dims.z); ++z)
                    for (std::size_t y = 0; y < ny; ++y)
                        for (std::size_t x = 0; x < nx; ++x, to += item)
                            std::memcpy(
                                to,
                                buffer.get() +
                                    (selection.first + x * step + y * selection.step[1] + z * selection.step[2]) * item,
                                item);
                stored.data = gathered.get();
                stored.stride = 1;
                buffer = std::move(gathered);
            }
            report(options, 0.7, "converting voxels");
            take_samples(stored, volume);
        }
        stream.skip((data.samples - begin - count) * item);
    } catch (const std::bad_alloc&) {
        fail("{}: not enough memory for {} voxels", data.path, voxels);
    }
    const std::size_t spare = stream.spare();
    if (spare > StoredStream::kSpare)
        volume.warnings.emplace_back("Data after the last voxel were not used: the dims may be wrong.");
    else if (spare > 0)
        volume.notes.push_back(fmt::format("{} bytes after the last voxel were not used.", spare));
}

std::optional<FileLayout> layout_of_stored(const StoredData& data, const StoredSelection& selection,
                                           const Volume& description) {
    const auto& dims = description.geometry.dims;
    const bool contiguous = selection.step[0] == 1 && data.samples == description.geometry.voxel_count() &&
                            selection.step[1] == static_cast<std::size_t>(dims.x) &&
                            selection.step[2] == selection.step[1] * static_cast<std::size_t>(dims.y);
    if (data.encoding != StoredEncoding::Raw || data.files.size() != 1 || !contiguous) return std::nullopt;
    check_stored(data);
    return FileLayout{.file = data.files.front().string(),
                      .offset = first_byte(data),
                      .type = data.type,
                      .swapped = data.swapped,
                      .slope = data.slope,
                      .intercept = data.intercept};
}

std::string without_gzip(const std::string& path, std::optional<TemporaryFolder>& folder) {
    std::ifstream in(path, std::ios::binary);
    std::array<char, 2> magic{};
    in.read(magic.data(), 2);
    if (magic != std::array<char, 2>{'\x1f', '\x8b'}) return path;
    StoredData data;
    data.path = path;
    DeflateBytes bytes(data, path);
    folder.emplace();
    std::string target = (folder->path() / "unpacked").string();
    std::ofstream out(target, std::ios::binary);
    const std::size_t stored = fs::file_size(path);
    std::vector<char> part(kChunk);
    std::size_t total = 0;
    for (std::size_t got = part.size(); got == part.size();) {
        got = bytes.read(part.data(), part.size());
        total += got;
        check_stored_size(path, total, stored);
        check_memory(path, "the unpacked file", total);
        out.write(part.data(), static_cast<std::streamsize>(got));
    }
    if (!bytes.at_end()) fail("{}: truncated: its gzip data have no end", path);
    if (!out.flush()) fail("{}: cannot write a temporary file of {} bytes", path, total);
    return target;
}

std::vector<std::string> names_of_pattern(const std::string& path, std::string_view what, const std::string& pattern,
                                          long long first, long long last, long long step) {
    const auto percent = pattern.find('%');
    auto end = percent == std::string::npos ? pattern.size() : percent + 1;
    std::size_t width = 0;
    const bool zeros = end < pattern.size() && pattern[end] == '0';
    for (; end < pattern.size() && std::isdigit(static_cast<unsigned char>(pattern[end])) != 0 && width < 100; ++end)
        width = width * 10 + static_cast<std::size_t>(pattern[end] - '0');
    if (end >= pattern.size() || width >= 100 || (pattern[end] != 'd' && pattern[end] != 'u' && pattern[end] != 'i') ||
        pattern.find('%', end) != std::string::npos)
        fail("{}: {}: '{}' must hold one number like %03d", path, what, pattern);
    constexpr long long kMost = 1'000'000'000;
    const auto sane = [](long long n) { return n >= -kMost && n <= kMost; };
    if (!sane(first) || !sane(last) || !sane(step) || step == 0 || (last - first) / step < 0 ||
        ((last - first) % step != 0 && (last < first) != (step < 0)) || (last - first) / step >= 1'000'000)
        fail("{}: {}: {} to {} in steps of {} is no range of at most 1000000 files", path, what, first, last, step);
    std::vector<std::string> names;
    for (long long i = first; step > 0 ? i <= last : i >= last; i += step)
        names.push_back(pattern.substr(0, percent) +
                        (zeros ? fmt::format("{:0{}}", i, width) : fmt::format("{:{}}", i, width)) +
                        pattern.substr(end + 1));
    return names;
}

}  // namespace edgesplat::detail
