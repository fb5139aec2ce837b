// Footprints of plain and warped kernels: the float32 mirror of footprints/ (same names, same equations).
//
// Include after shared/footprint_params.h. Declares no bindings: the table comes in as a sampler, the rest as FootprintParams.
// A ray is (rho2, pn, un): p its point nearest to the voxel centre relative to it, u its unit direction, n the unit edge normal,
// all in index space; rho2 = dot(p, p), pn = dot(p, n), un = dot(u, n). D, D2: distances to the edge along n and to a wall's
// second face along -n, voxels. Results are integrals of K per unit length of the ray in voxels.
//
//   footprint_isotropic(rho2)                               any splat without an edge
//   footprint_warp2d(rho2, pn, un, D, params)               --footprints warp2d
//   footprint_table_nearest(table, rho2, pn, un, D, params) --footprints table
//   footprint_table_lerp(table, rho2, pn, un, D, params)    --footprints table-lerp
//   footprint_procedural(rho2, pn, un, D, D2, params)       --footprints procedural, and walls in the table modes
//   footprint_paper_warp2d(rho2, pn, un, D, params)         --warp paper, warp2d
//   footprint_paper_procedural(rho2, pn, un, D, params)     --warp paper, every other mode
