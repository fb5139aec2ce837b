// Up to where along a ray the sheets of surface splats have voted. Include after shaders/splats/splat_projection.glsl.

// How far along a ray splats vote about: the ways to the sheets' first votes are begin + sheet * step.
struct SheetWays {
    float begin, step;
};

SheetWays sheet_ways(vec3 u) {
    float along = 1.0 / dot(params.frame.view_z, u);
    float begin = params.frame.sheet_zero - dot(params.frame.view_z, params.frame.eye) - votes_before() * length(params.frame.view_z);
    return SheetWays(begin * along, params.frame.sheet_thickness * along);
}

// The way up to which no splat of the sheet, or of one behind it, votes.
float way_before(SheetWays ways, uint sheet) { return ways.begin + float(sheet) * ways.step; }
