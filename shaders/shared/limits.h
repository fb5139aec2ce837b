// Constants that C++ and the shaders share, each with its reason.
#ifndef EDGESPLAT_LIMITS_H
#define EDGESPLAT_LIMITS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT float KERNEL_RADIUS = 1.6f;  // R of kernel K7, voxels
EDGESPLAT_CONSTANT float EDGE_REACH = 3.0f;     // search radius for an edge, voxels
EDGESPLAT_CONSTANT float GRADIENT_MIN = 1e-3f;  // value range per voxel; the gradient of flatter data has no reliable direction
EDGESPLAT_CONSTANT float EDGE_DISTANCE_UNIT = 4.0f;  // D is stored as snorm16 of D / 4: steps of 1.2e-4 voxel
EDGESPLAT_CONSTANT float FACE_DISTANCE_UNIT = 4.0f;  // D2 is stored as unorm10 of D2 / 4: steps of 4e-3 voxel
EDGESPLAT_CONSTANT uint FACE_NONE = 1023u;           // D2 code: no second edge in reach
// Faces (docs/method.md, passes 1 and 2).
EDGESPLAT_CONSTANT float SURFEL_REACH = 1.25f;  // voxels: upper bound of the distance from a voxel to its surfel
EDGESPLAT_CONSTANT int SURFEL_STEPS = 12;       // steps of Newton's method
EDGESPLAT_CONSTANT float FACE_SEARCH = 3.0f;    // voxels: upper bound of the distance from a voxel to the nearest surfel
EDGESPLAT_CONSTANT float BORDER_BEHIND = 0.7f;  // voxels: in that search, other surfels count as this much nearer than the volume's border
EDGESPLAT_CONSTANT float FIT_RADIUS = 1.5f;     // voxels around the nearest surfel in which a face is fitted
EDGESPLAT_CONSTANT float FIT_RIDGE = 1e-3f;     // voxels^2: regularization of H towards 0, added to the scatter of the points
EDGESPLAT_CONSTANT float FIT_WALL = 0.49f;      // upper bound of a wall's squared error, relative to that of one quadric
EDGESPLAT_CONSTANT int WALL_STEPS = 4;          // voxels along the normal in which the other face of a wall is searched
EDGESPLAT_CONSTANT float WALL_TILTED = 0.6f;    // lower bound of |cosine| between the normals of a wall's two faces
EDGESPLAT_CONSTANT float WALL_LEVEL = 0.99f;    // the same in a layer, whose faces are different ends of an interval
EDGESPLAT_CONSTANT float WALL_BENT = 0.5f;      // upper bound of a wall's thickness * larger curvature, outwards
EDGESPLAT_CONSTANT float TURN_FROM = 0.1f;      // voxels^2: in the turn -g D / (D^2 + TURN_FROM) of a quadric; deeper than that it turns like the field
EDGESPLAT_CONSTANT float STEEP_FROM = 0.2f;     // slope at a voxel / mean slope on the way to its face: below this its direction is ignored
EDGESPLAT_CONSTANT float STEEP_OVER = 0.4f;     // over this further range the weight of the direction grows to 1
EDGESPLAT_CONSTANT float MADE_UP = 0.5f;        // voxels: upper bound of the error of the field's own quadric beside matter, |f - J| / slope
EDGESPLAT_CONSTANT float CARRIES_NOTHING = -4.0f;  // sentinel for D: a voxel beside matter with its face out of reach; this splat is not drawn
EDGESPLAT_CONSTANT float BORDER_WEIGHT = 1.1501f;  // weight of an outermost voxel's kernel: replaces the missing voxels beyond the border
EDGESPLAT_CONSTANT float LIT_WITHIN = 0.6f;     // of a kernel's half chord: most of the kernel lies within
EDGESPLAT_CONSTANT float SHADOW_LIFT = 1.5f;    // voxels from a surface to where rays to a light begin
EDGESPLAT_CONSTANT float SHADOW_STEP = 0.5f;    // voxels between samples of such a ray
EDGESPLAT_CONSTANT float LIT_FACES = 3.2f;      // voxels from the ray's point nearest to the voxel: faces of a layer further away do not light it
EDGESPLAT_CONSTANT float FIT_THINNEST = 0.2f;   // voxels: lower bound of a wall's thickness
EDGESPLAT_CONSTANT float FIT_OWN = 0.5f;  // upper bound of the squared error of the field's own quadric, relative to that of the fitted one
EDGESPLAT_CONSTANT float FIT_WELL = 0.1f;  // voxels^2, summed: a fit with a smaller error is kept
EDGESPLAT_CONSTANT float FIT_BADLY = 2.0f;  // voxels^2, summed: if the fit's error is larger, the better of both quadrics is used
// Creases: planes fitted to surfels whose normals differ.
EDGESPLAT_CONSTANT float CREASE_RADIUS = 2.2f;  // voxels around the nearest surfel
EDGESPLAT_CONSTANT float CREASE_TURNED = 0.6f;  // cosine: upper bound between the normals of two planes
// If the samples around have only two values, the spline rounds sharp edges. Planes are then accepted if little lies
// outside them.
EDGESPLAT_CONSTANT float CREASE_ROUNDED = 0.75f;     // cosine in that case: surfels between this and CREASE_ALIKE lie on the rounding between two planes
EDGESPLAT_CONSTANT float CREASE_ROUNDED_LEFT = 0.02f;  // voxels^2, summed: upper bound of the error of such planes
EDGESPLAT_CONSTANT float CREASE_SPREAD = 0.01f;  // voxels^2: added to the covariance of points, since less scatter says little about their plane
EDGESPLAT_CONSTANT float CORNER_SQUARE = 0.98f;  // cosine: lower bound between a corner's third normal and the cross product of the other two
EDGESPLAT_CONSTANT float CREASE_ALIKE = 0.93f;  // cosine: lower bound between the normals of one plane's surfels
EDGESPLAT_CONSTANT float CREASE_BEHIND = 0.1f;  // voxels: lower bound of the depth of one plane's surfels behind another plane
EDGESPLAT_CONSTANT int CREASE_STEPS = 3;        // iterations of a plane's normal
EDGESPLAT_CONSTANT float CREASE_BLUNT = 0.25f;      // cosine: two planes with more similar normals may be a ridge
EDGESPLAT_CONSTANT float CREASE_BLUNT_LEFT = 0.2f;  // upper bound of the squared error of such planes, relative to that of the quadric
EDGESPLAT_CONSTANT float CREASE_REACH = 3.0f;   // voxels: planes further away cut no kernel
// Faces that rays find (5_trace_faces): if the samples on the wrong side of the best quadric have a larger sum of
// squared distances, voxels^2.
EDGESPLAT_CONSTANT float TRACE_STEP = 1.0f;       // voxels between samples of a ray
EDGESPLAT_CONSTANT int TRACE_ROOT_STEPS = 8;      // upper bound of steps towards an end between two samples; stops once a step is below TRACE_NEAR
// Surface splats: opaque matter drawn where rays enter it (engine/geometry). Lengths are voxels.
EDGESPLAT_CONSTANT float SURFACE_REACH = 1.3f;   // from a splat's foot point: its vote weighs nothing further away
EDGESPLAT_CONSTANT float LABEL_VIEW = 3.0f;      // from a place on a surface: labels of voxels further away do not decide which one is seen
EDGESPLAT_CONSTANT float SURFACE_SHEET = 0.4f;   // least error of a face in a sheet one voxel thick, whose other side has none
EDGESPLAT_CONSTANT float SURFACE_LOST = 0.5f;    // error of a face from which on it says nothing about where the surface is
EDGESPLAT_CONSTANT float SURFACE_AROUND = 2.0f;  // reach of such a splat: matter between samples extends further from a voxel of it
EDGESPLAT_CONSTANT float SURFACE_WINDOW = 0.8f;  // votes along a ray that are this near to each other are about one surface
EDGESPLAT_CONSTANT float SURFACE_FIT = 2.5f;     // radius around the nearest surfel in which the face is fitted
EDGESPLAT_CONSTANT float SURFACE_RING = 1.04f;   // from the foot point to the points around it where the face is compared with the field
EDGESPLAT_CONSTANT float SURFACE_ERROR = 0.02f;  // upper bound of a kept face's distance from the field's surface there, without noise
EDGESPLAT_CONSTANT float SURFACE_SMOOTH = 0.57f;  // slope over rise of an edge with a blur of .7 voxel; the spline ripples along steeper ones
EDGESPLAT_CONSTANT float SURFACE_RIPPLE = 0.45f;  // voxels: what the distance may be more there, times the square of the difference
EDGESPLAT_CONSTANT float SURFACE_TURN = 0.3f;    // radians: the same between their normals
EDGESPLAT_CONSTANT float SURFACE_NOISE = 4.0f;   // standard deviations of noise that both bounds also allow
EDGESPLAT_CONSTANT float SURFACE_CREASE = 1.2f;  // from a voxel to the foot points of the planes of a crease that it votes for
EDGESPLAT_CONSTANT float SURFACE_SHOWS = 0.1f;    // pixels: a smaller error of a face does not show
EDGESPLAT_CONSTANT float SURFACE_DEEP = 1.0f;    // a ray that is this deep in matter is not traced further
EDGESPLAT_CONSTANT float SURFACE_SURE = 10.0f;   // weight of the vote that a ray entered matter that deep
EDGESPLAT_CONSTANT float SURFACE_NEAR = 0.01f;   // last step towards a traced surface
EDGESPLAT_CONSTANT float SURFACE_CHORD = 2.0f;    // a ray in matter for longer is as good as one that stays there
EDGESPLAT_CONSTANT float SURFACE_DOUBT = 2.0f;    // between eight samples, the field may leave their range by this many times the range
EDGESPLAT_CONSTANT int SURFACE_PROBES = 8;       // along that length, where matter begins at a plane and may be thin
EDGESPLAT_CONSTANT float SURFACE_PROBE = 0.25f;   // between them
EDGESPLAT_CONSTANT float SURFACE_SOLID = 5.0f;    // optical depth behind which nothing is seen
EDGESPLAT_CONSTANT uint LABELS_OF_MASK = 1u;     // the labels' mask is drawn
EDGESPLAT_CONSTANT uint LABELS_OF_SCAN = 2u;     // a scan is drawn; beside a label, its voxels have that
EDGESPLAT_CONSTANT float SURFACE_CERTAIN = 1e3f;  // weight of matter that begins at the volume's border or at a clip plane
EDGESPLAT_CONSTANT uint NUMBERED_SPLATS = 0xfffffffu;  // numbers of surface splats in votes lie below this minus MAX_MATERIALS
EDGESPLAT_CONSTANT uint BEGUN_MATTER = 0xfffffff0u;  // plus a material: stands for a splat's number where matter begins so
EDGESPLAT_CONSTANT uint VOTE_TEXELS = 6u;       // of a pixel: both surfaces' votes, ten numbers each, and those against
EDGESPLAT_CONSTANT float SURFACE_STEP = 2.0f;  // voxels: where surfaces of two volumes join, they lie no farther apart
EDGESPLAT_CONSTANT float RIM_WIDTH = 0.05f;    // voxels from a side of a rim within which a ray begins there
EDGESPLAT_CONSTANT float SURFACE_EARLY = 1.0f;   // a face that a ray enters at most this far before a border or plane, within SURFACE_SIDE of it, is seen there
EDGESPLAT_CONSTANT float SURFACE_SIDE = 0.1f;    // the same of samples on a kept face's wrong side, without noise
EDGESPLAT_CONSTANT int FOOT_STEPS = 8;          // steps towards the foot point on a quadric
EDGESPLAT_CONSTANT float BENDING_UNIT = 8.0f;   // components of H, 1/voxel, are stored as 10 bits of sign(h) sqrt(|h| / 8)
EDGESPLAT_CONSTANT uint MAX_MATERIALS = 16u;         // 4 bits of the splat record
EDGESPLAT_CONSTANT uint MAX_CLIP_PLANES = 8u;        // of each kind
// The border of a block contains everything that its splats depend on. From a splat outwards, voxels: the surfels that
// its face is fitted to, the way to those and the gradient there, and the reach of the spline's ends.
EDGESPLAT_CONSTANT int ESTIMATE_MARGIN = 7;
EDGESPLAT_CONSTANT int MAX_BURY_DISTANCE = 10;
EDGESPLAT_CONSTANT int BLOCK_BORDER = 24;
EDGESPLAT_CONSTANT int CHANGE_MARGIN = 11;  // voxels around a changed sample in which edges may change
EDGESPLAT_CONSTANT uint BRICK = 8u;  // voxels along each side of a brick
EDGESPLAT_CONSTANT uint BRICK_ENDS = 1u << 31;  // in a list of bricks: matter may end in the brick
EDGESPLAT_CONSTANT uint SPLAT_BATCH = 64u;  // splats of visible bricks that 3_select_footprints processes together
EDGESPLAT_CONSTANT uint MAX_TOGETHER = 8u;  // volumes whose kernels are drawn as one list
EDGESPLAT_CONSTANT uint SORT_BLOCKS = 512u;   // columns of the sort histogram: serial inside, stable across
EDGESPLAT_CONSTANT uint QUADS_PER_INSTANCE = 64u;  // gives the most even vertex cost on lavapipe in near and far views
EDGESPLAT_CONSTANT uint MARKED_AT_ONCE = 32u;  // entries per word of marks; lists begin at multiples of it
EDGESPLAT_CONSTANT uint PREPARED_ENTRIES = 131072u;  // upper bound of prepared entries per chunk; 128 bytes each, 144 with creases
EDGESPLAT_CONSTANT uint PREPARED_ROW = 4096u;  // texels per row of their image: lavapipe loads rows of this size fastest
EDGESPLAT_CONSTANT uint TILE = 16u;  // pixels along each side of a tile
// Refined pixels (5_refine_pixels): every REFINE_STEP-th is drawn first, then those around which the second differences
// of samples exceed REFINE_TOLERANCE, one step of an 8-bit picture.
EDGESPLAT_CONSTANT uint REFINE_PIXELS = 33554432u;  // larger pictures may have no room for the lists
EDGESPLAT_CONSTANT uint MARK_PIXELS = 16777216u;   // in larger pictures, marks for every single pixel would take too much memory
EDGESPLAT_CONSTANT uint REFINE_STEP = 4u;
EDGESPLAT_CONSTANT float REFINE_TOLERANCE = 1.0f / 255.0f;
EDGESPLAT_CONSTANT float REFINE_WAY = 0.25f;  // voxels: the same for second differences of where surfaces end the rays
// Outlines (outline.glsl).
EDGESPLAT_CONSTANT uint NO_OUTLINE = 0xffffffffu;
EDGESPLAT_CONSTANT float OUTLINE_FAR2 = 16.0f;  // voxels^2 from the splat's voxel: further away, the face does not predict its outline
EDGESPLAT_CONSTANT float OUTLINE_NEAR2 = 1.44f;  // voxels^2: outside of the matter and further away, the kernel is too faint to show an edge
EDGESPLAT_CONSTANT float OUTLINE_TAU = 0.25f;  // a fainter splat does not prove that the ray is in its matter
EDGESPLAT_CONSTANT float OUTLINE_OPEN = 0.5f;  // outlines behind more opacity than this are ignored
EDGESPLAT_CONSTANT uint SHEET_NONE = 0xffffffffu;  // sheet of a splat that is not drawn
EDGESPLAT_CONSTANT uint SHEET_BITS = 17u;  // bits of a sliced splat's first sheet; the bits above count the sheets after it

