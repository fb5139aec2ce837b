// Rays through the materials of the voxels, each looked up where the edge nearby moves the sample to: sharp as splats
// are, by gathering. docs/method.md, Ray caster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/raycast_params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = BIND_RAYS, scalar) uniform Rays { SceneParams scene; RayParams rays; } params;
#include "shaders/lib/raycast.glsl"
#include "shaders/lib/raycast_edges.glsl"

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (any(greaterThanEqual(pixel, params.rays.size))) return;
    read_scene();
    Ray ray = ray_of(pixel);
    float step = params.rays.step, per_step = 1.0 / step, saturation = params.rays.saturation;
    int count = ray.first < ray.last ? int(ceil((ray.last - ray.first) * per_step)) : 0;

    vec4 sum = vec4(0.0);
    float light = 1.0, lit_at = -1e9, stale = 0.0;
    // Segment i is [i, i + 1] steps from the ray's first point. Loops, not ifs: see raycast.comp.
    for (int i = 0; i < count;) {
        vec4 matter = vec4(0.0);
        while (i < count && matter.a == 0.0) {
            float way = SKIP == 1u ? 1e9 : 0.0, t = 0.0;
            while (i < count && way > 0.0) {
                t = min(ray.first + (float(i) + 0.5) * step, ray.last);
                way = leap(ray, at(ray, t));
                i = way > 0.0 ? max(i + 1, int(ceil((t + way - 1e-3 - ray.first) * per_step - 0.5))) : i;
            }
            t = min(ray.first + (float(i) + 0.5) * step, ray.last);
            int end = SKIP == 1u ? min(count - 1, i + int(leave(ray, at(ray, t)) * per_step)) : count - 1;
            while (i <= end && matter.a == 0.0) {
                matter = matter_at(at(ray, min(ray.first + (float(i) + 0.5) * step, ray.last)));
                i += matter.a == 0.0 ? 1 : 0;
            }
        }
        // Split where it meets the surface: either side of a face is looked up on that side.
        float a = ray.first + float(i) * step, b = min(a + step, ray.last), middle = min(a + 0.5 * step, ray.last);
        Surface face = Surface(vec3(0.0), 0.0, 1.0, 1.0, 0.0);
        for (int run = matter.a > 0.0 ? 1 : 0; run > 0; --run) face = surface_near(at(ray, middle));
        float slope = dot(face.n, ray.u);
        float meets = middle - face.s / (abs(slope) > 1e-6 ? slope : 1e-6);
        bool split = face.weight > 0.0 && meets > a && meets < b;
        // Without a plane the value tells, in shorter steps; without edges at all, materials are just blurred.
        bool by_value = EDGES == 1u && face.weight == 0.0;
        int pieces = matter.a > 0.0 ? (split ? 2 : by_value ? 4 : 1) : 0;
        for (; pieces > 0; --pieces) {
            float c = split && pieces == 2 ? meets : a + (b - a) / (split ? 1.0 : float(pieces));
            float here = 0.5 * (a + c);
            float s = face.s + slope * (here - middle);
            for (int run = face.weight > 0.0 ? 1 : 0; run > 0; --run)
                matter = warped_matter_at(at(ray, here) + (edge_warp(s, face.a, face.k) - s) * face.n, at(ray, here), face.n);
            for (int run = by_value ? 1 : 0; run > 0; --run) {
                vec4 material = params.rays.materials[material_of(field(at(ray, here)))];
                matter = material.a * vec4(material.rgb, 1.0);
            }
            float weight = (1.0 - sum.a) * opacity(matter.a * ray.mm * (c - a));
            stale += weight;
            bool dark = LIGHT != LIGHT_NONE && weight > 0.0 && (lit_at < -1e8 || (stale > STALE_LIGHT && here - lit_at >= STALE_WAY));
            for (int run = dark ? 1 : 0; run > 0; --run) {
                // At the foot point: planes of single voxels are too rough to be lit.
                light = light_on(gradient(at(ray, here) - (face.weight > 0.0 ? s : 0.0) * face.n), ray.u);
                lit_at = here;
                stale = 0.0;
            }
            sum += weight * vec4(light * matter.rgb / max(matter.a, 1e-20), 1.0);
            a = c;
        }
        i = sum.a >= saturation ? count : i + 1;
    }
    write_pixel(pixel, sum);
}
