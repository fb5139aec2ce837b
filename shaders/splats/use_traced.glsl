// The face of a traced splat on one ray: the tangent plane of the field's surface where the ray meets it. Include after
// the variables of shaders/splats/splat_value.glsl and after shaders/splats/traced_ray.glsl. Mirrored by
// engine/reference/traced_face.h.
#ifndef EDGESPLAT_USE_TRACED_GLSL
#define EDGESPLAT_USE_TRACED_GLSL

// Changes `face_form` and `number_material` of a splat that IS_TRACED; p, u and ahead as in splat_value(). False: the
// ray meets no matter.
bool use_traced(SeenRay t, vec3 p, vec3 u, float ahead) {
    float half_chord = sqrt(max(TRACE_REACH * TRACE_REACH - dot(p, p), 0.0));
    float low = max(ahead - half_chord, 0.0), high = ahead + half_chord;
    float first = min(t.one.y, high) - max(t.one.x, low), other = min(t.two.y, high) - max(t.two.x, low);
    bool second = other > first, upper = second ? t.upper.y : t.upper.x;
    vec2 piece = second ? t.two : t.one;
    vec3 n = second ? t.second_normal : t.first_normal;
    bool some = max(first, other) > 0.0, enters = some && piece.x > low, leaves = some && piece.y < high;
    // Parts that were not traced keep the quadric: behind the second piece, or deep in matter.
    bool known = (number_material.y & IS_TRACED) != 0u && (some || t.last >= high - 1e-3);
    bool plane = known && enters, whole = known && some && !enters && !leaves;
    n = whole ? normalize(face_form.slope) : n;
    plane = plane || whole;
    face_form.slope = plane ? n : face_form.slope;
    // In matter all along: the face is too far away to cut the kernel.
    face_form.value = whole ? -TRACE_WHOLE : plane ? -dot(n, p + (piece.x - ahead) * u) : face_form.value;
    face_form.h.diagonal = plane ? vec3(0.0) : face_form.h.diagonal;
    face_form.h.mixed = plane ? vec3(0.0) : face_form.h.mixed;
    FaceCut cut = face_cut(-face_form.value, 0.0, 0.0, leaves ? max((piece.y - piece.x) * abs(dot(u, n)), 0.05) : 1e9, FACE_DEPTH);
    face_form.cut.depth = plane ? cut.depth : face_form.cut.depth;
    face_form.cut.thickness = plane ? cut.thickness : face_form.cut.thickness;
    face_form.cut.reach2 = plane ? cut.reach2 : face_form.cut.reach2;
    uint upward = number_material.y & ~(FACES_UPWARD | IS_MIXED) | (upper ? FACES_UPWARD : 0u);
    number_material.y = plane && !whole ? upward : number_material.y;
    // If the ray only leaves matter here, other splats draw the matter before.
    return !known || plane;
}
#endif
