// After shaders that declare SLICED: in which sheets a slot's splat lies, half open; none where it is not drawn.
uvec2 sheets_of_slot(uint slot) {
    uint sheet = UintsRef(params.frame.sheets).at[slot];
    if (sheet == SHEET_NONE) return uvec2(0u);
    uint first = SLICED == 1u ? sheet & ((1u << SHEET_BITS) - 1u) : sheet;
    return uvec2(first, first + 1u + (SLICED == 1u ? sheet >> SHEET_BITS : 0u));
}

uint slots_per_block() { return (params.frame.slot_count + SORT_BLOCKS - 1u) / SORT_BLOCKS; }
