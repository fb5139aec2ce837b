// The labels of a packed volume: datasets under /labels, one row a label.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "engine/volume/labels.h"
#include "engine/volume/packed_internal.h"

namespace edgesplat::detail {
namespace {

constexpr const char* kIds = "/labels/ids";
constexpr const char* kVoxels = "/labels/voxels";
constexpr const char* kColors = "/labels/colors";
constexpr const char* kNames = "/labels/names";
/// Longest mean length of a name, bytes.
constexpr std::uint64_t kMaxNameBytes = 4096;

template <typename T>
void write_rows(Hdf5File& file, const char* name, SampleType type, const Hdf5Extent& extent, const T* rows) {
    const Hdf5Dataset dataset = file.create_dataset(name, {.type = type, .extent = extent});
    dataset.write(Hdf5Extent(extent.size(), 0), extent, type, rows);
    dataset.finish();
}

template <typename T>
std::vector<T> read_rows(const Hdf5File& file, const std::string& path, const char* name, SampleType type,
                         const Hdf5Extent& wanted) {
    const Hdf5Dataset dataset = file.dataset(name);
    check_extent(path, name, dataset.extent(), wanted);
    const auto count = std::accumulate(wanted.begin(), wanted.end(), std::size_t{1}, std::multiplies<>());
    check_memory(path, name, count * sizeof(T));
    std::vector<T> rows(count);
    dataset.read(Hdf5Extent(wanted.size(), 0), wanted, type, rows.data());
    return rows;
}

/// The sample of a label with this number, or its place if floats cannot represent all numbers.
void set_values(LabelTable& table) {
    constexpr std::int64_t kExact = std::int64_t{1} << 24;
    const auto is_exact = [&](const Label& label) {
        const auto number = static_cast<std::int64_t>(label.id);
        return table.is_signed ? number >= -kExact && number <= kExact : label.id <= std::uint64_t{kExact};
    };
    const bool ranks = !std::ranges::all_of(table.labels, is_exact);
    for (std::size_t place = 0; place < table.labels.size(); ++place) {
        Label& label = table.labels[place];
        label.value = ranks ? static_cast<float>(place) : static_cast<float>(static_cast<std::int64_t>(label.id));
    }
}

void read_names(const Hdf5File& file, const std::string& path, LabelTable& table) {
    const std::size_t labels = table.labels.size();
    const Hdf5Extent extent = file.dataset(kNames).extent();
    if (extent.size() != 1 || extent[0] < labels || extent[0] > kMaxNameBytes * labels)
        fail("{}: {}: {} bytes, expected one axis of {} to {}", path, kNames, fmt::join(extent, " x "), labels,
             kMaxNameBytes * labels);
    const auto bytes = read_rows<char>(file, path, kNames, SampleType::UInt8, extent);
    const auto ends = static_cast<std::size_t>(std::ranges::count(bytes, '\0'));
    if (ends != labels || bytes.back() != '\0')
        fail("{}: {}: {} names that end with a zero byte, expected {}", path, kNames, ends, labels);
    const char* next = bytes.data();
    for (Label& label : table.labels) {
        label.name = next;
        next += label.name.size() + 1;
    }
}

}  // namespace

std::size_t checked_place(const LabelTable& table, float sample, const std::string& name) {
    const std::size_t place = place_of_label(table, sample);
    if (place == table.labels.size() || table.labels[place].value != sample)
        fail("{}: a sample is {}, which is none of its {} labels", name, sample, table.labels.size());
    return place;
}

void write_labels(Hdf5File& file, const LabelTable& table, const std::vector<std::uint64_t>& voxels) {
    const std::uint64_t count = table.labels.size();
    std::vector<std::uint64_t> ids;
    std::vector<double> colors;
    std::string names;
    for (const Label& label : table.labels) {
        ids.push_back(label.id);
        const glm::dvec3 color = label.color.value_or(glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
        colors.insert(colors.end(), {color.x, color.y, color.z});
        names += label.name.substr(0, std::min<std::size_t>(label.name.find('\0'), kMaxNameBytes - 1)) + '\0';
    }
    write_rows(file, kIds, SampleType::UInt64, {count}, ids.data());
    write_rows(file, kVoxels, SampleType::UInt64, {count}, voxels.data());
    write_rows(file, kColors, SampleType::Float64, {count, 3}, colors.data());
    write_rows(file, kNames, SampleType::UInt8, {names.size()}, names.data());
}

PackedLabels read_labels(const Hdf5File& file, const std::string& path, std::uint64_t count, std::uint64_t with_data) {
    const bool is_signed = file.whole_number("labels_signed") != 0;
    if (count == 0) return {};
    if (count > kMaxRankedLabels) fail("{}: attribute labels: {}, expected at most {}", path, count, kMaxRankedLabels);
    auto table = std::make_shared<LabelTable>();
    table->is_signed = is_signed;
    const auto ids = read_rows<std::uint64_t>(file, path, kIds, SampleType::UInt64, {count});
    for (const std::uint64_t id : ids)
        table->labels.push_back({id, 0, {}, {}});
    const auto is_above = [&](std::uint64_t a, std::uint64_t b) {
        return is_signed ? static_cast<std::int64_t>(a) >= static_cast<std::int64_t>(b) : a >= b;
    };
    if (const auto at = std::ranges::adjacent_find(ids, is_above); at != ids.end())
        fail("{}: {}: {} before {}, expected ascending numbers", path, kIds, table->number_of({at[0], 0, {}, {}}),
             table->number_of({at[1], 0, {}, {}}));
    set_values(*table);
    auto voxels = read_rows<std::uint64_t>(file, path, kVoxels, SampleType::UInt64, {count});
    std::uint64_t left = with_data;
    for (const std::uint64_t n : voxels) {
        if (n > left) fail("{}: {}: more than the {} voxels with data", path, kVoxels, with_data);
        left -= n;
    }
    if (left > 0) fail("{}: {}: {} voxels in all, expected {}", path, kVoxels, with_data - left, with_data);
    const auto colors = read_rows<double>(file, path, kColors, SampleType::Float64, {count, 3});
    for (std::size_t place = 0; place < table->labels.size(); ++place) {
        const glm::dvec3 color(colors[3 * place], colors[3 * place + 1], colors[3 * place + 2]);
        if (std::isnan(color.x) && std::isnan(color.y) && std::isnan(color.z)) continue;
        for (int channel = 0; channel < 3; ++channel)
            if (!(color[channel] >= 0 && color[channel] <= 1))
                fail("{}: {}: {} of label {}, expected 0 to 1, or NaN for all three channels", path, kColors,
                     color[channel], table->number_of(table->labels[place]));
        table->labels[place].color = color;
    }
    read_names(file, path, *table);
    return {std::move(table), std::move(voxels)};
}

}  // namespace edgesplat::detail
