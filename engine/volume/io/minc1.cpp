// The header of MINC1 files: netCDF in its classic format, big-endian.
#include <algorithm>

#include "engine/volume/io/binary_file.h"
#include "engine/volume/io/minc.h"

namespace edgesplat::detail {
namespace {

struct Minc1Variable {
    std::vector<std::size_t> dimensions;
    MincAttributes attributes;
    std::size_t type = 0, begin = 0;
};

class Minc1Parser {
  public:
    explicit Minc1Parser(const std::string& path) : path_(path), bytes_(first_unpacked_bytes(path, kMost)) {}

    void parse() {
        const std::string magic = take(4);
        if (magic != std::string("CDF\1") && magic != std::string("CDF\2"))
            fail("{}: not a MINC1 file: it does not begin with CDF", path_);
        const bool is_wide = magic[3] == 2;
        whole();  // number of records
        for (std::size_t i = count_of_list(10); i > 0; --i) {
            MincDimension dimension;
            dimension.name = name();
            dimension.length = whole();
            dimensions.push_back(dimension);
        }
        (void)attributes();
        for (std::size_t i = count_of_list(11); i > 0; --i) {
            const std::string key = name();
            Minc1Variable variable;
            for (std::size_t axis = whole(); axis > 0; --axis) {
                const std::size_t id = whole();
                if (id >= dimensions.size()) fail("{}: dimension {} of variable {} is missing", path_, id, tidy(key));
                variable.dimensions.push_back(id);
            }
            variable.attributes = attributes();
            variable.type = whole();
            whole();  // size
            variable.begin = is_wide ? whole() << 32 : 0;
            variable.begin |= whole();
            variables[key] = variable;
        }
    }

    std::vector<MincDimension> dimensions;
    std::map<std::string, Minc1Variable> variables;

  private:
    static constexpr std::size_t kMost = std::size_t{1} << 24;

    [[noreturn]] void truncated() const { fail("{}: truncated: its netCDF header is incomplete", path_); }
    std::string take(std::size_t count) {
        if (count > bytes_.size() - at_) truncated();
        at_ += count;
        return bytes_.substr(at_ - count, count);
    }
    std::size_t whole() {
        std::size_t value = 0;
        for (const char c : take(4))
            value = value << 8 | static_cast<unsigned char>(c);
        return value;
    }
    std::string name() {
        const std::size_t count = whole();
        std::string text = take(count);
        take((4 - count % 4) % 4);
        return text;
    }
    std::size_t count_of_list(std::size_t tag) {
        const std::size_t found = whole(), count = whole();
        if (count > 0 && found != tag) fail("{}: damaged netCDF header: tag {}, expected {}", path_, found, tag);
        return count;
    }
    MincAttributes attributes() {
        MincAttributes result;
        for (std::size_t i = count_of_list(12); i > 0; --i) {
            const std::string key = name();
            const std::size_t type = whole(), count = whole(), size = size_of_type(type);
            if (count > bytes_.size()) truncated();
            BinaryHeader values{.bytes = take(count * size), .swapped = std::endian::native == std::endian::little};
            take((4 - count * size % 4) % 4);
            if (type == 2) {
                result.texts[key] = trimmed(values.bytes.substr(0, values.bytes.find('\0')));
                continue;
            }
            auto& numbers = result.numbers[key];
            for (std::size_t at = 0; at < values.bytes.size(); at += size)
                numbers.push_back(type == 1   ? values.get<std::int8_t>(at)
                                  : type == 3 ? values.get<std::int16_t>(at)
                                  : type == 4 ? values.get<std::int32_t>(at)
                                  : type == 5 ? static_cast<double>(values.get<float>(at))
                                              : values.get<double>(at));
        }
        return result;
    }

  public:
    std::size_t size_of_type(std::size_t type) const {
        constexpr std::array<std::size_t, 7> kSizes{0, 1, 1, 2, 4, 4, 8};
        if (type < 1 || type >= kSizes.size()) fail("{}: netCDF type {}, expected 1 to 6", path_, type);
        return kSizes[type];
    }

