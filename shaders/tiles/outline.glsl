// The outline of a splat that passes a pixel, in a word. The including shader declares the variable `face_form`, the constant
// CREASES and the uniform block `params.frame`. docs/method/smoothing.md, Outlines.
#ifndef EDGESPLAT_OUTLINE_OF_GLSL
#define EDGESPLAT_OUTLINE_OF_GLSL
#include "shaders/drivers/if_any.glsl"
#include "shaders/splats/outline_word.glsl"
#include "footprints/face.glsl"
#include "engine/geometry/face_sight.glsl"
#include "engine/geometry/outline.glsl"

uint word_of(PassingOutline passing) { return passing.there ? outline_word(passing.level, passing.rate) : NO_OUTLINE; }

// Outline of a splat with a face and with the optical depth `tau` on the ray; other arguments as in splat_value().
uint outline_of(vec3 p, vec3 u, float ahead, float tau) {
    OutlinedSplat splat;
    splat.sight = face_sight(p, u);
    if (CREASES == 1u) splat.crease = crease_seen(p, u);
    splat.ahead = ahead;
    splat.depth_along = dot(params.of_volume.view_z, u);
    splat.tau = tau;
    uint word = word_of(outline_of_face(splat, CREASES == 1u));
    if (CREASES == 1u) word = min(word, word_of(outline_of_crease(splat)));
    return word;
}
#endif
