// Ray casting with a transfer function. Values are linear between two samples of a ray; their absorption and emission
// are exact. docs/method.md, Ray caster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/raycast_params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = BIND_RAYS, scalar) uniform Rays { SceneParams scene; RayParams rays; } params;
#include "shaders/raycast/raycast.glsl"
#include "shaders/common/transfer.glsl"

const float PIECE_DEPTH = 0.5;   // optical depth of a piece; within a piece, colours are mixed without regard to order
const float MOST_PIECES = 16.0;

// The border's inward normal within BORDER_LIGHT of the border, where it serves as gradient; 0 elsewhere.
vec3 border_beside(vec3 p) {
    vec3 below = p + 0.5, above = vec3(dims) - 0.5 - p, near = min(below, above);
    float nearest = min(near.x, min(near.y, near.z));
    bool x = near.x == nearest, y = !x && near.y == nearest;
    vec3 axis = vec3(x, y, !x && !y) * mix(vec3(-1.0), vec3(1.0), lessThan(below, above));
    return nearest < BORDER_LIGHT ? axis : vec3(0.0);
}

// The field at p from the samples with data; `otherwise` if there are none.
float field_of_data(vec3 p, float otherwise) {
    if (NO_DATA == 0u) return field(p);
    p = within_samples(p);
    ivec3 c = ivec3(p), e = min(c + 1, dims - 1);
    vec3 t = p - vec3(c);
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 8; ++i) {
        bvec3 upper = bvec3(i & 1, i & 2, i & 4);
        vec3 w = mix(1.0 - t, t, upper);
        float value = voxel(mix(c, e, upper)), weight = has_data(value) ? w.x * w.y * w.z : 0.0;
        sum += weight * value;
        weights += weight;
    }
    return weights > 0.0 ? sum / weights : otherwise;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (any(greaterThanEqual(pixel, params.rays.size))) return;
    read_scene();
    Ray ray = ray_of(pixel);
    TransferRef rows = TransferRef(params.scene.transfer);
    float step = params.rays.step, per_step = 1.0 / step, saturation = params.rays.saturation;
    int count = ray.first < ray.last ? int(ceil((ray.last - ray.first) * per_step)) : 0;

    vec4 sum = vec4(0.0);
    float previous = 0.0;
    float light = 1.0, lit_at = -1e9, stale = 0.0;  // depth of the last lighting, and opacity drawn with it since
    bool empty = true;                               // `previous` is unknown, or absorbs nothing
    for (int i = 1; i <= count;) {
        // Skips transparent bricks up to a segment (i - 1, i) that may be visible.
        float way = SKIP == 1u && empty ? 1e9 : 0.0;
        while (i <= count && way > 0.0) {
            float t = min(ray.first + float(i) * step, ray.last);
            way = leap(ray, at(ray, t));
            i = way > 0.0 ? max(i + 1, int(ceil((t + way - 1e-3 - ray.first) * per_step))) : i;
        }
        IF_ANY(i <= count && empty) previous = field_of_data(at(ray, min(ray.first + float(i - 1) * step, ray.last)), -1.0);
        empty = false;
        bool dark = false;  // light must be computed before anything else is drawn
        float middle = 0.0;
        while (i <= count && !dark && !empty) {
            float a = min(ray.first + float(i - 1) * step, ray.last), b = min(ray.first + float(i) * step, ray.last);
            middle = 0.5 * (a + b);
            float current = field_of_data(at(ray, b), previous);
            bool missing = false;
            if (NO_DATA == 1u) {
                missing = is_missing(at(ray, middle));
                previous = previous < 0.0 ? current : previous;
            }
            float depth = missing ? 0.0 : ray.mm * (b - a) * transfer_between(rows, previous, current).a;
            float weight = (1.0 - sum.a) * opacity(depth);
            dark = LIGHT != LIGHT_NONE && depth > 0.0 && (lit_at < -1e8 || (stale + weight > STALE_LIGHT && middle > lit_at));
            int pieces = dark || missing ? 0 : int(clamp(ceil(depth / PIECE_DEPTH), 1.0, MOST_PIECES));
            for (int k = 0; k < pieces; ++k) {
                vec4 matter = transfer_between(rows, mix(previous, current, float(k) / float(pieces)), mix(previous, current, float(k + 1) / float(pieces)));
                float part = (1.0 - sum.a) * opacity(ray.mm * (b - a) / float(pieces) * matter.a);
                sum += part * vec4(light * matter.rgb / max(matter.a, 1e-30), 1.0);
            }
            stale += dark ? 0.0 : weight;
            empty = SKIP == 1u && depth == 0.0;
            previous = dark ? previous : current;
            i = sum.a >= saturation ? count + 1 : dark ? i : i + 1;
        }
        IF_ANY(dark) {
            vec3 p = at(ray, middle), border = border_beside(p);
            light = light_on(dot(border, border) > 0.0 ? border : gradient(p), ray.u);
            lit_at = middle;
            stale = 0.0;
        }
    }
    write_pixel(pixel, sum);
}
