// Where 5_trace_faces keeps what a pixel's ray meets: two texels, from here on.
uint traced_at(ivec2 pixel) { return 2u * uint(pixel.y * params.frame.size.x + pixel.x); }
