// What 5_trace_faces keeps, by address: few are loaded, and devices have few slots for texels. After shaders/splats/traced_ray.glsl.

// Of a pixel's ray: two texels, from here on.
uint traced_at(ivec2 pixel) { return 2u * uint(pixel.y * params.frame.size.x + pixel.x); }

SeenRay load_seen_ray(ivec2 pixel) {
    PixelsRef rays = PixelsRef(params.frame.traced_rays);
    return seen_ray(rays.at[traced_at(pixel)], rays.at[traced_at(pixel) + 1u]);
}

// Which of MARKED_AT_ONCE entries are traced.
uint traced_word(uint at) { return UintsRef(params.frame.traced_entries).at[at]; }
