#include "engine/volume/io/classic_netcdf.h"

#include "engine/error.h"
#include "engine/volume/io/binary_file.h"

namespace edgesplat::detail {
namespace {

// Types from 7 on: version 5 only.
constexpr std::array<std::size_t, 12> kSizes{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
constexpr std::size_t kText = 2;

/// Numbers are big-endian.
class Parser {
  public:
    explicit Parser(const std::string& path) : path_(path), bytes_(first_unpacked_bytes(path, kMost)) {}

    ClassicNetcdf parse() {
        ClassicNetcdf file;
        const std::string magic = take(4);
        version_ = static_cast<unsigned char>(magic[3]);
        if (!ClassicNetcdf::is_classic(magic) || (version_ != 1 && version_ != 2 && version_ != 5))
            fail("{}: not a classic netCDF file: it does not begin with CDF and the version 1, 2 or 5", path_);
        count();  // number of records
        for (std::size_t i = count_of_list(10); i > 0; --i) {
            ClassicNetcdf::Dimension dimension;
            dimension.name = name();
            dimension.length = count();
            file.dimensions.push_back(dimension);
        }
        (void)attributes();
        for (std::size_t i = count_of_list(11); i > 0; --i) {
            const std::string key = name();
            ClassicNetcdf::Variable variable;
            for (std::size_t axis = count(); axis > 0; --axis) {
                const std::size_t id = count();
                if (id >= file.dimensions.size())
                    fail("{}: dimension {} of variable {} is missing", path_, id, tidy(key));
                variable.dimensions.push_back(id);
            }
            variable.attributes = attributes();
            variable.type = type();
            count();  // size
            variable.begin = version_ == 1 ? whole(4) : whole(8);
            file.variables[key] = variable;
        }
        return file;
    }

  private:
    static constexpr std::size_t kMost = std::size_t{1} << 24;

    [[noreturn]] void truncated() const { fail("{}: truncated: its netCDF header is incomplete", path_); }
    std::string take(std::size_t wanted) {
        if (wanted > bytes_.size() - at_) truncated();
        at_ += wanted;
        return bytes_.substr(at_ - wanted, wanted);
    }
    std::size_t whole(std::size_t size) {
        std::size_t value = 0;
        for (const char c : take(size))
            value = value << 8 | static_cast<unsigned char>(c);
        return value;
    }
    std::size_t count() { return whole(version_ == 5 ? 8 : 4); }
    std::size_t type() {
        const std::size_t type = whole(4), last = version_ == 5 ? 11 : 6;
        if (type < 1 || type > last) fail("{}: netCDF type {}, expected 1 to {}", path_, type, last);
        return type;
    }
    std::string name() {
        const std::size_t length = count();
        std::string text = take(length);
        take((4 - length % 4) % 4);
        return text;
    }
    std::size_t count_of_list(std::size_t tag) {
        const std::size_t found = whole(4), entries = count();
        if (entries > 0 && found != tag) fail("{}: damaged netCDF header: tag {}, expected {}", path_, found, tag);
        return entries;
    }
    VariableAttributes attributes() {
        VariableAttributes result;
        for (std::size_t i = count_of_list(12); i > 0; --i) {
            const std::string key = name();
            const std::size_t of = type(), entries = count(), size = kSizes.at(of);
            if (entries > bytes_.size()) truncated();
            BinaryHeader values{.bytes = take(entries * size), .swapped = std::endian::native == std::endian::little};
            take((4 - entries * size % 4) % 4);
            if (of == kText) {
                result.texts[key] = trimmed(values.bytes.substr(0, values.bytes.find('\0')));
                continue;
            }
            auto& numbers = result.numbers[key];
            for (std::size_t at = 0; at < values.bytes.size(); at += size)
                numbers.push_back(number(values, of, at));
        }
        return result;
    }
    static double number(const BinaryHeader& values, std::size_t type, std::size_t at) {
        switch (type) {
            case 1:
                return values.get<std::int8_t>(at);
            case 3:
                return values.get<std::int16_t>(at);
            case 4:
                return values.get<std::int32_t>(at);
            case 5:
                return static_cast<double>(values.get<float>(at));
            case 6:
                return values.get<double>(at);
            case 7:
                return values.get<std::uint8_t>(at);
            case 8:
                return values.get<std::uint16_t>(at);
            case 9:
                return values.get<std::uint32_t>(at);
            case 10:
                return static_cast<double>(values.get<std::int64_t>(at));
            default:
                return static_cast<double>(values.get<std::uint64_t>(at));
        }
    }

    const std::string& path_;
    std::string bytes_;
    std::size_t at_ = 0;
    int version_ = 1;
};

}  // namespace

std::size_t ClassicNetcdf::size_of(std::size_t type) {
    return kSizes.at(type);
}

ClassicNetcdf read_classic_netcdf(const std::string& path) {
    return Parser(path).parse();
}

}  // namespace edgesplat::detail
