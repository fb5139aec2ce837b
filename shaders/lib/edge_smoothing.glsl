// Evens out the distances of edges that lie on one piece of surface. docs/method.md, pass 1, step 5.
// The including shader declares `edges` (rg32ui uimage3D) and `material_at(ivec3)`.
#include "shaders/lib/edge_record.glsl"

const float SMOOTH_AGREEMENT = 0.8;  // cosine between normals of one piece of surface: 37 degrees
const float SMOOTH_REACH = 1.5;      // voxels between foot points

// The chord between two foot points of a sphere is at right angles to the mean of their normals, so what is left along
// it is the difference of the two distances' errors: curvature does not bias the mean.
struct SurfaceAround {
    float distance_correction;  // voxels
    float curvature;            // of the sphere that fits the normals best, positive where n points away from its centre
};

SurfaceAround surface_around(ivec3 p, ivec3 dims, Edge e, uint material) {
    float sum = 0.0, count = 1.0, turned = 0.0, apart = 0.0;
    // The edge belongs to an iso-value; both of its sides look for it, and err in opposite directions.
    uint iso = material + (e.state & 1u);  // EDGE_UPPER is odd: the interval's upper end
    int reach = e.state >= EDGE_LOWER ? 1 : -1;
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                ivec3 q = p + ivec3(x, y, z);
                if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, dims)) || q == p) continue;
                uvec2 code = imageLoad(edges, q).xy;
                Edge other = unpack_edge(code.x, code.y);
                if ((code.y & EDGE_ADOPTED) != 0u || other.state < EDGE_LOWER) continue;
                if (material_at(q) + (other.state & 1u) != iso) continue;
                vec3 n = other.state == e.state ? other.n : -other.n;
                vec3 between = vec3(x, y, z) + other.d * other.n - e.d * e.n;
                if (dot(n, e.n) >= SMOOTH_AGREEMENT && dot(between, between) < SMOOTH_REACH * SMOOTH_REACH) {
                    sum += 0.5 * dot(e.n + n, between);
                    count += 1.0;
                    turned += dot(n - e.n, between);
                    apart += dot(between, between);
                }
            }
    return SurfaceAround(sum / count, apart > 0.0 ? turned / apart : 0.0);
}
