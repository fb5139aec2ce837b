// The colour of a surface as seen from the eye: light, silhouette and fog (docs/method/shading.md). Written in the subset of
// GLSL that is C++. The includer declares what the scene has:
//   LightShares, the type of the shares of the lights that arrive, and light_share(LightShares, uint light)
//   LIGHTS, their number, and whether there is GLOSS, SILHOUETTE, FOG (1u or 0u)
//   light_place(uint): direction to a far light, 0; or position relative to the eye, mm, 1; light_sent(uint): its colour
//   ambient_light(); silhouette_color(), its strength as w; silhouette_sharpness(); fog_color(), its density per mm as w;
//   fog_start(), mm
#ifndef EDGESPLAT_LIT_SURFACE_GLSL
#define EDGESPLAT_LIT_SURFACE_GLSL

struct Surface {
    vec3 color;          // linear light
    vec4 response;       // to ambient light, to light; highlights and their exponent
    LightShares lights;  // shares of the lights that arrive
    bool has_normal;
    vec3 normal;         // world, unit
    Real ambient;        // share of ambient light that arrives
    vec3 from_eye;       // world, mm
    vec3 to_eye;         // world, unit
    Real depth;          // along the view axis, mm
};

// pow(0, x) is not defined on every device.
Real power(Real base, Real exponent) { return base > 0.0 ? pow(base, exponent) : Real(0.0); }

vec3 unit_or_zero(vec3 v) { return dot(v, v) > 0.0 ? normalize(v) : vec3(0.0); }

// Blinn 1977, "Models of light reflection for computer synthesized pictures".
vec3 lit(Surface s) {
    vec3 diffuse = vec3(ambient_light() * s.response.x * s.ambient);
    vec3 specular = vec3(0.0);
    for (uint l = 0u; l < LIGHTS; ++l) {
        vec4 place = light_place(l);
        vec3 towards = vec3(place) - place.w * s.from_eye;
        // At the light itself, all directions are equivalent.
        bool at_light = dot(towards, towards) == 0.0;
        vec3 to_light = unit_or_zero(towards);
        Real facing = at_light ? Real(1.0) : dot(s.normal, to_light);
        vec3 light = light_sent(l) * light_share(s.lights, l);
        diffuse += s.response.y * light * (s.has_normal ? max(facing, Real(0.0)) : Real(0.5));
        if (GLOSS == 1u) {
            vec3 halfway = unit_or_zero(to_light + s.to_eye);
            Real glossy = s.response.z * power(dot(s.normal, halfway), s.response.w);
            specular += s.has_normal && facing > 0.0 ? light * glossy : vec3(0.0);
        }
    }
    if (GLOSS == 0u) return s.color * diffuse;
    return s.color * diffuse + specular;
}

vec3 shade(Surface s) {
    vec3 color = s.color;
    if (LIGHTS > 0u) color = lit(s);
    if (SILHOUETTE == 1u) {
        vec4 outline = silhouette_color();
        Real turned = power(1.0 - abs(dot(s.normal, s.to_eye)), silhouette_sharpness());
        Real share = s.has_normal ? outline.w * turned : Real(0.0);
        color += share * (vec3(outline) - color);
    }
    if (FOG == 1u) {
        vec4 fog = fog_color();
        Real clear = exp(-fog.w * max(s.depth - fog_start(), Real(0.0)));
        color = mix(vec3(fog), color, clear);
    }
    return color;
}
#endif
