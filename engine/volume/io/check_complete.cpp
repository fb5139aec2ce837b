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

// Thrown for a file of unknown structure, which is left to GDCM.
struct NotUnderstood {};

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
