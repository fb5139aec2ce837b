// Where along a ray the splats of a sheet begin. Include after shaders/splats/splat_projection.glsl.

// The splats of a sheet, and of all behind it, vote or contain matter from begin + sheet * step on.
struct SheetWays {
    float begin, step;
};

// `before`: how far splats reach in front of their sheets, voxels.
SheetWays sheet_ways(vec3 u, float before) {
    float along = 1.0 / dot(params.frame.view_z, u);
    float begin = params.frame.sheet_zero - dot(params.frame.view_z, params.frame.eye) - before * length(params.frame.view_z);
    return SheetWays(begin * along, params.frame.sheet_thickness * along);
}

// The way up to which the sheet, and those behind it, have nothing.
float way_before(SheetWays ways, uint sheet) { return ways.begin + float(sheet) * ways.step; }
