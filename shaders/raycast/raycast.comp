// Ray casting with iso-values: emission and absorption of the material at each point. The material changes where the
// interpolated value crosses an iso-value. docs/method.md, Ray caster.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/drivers/if_any.glsl"
#include "shaders/shared/raycast_params.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = BIND_RAYS, scalar) uniform Rays { SceneParams scene; RayParams rays; } params;
#include "shaders/raycast/raycast.glsl"

// The crossing of an iso-value between low and high. f_low and f_high: value minus iso-value at both; their signs
// differ.
float crossing(Ray ray, float low, float high, float f_low, float f_high, float iso) {
    float a = low, b = high, c = 0.0;
    if (FILTER == FILTER_CUBIC) {
        // Newton's method from the secant's zero; bisection if a step leaves the bracket. Accurate to 1e-3 voxel.
        c = low + (high - low) * f_low / (f_low - f_high);
        for (int k = 0; k < 3; ++k) {
            vec4 s = bspline_slope(ivec3(0), at(ray, c));
            float f = s.w - iso;
            bool near = (f < 0.0) == (f_low < 0.0);
            low = near ? c : low;
            high = near ? high : c;
            float next = c - f / dot(s.xyz, ray.u);
            c = next >= low && next <= high ? next : 0.5 * (low + high);
        }
    } else {
        // Regula falsi, Illinois variant: halves the value at the end that does not move.
        for (int k = 0; k < 2; ++k) {
            c = low + (high - low) * f_low / (f_low - f_high);
            float f = field(at(ray, c)) - iso;
            bool near = (f < 0.0) == (f_low < 0.0);
            f_high = near ? 0.5 * f_high : f;
            f_low = near ? f : 0.5 * f_low;
            low = near ? c : low;
            high = near ? high : c;
        }
        c = clamp(low + (high - low) * f_low / (f_low - f_high), a, b);
    }
    return c;
}

void main() {
    ivec2 pixel = pixel_of_invocation();
    if (any(greaterThanEqual(pixel, params.rays.size))) return;
    read_scene();
    Ray ray = ray_of(pixel);
    float step = params.rays.step, per_step = 1.0 / step, saturation = params.rays.saturation;
    int count = ray.first < ray.last ? int(ceil((ray.last - ray.first) * per_step)) : 0;

    vec4 sum = vec4(0.0);
    float previous = 0.0, current = 0.0;
    IF_ANY(count > 0) previous = field(at(ray, ray.first));
    uint from = material_of(previous), to = from, lowest = material_of(0.0);
    bool was_visible = is_visible(from);
    float light = 1.0, lit_at = -1e9, stale = 0.0;  // depth of the last lighting, and opacity drawn with it since
    float alpha_step = 0.0;            // opacity of a whole step in the current material
    vec4 color = vec4(0.0);            // lit colour
    vec3 unlit = vec3(0.0);
    // Each loop does one kind of work: lavapipe runs both sides of an `if`, but skips an empty loop.
    for (int i = 1; i <= count;) {
        // Passes transparent and unchanged parts up to a segment (i - 1, i) that needs crossings or lighting.
        bool found = false;
        while (i <= count && !found) {
            float way = SKIP == 1u && !was_visible ? 1e9 : 0.0;
            while (i <= count && way > 0.0) {
                float t = min(ray.first + float(i) * step, ray.last);
                way = leap(ray, at(ray, t));
                // If the end point lies in a transparent brick and the segment starts transparent, the whole segment is
                // transparent.
                i = way > 0.0 ? max(i + 1, int(ceil((t + way - 1e-3 - ray.first) * per_step))) : i;
            }
            int end = count;
            if (SKIP == 1u && !was_visible) {
                float t = min(ray.first + float(i) * step, ray.last);
                end = min(count, i + int(leave(ray, at(ray, t)) * per_step));
            }
            while (i <= end && !found) {
                float t = min(ray.first + float(i) * step, ray.last);
                current = field(at(ray, t));
                to = material_of(current);
                bool changes = was_visible ? to != from : is_visible(to);
                float weight = (1.0 - sum.a) * alpha_step;
                // Matter of the smallest value is not there where samples contain no data.
                if (NO_DATA == 1u) weight = from == lowest && is_missing(at(ray, t - 0.5 * step)) ? 0.0 : weight;
                bool dark = LIGHT + LABELS != 0u && stale + weight > STALE_LIGHT && t - 0.5 * step - lit_at >= STALE_WAY;
                found = changes || (was_visible && (dark || i == count || alpha_step == 0.0));
                weight = found ? 0.0 : weight;
                previous = found ? previous : current;
                stale += weight;
                sum += weight * color;
                i = sum.a >= saturation ? count + 1 : found ? i : i + 1;
            }
        }

        // One piece per material on the segment.
        float a = min(ray.first + float(i - 1) * step, ray.last), b = min(ray.first + float(i) * step, ray.last);
        IF_ANY(found && !was_visible) {
            previous = field(at(ray, a));
            from = material_of(previous);
        }
        to = found ? material_of(current) : to;
        float f_from = previous;
        bool entered = false;
        int way = to > from ? 1 : -1;
        for (int pieces = found ? abs(int(to) - int(from)) + 1 : 0; pieces > 0; --pieces) {
            float c = b;
            float iso = 0.0;
            IF_ANY(pieces > 1) {
                iso = params.scene.iso[way > 0 ? from : from - 1u];
                c = crossing(ray, a, b, f_from - iso, current - iso, iso);
            }
            vec4 material = params.rays.materials[from];
            float weight = (1.0 - sum.a) * opacity(material.a * ray.mm * (c - a));
            if (NO_DATA == 1u) weight = from == lowest && is_missing(at(ray, 0.5 * (a + c))) ? 0.0 : weight;
            stale += weight;
            // Surfaces are lit at the crossing, independent of the sample positions.
            float here = entered ? a : 0.5 * (a + c);
            bool dark = LIGHT + LABELS != 0u && material.a > 0.0 && (entered || (stale > STALE_LIGHT && here - lit_at >= STALE_WAY));
            // Matter that the volume's border cuts is lit with the border's normal.
            bool cut = !entered && lit_at < -1e8 && dot(ray.border, ray.border) > 0.0;
            IF_ANY(dark) {
                if (LIGHT != LIGHT_NONE) light = light_on(cut ? ray.border : gradient(at(ray, here)), ray.u);
                unlit = color_at(from, at(ray, here));
                lit_at = here;
                stale = 0.0;
            }
            color = vec4(light * (LABELS != 0u ? unlit : material.rgb), 1.0);
            sum += weight * color;
            alpha_step = opacity(material.a * ray.mm * step);
            entered = pieces > 1;
            from = pieces > 1 ? uint(int(from) + way) : from;
            a = c;
            f_from = iso;
        }
        previous = current;
        was_visible = is_visible(from);
        i = sum.a >= saturation ? count + 1 : i + 1;
    }
    write_pixel(pixel, sum);
}
