// The edge of a voxel. Written in the subset of GLSL that is C++.
#ifndef EDGESPLAT_EDGE_GLSL
#define EDGESPLAT_EDGE_GLSL

struct Edge {
    vec3 n;      // index space, unit; points towards the edge
    Real d;      // distance along n, voxels
    Real d2;     // distance along -n to the second edge; > FACE_DISTANCE_UNIT if none is in reach
    uint state;  // EdgeState
};

Edge no_edge() {
    Edge edge = {vec3(0.0, 0.0, 1.0), 1e9, 1e9, EDGE_NONE};
    return edge;
}

// A voxel without an edge has at most the normal against its gradient g, if that is steep enough.
Edge normal_only(vec3 g) {
    Real slope = length(g);
    Edge edge = {-g / max(slope, 1e-30), 1e9, 1e9, EDGE_NORMAL};
    if (!(slope >= GRADIENT_MIN)) edge = no_edge();
    return edge;
}
#endif
