// Surface splats on a ray: each says where the ray enters opaque matter, or that it passes by, and the weighted
// majority decides. docs/method.md, Surface splats; design (14) to (16). Written in the subset of GLSL that is C++:
// shaders include it in float, engine/geometry/in_double.h in double. Include after bending.glsl.
#ifndef EDGESPLAT_SURFACE_VOTES_GLSL
#define EDGESPLAT_SURFACE_VOTES_GLSL

// The quadric value + slope.x + x'Hx / 2 about the voxel, negative in the matter, and the splat's place on it.
struct SurfaceSplat {
    Real value;
    vec3 slope;
    Bending h;
    vec3 foot;   // where the weight is 1
    Real reach;  // where it becomes 0, voxels from the foot
};

// What a splat says about a ray.
struct SurfaceVote {
    Real z;       // along the ray, from its point nearest to the voxel
    Real weight;  // 0: nothing
    bool enters;  // false: the ray passes the surface by
    vec3 n;       // out of the matter, not unit; only if it enters
    Real chord;   // length of the ray in the matter, at most SURFACE_CHORD; only if it enters
};

Real vote_weight(vec3 from_foot, Real reach) { return max(1.0 - dot(from_foot, from_foot) / (reach * reach), 0.0); }

// The vote of a splat with a quadric. p: the ray's point nearest to the voxel, relative to it; u: its unit direction.
SurfaceVote vote_of(SurfaceSplat splat, vec3 p, vec3 u) {
    vec3 hp = bent(splat.h, p);
    vec3 hu = bent(splat.h, u);
    Real c = splat.value + dot(splat.slope, p) + 0.5 * dot(p, hp);
    Real b = dot(splat.slope + hp, u);
    Real a = 0.5 * dot(u, hu);
    Real root2 = b * b - 4.0 * a * c;
    Real root = sqrt(max(root2, 0.0));
    // Where the quadric falls through 0; the ray enters only one such place.
    bool falls = b < 0.0;
    Real enters = falls ? 2.0 * c / (root - b) : (-b - root) / (2.0 * (abs(a) > 1e-9 ? a : 1e-9));
    SurfaceVote vote;
    vote.enters = root2 >= 0.0;
    // A quadric that is positive along the whole ray is least where the ray passes it.
    bool passes = root2 < 0.0 && a > 0.0;
    Real turn = -0.5 * b / max(a, 1e-9);
    vote.z = vote.enters ? enters : clamp(turn, -3.0, 3.0);
    vec3 at = p + vote.z * u;
    vote.n = splat.slope + bent(splat.h, at);
    // It leaves the matter where the surface bends away from it. Across the surface the quadric says nothing.
    Real inward = -dot(vote.n, u);
    vec3 beside = u + inward / max(dot(vote.n, vote.n), 1e-12) * vote.n;
    Real bend = 0.5 * dot(beside, bent(splat.h, beside));
    vote.chord = bend * SURFACE_CHORD > inward ? inward / bend : SURFACE_CHORD;
    bool says = vote.enters ? falls || abs(a) > 1e-9 : passes;
    vote.weight = says ? vote_weight(at - splat.foot, splat.reach) : 0.0;
    return vote;
}

// The vote of a splat whose matter lies behind two or three planes.
SurfaceVote vote_of_planes(Plane one, Plane two, Plane three, Real reach, vec3 p, vec3 u) {
    Real first = -1e9;
    Real last = 1e9;
    SurfaceVote vote;
    vote.n = one.n;
    for (int i = 0; i < 3; ++i) {
        Plane plane = one;
        if (i == 1) plane = two;
        if (i == 2) plane = three;
        Real along = dot(plane.n, u);
        Real way = (plane.away - dot(plane.n, p)) / (abs(along) > 1e-9 ? along : -1e-9);
        bool there = plane.away < 0.1 * NO_PLANE;
        bool begins = there && along <= 0.0 && way > first;
        if (begins) vote.n = plane.n;
        if (begins) first = way;
        if (there && along > 0.0) last = min(last, way);
    }
    vote.enters = first < last;
    vote.z = vote.enters ? first : 0.5 * (first + last);
    vec3 at = p + vote.z * u;
    vec3 foot = one.away * one.n;
    Real weight = vote_weight(at - foot, reach);
    foot = two.away * two.n;
    weight = max(weight, vote_weight(at - foot, reach));
    foot = three.away * three.n;
    weight = max(weight, three.away < 1e8 ? vote_weight(at - foot, reach) : 0.0);
    vote.weight = first > -1e8 && (vote.enters || last < 1e8) ? weight : 0.0;
    vote.chord = min(max(last - first, 0.0), SURFACE_CHORD);
    return vote;
}

