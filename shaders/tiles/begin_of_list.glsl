// The first position at or after `at` where a list may begin.
uint begin_of_list(uint at) { return (at + MARKED_AT_ONCE - 1u) / MARKED_AT_ONCE * MARKED_AT_ONCE; }
