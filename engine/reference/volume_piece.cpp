#include "engine/reference/volume_piece.h"

#include "engine/geometry/in_double.h"

namespace edgesplat::reference {

VolumePiece piece_in_volume(const glm::ivec3& dims, const glm::dvec3& from, const glm::dvec3& u) {
    const glm::dvec3 way = geometry::divisible(u);
    const geometry::VolumeEnds ends = geometry::volume_ends(from, way, dims);
    return {geometry::entry_of(ends), geometry::exit_of(ends), geometry::out_of_entry(ends, way),
            geometry::out_of_exit(ends, way)};
}

}  // namespace edgesplat::reference
