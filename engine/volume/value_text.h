// Text of values in messages, tables and labels: as few digits as tell them apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/volume/volume.h"

namespace edgesplat {

/// A sample or another value in the unit of the samples, written in the file's unit: the fewest digits that read back
/// as the same float.
std::string value_text(const Volume& volume, float sample);

/// A value of data with a given range, in the same unit: the fewest digits that are within 1e-4 of the range, and
/// within 5e-6 of the value. All digits of the value if the range is 0.
std::string value_text(double value, double range);

/// Significant digits for values up to `largest` of data with that range, so that steps of 1e-4 of it differ: 5 to 17.
int value_digits(double largest, double range);

/// The format for printf of values of a volume, in the file's unit, e.g. "%.5g".
std::string value_format(const Volume& volume);

/// Values side by side: digits as above, and as many more as tell them apart.
std::vector<std::string> value_texts(std::span<const double> values, double range);

}  // namespace edgesplat
