// The `paper` warp: the curve of Huang, Crawfis, Stredney 1998 without its misprints (docs/paper.md), and a smooth
// variant.
//
// The paper warps the unit interval between the two voxels that enclose the edge: x in [0, 1] is sampled at map(x), the
// inverse of a monotone profile p. As p' vanishes at t1 and t2, map rises with infinite slope at m1 and m2. `Smooth`
// puts a monotone rational quadratic through the same knots instead. Both lose the partition of unity on edges that are
// not aligned with the grid. They serve for comparison; faces (face.h) are the default.
#pragma once

namespace edgesplat {

enum class PaperCurve { Cosine, Smooth };

/// Knots of p: p(t1) = m1, p(t2) = m2; 0 < t1 < t2 < 1 and t1/3 <= m1 < m2 <= (2 + t2)/3, or p is not monotone.
struct PaperProfile {
    double t1 = 0.2, t2 = 0.8, m1 = 0.45, m2 = 0.55;
    PaperCurve curve = PaperCurve::Cosine;
};

/// Throws std::invalid_argument naming the parameter, its value and its range if p would not be monotone.
void validate(const PaperProfile& profile);

/// p on [0, 1], its slope, and map = p^-1; the identity outside. map by bracketed Newton to 1e-14.
double paper_profile(double x, const PaperProfile& profile);
double paper_profile_slope(double x, const PaperProfile& profile);
double paper_map(double x, const PaperProfile& profile);

/// Shape of the profiles that place an edge anywhere: t1, t2 = 1/2 -+ inset, m1, m2 = D' -+ rise.
struct PaperShape {
    double inset = 0.3;  ///< (0, 0.5)
    double rise = 0.05;  ///< half width of the transition, voxels, (0, 0.5)
    PaperCurve curve = PaperCurve::Cosine;
};

/// A voxel's edge at D along n. Primary splats (D < 1) warp t in [0, 1], secondary ones (1 <= D < R) t in [1, 2]; these
/// are the paper's four cases, two on either side of the edge. D >= R means no edge.
struct PaperEdge {
    double distance = 0;  ///< D, voxels
    PaperShape shape;
};

/// Reach of a warped kernel of the default shape, voxels: sqrt(R^2 - w(t)^2 + t^2), at most 1.9074 over all edges.
inline constexpr double kPaperReach = 1.91;

/// First t of the warped unit interval: 0 or 1.
double paper_interval(const PaperEdge& edge);

/// The profile that puts the edge at D' = D - paper_interval: p(1/2) = D'. D' is clamped to where p stays monotone,
/// (t1/3 + rise) to (2 + t2)/3 - rise.
PaperProfile paper_profile_for(const PaperEdge& edge);

/// w(t): the coordinate along n at which t is sampled; t itself outside the interval and for D >= R.
double warped_coordinate(double t, const PaperEdge& edge);

}  // namespace edgesplat
