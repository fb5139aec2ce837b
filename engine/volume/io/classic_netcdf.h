// The header of a classic netCDF file (versions 1, 2 and 5), which MINC1 files are, too. Internal to engine/volume/io.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace edgesplat::detail {

/// Attributes of a variable: texts without white space at their ends, numbers as double.
struct VariableAttributes {
    std::map<std::string, std::string> texts;
    std::map<std::string, std::vector<double>> numbers;
};

struct ClassicNetcdf {
    struct Dimension {
        std::string name;
        std::size_t length = 0;  ///< 0: unlimited or empty
    };
    struct Variable {
        std::vector<std::size_t> dimensions;  ///< indices, slowest first
        VariableAttributes attributes;
        std::size_t type = 0;   ///< 1 to 11
        std::size_t begin = 0;  ///< of its samples in the file, bytes
    };
    std::vector<Dimension> dimensions;
    std::map<std::string, Variable> variables;

    static bool is_classic(const std::string& first_bytes) { return first_bytes.starts_with("CDF"); }
    /// Bytes of a number of a valid type.
    static std::size_t size_of(std::size_t type);
};

/// Reads the header. Throws Error if it is damaged: truncated, an unknown type, a dimension that is missing.
ClassicNetcdf read_classic_netcdf(const std::string& path);

}  // namespace edgesplat::detail
