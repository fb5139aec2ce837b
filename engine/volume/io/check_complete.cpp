// Checks that a file is complete. Some libraries read uninitialised memory instead of missing data (netCDF, NIfTI) or
// abort the program on an assertion (GDCM as Debian builds it). They get only files whose structure ends at the end of
// the file.
#include <algorithm>
#include <cstdint>
#include <fstream>

#include "engine/volume/io/readers.h"

namespace edgesplat::detail {
namespace {

class Bytes {
  public:
    explicit Bytes(const std::string& path)
        : file_(path, std::ios::binary), size_(std::filesystem::file_size(path)), path_(path) {}

    std::uint64_t size() const { return size_; }
    std::uint64_t at() const { return at_; }
    std::uint64_t left() const { return size_ - at_; }
    void rewind() { at_ = 0; }
    void skip(std::uint64_t count) {
        if (count > left()) truncated();
        at_ += count;
    }
    std::uint64_t number(int bytes, bool big) {
        if (left() < static_cast<std::uint64_t>(bytes)) truncated();
        unsigned char raw[8] = {};
        file_.seekg(static_cast<std::streamoff>(at_));
        file_.read(reinterpret_cast<char*>(raw), bytes);
        at_ += static_cast<std::uint64_t>(bytes);
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i)
            value = (value << 8) | raw[big ? i : bytes - 1 - i];
        return value;
    }
    std::string text(std::uint64_t count) {
        if (count > left()) truncated();
        std::string value(count, '\0');
        file_.seekg(static_cast<std::streamoff>(at_));
        file_.read(value.data(), static_cast<std::streamsize>(count));
        at_ += count;
        return value;
    }
    [[noreturn]] void truncated() const { fail("{}: truncated: its data continue beyond the end of the file", path_); }

  private:
    std::ifstream file_;
    std::uint64_t size_, at_ = 0;
    std::string path_;
};

constexpr std::uint32_t kUndefined = 0xffffffff;
constexpr std::uint32_t kItem = 0xfffee000, kItemEnd = 0xfffee00d, kSequenceEnd = 0xfffee0dd;
// Thrown for a file of unknown structure, which is left to GDCM.
struct NotUnderstood {};

struct Dataset {
    Bytes& bytes;
    bool big, explicit_vr;

    std::uint32_t tag() {
        const auto group = bytes.number(2, big);
        return static_cast<std::uint32_t>(group << 16 | bytes.number(2, big));
    }
    // Length of the value after the tag; `vr` is empty if there is none.
    std::uint32_t length(std::string& vr) {
        vr.clear();
        if (!explicit_vr) return static_cast<std::uint32_t>(bytes.number(4, big));
        vr = bytes.text(2);
        for (const char c : vr)
            if (c < 'A' || c > 'Z') throw NotUnderstood{};
        static constexpr std::string_view kLong = "OB OW OF OD OL OV SQ UT UN UC UR SV UV";
        if (kLong.find(vr) == std::string_view::npos) return static_cast<std::uint32_t>(bytes.number(2, big));
        bytes.skip(2);
        return static_cast<std::uint32_t>(bytes.number(4, big));
    }
    // Skips elements up to `end` or the end-of-item tag.
    void elements(std::uint64_t end, int depth) {
        std::string vr;
        while (bytes.at() < end) {
            const auto here = tag();
            if (here == kItemEnd) {
                bytes.skip(4);
                return;
            }
            const auto count = length(vr);
            if (count != kUndefined)
                bytes.skip(count);
            else
                items(here == 0x7fe00010, depth + 1);
        }
    }
    // Skips the items of a sequence of undefined length, or the fragments of compressed pixels.
    void items(bool fragments, int depth) {
        if (depth > 32) throw NotUnderstood{};
        while (true) {
            const auto here = tag();
            const auto count = static_cast<std::uint32_t>(bytes.number(4, big));
            if (here == kSequenceEnd) return;
            if (here != kItem || (fragments && count == kUndefined)) throw NotUnderstood{};
            if (count != kUndefined)
                bytes.skip(count);
            else
                elements(bytes.size(), depth + 1);
        }
    }
};

/// Whether the first element of a file without preamble has a value representation.
bool has_representations(Bytes& bytes) {
    bytes.skip(4);
    const std::string vr = bytes.text(2);
    bytes.rewind();
    return std::ranges::all_of(vr, [](char c) { return c >= 'A' && c <= 'Z'; });
}

std::uint64_t padded(std::uint64_t count) {
    return (count + 3) / 4 * 4;
}

std::uint64_t netcdf_type_size(std::uint64_t type) {
    constexpr std::uint64_t kSizes[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
    if (type < 1 || type > 11) throw NotUnderstood{};
    return kSizes[type];
}

// Counts in a classic netCDF header: 8 bytes in version 5, else 4.
struct NetcdfHeader {
    Bytes& bytes;
    int version;
    std::uint64_t count() { return bytes.number(version == 5 ? 8 : 4, true); }
    void name() { bytes.skip(padded(count())); }
    void attributes() {
        bytes.skip(4);
        for (auto left = count(); left > 0; --left) {
            name();
            const auto size = netcdf_type_size(bytes.number(4, true));
            std::uint64_t total = 0;
            if (__builtin_mul_overflow(size, count(), &total)) bytes.truncated();
            bytes.skip(padded(total));
        }
    }
};

}  // namespace

bool begins_with_dicom_elements(const std::string& path) {
    Bytes bytes(path);
    if (bytes.size() < 8) return false;
    try {
        Dataset data{bytes, false, has_representations(bytes)};
        std::uint32_t before = 0;
        std::string vr;
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t tag = data.tag(), group = tag >> 16U;
            if (tag <= before || (i == 0 && group != 2 && group != 8) || group > 0x7fe0) return false;
            const std::uint32_t count = data.length(vr);
            if (count == kUndefined) return i > 0;
            bytes.skip(count);
            before = tag;
        }
        return true;
    } catch (const NotUnderstood&) {
        return false;
    } catch (const Error&) {
        return false;
    }
}

