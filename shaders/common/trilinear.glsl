// Samples and trilinear interpolation, in index space. The including shader declares `volume` (r32f image3D) and the
// variable `dims`.

float voxel(ivec3 p) { return imageLoad(volume, p).r; }

// Samples lie between 0 and 1. Without data they are -1e-30, which is 0 to interpolation.
bool has_data(float value) { return value >= 0.0; }

// Interpolates in the cell with the corners c and e at the fraction t.
float within_cell(ivec3 c, ivec3 e, vec3 t) {
    vec4 low = vec4(voxel(c), voxel(ivec3(c.x, e.y, c.z)), voxel(ivec3(c.x, c.y, e.z)), voxel(ivec3(c.x, e.y, e.z)));
    vec4 high = vec4(voxel(ivec3(e.x, c.y, c.z)), voxel(ivec3(e.x, e.y, c.z)), voxel(ivec3(e.x, c.y, e.z)), voxel(e));
    vec4 x = low + t.x * (high - low);
    vec2 y = x.xz + t.y * (x.yw - x.xz);
    return y.x + t.z * (y.y - y.x);
}

// The value at voxel `origin` + p. p is small, so the precision does not depend on the position in the volume.
float trilinear(ivec3 origin, vec3 p) {
    p = clamp(p, vec3(-origin), vec3(dims - 1 - origin));
    ivec3 c = clamp(ivec3(floor(p)), -origin, max(dims - 2, ivec3(0)) - origin);
    return within_cell(origin + c, min(origin + c + 1, dims - 1), p - vec3(c));
}
