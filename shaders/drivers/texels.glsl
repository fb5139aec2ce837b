// Buffers that shaders read either as texels (faster on lavapipe) or through their addresses (for devices with fewer
// texels than a picture may have pixels). Include after the declaration of `params`. bindings.h says what each buffer
// contains.
#ifndef EDGESPLAT_TEXELS_GLSL
#define EDGESPLAT_TEXELS_GLSL
layout(constant_id = SPEC_TEXELS) const uint TEXELS = 1u;

uvec4 as_texel(uint value) { return uvec4(value, 0u, 0u, 0u); }
uvec4 as_texel(uvec2 value) { return uvec4(value, 0u, 0u); }
vec4 as_texel(vec4 value) { return value; }

// Declares a buffer with name, slot and the FrameParams field of its address. Defines T load(uint); STORED_OF also
// defines void store(uint, T).
#define TEXELS_OF(T, texel, image, Ref, slot, access, name, address, load) \
    layout(binding = slot, texel) uniform access image name;               \
    T load(uint at) {                                                      \
        if (TEXELS == 1u) return T(imageLoad(name, int(at)));              \
        return Ref(params.frame.address).at[at];                           \
    }
#define STORED_OF(T, texel, image, Ref, slot, name, address, load, store)          \
    TEXELS_OF(T, texel, image, Ref, slot, restrict, name, address, load)           \
    void store(uint at, T value) {                                                 \
        if (TEXELS == 1u) imageStore(name, int(at), as_texel(value));              \
        else Ref(params.frame.address).at[at] = value;                             \
    }
#define TEXEL_WORDS(slot, name, address, load) TEXELS_OF(uint, r32ui, uimageBuffer, UintsRef, slot, readonly, name, address, load)
#define TEXEL_PAIRS(slot, name, address, load) TEXELS_OF(uvec2, rg32ui, uimageBuffer, PairsRef, slot, readonly, name, address, load)
#define TEXEL_PIXELS(slot, name, address, load) TEXELS_OF(vec4, rgba32f, imageBuffer, PixelsRef, slot, readonly, name, address, load)
#define STORED_WORDS(slot, name, address, load, store) STORED_OF(uint, r32ui, uimageBuffer, UintsRef, slot, name, address, load, store)
#define STORED_PAIRS(slot, name, address, load, store) STORED_OF(uvec2, rg32ui, uimageBuffer, PairsRef, slot, name, address, load, store)
#define STORED_PIXELS(slot, name, address, load, store) STORED_OF(vec4, rgba32f, imageBuffer, PixelsRef, slot, name, address, load, store)
#endif