  private:
    const std::string& path_;
    std::string bytes_;
    std::size_t at_ = 0;
};

SampleType minc1_type(const std::string& path, const Minc1Variable& variable) {
    const auto found = variable.attributes.texts.find("signtype");
    const std::string sign = found == variable.attributes.texts.end() ? "" : found->second;
    const bool is_unsigned = sign.starts_with("unsigned") || (!sign.starts_with("signed") && variable.type == 1);
    switch (variable.type) {
        case 1:
            return is_unsigned ? SampleType::UInt8 : SampleType::Int8;
        case 3:
            return is_unsigned ? SampleType::UInt16 : SampleType::Int16;
        case 4:
            return is_unsigned ? SampleType::UInt32 : SampleType::Int32;
        case 5:
            return SampleType::Float32;
        case 6:
            return SampleType::Float64;
        default:
            fail("{}: its image has the netCDF type {}, expected numbers", path, variable.type);
    }
}

}  // namespace

MincImage minc1_image(const std::string& path) {
    Minc1Parser file(path);
    file.parse();
    const auto entries = [&](const Minc1Variable& variable) {
        std::size_t count = 1;
        for (const std::size_t id : variable.dimensions) {
            const std::size_t length = file.dimensions[id].length;
            if (length == 0)
                fail("{}: its dimension {} is unlimited or empty, expected a fixed length", path,
                     tidy(file.dimensions[id].name));
            if (__builtin_mul_overflow(count, length, &count) || count > std::size_t{1} << 40)
                fail("{}: more than 2^40 samples", path);
        }
        return count;
    };
    const auto found = file.variables.find("image");
    if (found == file.variables.end()) fail("{}: a netCDF file without the variable image: not MINC", path);
    const Minc1Variable& variable = found->second;
    const bool swapped = std::endian::native == std::endian::little;

    MincImage image;
    image.type = minc1_type(path, variable);
    image.swapped = swapped;
    for (const std::size_t id : variable.dimensions) {
        MincDimension dimension = file.dimensions[id];
        if (const auto own = file.variables.find(dimension.name); own != file.variables.end())
            dimension.attributes = own->second.attributes;
        image.dimensions.push_back(std::move(dimension));
    }
    if (const auto range = variable.attributes.numbers.find("valid_range");
        range != variable.attributes.numbers.end() && range->second.size() == 2)
        image.valid_range = range->second;
    const auto end_values = [&](const char* name) {
        std::vector<double> values;
        const auto place = file.variables.find(name);
        if (place == file.variables.end()) return values;
        const Minc1Variable& ends = place->second;
        if (ends.dimensions.size() > variable.dimensions.size() ||
            !std::equal(ends.dimensions.begin(), ends.dimensions.end(), variable.dimensions.begin()))
            fail("{}: the dimensions of {} are not the first ones of image", path, name);
        if (ends.type != 5 && ends.type != 6)
            fail("{}: {} has the netCDF type {}, expected 5 or 6", path, name, ends.type);
        const std::size_t count = entries(ends), size = file.size_of_type(ends.type);
        check_memory(path, name, count * (size + sizeof(double)));
        std::vector<std::string> ignored;
        BinaryHeader data{{}, swapped};
        const auto bytes =
            read_block({.path = path, .file = path, .offset = ends.begin, .bytes = count * size}, {}, ignored);
        data.bytes.assign(bytes.begin(), bytes.end());
        for (std::size_t at = 0; at < data.bytes.size(); at += size)
            values.push_back(size == 4 ? static_cast<double>(data.get<float>(at)) : data.get<double>(at));
        return values;
    };
    image.low = end_values("image-min");
    image.high = end_values("image-max");
    image.read = [path, begin = variable.begin, bytes = entries(variable) * size_of(image.type)] {
        std::vector<std::string> ignored;  // other variables may follow
        return read_block({.path = path, .file = path, .offset = begin, .bytes = bytes}, {}, ignored);
    };
    return image;
}

}  // namespace edgesplat::detail
