// Finds where a ray meets the surface of the cubic field, for splats whose face was refused. The result is the ray's first
// two pieces in the matter. docs/method/tiles.md, 5_trace_faces. The including shader declares `coefficients` and `dims`.
#ifndef EDGESPLAT_TRACE_RAY_GLSL
#define EDGESPLAT_TRACE_RAY_GLSL
#include "footprints/in_float.glsl"
#include "engine/geometry/volume_ends.glsl"
#include "shaders/drivers/if_any.glsl"
#include "shaders/edges/edge_record.glsl"
#include "shaders/splats/traced_ray.glsl"
#include "shaders/common/matter.glsl"
#include "shaders/splats/outline_word.glsl"

// Packs the normal out of the matter; the last bit says whether the values outside are higher.
uint pack_end(vec3 n, bool upper) { return (pack_normal(n) & ~1u) | (upper ? 1u : 0u); }

// The extremum between 0 and 1 of the cubic with these values and slopes at 0 and 1: position and value.
struct Turn {
    bool there;
    float at;
    float value;
};
Turn turn_of(float f0, float d0, float f1, float d1) {
    float at = d0 / (d0 - d1), rest = 1.0 - at;
    float value = rest * rest * (f0 * (1.0 + 2.0 * at) + d0 * at) + at * at * (f1 * (3.0 - 2.0 * at) - d1 * rest);
    return Turn(d0 * d1 < 0.0, at, value);
}

// Where the same cubic has the value `level`, which lies between those at 0 and 1.
float root_of(float f0, float d0, float f1, float d1, float level) {
    float rise = f1 - f0, square = 3.0 * rise - 2.0 * d0 - d1, cube = d0 + d1 - 2.0 * rise;
    float t = (level - f0) / rise;
    for (int i = 0; i < 2; ++i) {
        float slope = d0 + t * (2.0 * square + t * 3.0 * cube), off = f0 + t * (d0 + t * (square + t * cube)) - level;
        t = clamp(t - off / (abs(slope) > 1e-9 ? slope : 1e-9), 0.0, 1.0);
    }
    return t;
}

bool is_matter(float f) { return is_drawn(material_of(f)); }

// A part of a ray, voxels from the eye; empty if first >= last.
struct Stretch {
    float first;
    float last;
};
const Stretch NO_STRETCH = Stretch(TRACE_NOWHERE, -TRACE_NOWHERE);

// The part of a ray that a kernel may cover. p: the ray's point nearest to the voxel; `ahead`: its distance along u
// from the eye.
Stretch kernel_stretch(vec3 p, float reach, float ahead) {
    float half_chord = sqrt(max(reach * reach - dot(p, p), 0.0));
    Stretch s = Stretch(max(ahead - half_chord, 0.0), ahead + half_chord);
    if (!(half_chord > 0.0 && s.last > 0.0)) s = NO_STRETCH;
    return s;
}

// Where the field is nearest to the matter on a ray that passes it, or deepest in the matter. `level`: distance from the
// matter, negative in it.
struct Passing {
    float z;
    float level;
    vec3 out_of;  // unit
};
const Passing NO_PASSING = Passing(TRACE_NOWHERE, TRACE_NOWHERE, vec3(0.0));

// Of a ray that enters the matter at z0, where the field's gradient is g0; g1: at z1 in it. `inward`: 1 if values grow into
// the matter, else -1. The slope along the ray is taken as linear.
Passing deepest(float z0, vec3 g0, float z1, vec3 g1, vec3 u, float inward) {
    float s0 = inward * dot(g0, u), bend = (s0 - inward * dot(g1, u)) / max(z1 - z0, 1e-3), z = s0 / max(bend, 1e-9);
    vec3 g = inward * mix(g0, g1, z / max(z1 - z0, 1e-3));
    float steep = max(length(g), 1e-9);
    Passing p = Passing(z0 + z, -0.5 * s0 * z / steep, -g / steep);
    if (!(bend > 0.0 && z * z < OUTLINE_FAR2)) p = NO_PASSING;
    return p;
}

uint outline_of_passing(Passing p, vec3 u) { return outline_word(p.level, rate_across(p.out_of, p.z * dot(params.of_volume.view_z, u))); }

