// Numbers that C++ and the shaders must agree on, each with its reason.
#ifndef EDGESPLAT_LIMITS_H
#define EDGESPLAT_LIMITS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT float KERNEL_RADIUS = 1.6f;  // R of kernel K7, voxels
EDGESPLAT_CONSTANT float EDGE_REACH = 3.0f;     // how far an edge is searched, voxels
EDGESPLAT_CONSTANT float GRADIENT_MIN = 1e-3f;  // value range per voxel; flatter data has no trustworthy direction
EDGESPLAT_CONSTANT float EDGE_DISTANCE_UNIT = 4.0f;  // D is stored as snorm16 of D / 4: steps of 1.2e-4 voxel
EDGESPLAT_CONSTANT float FACE_DISTANCE_UNIT = 4.0f;  // D2 as unorm10 of D2 / 4: steps of 4e-3 voxel
EDGESPLAT_CONSTANT uint FACE_NONE = 1023u;           // D2 code: no second edge in reach
// Faces (docs/method.md, passes 1 and 2).
EDGESPLAT_CONSTANT float SURFEL_REACH = 1.25f;  // voxels: how far from a voxel the point of the surface may be that it finds
EDGESPLAT_CONSTANT int SURFEL_STEPS = 12;       // of Newton's method
EDGESPLAT_CONSTANT float FACE_SEARCH = 3.0f;    // voxels: how far from a voxel the nearest of these may be
EDGESPLAT_CONSTANT float BORDER_BEHIND = 0.7f;  // voxels: by so much a surface may be further off than the volume's border
EDGESPLAT_CONSTANT float FIT_RADIUS = 1.5f;     // voxels around it from which a face is fitted
EDGESPLAT_CONSTANT float FIT_RIDGE = 1e-3f;     // voxels^2: weight of H = 0 against the scatter of what is fitted
EDGESPLAT_CONSTANT float FIT_WALL = 0.49f;      // a wall's two faces must leave less of the squared error than one quadric
EDGESPLAT_CONSTANT int WALL_STEPS = 4;          // along the normal the other face of a wall is looked for, voxels
EDGESPLAT_CONSTANT float WALL_TILTED = 0.6f;    // cosine of its two faces' normals at least
EDGESPLAT_CONSTANT float WALL_LEVEL = 0.99f;    // the same in a layer, whose faces are different ends of an interval
EDGESPLAT_CONSTANT float WALL_BENT = 0.5f;      // and thickness times the larger curvature, outwards, at most
EDGESPLAT_CONSTANT float TURN_FROM = 0.1f;      // voxels^2 of depth, from which on a quadric turns as the field does
EDGESPLAT_CONSTANT float STEEP_FROM = 0.2f;     // slope at a voxel over that on the way to its face, from which on its direction is believed
EDGESPLAT_CONSTANT float STEEP_OVER = 0.4f;     // and by how much more all of it
EDGESPLAT_CONSTANT float MADE_UP = 0.5f;        // voxels that the field's own quadric may be off beside matter, by its slope
EDGESPLAT_CONSTANT float CARRIES_NOTHING = -4.0f;  // D of a voxel beside matter whose face is out of its kernel's reach
EDGESPLAT_CONSTANT float BORDER_WEIGHT = 1.1501f;  // of an outermost voxel's kernel: what those beyond the border would have of matter
EDGESPLAT_CONSTANT float LIT_WITHIN = 0.6f;     // of a kernel's half chord: most of it lies between
EDGESPLAT_CONSTANT float LIT_FACES = 3.2f;      // voxels from a ray's point nearest to the voxel: faces of a layer further off do not light it
EDGESPLAT_CONSTANT float FIT_THINNEST = 0.2f;   // wall, voxels
EDGESPLAT_CONSTANT float FIT_OWN = 0.5f;  // the field's own quadric must leave less of the squared error than what is fitted
EDGESPLAT_CONSTANT float FIT_WELL = 0.1f;  // voxels^2, summed: what fits as well as this is kept
EDGESPLAT_CONSTANT float FIT_BADLY = 2.0f;  // the same: of what fits worse than this the better is taken
// Creases: planes fitted to surfels whose normals differ.
EDGESPLAT_CONSTANT float CREASE_RADIUS = 2.2f;  // voxels around the nearest surfel
EDGESPLAT_CONSTANT float CREASE_TURNED = 0.6f;  // cosine: normals of two planes are less alike
// Of two values alone the spline rounds what is sharp: planes are believed that leave nothing outside.
EDGESPLAT_CONSTANT float CREASE_ROUNDED = 0.75f;     // cosine there, of what is seen between two planes
EDGESPLAT_CONSTANT float CREASE_ROUNDED_LEFT = 0.02f;  // voxels^2, summed, that such planes leave at most
EDGESPLAT_CONSTANT float CREASE_SPREAD = 0.01f;  // voxels^2: what places are spread over less says little of their plane
EDGESPLAT_CONSTANT float CORNER_SQUARE = 0.98f;  // cosine: a third plane is kept where it is as square to both
EDGESPLAT_CONSTANT float CREASE_ALIKE = 0.93f;  // cosine: those of one plane's surfels are more alike
EDGESPLAT_CONSTANT float CREASE_BEHIND = 0.1f;  // voxels that one plane's surfels lie inside of another plane
EDGESPLAT_CONSTANT int CREASE_STEPS = 3;        // in which a plane's normal settles
EDGESPLAT_CONSTANT float CREASE_FROM = 1e-3f;   // voxels^2, summed: where a quadric leaves less none is looked for
EDGESPLAT_CONSTANT float CREASE_BLUNT = 0.25f;      // cosine: two planes whose normals are more alike may be a ridge
EDGESPLAT_CONSTANT float CREASE_BLUNT_LEFT = 0.2f;  // such ones must leave less of the squared error than a quadric
EDGESPLAT_CONSTANT float CREASE_REACH = 3.0f;   // planes further off cut no kernel
// Faces that rays find (5_trace_faces), where samples lie further than TRACE_FROM on the wrong side of the best quadric, voxels^2, summed.
EDGESPLAT_CONSTANT float TRACE_FROM = 0.01f;
EDGESPLAT_CONSTANT float TRACE_REACH = 1.9f;       // of their kernels, the narrow ones, voxels: a plane at most 1.7 away cuts none that reaches further
EDGESPLAT_CONSTANT float TRACE_STEP = 1.0f;       // voxels between samples of a ray
EDGESPLAT_CONSTANT int TRACE_ROOT_STEPS = 8;      // towards an end between two of them, at most: until one moves less than TRACE_NEAR
EDGESPLAT_CONSTANT float TRACE_NEAR = 1e-3f;      // voxels
EDGESPLAT_CONSTANT float TRACE_WHOLE = 2.0f;       // voxels to a face that cuts nothing: less than the narrow R and the depth
EDGESPLAT_CONSTANT float TRACE_DEEP = 2.5f;       // voxels within opaque matter that nothing is seen behind
EDGESPLAT_CONSTANT int FOOT_STEPS = 8;          // towards the foot point on a quadric
EDGESPLAT_CONSTANT float BENDING_UNIT = 8.0f;   // components of H are stored as 10 bits of sign(h) sqrt(|h| / 8), 1/voxel
EDGESPLAT_CONSTANT uint MAX_MATERIALS = 16u;         // 4 bits of the splat record
EDGESPLAT_CONSTANT uint MAX_CLIP_PLANES = 8u;        // of either kind
// A block's border holds all that its splats depend on. From a splat outwards, voxels: the points of the surface that its face is
// fitted to, the way to those and the gradient there, and a spline's coefficients as far as its ends are felt.
EDGESPLAT_CONSTANT int ESTIMATE_MARGIN = 7;
EDGESPLAT_CONSTANT int MAX_BURY_DISTANCE = 10;
EDGESPLAT_CONSTANT int BLOCK_BORDER = 24;
EDGESPLAT_CONSTANT int CHANGE_MARGIN = 11;  // as far from a sample that changes edges may be others
EDGESPLAT_CONSTANT uint BRICK = 8u;  // voxels along a side of a brick
EDGESPLAT_CONSTANT uint SPLAT_BATCH = 64u;  // splats of bricks in view that 3_select_footprints goes through at once
EDGESPLAT_CONSTANT uint SORT_BLOCKS = 512u;   // columns of the sort's histogram: serial inside, stable across
EDGESPLAT_CONSTANT uint QUADS_PER_INSTANCE = 64u;  // most even vertex cost on lavapipe in near and far views
EDGESPLAT_CONSTANT uint MARKED_AT_ONCE = 32u;  // entries that a word of marks is for; lists begin at multiples of it
EDGESPLAT_CONSTANT uint PREPARED_ENTRIES = 131072u;  // of a chunk that are prepared; 96 bytes each by default
EDGESPLAT_CONSTANT uint PREPARED_ROW = 4096u;  // texels of the image that holds them: lavapipe loads those fastest
EDGESPLAT_CONSTANT uint TILE = 16u;  // pixels along a side of a tile
// Of refined pixels (5_refine_pixels): every REFINE_STEP-th is drawn first, then those between which samples differ in the second
// order by more than REFINE_TOLERANCE, a step of a picture of 8 bits.
EDGESPLAT_CONSTANT uint REFINE_PIXELS = 33554432u;  // larger pictures may have no room for the lists
EDGESPLAT_CONSTANT uint MARK_PIXELS = 16777216u;   // of larger pictures the marks of each would take too much
EDGESPLAT_CONSTANT uint REFINE_STEP = 4u;
EDGESPLAT_CONSTANT float REFINE_TOLERANCE = 1.0f / 255.0f;
// Outlines (outline.glsl).
EDGESPLAT_CONSTANT uint NO_OUTLINE = 0xffffffffu;
EDGESPLAT_CONSTANT float OUTLINE_FAR2 = 16.0f;  // voxels^2: further from its voxel a face does not know where it turns away
EDGESPLAT_CONSTANT float OUTLINE_NEAR2 = 1.44f;  // voxels^2: further away there is too little of a kernel to show an edge
EDGESPLAT_CONSTANT float OUTLINE_TAU = 0.25f;  // a splat that shows less of a ray does not know that it is in matter
EDGESPLAT_CONSTANT float OUTLINE_OPEN = 0.5f;  // opacity of what is in front of an outline that counts
EDGESPLAT_CONSTANT uint SHEET_NONE = 0xffffffffu;  // sheet of a splat that is not drawn
EDGESPLAT_CONSTANT uint SHEET_BITS = 17u;  // of a sliced splat's first sheet; the bits above count the sheets after it

