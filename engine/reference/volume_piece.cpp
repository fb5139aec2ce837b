#include "engine/reference/volume_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edgesplat::reference {

VolumePiece piece_in_volume(const glm::ivec3& dims, const glm::dvec3& from, const glm::dvec3& u) {
    VolumePiece piece{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    for (int axis = 0; axis < 3; ++axis) {
        const double way = std::abs(u[axis]) < 1e-8 ? 1e-8 : u[axis];
        const double a = (-0.5 - from[axis]) / way;
        const double b = (dims[axis] - 0.5 - from[axis]) / way;
        glm::dvec3 out(0);
        out[axis] = way > 0 ? 1 : -1;
        if (std::max(a, b) < piece.high) {
            piece.high = std::max(a, b);
            piece.far_normal = out;
        }
        if (std::min(a, b) > piece.low) {
            piece.low = std::min(a, b);
            piece.normal = -out;
        }
    }
    return piece;
}

}  // namespace edgesplat::reference
