// Samples without data that no header declares: named by the user, or noticed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// Marks the samples of `value`, in the file's unit (of labels: the label's number), as samples without data. `value`
/// may be rounded to four digits if it is far from every other value. The volume must be finished again. Returns the
/// number of samples.
std::size_t declare_no_data(Volume& volume, double value);

/// A value that may stand for "no data" although the file does not say so.
struct SuspectedFill {
    float value = 0;          ///< the smallest or the largest sample
    std::size_t count = 0;    ///< samples of that value
    float low = 0, high = 0;  ///< range of the other samples
};

/// Values at one end or both ends of the range that are far from all other samples and occur more than twice: numbers
/// that programs use as fill values (-9999, 9.97e36, the ends of a type) at a distance of at least the others' range,
/// other numbers at 100 times that. Empty for few distinct values, and for packed volumes.
std::vector<SuspectedFill> suspected_fill(const Volume& volume);

/// One sentence that says what was noticed and which option declares it.
std::string text_of(const SuspectedFill& fill, const Volume& volume);

}  // namespace edgesplat
