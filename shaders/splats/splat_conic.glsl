// The image of a splat's support: rays that meet its bounding sphere pass through the pixels of a conic. Include after
// shaders/splats/splat_projection.glsl. docs/method.md, 4_mark_pixels.
#ifndef EDGESPLAT_SPLAT_CONIC_GLSL
#define EDGESPLAT_SPLAT_CONIC_GLSL

// The pixels at d from `centre` with form.x d.x^2 + 2 form.y d.x d.y + form.z d.y^2 - 2 linear . d <= 1. All
// coefficients are 0, so that all pixels count, if the support may reach the eye.
struct SplatConic {
    vec2 centre;  // pixels
    vec3 form;
    vec2 linear;
    float depth;  // of the support's centre, mm
};

// With w the ray through the centre c of a sphere |x|_A <= 1 and z w = c, a ray w + d meets the sphere if z^2 (|w|^2
// |d|^2 - (w.d)^2) <= |w + d|^2, all products in A. Nothing cancels, however far the eye.
SplatConic splat_conic(Projection p) {
    SplatConic s = SplatConic(vec2(0.0), vec3(0.0), vec2(0.0), 0.0);
    float radius = reach_across(p) * 1.005 + 1e-4;
    vec3 view = view_position(p.position + p.centre);
    s.depth = view.z;
    bool before = view.z > 1.05 * radius * length(params.of_volume.view_z);
    vec2 slope = before ? view.xy / view.z : vec2(0.0);
    vec2 pixel = 2.0 * vec2(params.frame.tan_half_x, params.frame.tan_half_y) / vec2(params.frame.size);
    s.centre = slope / pixel + 0.5 * vec2(params.frame.size);
    vec3 w = params.of_volume.ray_z + slope.x * params.of_volume.ray_x + slope.y * params.of_volume.ray_y;
    vec3 x = pixel.x * params.of_volume.ray_x, y = pixel.y * params.of_volume.ray_y;
    float wide = 1.0 / (radius * radius), ww = dot(w, w) * wide;
    vec2 with_w = vec2(dot(w, x), dot(w, y)) * wide / ww;
    vec3 across = vec3(dot(x, x), dot(x, y), dot(y, y)) * wide;
    vec3 form = view.z * view.z * (across - ww * vec3(with_w.x * with_w.x, with_w.x * with_w.y, with_w.y * with_w.y)) - across / ww;
    s.form = before ? form : vec3(0.0);
    s.linear = before ? with_w : vec2(0.0);
    return s;
}

// The conic's pixels in a row, half open.
ivec2 row_of_conic(SplatConic s, int row) {
    float dy = float(row) + 0.5 - s.centre.y;
    float b = s.linear.x - s.form.y * dy, c = (s.form.z * dy - 2.0 * s.linear.y) * dy - 1.0;
    float root = b * b - s.form.x * c;
    float half_width = sqrt(max(root, 0.0)) / s.form.x, middle = s.centre.x + b / s.form.x;
    // Pixel centres, with a margin for rounding.
    vec2 ends = vec2(middle - half_width, middle + half_width) + vec2(-0.51, 0.51);
    ends = root < 0.0 ? vec2(0.0) : clamp(ends, -1e6, 1e6);
    return s.form.x > 0.0 ? ivec2(ceil(ends.x), floor(ends.y)) : ivec2(-1000000, 1000000);
}
#endif