// Traces the ray along u from `from`, within `kept`. Samples lie TRACE_STEP apart, at
// positions independent of the beginning. An extra sample lies where the field may have an extremum beyond the
// interval's end. Ends are refined by Newton's method. Stops after the second piece, SURFACE_DEEP inside a piece, or at
// the end of the volume.
TracedRay trace_ray(vec3 from, vec3 u, Stretch along, Stretch kept) {
    VolumeEnds ends = volume_ends(from, divisible(u), dims);
    Stretch whole = Stretch(entry_of(ends), exit_of(ends));
    float until = along.last;
    whole = Stretch(max(whole.first, kept.first), min(whole.last, kept.last));
    along = Stretch(max(along.first, whole.first), min(along.last, whole.last));
    int k = int(floor(along.first / TRACE_STEP)), end = int(ceil(along.last / TRACE_STEP));
    TracedRay t = TracedRay(vec2(TRACE_NOWHERE), vec2(TRACE_NOWHERE), 0u, 0u, float(k) * TRACE_STEP, NO_OUTLINE);
    Passing passing = NO_PASSING;
    vec3 g_before = vec3(0.0), g_first = vec3(0.0), g_last = vec3(0.0);
    float z_last = 0.0, inward = 1.0;
    uint pieces = 0u;
    bool begun = false, matter = false, turned = false, probes = false, looks = along.first < along.last;
    float entered = along.first, probe = 0.0, before = 0.0, value_before = 0.0, slope_before = 0.0;  // the previous sample
    float a = 0.0, b = 0.0, guess = 0.0, level = 0.0;  // bracket of an end
    bool rises = false, upper = false;
    int searching = 0;
    // One sample per iteration, of the ray or of the search for an end, so that lavapipe has a single loop.
    while (looks) {
        bool in_search = searching > 0, walks = !in_search;
        float z = in_search ? guess : probes ? probe : clamp(float(k) * TRACE_STEP, whole.first, whole.last);
        vec4 field = bspline_slope(ivec3(0), from + z * u);
        float slope = dot(field.xyz, u);
        bool inside = is_matter(field.w);
        // Refinement of an end.
        bool nearer = (field.w < level) == rises;
        a = in_search && nearer ? z : a;
        b = in_search && !nearer ? z : b;
        float newton = z - (field.w - level) / (abs(slope) > 1e-9 ? slope : 1e-9);
        float next = newton >= a && newton <= b ? newton : 0.5 * (a + b);
        guess = in_search ? next : guess;
        searching = in_search ? (abs(next - z) < SURFACE_NEAR ? 0 : searching - 1) : searching;
        bool found = in_search && searching == 0, second = pieces == 2u, enters = found && matter, leaves = found && !matter;
        uint code = pack_end(normalize((upper ? field.xyz : -field.xyz) + vec3(0.0, 0.0, 1e-12)), upper);
        entered = enters ? guess : entered;
        t.one.x = enters && !second ? guess : t.one.x;
        t.first_end = enters && !second ? code : t.first_end;
        t.one.y = leaves && !second ? guess : t.one.y;
        if (OUTLINES == 1u) {
            g_first = enters && !second ? field.xyz : g_first;
            inward = enters && !second ? (upper ? -1.0 : 1.0) : inward;
            bool in_first = pieces == 1u && (leaves || (walks && inside));
            g_last = in_first ? field.xyz : g_last;
            z_last = in_first ? z : z_last;
        }
        t.two.x = enters && second ? guess : t.two.x;
        t.second_end = enters && second ? code : t.second_end;
        t.two.y = leaves && second ? guess : t.two.y;
        // A sample of the ray.
        float step = z - before;
        Turn turn = turn_of(value_before, slope_before * step, field.w, slope * step);
        float beyond = turn.value + 0.5 * (turn.value - 0.5 * (value_before + field.w));
        bool turns = walks && begun && !turned && !probes && inside == matter && turn.there && is_matter(beyond) != matter;
        if (OUTLINES == 1u) {
            vec2 empty = body_around(turn.value);
            float towards = slope_before > 0.0 ? empty.y : empty.x;
            vec3 g = mix(g_before, field.xyz, turn.at);
            float level = abs(towards - turn.value) / max(length(g), 1e-9);
            bool passes = walks && begun && !inside && !matter && turn.there && (slope_before > 0.0) == (towards > turn.value) && level < passing.level;
            if (passes) passing = Passing(before + turn.at * step, level, (slope_before > 0.0 ? -g : g) / max(length(g), 1e-9));
            g_before = walks && !turns ? field.xyz : g_before;
        }
        bool takes = walks && !turns, crosses = takes && begun && inside != matter;
        float outer = inside ? value_before : field.w;
        vec2 body = body_around(inside ? field.w : value_before);
        upper = crosses ? outer >= body.x : upper;
        level = crosses ? (upper ? body.y : body.x) : level;
        a = crosses ? before : a;
        b = crosses ? z : b;
        guess = crosses ? mix(a, b, root_of(value_before, slope_before * step, field.w, slope * step, level)) : guess;
        rises = crosses ? field.w > value_before : rises;
        searching = crosses ? TRACE_ROOT_STEPS : searching;
        bool starts = takes && !begun && inside;
        pieces += starts || (crosses && inside) ? 1u : 0u;
        t.one.x = starts ? -TRACE_NOWHERE : t.one.x;
        matter = takes ? inside : matter;
        probe = turns ? before + turn.at * step : probe;
        turned = takes ? probes : turned;
        k += takes && !probes ? 1 : 0;
        probes = walks ? turns : probes;
        before = takes ? z : before;
        value_before = takes ? field.w : value_before;
        slope_before = takes ? slope : slope_before;
        begun = begun || takes;
        bool deep = takes && !crosses && matter && z - entered > SURFACE_DEEP, at_end = takes && !crosses && k > end;
        t.last = at_end ? max(z, until) : takes ? z : t.last;
        looks = !(leaves && second) && !at_end && pieces < 3u && !deep;
    }
    if (OUTLINES == 1u) {
        Passing deep = deepest(t.one.x, g_first, z_last, g_last, u, inward);
        uint crossed = abs(t.one.x) < TRACE_NOWHERE && z_last > t.one.x ? outline_of_passing(deep, u) : NO_OUTLINE;
        t.outline = min(crossed, passing.level < TRACE_NOWHERE ? outline_of_passing(passing, u) : NO_OUTLINE);
    }
    return t;
}
#endif
