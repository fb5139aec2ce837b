// Evens out the distances of edges that lie on one piece of surface. docs/method.md, pass 1, step 5.
// The including shader declares `edges` (rg32ui uimage3D) and `material_at(ivec3)`.
#include "shaders/lib/edge_record.glsl"

const float SMOOTH_AGREEMENT = 0.8;  // cosine between normals of one piece of surface: 37 degrees
const float SMOOTH_REACH = 1.5;      // voxels between foot points

// The chord between two foot points of a sphere is at right angles to the mean of their normals, so what is left along
// it is the difference of the two distances' errors: curvature does not bias the mean.
float distance_correction(ivec3 p, ivec3 dims, Edge e, uint material) {
    float sum = 0.0, count = 1.0;
    int reach = e.state >= EDGE_LOWER ? 1 : -1;
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y)
            for (int x = -reach; x <= reach; ++x) {
                ivec3 q = p + ivec3(x, y, z);
                if (any(lessThan(q, ivec3(0))) || any(greaterThanEqual(q, dims)) || q == p) continue;
                uvec2 code = imageLoad(edges, q).xy;
                if ((code.y & EDGE_ADOPTED) != 0u || (code.y >> 26 & 3u) != e.state || material_at(q) != material) continue;
                Edge other = unpack_edge(code.x, code.y);
                vec3 between = vec3(x, y, z) + other.d * other.n - e.d * e.n;
                if (dot(other.n, e.n) >= SMOOTH_AGREEMENT && dot(between, between) < SMOOTH_REACH * SMOOTH_REACH) {
                    sum += 0.5 * dot(e.n + other.n, between);
                    count += 1.0;
                }
            }
    return sum / count;
}
