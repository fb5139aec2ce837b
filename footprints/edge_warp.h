// The `edge` warp: space is stretched along the edge normal within a band of half width a around the edge (design (6),
// (7)).
//
// One coordinate matters: t = n . (x - x_i), measured from the voxel along its edge normal, in voxels. The edge is the
// plane t = D. A wall has a second face at t = -D2. Where neighbouring voxels agree on the edge they share one warp of
// space, and their kernels still sum to one whatever the edge's orientation.
#pragma once

#include <limits>
#include <vector>

namespace edgesplat {

/// How far the warp reaches and how steep it is.
struct EdgeBand {
    double half_width = 1.6;  ///< a, voxels, (0, 3]
    double strength = 16;     ///< k, slope at the edge, [1, 64]; 1 is no warp
    bool operator==(const EdgeBand&) const = default;
};

/// The edge (or the two faces of a wall) that a voxel's kernel is warped around.
struct Edge {
    double distance = 0;  ///< D, voxels along n; may be negative
    EdgeBand band;        ///< of both faces; see wall_edge()
    double second_distance =
        std::numeric_limits<double>::infinity();  ///< D2, voxels along -n; infinite: no second face
    /// The edge is a sphere of this curvature, 1/voxel, positive where its centre lies on the side of -n; 0: a plane.
    /// |curvature| * half_width < 1, so that the band does not reach the centre. Walls are plane.
    double curvature = 0;
};

/// M(s) of design (7): where a point at signed distance s from the edge is sampled. Odd, C1, strictly increasing, slope
/// k at 0 and 1 at +-a, identity from +-a on.
double edge_warp(double s, const EdgeBand& band);
double edge_warp_slope(double s, const EdgeBand& band);
/// The inverse of M in closed form: of the same kind, with slope 1/k.
double edge_warp_inverse(double w, const EdgeBand& band);
double edge_warp_inverse_slope(double w, const EdgeBand& band);

/// The edge of a voxel between faces at D and D2 by the rule of docs/method.md "Walls": the bands share the wall's
/// thickness, and the strength fades to 1 where the wall is one voxel thick or less. D2 >= R + a is one face.
Edge wall_edge(double distance, double second_distance, const EdgeBand& band);

/// w(t) = t plus the displacements of both faces (their bands are disjoint): the normal coordinate of W(x).
double warped_coordinate(double t, const Edge& edge);
/// |W(x) - x_i|^2 of a point with r2 = |x - x_i|^2 and t as above, whatever the edge's shape. On a curved edge space is
/// stretched along the radius, by the distance to the sphere: neighbours that know the same sphere share one warp.
double warped_distance2(double r2, double t, const Edge& edge);

/// The t with warped_coordinate(t) = w.
double unwarped_coordinate(double w, const Edge& edge);

/// A sphere that holds every point where the warped kernel is not zero.
struct Support {
    double shift = 0;               ///< the smallest such sphere's centre: x_i + shift n, voxels
    double radius = 0;              ///< its radius, voxels
    double radius_about_voxel = 0;  ///< radius of the smallest one centred at x_i
};

/// The true support of a warped kernel. It is larger than R near an edge: M moves points away from the edge, so a
/// kernel whose ball nears the edge is sampled from further off, up to R + max(|s| - |M^-1(s)|).
Support warped_support(const Edge& edge);

/// `entries` >= 2 supports of single faces, at D equally spaced over [-(R + a), R + a].
std::vector<Support> warped_support_table(const EdgeBand& band, int entries);

/// Spheres that hold the support of every single face with |D| in the cell i/cells ... (i+1)/cells of R + a, i < cells:
/// entry min(int(|D| / (R + a) * cells), cells - 1) serves D, with sign(D) * shift. No interpolation, so nothing is cut
/// off.
std::vector<Support> covering_supports(const EdgeBand& band, int cells);

/// An ellipsoid of revolution about n that holds a support: its centre is x_i + shift n. Voxels.
struct Spheroid {
    double shift = 0;
    double along = 0;   ///< half-axis along n
    double across = 0;  ///< half-axis across n
};

/// One for every cell of |D| as above. Nearer than the spheres, for the support near an edge is a disc that thins out
/// on either side.
std::vector<Spheroid> covering_spheroids(const EdgeBand& band, int cells);

/// Spheres as above for edges of any curvature: spheres around the voxel (shift 0) of radius R + the farthest that W
/// moves a point of the kernel's ball.
std::vector<Support> covering_supports_of_curved(const EdgeBand& band, int cells);

/// The largest radius_about_voxel over every D, walls included: a bound that needs no look-up.
double largest_support_radius(const EdgeBand& band);

}  // namespace edgesplat
