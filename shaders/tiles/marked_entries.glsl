// The entries of a list that are marked for a pixel, four words at a time. Include after shaders/tiles/tile_marks.glsl
// and the declaration of load_mark().

// Marks of 4 * MARKED_AT_ONCE entries of a list from `base` on; marks beyond its `length` are 0.
uvec4 marks_from(int marks_at, uint base, uint length) {
    uvec4 words;
    for (uint i = 0u; i < 4u; ++i) {
        uint begin = base + i * MARKED_AT_ONCE, left = length - min(begin, length);
        words[i] = load_mark(marks_at + int(begin / MARKED_AT_ONCE * CELLS));
        words[i] = left == 0u ? 0u : words[i] & ~(left < MARKED_AT_ONCE ? ~0u << left : 0u);
    }
    return words;
}

bool has_marks(uvec4 words) { return (words.x | words.y | words.z | words.w) != 0u; }

// Removes the first mark. Result: its entry, counted from `base`.
uint take_mark(inout uvec4 words) {
    bvec3 done = equal(words.xyz, uvec3(0u));
    uint first = !done.x ? 0u : !done.y ? 1u : !done.z ? 2u : 3u;
    uint bits = !done.x ? words.x : !done.y ? words.y : !done.z ? words.z : words.w;
    uint rest = bits & bits - 1u;
    words = uvec4(first == 0u ? rest : words.x, first == 1u ? rest : words.y, first == 2u ? rest : words.z,
                  first == 3u ? rest : words.w);
    return first * MARKED_AT_ONCE + uint(findLSB(bits));
}
