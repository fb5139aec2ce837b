// Surfels: the surface points that the voxels around a voxel found. Written in the subset of GLSL that is C++. The includer
// declares material_at(ivec3), the struct StoredEdge with the fields `state`, `away` (|distance|) and `border`,
// stored_edge(ivec3) and edge_of(StoredEdge). Include after edge.glsl and values_around.glsl.
#ifndef EDGESPLAT_SURFEL_GLSL
#define EDGESPLAT_SURFEL_GLSL

struct Surfel {
    bool there;
    vec3 at;      // relative to the voxel
    vec3 n;       // out of the voxel's material
    uint state;   // the end of the material's interval that it lies on
    bool border;  // it lies on the volume's border
};

Surfel no_surfel() {
    Surfel s = {false, vec3(0.0), vec3(0.0), EDGE_NONE, false};
    return s;
}

// The surfel of voxel q, relative to voxel p. `material`: the material that it must bound, from either side. `lost`: how
// far it must lie from its voxel, or it is of no use and may be left out.
Surfel surfel_at(ivec3 p, ivec3 q, uint material, Real lost) {
    Surfel s = no_surfel();
    ivec3 held = clamp(q, ivec3(0), dims - 1);
    StoredEdge stored = stored_edge(held);
    IF_ANY(is_in_volume(q) && stored.state >= EDGE_LOWER && stored.away >= lost) {
        Edge e = edge_of(stored);
        uint own = material_at(held);
        // An upper end is the lower end of the material above. The volume's border only bounds the material inside it.
        bool ours = own == material;
        bool below = own + 1u == material && stored.state == EDGE_UPPER && !stored.border;
        bool above = own == material + 1u && stored.state == EDGE_LOWER && !stored.border;
        s.there = ours || below || above;
        s.at = vec3(q - p) + e.d * e.n;
        s.n = ours ? e.n : -e.n;
        s.border = stored.border;
        s.state = ours ? stored.state : (below ? EDGE_LOWER : EDGE_UPPER);
    }
    return s;
}

// The offset of the i-th of the 125 voxels around a voxel.
ivec3 around_at(int i) { return ivec3(i % 5, i / 5 % 5, i / 25) - 2; }

// The voxel nearest to a point relative to voxel p.
ivec3 voxel_near(ivec3 p, vec3 at) { return p + ivec3(roundEven(at)); }

// Whether voxel q has matter of the material. Missing samples have none.
bool is_matter_at(ivec3 q, uint material) {
    ivec3 held = clamp(q, ivec3(0), dims - 1);
    return is_in_volume(q) && has_data(voxel(held)) && material_at(held) == material;
}
#endif
