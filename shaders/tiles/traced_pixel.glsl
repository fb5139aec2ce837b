// Access to the results of 5_trace_faces, by address: few are loaded, and devices have few slots for texels. Include
// after shaders/splats/traced_ray.glsl.

// Index of the first of the two texels of a pixel's ray.
uint traced_at(ivec2 pixel) { return 2u * uint(pixel.y * params.frame.size.x + pixel.x); }

SeenRay load_seen_ray(ivec2 pixel) {
    PixelsRef rays = PixelsRef(params.frame.traced_rays);
    return seen_ray(rays.at[traced_at(pixel)], rays.at[traced_at(pixel) + 1u]);
}

// One bit for each of MARKED_AT_ONCE entries: it is traced.
uint traced_word(uint at) { return UintsRef(params.frame.traced_entries).at[at]; }
