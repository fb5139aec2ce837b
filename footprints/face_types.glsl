// A face along a ray, and how it cuts a kernel: what face.glsl computes with. Written in the subset of GLSL that is C++:
// shaders include it in float, face.h in double. Lengths are voxels, index space, relative to the voxel's centre.
#ifndef EDGESPLAT_FACE_TYPES_GLSL
#define EDGESPLAT_FACE_TYPES_GLSL

// FaceCut::depth under faces of opaque matter where there is room. There the sum of kernels is large enough: .8 voxel
// behind a lattice plane at least .86, .98 in the mean. The depth is 0 in translucent matter: voxels beside it emit splats
// of it, too, so the sum is 1 up to the face. Faces further away than R + FACE_DEPTH cut nothing.
CONSTANT Real FACE_DEPTH = 0.8;
CONSTANT Real FACE_FARTHEST = 3.0;   // upper bound of every cut kernel's reach
CONSTANT Real FACE_NO_WALL = 1e8;    // a wall is thinner, and planes of creases are nearer
CONSTANT Real FACE_NOWHERE = 1e9;    // a position along a ray: beyond every kernel's reach
CONSTANT Real FACE_STRAIGHT = 1e-6;  // with less curvature phi counts as linear along a ray
CONSTANT Real BESIDE_OTHER = 0.8;    // a point deeper in a wall than this share of its thickness shows the other face

// c + z (b + z a).
struct Quadratic {
    Real c;
    Real b;
    Real a;
};

// Intersections of a ray with a quadric: low <= high.
struct FaceRoots {
    bool real;
    Real low;
    Real high;
};

// The values of a face along a ray x = p + z u; p is the ray's point nearest to the voxel's centre, u a unit vector.
struct FaceRay {
    Real rho2;         // |p|^2
    Quadratic phi;     // at x
    Quadratic slope2;  // |grad phi|^2
    Real across;       // p . grad phi at p
    Real turn;         // p . Hu
};

// How a face cuts a kernel, independent of the ray.
struct FaceCut {
    Real depth;      // smallest distance under the face at which it is sampled, >= 0
    Real thickness;  // of the wall, > 0; FACE_NO_WALL or more: no second face lies behind the first
    Real reach2;     // of the cut kernel from the voxel's centre, squared
    Real shift;      // along the normal to the centre of a sphere that contains the kernel
    Real radius;     // of that sphere
};

// Other planes that bound the matter, at a crease and at a corner, relative to a ray.
struct FaceCrease {
    Real p;         // n . p
    Real u;         // n . u
    Real distance;  // from the voxel's centre; larger than FACE_NO_WALL if there is no plane
    Real facing;    // cosine of its normal with the face's
    Real corner_p;  // likewise of a third plane
    Real corner_u;
    Real corner_distance;
};

// The tangent plane of a face at the point where a ray meets it, or where the ray is nearest to it within the kernel's
// reach. p = n.p, u = n.u, level: x is moved along n if n.x exceeds it.
struct FacePlane {
    Real p;
    Real u;
    Real level;
};

// A piece of the ray on the own side of a face. It begins where the ray enters the matter: through the face, or through
// a wall's other face. If the ray never enters, it begins at -FACE_NOWHERE.
struct FacePiece {
    Real low;
    Real high;
    FacePlane entry;
    FacePlane leave;
    FacePlane edge;  // of the crease
};

// The point where a ray enters or leaves a kernel's matter.
struct FaceEnd {
    Real z;
    Real side;  // -1: at the wall's other face, or beside it; else 1
    int plane;  // at the face (0), the crease's plane (1) or the corner's (2)
};

// The integral of a cut kernel along a ray, 1/voxel^2, with the points where the ray first enters its matter and last
// leaves it.
struct FaceFootprint {
    Real integral;
    FaceEnd entry;
    FaceEnd leave;
};

// Where a ray enters and leaves the half-spaces of the crease's planes, and through which plane.
struct CreaseEnds {
    Real low;
    Real high;
    int low_plane;
    int high_plane;
};

// Where a ray is on the own side of a face: one piece of it, or two.
struct FaceWay {
    Real half_chord;    // half the length of the ray within the cut kernel's reach; beyond it the kernel is 0
    bool there;
    bool both;          // the second piece counts, too
    bool goes_on;       // the ray leaves the matter in reach by the second piece
    Real low;           // ends of the first piece, between the faces
    Real high;
    bool from_behind;   // the ray enters the first piece through the wall's other face
    bool to_behind;
    Real second_low;
    Real second_high;
    bool second_from_behind;
    bool second_to_behind;
};
#endif
