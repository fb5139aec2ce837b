// The sheet of an entry of `order`: the last sheet that begins at or before it.
uint sheet_of_entry(uint entry) {
    UintsRef starts = UintsRef(params.frame.sheet_starts);
    uint sheet = 0u;
    for (uint step = 1u << 16; step > 0u; step >>= 1)
        sheet += sheet + step < params.frame.sheet_count && starts.at[min(sheet + step, params.frame.sheet_count)] <= entry ? step : 0u;
    return sheet;
}
