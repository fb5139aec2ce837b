// The sample types of files.
#pragma once

#include <cstddef>
#include <string_view>

namespace edgesplat::detail {

enum class SampleType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float32, Float64 };

std::string_view name_of(SampleType type);
/// Bytes per sample.
std::size_t size_of(SampleType type);

}  // namespace edgesplat::detail
