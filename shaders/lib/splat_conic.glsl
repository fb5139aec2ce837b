// The image of a splat's support: pixels whose rays meet a spheroid that holds it lie in a conic. After
// shaders/lib/splat_projection.glsl. docs/method.md, 4_mark_pixels.
#ifndef EDGESPLAT_SPLAT_CONIC_GLSL
#define EDGESPLAT_SPLAT_CONIC_GLSL

// Pixels d from `centre` with form.x d.x^2 + 2 form.y d.x d.y + form.z d.y^2 - 2 linear . d <= 1; all of them where every
// number is 0, as where the support may reach the eye.
struct SplatConic {
    vec2 centre;  // pixels
    vec3 form;
    vec2 linear;
    float depth;  // of the support's centre, mm
};

// With w the ray through the centre c of a spheroid |x|_A <= 1, z w = c, a ray w + d meets it where
// z^2 (|w|^2 |d|^2 - (w.d)^2) <= |w + d|^2, all of them in A: nothing of it cancels, however far the eye.
SplatConic splat_conic(Projection p, Edge e, bool is_sphere) {
    SplatConic s = SplatConic(vec2(0.0), vec3(0.0), vec2(0.0), 0.0);
    vec3 spheroid = splat_spheroid(e);
    vec3 shift = is_sphere ? p.centre : spheroid.x * e.n;
    vec2 axes = (is_sphere ? vec2(reach_across(p)) : spheroid.yz) * 1.005 + 1e-4;
    vec3 view = view_position(p.position + shift);
    s.depth = view.z;
    bool before = view.z > 1.05 * max(axes.x, axes.y) * length(params.frame.view_z);
    vec2 slope = before ? view.xy / view.z : vec2(0.0);
    vec2 pixel = 2.0 * vec2(params.frame.tan_half_x, params.frame.tan_half_y) / vec2(params.frame.size);
    s.centre = slope / pixel + 0.5 * vec2(params.frame.size);
    vec3 w = params.frame.ray_z + slope.x * params.frame.ray_x + slope.y * params.frame.ray_y;
    vec3 x = pixel.x * params.frame.ray_x, y = pixel.y * params.frame.ray_y;
    // In A: the products of vectors less those of their parts along n.
    vec3 n = is_sphere ? vec3(0.0) : e.n;
    float wide = 1.0 / (axes.y * axes.y), more = 1.0 / (axes.x * axes.x) - wide;
    vec3 along = vec3(dot(w, n), dot(x, n), dot(y, n));
    float ww = dot(w, w) * wide + along.x * along.x * more;
    vec3 with_w = vec3(ww, dot(w, x) * wide + along.x * along.y * more, dot(w, y) * wide + along.x * along.z * more) / ww;
    float xx = dot(x, x) * wide + along.y * along.y * more, xy = dot(x, y) * wide + along.y * along.z * more;
    float yy = dot(y, y) * wide + along.z * along.z * more;
    float z2 = view.z * view.z;
    vec3 form = z2 * (vec3(xx, xy, yy) - ww * vec3(with_w.y * with_w.y, with_w.y * with_w.z, with_w.z * with_w.z)) -
                vec3(xx, xy, yy) / ww;
    s.form = before ? form : vec3(0.0);
    s.linear = before ? with_w.yz : vec2(0.0);
    return s;
}

// Pixels of that row, from the first to before the last.
ivec2 row_of_conic(SplatConic s, int row) {
    float dy = float(row) + 0.5 - s.centre.y;
    float b = s.linear.x - s.form.y * dy, c = (s.form.z * dy - 2.0 * s.linear.y) * dy - 1.0;
    float root = b * b - s.form.x * c;
    float half_width = sqrt(max(root, 0.0)) / s.form.x, middle = s.centre.x + b / s.form.x;
    // Centres of pixels, with a little more for rounding.
    vec2 ends = vec2(middle - half_width, middle + half_width) + vec2(-0.51, 0.51);
    ends = root < 0.0 ? vec2(0.0) : clamp(ends, -1e6, 1e6);
    return s.form.x > 0.0 ? ivec2(ceil(ends.x), floor(ends.y)) : ivec2(-1000000, 1000000);
}
#endif
