// The next list may begin there or after.
uint begin_of_list(uint at) { return (at + MARKED_AT_ONCE - 1u) / MARKED_AT_ONCE * MARKED_AT_ONCE; }
