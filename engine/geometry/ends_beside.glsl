// Which voxels have a surface splat. Written in the subset of GLSL that is C++. The includer declares `dims`, voxel(ivec3),
// has_data(Real) and material_of(Real).

// Whether matter of voxel p, with the sample `value`, ends on one of its six sides. Beyond the outermost samples the field
// continues linearly, for half a voxel.
bool ends_beside(ivec3 p, Real value, uint material) {
    bool ends = false;
    for (int i = 0; i < 6 && !ends; ++i) {
        ivec3 o = ivec3(0);
        o[i >> 1] = (i & 1) * 2 - 1;
        ivec3 at = clamp(p + o, ivec3(0), dims - 1);
        Real beside = voxel(at);
        if (at == p) beside = max(1.5 * value - 0.5 * voxel(clamp(p - o, ivec3(0), dims - 1)), 0.0);
        ends = !has_data(beside) || material_of(beside) != material;
    }
    return ends;
}
