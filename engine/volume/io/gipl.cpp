// Reads GIPL (Guy's Image Processing Lab): a header of 256 bytes, big endian, then samples; often in gzip.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>

#include "engine/volume/io/samples.h"
#include "engine/volume/io/stored_data.h"

namespace edgesplat::detail {
namespace {

class GiplHeader {
  public:
    static constexpr std::size_t kBytes = 256;
    explicit GiplHeader(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        in.read(bytes_.data(), kBytes);
        complete = in.gcount() == kBytes;
    }
    template <typename T>
    T at(std::size_t offset) const {
        std::array<char, sizeof(T)> raw{};
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), sizeof(T), raw.begin());
        if (std::endian::native == std::endian::little) std::ranges::reverse(raw);
        return std::bit_cast<T>(raw);
    }
    bool complete = false;

  private:
    std::array<char, kBytes> bytes_{};
};

SampleType gipl_type(const std::string& path, unsigned code) {
    switch (code) {
        case 7:
            return SampleType::Int8;
        case 8:
            return SampleType::UInt8;
        case 15:
            return SampleType::Int16;
        case 16:
            return SampleType::UInt16;
        case 31:
            return SampleType::UInt32;
        case 32:
            return SampleType::Int32;
        case 64:
            return SampleType::Float32;
        case 65:
            return SampleType::Float64;
        default:
            fail("{}: GIPL image type {}, expected 7, 8, 15, 16, 31, 32, 64 or 65", path, code);
    }
}

}  // namespace

Volume load_gipl(const std::string& path, const LoadOptions& options) {
    std::optional<TemporaryFolder> folder;
    StoredData data;
    data.path = path;
    data.files = {without_gzip(path, folder)};
    const GiplHeader header(data.files[0].string());
    if (!header.complete) fail("{}: truncated: a GIPL header has {} bytes", path, GiplHeader::kBytes);
    const auto magic = header.at<std::uint32_t>(252);
    if (magic != 719555000U && magic != 4026526128U)
        fail("{}: not a GIPL file: its magic number is {}, expected 719555000 or 4026526128", path, magic);
    data.type = gipl_type(path, header.at<std::uint16_t>(8));
    data.swapped = std::endian::native == std::endian::little;
    data.offset = GiplHeader::kBytes;

    Volume volume;
    volume.name = path;
    std::vector<std::size_t> dims;
    glm::dmat3 axes(1.0);
    glm::dvec3 origin(0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        dims.push_back(header.at<std::uint16_t>(2 * i));
        // An axis that is not used has 0 voxels.
        if (i >= 2 && dims[i] == 0) dims[i] = 1;
        if (i == 3) continue;
        const auto column = static_cast<int>(i);
        const double spacing = static_cast<double>(header.at<float>(10 + 4 * i));
        if (!(spacing > 0) && !(i == 2 && dims[i] == 1 && spacing == 0))
            fail("{}: GIPL voxel dims: {} along axis {}, expected a length above 0", path, spacing, i);
        if (spacing > 0) axes[column][column] = spacing;
        origin[column] = header.at<double>(204 + 8 * i);
        if (!std::isfinite(origin[column])) fail("{}: GIPL origin: {} is no position", path, origin[column]);
    }
    const std::size_t total = checked_bytes(path, dims, size_of(data.type));
    data.samples = total / size_of(data.type);
    volume.geometry.dims = glm::ivec3(dims[0], dims[1], dims[2]);
    set_place(volume, axes, origin, 1, "voxel dims");
    StoredSelection selection{.step = {1, dims[0], dims[0] * dims[1]}};
    selection.first = chosen_frame(path, options, dims[3]) * selection.step[2] * dims[2];
    (void)chosen_component(path, options, 1);

    // The format has fields for a matrix and for a calibration, but does not define them; no program writes them alike.
    bool has_matrix = false;
    for (std::size_t i = 0; i < 20; ++i)
        has_matrix = has_matrix || header.at<float>(106 + 4 * i) != 0;
    const auto offset = header.at<float>(236), scale = header.at<float>(240);
    if (has_matrix) volume.warnings.emplace_back("The matrix in the GIPL header is not defined and was not used.");
    if (offset != 0 || (scale != 0 && scale != 1))
        volume.warnings.emplace_back("The calibration in the GIPL header is not defined: values are as stored.");
    read_stored(data, selection, volume, options);
    return volume;
}

}  // namespace edgesplat::detail
