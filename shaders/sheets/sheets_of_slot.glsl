// The sheets of a slot's splat, half open; empty if it is not drawn. The including shader declares SLICED.
uvec2 sheets_of_slot(uint slot) {
    uint sheet = UintsRef(params.frame.sheets).at[slot];
    uint first = SLICED == 1u ? sheet & ((1u << SHEET_BITS) - 1u) : sheet;
    uint end = first + 1u + (SLICED == 1u ? sheet >> SHEET_BITS : 0u);
    return sheet == SHEET_NONE ? uvec2(0u) : uvec2(first, end);
}

uint slots_per_block() { return (params.frame.slot_count + SORT_BLOCKS - 1u) / SORT_BLOCKS; }

// The slots of a block, half open.
uvec2 slots_of_block(uint block) {
    return min(uvec2(block, block + 1u) * slots_per_block(), uvec2(params.frame.slot_count));
}