void check_dicom_is_whole(const std::string& path) {
    Bytes bytes(path);
    const bool preamble = bytes.size() >= 132 && (bytes.skip(128), bytes.text(4)) == "DICM";
    if (!preamble) {
        bytes.rewind();
        // Old files begin with the data set.
        if (bytes.size() >= 8 && bytes.number(2, false) != 2) {
            bytes.rewind();
            try {
                Dataset data{bytes, false, has_representations(bytes)};
                data.elements(bytes.size(), 0);
            } catch (const NotUnderstood&) {
            }
            return;
        }
        bytes.rewind();
    }
    try {
        Dataset meta{bytes, false, true};
        std::string vr, syntax;
        while (bytes.left() > 0) {
            const auto start = bytes.at();
            const auto group = bytes.number(2, false), element = bytes.number(2, false);
            if (group != 2) {
                Bytes rest(path);
                rest.skip(start);
                const bool big = syntax == "1.2.840.10008.1.2.2";
                if (syntax.empty() || syntax == "1.2.840.10008.1.2.1.99") return;  // unknown, or deflated
                Dataset data{rest, big, syntax != "1.2.840.10008.1.2"};
                data.elements(rest.size(), 0);
                return;
            }
            const auto count = meta.length(vr);
            if (count == kUndefined) return;
            auto value = bytes.text(count);
            while (!value.empty() && (value.back() == '\0' || value.back() == ' '))
                value.pop_back();
            if (element == 0x10) syntax = value;
        }
    } catch (const NotUnderstood&) {
        return;
    }
}

void check_netcdf_is_whole(const std::string& path) {
    Bytes bytes(path);
    if (bytes.text(3) != "CDF") return;
    NetcdfHeader header{bytes, static_cast<int>(bytes.number(1, true))};
    struct Place {
        std::uint64_t begin, size;
    };
    std::vector<Place> records;
    try {
        const auto record_count = header.count();
        const auto all_ones = header.version == 5 ? ~std::uint64_t{0} : std::uint64_t{0xffffffff};
        if (record_count == all_ones) throw NotUnderstood{};  // written as a stream
        bytes.skip(4);
        const auto axes = header.count();
        if (axes > bytes.left() / 8) bytes.truncated();  // each takes at least a name and a length
        std::vector<std::uint64_t> dims(axes);
        for (auto& dim : dims) {
            header.name();
            dim = header.count();
        }
        header.attributes();
        bytes.skip(4);
        for (auto variables = header.count(); variables > 0; --variables) {
            header.name();
            std::uint64_t items = 1;
            bool of_records = false;
            for (auto left = header.count(); left > 0; --left) {
                const auto id = header.count();
                if (id >= dims.size()) throw NotUnderstood{};
                of_records = of_records || dims[id] == 0;  // the axis that grows
                if (dims[id] != 0 && __builtin_mul_overflow(items, dims[id], &items)) bytes.truncated();
            }
            header.attributes();
            std::uint64_t size = 0;
            if (__builtin_mul_overflow(items, netcdf_type_size(bytes.number(4, true)), &size)) bytes.truncated();
            (void)header.count();
            const auto begin = bytes.number(header.version == 1 ? 4 : 8, true);
            if (of_records) {
                if (record_count > 0) records.push_back({begin, size});
            } else if (begin > bytes.size() || size > bytes.size() - begin) {
                bytes.truncated();
            }
        }
        // A record holds one piece of each such variable, padded unless there is only one.
        std::uint64_t record = 0;
        for (const Place& place : records)
            if (__builtin_add_overflow(record, records.size() > 1 ? padded(place.size) : place.size, &record))
                bytes.truncated();
        for (const Place& place : records) {
            std::uint64_t end = 0;
            if (__builtin_mul_overflow(record, record_count - 1, &end) ||
                __builtin_add_overflow(end, place.begin, &end) || __builtin_add_overflow(end, place.size, &end) ||
                end > bytes.size())
                bytes.truncated();
        }
    } catch (const NotUnderstood&) {
        return;
    }
}

}  // namespace edgesplat::detail
