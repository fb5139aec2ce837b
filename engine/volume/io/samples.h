// From stored samples to the samples of a volume, and from a header's lengths to mm: shared by the readers of all
// formats. Internal to engine/volume/io.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "engine/files/sample_type_internal.h"
#include "engine/volume/volume.h"

namespace edgesplat::detail {

/// Samples as a file stores them.
struct StoredSamples {
    SampleType type = SampleType::UInt8;
    const void* data = nullptr;  ///< the first voxel's first component; any alignment
    std::size_t stride = 1;      ///< samples from one voxel to the next
    bool swapped = false;        ///< in the other byte order than this machine's
    /// A sample is slope * stored + intercept, computed in double.
    double slope = 1, intercept = 0;
    std::optional<double> fill = {};  ///< the stored value that the header declares as "no data"; NaN is always that
};

/// Converts `stored` to `count` floats. Samples that equal the fill value become NaN.
void convert_stored(const StoredSamples& stored, std::size_t count, float* target);

/// Whether take_samples must see all samples at once: integers that may be labels, and values that floats may not hold.
bool needs_all(const StoredSamples& stored);

/// Fills `volume.values`, of the volume's dims, which must be set. Integers whose magnitude exceeds 2^24 and which are
/// not scaled keep their identity if they have at most kMaxRankedLabels distinct values: `volume.labels` is set and
/// the samples become ranks. Otherwise they are rounded to float, which a note says. Values that floats cannot hold are
/// divided by a power of two (`value_scale`); those beyond 1e100 contain no data, which a warning says. Sets
/// `stored_type` if it is empty.
void take_samples(const StoredSamples& stored, Volume& volume);

/// Millimetres in a unit of length by its name or symbol ("mm", "um", "micron", "microns", "meter", "inch", ...), in
/// any case; nullopt if the name is unknown or no length.
std::optional<double> millimetres_in(std::string_view unit);

/// Sets the geometry's axes and origin, given in a unit of `millimetres` mm, and where they come from. `axes`: columns
/// are steps of one voxel.
void set_place(Volume& volume, const glm::dmat3& axes, const glm::dvec3& origin, double millimetres,
               std::string_view source);

}  // namespace edgesplat::detail
