#include <algorithm>
#include <cmath>

#include "engine/reference/1_estimate_edges.h"
#include "engine/reference/footprints.h"
#include "engine/reference/parallel.h"
#include "footprints/edge_weight.h"

namespace edgesplat::reference {

void weigh_kernels(const Field& field, const Settings& settings, std::vector<VoxelEdge>& edges) {
    Settings plain_integration = settings;
    plain_integration.footprints = FootprintMode::Procedural;
    const Footprints footprints(plain_integration);
    const EdgeBand band{settings.edge_half_width, settings.edge_strength};
    std::vector<double> weights(edges.size(), 1.0);
    parallel_for(field.dims.z, [&](int begin, int end) {
        const std::size_t slice = static_cast<std::size_t>(field.dims.x) * static_cast<std::size_t>(field.dims.y);
        for (std::size_t at = slice * static_cast<std::size_t>(begin); at < slice * static_cast<std::size_t>(end);
             ++at) {
            const VoxelEdge& edge = edges[at];
            if (!footprints.warped(edge)) continue;
            const double t = unwarped_coordinate(0, wall_edge(edge.D, edge.D2, band));
            const glm::dvec3 x = glm::dvec3(field.voxel(at)) + t * edge.n;
            // No kernel reaches further than 3 voxels.
            const glm::ivec3 low = glm::max(glm::ivec3(glm::ceil(x - 3.0)), glm::ivec3(0));
            const glm::ivec3 high = glm::min(glm::ivec3(glm::floor(x + 3.0)), field.dims - 1);
            double sum = 0;
            for (int k = low.z; k <= high.z; ++k) {
                for (int j = low.y; j <= high.y; ++j) {
                    for (int i = low.x; i <= high.x; ++i) {
                        const glm::ivec3 voxel(i, j, k);
                        sum += footprints.at_point(edges[field.offset(voxel)], x - glm::dvec3(voxel));
                    }
                }
            }
            weights[at] = sum > 0 ? std::clamp(1 / sum, 0.25, 4.0) : 1.0;
        }
    });
    for (std::size_t at = 0; at < edges.size(); ++at)
        edges[at].weight = weights[at];
}

void weigh_by_edge(const Settings& settings, std::span<const double> contrasts, std::vector<VoxelEdge>& edges) {
    const EdgeBand band{settings.edge_half_width, settings.edge_strength};
    const EdgeWeights weights = edge_weights(band);
    for (std::size_t at = 0; at < edges.size(); ++at) {
        VoxelEdge& edge = edges[at];
        if (!edge.has_edge) continue;
        edge.weight = 1 + contrasts[at] * (edge_weight(edge.D, edge.D2, band, weights) - 1);
    }
}

}  // namespace edgesplat::reference
