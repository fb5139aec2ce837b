// Data that all pixels of a splat share, computed once: position, kernel, colour. 4_prepare_splats stores it in records
// of PREPARED_STRIDE vec4 for 5_draw_tiles; `prepared_stride` in C++ computes the same size. Include after
// shaders/splats/splat_inputs.glsl.
#ifndef EDGESPLAT_PREPARED_SPLAT_GLSL
#define EDGESPLAT_PREPARED_SPLAT_GLSL
#include "shaders/splats/splat_conic.glsl"

struct PreparedSplat {
    SplatConic conic;
    vec3 start;      // rays_beside()
    float plane;
    vec2 slopes;     // slopes of the voxel; only with antialias
    SplatInputs inputs;
};

// The last bit of the depth stores whether the splat is traced.
float with_traced(float depth, bool traced) { return uintBitsToFloat(floatBitsToUint(depth) & ~1u | (traced ? 1u : 0u)); }
bool conic_is_traced(SplatConic conic) { return (floatBitsToUint(conic.depth) & 1u) != 0u; }

// The last bits of the extinction store the splat's volume if there are several.
float with_volume(float extinction, uint volume) { return uintBitsToFloat(floatBitsToUint(extinction) & ~(MAX_TOGETHER - 1u) | volume); }
uint volume_of(float extinction) { return floatBitsToUint(extinction) & MAX_TOGETHER - 1u; }

// `number`: in its volume's list; enter_volume() has selected the volume.
PreparedSplat prepared_splat(uint number, uint sheet) {
    PreparedSplat s;
    Splat splat = SplatsRef(params.of_volume.splats).at[number];
    Edge e = unpack_edge(splat.normal, splat.edge);
    Projection p = place_splat(number, splat, e);
    vec2 depths = vec2(0.0);
    if (SLICED == 1u) {
        float near = params.of_volume.sheet_zero + float(sheet) * params.frame.sheet_thickness - dot(params.of_volume.view_z, p.position);
        depths = vec2(near, near + params.frame.sheet_thickness);
        cut_support(p, depths);
    }
    s.inputs = splat_inputs(number, splat, e, p, depths);
    if (TOGETHER == 1u) s.inputs.color_sigma.w = with_volume(s.inputs.color_sigma.w, volume_number);
    s.conic = splat_conic(p);
    if (TRACED == 1u) s.conic.depth = with_traced(s.conic.depth, (s.inputs.number_material.y & IS_TRACED) != 0u);
    bool at_eye = view_position(p.position + p.centre).z < 1.05 * p.radius * length(params.of_volume.view_z);
    vec4 beside = rays_beside(p, at_eye);
    s.start = beside.xyz;
    s.plane = beside.w;
    s.slopes = p.view.xy / p.view.z;
    return s;
}

// Planes cut rays, not surface splats.
const bool PREPARES_CUTS = CLIP_KEEP + CLIP_REMOVE > 0u && SURFACES == 0u;
const uint PREPARED_KERNEL = 2u;
const uint PREPARED_CREASE = 6u;
const uint PREPARED_START = FACES ? 6u + CREASES : FOOTPRINTS != ISOTROPIC ? 4u : 2u;
const uint PREPARED_CUT = PREPARED_START + 2u;
const uint PREPARED_MATTER = PREPARED_CUT + SLICED;
const uint PREPARED_FILTER = PREPARED_MATTER + (PREPARES_CUTS ? 2u : 0u);
const uint PREPARED_TABLE = PREPARED_FILTER + (ANTIALIAS == 1u ? 2u : 0u);
const uint PREPARED_STRIDE = PREPARED_TABLE + (FOOTPRINTS == TABLE ? 2u : 0u);

// The entries of a chunk are consecutive, and there are at most as many as slots.
uint prepared_slot(uint entry) { return (entry & params.frame.prepared_mask) * PREPARED_STRIDE; }

ivec2 prepared_texel(uint at) { return ivec2(at % PREPARED_ROW, at / PREPARED_ROW); }

