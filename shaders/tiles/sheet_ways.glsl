// Where along a ray the splats of a sheet begin. Include after shaders/splats/splat_projection.glsl.

// The splats of a sheet, and of all behind it, vote or contain matter from begin + sheet * step on.
struct SheetWays {
    float begin, step;
};

// `before`: how far splats reach in front of their sheets, voxels of the first volume.
SheetWays sheet_ways(vec3 u, float before) {
    float along = 1.0 / dot(params.of_volume.view_z, u);
    float begin = params.of_volume.sheet_zero - dot(params.of_volume.view_z, params.of_volume.eye) - before * length(params.of_volume.view_z);
    return SheetWays(begin * along, params.frame.sheet_thickness * along);
}

// The way up to which the sheet, and those behind it, have nothing.
float way_before(SheetWays ways, uint sheet) { return ways.begin + float(sheet) * ways.step; }

// How far kernels reach in front of their sheets, voxels of the first volume.
float kernels_before() {
    float before = params.of_volume.support;
    for (uint k = 1u; k < MAX_TOGETHER && TOGETHER == 1u; ++k) {
        float mm = params.volumes[k].support * length(params.volumes[k].view_z);
        before = k < params.frame.volume_count ? max(before, mm / length(params.of_volume.view_z)) : before;
    }
    return before;
}