// The vote of a splat without a quadric about a ray that was traced through the field: it enters matter in the splat's
// ball at `enters` (beyond `high`: it does not) and stays in it for `chord`, or passes without matter there.
SurfaceVote vote_of_traced(Real low, Real high, Real enters, Real chord, bool matter, vec3 n, Real reach, vec3 p, vec3 u, Real ahead) {
    SurfaceVote vote;
    vote.enters = enters > low && enters < high;
    vote.z = vote.enters ? enters - ahead : 0.0;
    vote.n = n;
    vote.chord = min(chord, SURFACE_CHORD);
    vote.weight = vote.enters || !matter ? vote_weight(p + vote.z * u, reach) : 0.0;
    return vote;
}

// The vote of such a splat beyond the matter that the ray entered at `enters` and stays in. If no surface is seen so far,
// faces let the ray pass wrongly.
SurfaceVote vote_of_deep(Real enters, vec3 n, Real ahead, bool seen) {
    SurfaceVote vote;
    vote.enters = true;
    vote.z = enters - ahead;
    vote.n = n;
    vote.chord = SURFACE_CHORD;
    vote.weight = seen ? 0.0 : SURFACE_SURE;
    return vote;
}

// What a surface shows where a splat votes that the ray enters it.
struct Shown {
    uint number;   // of the splat
    Real arrives;  // share of ambient light
    vec2 lights;   // shares of the two lights with shadows
};

// Votes about one surface on a ray.
struct SurfaceVotes {
    Real hits;    // weight of the votes that the ray enters
    Real misses;  // weight of those that it passes by
    Real way;     // of the hits, sum of weight * distance from the eye along the ray
    Real chord;   // likewise, of chords
    vec3 normal;  // likewise, of unit normals
    Real arrives; // likewise, of the share of ambient light that arrives
    vec2 lights;  // likewise, of the shares of the lights with shadows
    uint number;  // the splat with the largest weight of a hit
    Real largest;  // that weight
};

SurfaceVotes no_votes() {
    SurfaceVotes votes;
    votes.hits = 0.0;
    votes.misses = 0.0;
    votes.way = 0.0;
    votes.chord = 0.0;
    votes.normal = vec3(0.0);
    votes.arrives = 0.0;
    votes.lights = vec2(0.0);
    votes.number = 0u;
    votes.largest = 0.0;
    return votes;
}

const Real NO_SURFACE = 1e9;

// Where the ray enters the surface: mean distance of the hits; NO_SURFACE without any.
Real way_to(SurfaceVotes votes) { return votes.hits > 0.0 ? votes.way / votes.hits : NO_SURFACE; }

// Mean share of ambient light that arrives where the ray enters.
Real arrives_at(SurfaceVotes votes) { return votes.hits > 0.0 ? votes.arrives / votes.hits : 1.0; }

// Likewise of the lights with shadows.
vec2 lights_at(SurfaceVotes votes) {
    vec2 all = vec2(1.0);
    if (votes.hits > 0.0) all = votes.lights / votes.hits;
    return all;
}

// Largest distance of votes about the same surface; 0 where matter begins, since that is certain.
Real window_of(SurfaceVotes votes) { return votes.number >= BEGUN_MATTER ? Real(0.0) : SURFACE_WINDOW; }

// Mean length of the ray in the matter; it is 0 where it passes by.
Real mean_chord(SurfaceVotes votes) { return votes.hits > 0.0 ? votes.chord / (votes.hits + votes.misses) : 0.0; }

// Whether matter begins where the ray does, at `first`, and hides all behind: then no splat's vote counts. The mean of
// certain votes may be off by rounding.
bool begins_and_hides(SurfaceVotes front, Real first, Real solid) {
    return front.number >= BEGUN_MATTER && way_to(front) <= first + 1e-3 && mean_chord(front) >= solid;
}

bool wins(SurfaceVotes votes) { return votes.hits > votes.misses; }

// Whether a surface at most SURFACE_WINDOW behind `way` is seen so far.
bool is_seen_before(SurfaceVotes votes, Real way) { return wins(votes) && way_to(votes) < way + SURFACE_WINDOW; }

// The first two surfaces on a ray, in this order, and the latest votes against one.
struct SurfacePair {
    SurfaceVotes front;
    SurfaceVotes behind;
    Real passed;      // weight of those votes
    Real passed_way;  // their sum of weight * distance
};