// Specialization constants: the ids are the same in every shader, in ascending order. C++ gets their names from this
// list, too.
#define EDGESPLAT_SPECIALIZATIONS(X) \
    X(SPEC_ESTIMATOR, 0u)     /* EdgeEstimator */ \
    X(SPEC_FOOTPRINTS, 1u)    /* FootprintMode */ \
    X(SPEC_WARP, 2u)          /* WarpFamily */ \
    X(SPEC_PAYLOAD, 3u)       /* Payload */ \
    X(SPEC_LIGHT, 4u)         /* number of lights */ \
    X(SPEC_AXIS, 5u)          /* 0 x, 1 y, 2 z */ \
    X(SPEC_EDGES, 6u)         /* 1: the edge field exists */ \
    X(SPEC_BURIED, 7u)        /* 1: the buried mask exists */ \
    X(SPEC_SLICED, 8u)        /* 1: the sheets' planes cut kernels */ \
    X(SPEC_NODES, 9u)         /* quadrature nodes per piece of a footprint: 4, 6 or 10 */ \
    X(SPEC_GLOSS, 10u)        /* 1: some material has highlights */ \
    X(SPEC_LIT_EDGES, 11u)    /* 1: splats without an edge are lit as if without a normal */ \
    X(SPEC_FOG, 12u)          /* 1: fog */ \
    X(SPEC_SILHOUETTE, 13u)   /* 1: silhouettes */ \
    X(SPEC_TRANSFER, 14u)     /* 1: colour and extinction by a transfer function */ \
    X(SPEC_CLIP_KEEP, 15u)    /* number of planes that bound the kept region */ \
    X(SPEC_CLIP_REMOVE, 16u)  /* number of planes that bound the removed region */ \
    X(SPEC_ANTIALIAS, 17u)    /* 1: no footprint is narrower than a pixel */ \
    X(SPEC_RESPONSE, 18u)     /* 1: materials have their own light responses */ \
    X(SPEC_OCCLUSION, 19u)    /* 1: ambient light is occluded */ \
    X(SPEC_SHADOWS, 20u)      /* number of lights with shadows */ \
    X(SPEC_GRADIENT, 21u)     /* 1: the background is a gradient of two colours */ \
    X(SPEC_TILES, 22u)        /* 1: sheets are summed tile by tile, not in layers */ \
    X(SPEC_ROUNDS, 23u)       /* 1: a tile's list is drawn TILE_ROUND entries at a time */ \
    X(SPEC_COUNT, 24u)        /* 1: footprints are counted */ \
    X(SPEC_PREPARED, 25u)     /* 1: entries are prepared, 0: the drawing pass prepares them itself */ \
    X(SPEC_REFINED, 26u)      /* 1: only the pixels in their tile's list are drawn */ \
    X(SPEC_GROUP, 27u)        /* invocations per workgroup */ \
    X(SPEC_STEP, 28u)         /* distance of the pixels that are already drawn, pixels */ \
    X(SPEC_ISO_COUNT, 29u)    /* number of iso-values */ \
    X(SPEC_WIDE_MARKS, 30u)   /* 1: entries are marked for 4 x 2 pixels at once, 0: for each */ \
    X(SPEC_LIST_PARTS, 31u)   /* parts of 32 list entries that are marked together */ \
    X(SPEC_CULLED, 32u)       /* 1: only splats of batches, from bricks in view; 0: the whole list */ \
    X(SPEC_FACES, 33u)        /* 1: faces are fitted */ \
    X(SPEC_PIECES, 34u)       /* pieces of a ray in a cut kernel that count: 2, or 1 if all matter is opaque */ \
    X(SPEC_SKIP, 35u)         /* 1: transparent bricks are skipped */ \
    X(SPEC_RAY_LIGHT, 36u)    /* 0 without light, else 1 + Light::Kind */ \
    X(SPEC_RAY_FILTER, 37u)   /* RaycastFilter */ \
    X(SPEC_CREASES, 38u)      /* 1: planes of creases also cut kernels */ \
    X(SPEC_OUTLINES, 39u)     /* 1: pixels at outlines blend both sides */ \
    X(SPEC_TEXELS, 40u)       /* 1: buffers are loaded as texels, 0: through their addresses */ \
    X(SPEC_LOOPS, 41u)        /* 1: IF_ANY is a loop, 0: an `if` (drivers/if_any.glsl) */ \
    X(SPEC_TRACED, 42u)       /* 1: rays find some splats' faces */ \
    X(SPEC_NARROW, 43u)       /* 1: narrow kernels */ \
    X(SPEC_NO_DATA, 44u)      /* 1: rays meet samples without data where matter would be drawn */ \
    X(SPEC_LABELS, 45u)       /* every label has its own colour: LABELS_OF_MASK or LABELS_OF_SCAN; 0: none have */ \
    X(SPEC_SURFACES, 46u)     /* 1: splats are surface splats */ \
    X(SPEC_TWO_VALUES, 47u)   /* 1: the samples have only two values */ \
    X(SPEC_MIXED, 48u)        /* 1: surface splats draw opaque matter, kernels translucent matter in front of it */ \
    X(SPEC_BESIDE, 49u)       /* 1: the matter that attenuates light is that of another volume than the splats' */ \
    X(SPEC_TOGETHER, 50u)     /* 1: kernels of several volumes are drawn as one list */ \
    X(SPEC_RIM, 51u)          /* 1: along a rim, kernels of one volume give way to those of another */ \
    X(SPEC_INNER, 52u)        /* 1: surfaces of one volume continue those of another */
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
EDGESPLAT_CONSTANT uint PAPER = 0u;  // the paper's curve warps kernels at edges
EDGESPLAT_CONSTANT uint FACE = 1u;   // faces cut kernels

// Payload: the quantity that a frame accumulates instead of colour.
EDGESPLAT_CONSTANT uint PAYLOAD_COLOR = 0u;
EDGESPLAT_CONSTANT uint PAYLOAD_TAU = 1u;
EDGESPLAT_CONSTANT uint PAYLOAD_DEPTH_DISTANCE = 2u;
EDGESPLAT_CONSTANT uint PAYLOAD_NORMAL = 3u;

EDGESPLAT_SHARED_END
#endif
