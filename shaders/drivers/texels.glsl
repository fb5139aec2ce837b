// Buffers that shaders load as texels, which lavapipe does faster, or through their addresses, where a device has fewer texels than a
// picture may have pixels. After the declaration of `params`; `format` of each is in bindings.h.
#ifndef EDGESPLAT_TEXELS_GLSL
#define EDGESPLAT_TEXELS_GLSL
layout(constant_id = SPEC_TEXELS) const uint TEXELS = 1u;

// uint load(int), by the buffer's name and the field of FrameParams with its address; STORED_: void store(int, uint), too.
#define TEXEL_WORDS(slot, access, name, address, load)                      \
    layout(binding = slot, r32ui) uniform access uimageBuffer name;         \
    uint load(int at) {                                                     \
        if (TEXELS == 1u) return imageLoad(name, at).x;                     \
        return UintsRef(params.frame.address).at[at];                       \
    }
#define STORED_WORDS(slot, name, address, load, store)                      \
    TEXEL_WORDS(slot, restrict, name, address, load)                        \
    void store(int at, uint value) {                                        \
        if (TEXELS == 1u) imageStore(name, at, uvec4(value, 0u, 0u, 0u));   \
        else UintsRef(params.frame.address).at[at] = value;                 \
    }
// uvec2.
#define TEXEL_PAIRS(slot, access, name, address, load)                      \
    layout(binding = slot, rg32ui) uniform access uimageBuffer name;        \
    uvec2 load(int at) {                                                    \
        if (TEXELS == 1u) return imageLoad(name, at).xy;                    \
        return PairsRef(params.frame.address).at[at];                       \
    }
#define STORED_PAIRS(slot, name, address, load, store)                      \
    TEXEL_PAIRS(slot, restrict, name, address, load)                        \
    void store(int at, uvec2 value) {                                       \
        if (TEXELS == 1u) imageStore(name, at, uvec4(value, 0u, 0u));       \
        else PairsRef(params.frame.address).at[at] = value;                 \
    }
// vec4.
#define TEXEL_PIXELS(slot, access, name, address, load)                     \
    layout(binding = slot, rgba32f) uniform access imageBuffer name;        \
    vec4 load(int at) {                                                     \
        if (TEXELS == 1u) return imageLoad(name, at);                       \
        return PixelsRef(params.frame.address).at[at];                      \
    }
#define STORED_PIXELS(slot, name, address, load, store)                     \
    TEXEL_PIXELS(slot, restrict, name, address, load)                       \
    void store(int at, vec4 value) {                                        \
        if (TEXELS == 1u) imageStore(name, at, value);                      \
        else PixelsRef(params.frame.address).at[at] = value;                \
    }
#endif