#ifdef KEEPS_PREPARED
void keep_prepared(uint entry, PreparedSplat s) {
    uint at = prepared_slot(entry);
    imageStore(prepared, prepared_texel(at), vec4(s.conic.centre, s.conic.form.xy));
    imageStore(prepared, prepared_texel(at + 1u), vec4(s.conic.form.z, s.conic.linear, s.conic.depth));
    if (FACES) {
        FaceForm f = s.inputs.face;
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL), vec4(f.slope, f.value));
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL + 1u), vec4(f.h.diagonal, f.cut.depth));
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL + 2u), vec4(f.h.mixed, f.cut.thickness));
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL + 3u),
                   vec4(f.cut.reach2, uintBitsToFloat(s.inputs.number_material.x), uintBitsToFloat(s.inputs.number_material.y), f.corner));
        if (CREASES == 1u) imageStore(prepared, prepared_texel(at + PREPARED_CREASE), vec4(f.crease.n, f.crease.away));
    }
    if (FOOTPRINTS != ISOTROPIC && !FACES) {
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL), s.inputs.normal_distance);
        imageStore(prepared, prepared_texel(at + PREPARED_KERNEL + 1u), vec4(s.inputs.shape.x, 0.0, 0.0, 0.0));
    }
    imageStore(prepared, prepared_texel(at + PREPARED_START), vec4(s.start, s.plane));
    imageStore(prepared, prepared_texel(at + PREPARED_START + 1u), s.inputs.color_sigma);
    if (SLICED == 1u) imageStore(prepared, prepared_texel(at + PREPARED_CUT), vec4(s.inputs.shape.yz, 0.0, 0.0));
    if (PREPARES_CUTS) {
        imageStore(prepared, prepared_texel(at + PREPARED_MATTER), vec4(s.inputs.from_eye, uintBitsToFloat(s.inputs.number_material.y)));
        imageStore(prepared, prepared_texel(at + PREPARED_MATTER + 1u), vec4(s.inputs.matter, uintBitsToFloat(s.inputs.number_material.x)));
    }
    if (ANTIALIAS == 1u) {
        imageStore(prepared, prepared_texel(at + PREPARED_FILTER), vec4(s.slopes, 0.0, 0.0));
        imageStore(prepared, prepared_texel(at + PREPARED_FILTER + 1u), s.inputs.filtered);
    }
    if (FOOTPRINTS == TABLE) {
        imageStore(prepared, prepared_texel(at + PREPARED_TABLE), first_texel(s.inputs.selected));
        imageStore(prepared, prepared_texel(at + PREPARED_TABLE + 1u), second_texel(s.inputs.selected));
    }
}

#else
SplatConic load_conic(uint entry) {
    uint at = prepared_slot(entry);
    vec4 u = imageLoad(prepared, prepared_texel(at)), v = imageLoad(prepared, prepared_texel(at + 1u));
    return SplatConic(u.xy, vec3(u.zw, v.x), v.yz, v.w);
}

// Reference point of the rays through an entry's splat: rays_beside().
vec4 load_start(uint entry) { return imageLoad(prepared, prepared_texel(prepared_slot(entry) + PREPARED_START)); }

vec4 load_color_sigma(uint entry) { return imageLoad(prepared, prepared_texel(prepared_slot(entry) + PREPARED_START + 1u)); }

// Reach of a surface splat's votes.
float load_reach(uint entry) { return load_color_sigma(entry).w; }

// Volume of a kernel, if there are several.
uint load_volume(uint entry) { return volume_of(load_color_sigma(entry).w); }

// Loads the data that draws an entry.
void load_kernel(uint entry, inout PreparedSplat s) {
    uint at = prepared_slot(entry);
    if (FACES) {
        vec4 a = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL)), b = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL + 1u));
        vec4 c = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL + 2u)), d = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL + 3u));
        s.inputs.face = FaceForm(a.w, a.xyz, Bending(b.xyz, c.xyz), FaceCut(b.w, c.w, d.x, 0.0, 0.0), no_plane(), d.w);
        s.inputs.number_material = uvec2(floatBitsToUint(d.y), floatBitsToUint(d.z));
        if (CREASES == 1u) {
            vec4 plane = imageLoad(prepared, prepared_texel(at + PREPARED_CREASE));
            s.inputs.face.crease = Plane(plane.xyz, plane.w);
        }
    }
    if (FOOTPRINTS != ISOTROPIC && !FACES) {
        s.inputs.normal_distance = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL));
        s.inputs.shape.x = imageLoad(prepared, prepared_texel(at + PREPARED_KERNEL + 1u)).x;
    }
    vec4 v = load_start(entry);
    s.start = v.xyz;
    s.plane = v.w;
    s.inputs.color_sigma = load_color_sigma(entry);
    if (SLICED == 1u) s.inputs.shape.yz = imageLoad(prepared, prepared_texel(at + PREPARED_CUT)).xy;
    if (PREPARES_CUTS) {
        vec4 place = imageLoad(prepared, prepared_texel(at + PREPARED_MATTER)), matter = imageLoad(prepared, prepared_texel(at + PREPARED_MATTER + 1u));
        s.inputs.from_eye = place.xyz;
        s.inputs.matter = matter.xyz;
        if (!FACES) s.inputs.number_material = uvec2(floatBitsToUint(matter.w), floatBitsToUint(place.w));
    }
    if (ANTIALIAS == 1u) {
        s.slopes = imageLoad(prepared, prepared_texel(at + PREPARED_FILTER)).xy;
        s.inputs.filtered = imageLoad(prepared, prepared_texel(at + PREPARED_FILTER + 1u));
    }
    if (FOOTPRINTS == TABLE)
        s.inputs.selected = from_texels(imageLoad(prepared, prepared_texel(at + PREPARED_TABLE)), imageLoad(prepared, prepared_texel(at + PREPARED_TABLE + 1u)));
}
#endif
#endif