// Specialization constants: ids are the same in every shader, and ascend. C++ has their names from here, too.
#define EDGESPLAT_SPECIALIZATIONS(X) \
    X(SPEC_ESTIMATOR, 0u)     /* EdgeEstimator */ \
    X(SPEC_FOOTPRINTS, 1u)    /* FootprintMode */ \
    X(SPEC_WARP, 2u)          /* WarpFamily */ \
    X(SPEC_PAYLOAD, 3u)       /* Payload */ \
    X(SPEC_LIGHT, 4u)         /* number of lights */ \
    X(SPEC_AXIS, 5u)          /* 0 x, 1 y, 2 z */ \
    X(SPEC_EDGES, 6u)         /* 1: the edge field exists */ \
    X(SPEC_BURIED, 7u)        /* 1: the buried mask exists */ \
    X(SPEC_SLICED, 8u)        /* 1: kernels are cut at the sheets' planes */ \
    X(SPEC_NODES, 9u)         /* quadrature nodes of a piece of a footprint: 4, 6 or 10 */ \
    X(SPEC_GLOSS, 10u)        /* 1: some material has highlights */ \
    X(SPEC_LIT_EDGES, 11u)    /* 1: splats without an edge count as without normal */ \
    X(SPEC_FOG, 12u)          /* 1: fog */ \
    X(SPEC_SILHOUETTE, 13u)   /* 1: silhouettes */ \
    X(SPEC_TRANSFER, 14u)     /* 1: colour and extinction by a transfer function */ \
    X(SPEC_CLIP_KEEP, 15u)    /* number of planes that what is kept lies before */ \
    X(SPEC_CLIP_REMOVE, 16u)  /* number of planes that what is removed lies before */ \
    X(SPEC_ANTIALIAS, 17u)    /* 1: no footprint is narrower than a pixel */ \
    X(SPEC_RESPONSE, 18u)     /* 1: materials answer to light each in its own way */ \
    X(SPEC_OCCLUSION, 19u)    /* 1: ambient light is what reaches a splat */ \
    X(SPEC_SHADOWS, 20u)      /* number of lights with shadows */ \
    X(SPEC_GRADIENT, 21u)     /* 1: the background goes from one colour to another */ \
    X(SPEC_TILES, 22u)        /* 1: sheets are summed tile by tile, not in layers */ \
    X(SPEC_ROUNDS, 23u)       /* 1: a tile's list is drawn TILE_ROUND entries at a time */ \
    X(SPEC_COUNT, 24u)        /* 1: footprints are counted */ \
    X(SPEC_PREPARED, 25u)     /* 1: entries are prepared, 0: by whoever draws them */ \
    X(SPEC_REFINED, 26u)      /* 1: pixels are those of their tile's list */ \
    X(SPEC_GROUP, 27u)        /* invocations of a workgroup */ \
    X(SPEC_STEP, 28u)         /* pixels between those that are there already */ \
    X(SPEC_ISO_COUNT, 29u)    /* number of iso-values */ \
    X(SPEC_WIDE_MARKS, 30u)   /* 1: entries are marked for 4 x 2 pixels at once, 0: for each */ \
    X(SPEC_LIST_PARTS, 31u)   /* parts of 32 entries of a list that are marked at once */ \
    X(SPEC_CULLED, 32u)       /* 1: splats are those of batches, of bricks in view; 0: all of the list */ \
    X(SPEC_FACES, 33u)        /* 1: faces are found */ \
    X(SPEC_PIECES, 34u)       /* of a ray in a cut kernel that count: 2, or 1 where matter is opaque */ \
    X(SPEC_SKIP, 35u)         /* 1: transparent bricks are leapt over */ \
    X(SPEC_RAY_LIGHT, 36u)    /* 0 without light, else 1 + Light::Kind */ \
    X(SPEC_RAY_FILTER, 37u)   /* RaycastFilter */ \
    X(SPEC_CREASES, 38u)      /* 1: planes beside faces cut kernels, too */ \
    X(SPEC_OUTLINES, 39u)     /* 1: pixels that outlines pass show both sides */ \
    X(SPEC_TEXELS, 40u)       /* 1: buffers of texels are loaded as such, 0: through their addresses */ \
    X(SPEC_LOOPS, 41u)        /* 1: IF_ANY is a loop, 0: an if (drivers/if_any.glsl) */ \
    X(SPEC_TRACED, 42u)       /* 1: some splats' faces are found by rays */ \
    X(SPEC_NARROW, 43u)       /* 1: kernels are the narrow ones */
