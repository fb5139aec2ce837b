// The face of a traced splat at one ray: the plane that touches the field's surface where the ray meets it. After
// shaders/splats/splat_value.glsl's variables and shaders/splats/traced_ray.glsl; mirrored by engine/reference/traced_face.h.
#ifndef EDGESPLAT_USE_TRACED_GLSL
#define EDGESPLAT_USE_TRACED_GLSL

// Changes `face_form` and `number_material` of a splat that IS_TRACED; p, u and ahead as in splat_value(). False: the ray meets no matter.
bool use_traced(SeenRay t, vec3 p, vec3 u, float ahead) {
    float half_chord = sqrt(max(TRACE_REACH * TRACE_REACH - dot(p, p), 0.0));
    float low = max(ahead - half_chord, 0.0), high = ahead + half_chord;
    float first = min(t.one.y, high) - max(t.one.x, low), other = min(t.two.y, high) - max(t.two.x, low);
    bool second = other > first, upper = second ? t.upper.y : t.upper.x;
    vec2 piece = second ? t.two : t.one;
    vec3 n = second ? t.second_normal : t.first_normal;
    bool some = max(first, other) > 0.0, enters = some && piece.x > low, leaves = some && piece.y < high;
    // What was not looked at keeps its quadric: behind the second piece, or deep in matter.
    bool known = (number_material.y & IS_TRACED) != 0u && (some || t.last >= high - 1e-3);
    bool plane = known && enters, whole = known && some && !enters && !leaves;
    n = whole ? normalize(face_form.slope) : n;
    plane = plane || whole;
    face_form.slope = plane ? n : face_form.slope;
    // Matter all along: the face is too far off to cut it.
    face_form.value = whole ? -TRACE_WHOLE : plane ? -dot(n, p + (piece.x - ahead) * u) : face_form.value;
    face_form.h.diagonal = plane ? vec3(0.0) : face_form.h.diagonal;
    face_form.h.mixed = plane ? vec3(0.0) : face_form.h.mixed;
    FaceCut cut = face_cut(-face_form.value, 0.0, 0.0, leaves ? max((piece.y - piece.x) * abs(dot(u, n)), 0.05) : 1e9, FACE_DEPTH);
    face_form.cut.depth = plane ? cut.depth : face_form.cut.depth;
    face_form.cut.thickness = plane ? cut.thickness : face_form.cut.thickness;
    face_form.cut.reach2 = plane ? cut.reach2 : face_form.cut.reach2;
    uint upward = number_material.y & ~(FACES_UPWARD | IS_MIXED) | (upper ? FACES_UPWARD : 0u);
    number_material.y = plane && !whole ? upward : number_material.y;
    // Where it but leaves matter there is more of that before, of other splats.
    return !known || plane;
}
#endif