SurfacePair no_surfaces() {
    SurfacePair pair;
    pair.front = no_votes();
    pair.behind = no_votes();
    pair.passed = 0.0;
    pair.passed_way = 0.0;
    return pair;
}

// A certain vote, before all others: matter that a ray does not enter through a surface begins there. n: unit.
void begin_matter(INOUT(SurfaceVotes) votes, Real way, Real chord, vec3 n, uint number) {
    votes.hits = SURFACE_CERTAIN;
    votes.way = SURFACE_CERTAIN * way;
    votes.chord = SURFACE_CERTAIN * min(chord, SURFACE_CHORD);
    votes.normal = SURFACE_CERTAIN * n;
    votes.arrives = SURFACE_CERTAIN;
    votes.lights = vec2(SURFACE_CERTAIN);
    votes.number = number;
    votes.largest = SURFACE_CERTAIN;
}

// How far a value that lies in a body's interval and changes by `slope` per voxel of a ray stays in it, about.
Real chord_in_body(Real value, Real slope, Real lower, Real upper) {
    Real room = slope < 0.0 ? value - lower : upper - value;
    return min(room / max(abs(slope), 1e-6), SURFACE_CHORD);
}

// Counts a vote at the distance `way` from the eye. Votes are about one surface if they lie within SURFACE_WINDOW of
// its hits' mean.
void count_vote(INOUT(SurfacePair) pair, SurfaceVote vote, Real way, Shown shown) {
    bool votes = vote.weight > 0.0 && way > 0.0;
    bool hit = votes && vote.enters;
    bool miss = votes && !vote.enters;
    Real front = way_to(pair.front);
    Real behind = way_to(pair.behind);
    Real window = window_of(pair.front);
    bool before = hit && way < front - window;
    bool between = hit && !before && way >= front + window && way < behind - window_of(pair.behind);
    // A surface in front of another moves that back.
    if (before) pair.behind = pair.front;
    if (before) pair.front = no_votes();
    if (between) pair.behind = no_votes();
    if (before) front = way;
    if (before) behind = way_to(pair.behind);
    if (between) behind = way;
    bool of_front = votes && abs(way - front) < window_of(pair.front);
    bool of_behind = votes && !of_front && abs(way - behind) < window_of(pair.behind);
    // A new surface takes over the votes against it that came before.
    Real passed = pair.passed > 0.0 ? pair.passed_way / pair.passed : -NO_SURFACE;
    bool near = abs(way - passed) < SURFACE_WINDOW;
    Real against = near ? pair.passed : 0.0;
    if (before) pair.front.misses = against;
    if (between) pair.behind.misses = against;
    Real w = vote.weight;
    if (miss) pair.passed = near ? pair.passed + w : w;
    if (miss) pair.passed_way = near ? pair.passed_way + w * way : w * way;
    SurfaceVotes to = pair.front;
    if (of_behind) to = pair.behind;
    to.misses += miss ? w : 0.0;
    Real weight = hit ? w : 0.0;
    to.hits += weight;
    to.way += weight * way;
    to.chord += weight * vote.chord;
    to.arrives += weight * shown.arrives;
    to.lights += weight * shown.lights;
    if (hit) to.normal += w / max(length(vote.n), 1e-12) * vote.n;
    if (weight > to.largest) to.number = shown.number;
    to.largest = max(to.largest, weight);
    if (of_front) pair.front = to;
    if (of_behind) pair.behind = to;
}

// The first surface is refused: the second takes its place.
void refuse_front(INOUT(SurfacePair) pair) {
    pair.front = pair.behind;
    pair.behind = no_votes();
}

// Counts the votes of splats up to the distance `way` from the eye as all votes about surfaces before it: refuses those
// that lost. Result: whether what the ray sees is known. `solid`: chord from which on nothing behind is seen.
bool is_decided(INOUT(SurfacePair) pair, Real way, Real solid) {
    bool front = way > way_to(pair.front) + SURFACE_WINDOW;
    if (front && !wins(pair.front)) refuse_front(pair);
    front = way > way_to(pair.front) + SURFACE_WINDOW && wins(pair.front);
    bool thin = front && mean_chord(pair.front) < solid;
    bool behind = way > way_to(pair.behind) + SURFACE_WINDOW;
    if (thin && behind && !wins(pair.behind)) pair.behind = no_votes();
    return front && (!thin || (behind && wins(pair.behind)));
}
#endif