#define EDGESPLAT_SPECIALIZATION(name, id) EDGESPLAT_CONSTANT uint name = id;
EDGESPLAT_SPECIALIZATIONS(EDGESPLAT_SPECIALIZATION)
#undef EDGESPLAT_SPECIALIZATION

// EdgeEstimator
EDGESPLAT_CONSTANT uint TAYLOR = 1u;
EDGESPLAT_CONSTANT uint MARCH = 2u;
EDGESPLAT_CONSTANT uint CUBIC = 3u;

// FootprintMode
EDGESPLAT_CONSTANT uint ISOTROPIC = 0u;
EDGESPLAT_CONSTANT uint WARP2D = 1u;
EDGESPLAT_CONSTANT uint PROCEDURAL = 2u;
EDGESPLAT_CONSTANT uint TABLE = 3u;

// WarpFamily
EDGESPLAT_CONSTANT uint PAPER = 0u;  // kernels at edges are warped by the paper's curve
EDGESPLAT_CONSTANT uint FACE = 1u;   // or cut at faces

// Payload: the quantity that a frame carries in place of colour.
EDGESPLAT_CONSTANT uint PAYLOAD_COLOR = 0u;
EDGESPLAT_CONSTANT uint PAYLOAD_TAU = 1u;
EDGESPLAT_CONSTANT uint PAYLOAD_DEPTH_DISTANCE = 2u;
EDGESPLAT_CONSTANT uint PAYLOAD_NORMAL = 3u;

EDGESPLAT_SHARED_END
#endif
