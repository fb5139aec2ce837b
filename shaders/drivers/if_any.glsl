// `if`, before what takes longer than to look whether any invocation needs it: lavapipe runs both sides of an if for all eight that
// go side by side, but no loop that none of them enters. Elsewhere the loop ends at once, as compilers see.
#ifndef EDGESPLAT_IF_ANY_GLSL
#define EDGESPLAT_IF_ANY_GLSL
#include "shaders/shared/limits.h"
layout(constant_id = SPEC_LOOPS) const uint LOOPS = 1u;
#define IF_ANY(condition) for (int any_one = (condition) ? 1 : 0; any_one > 0; any_one = LOOPS == 1u ? any_one - 1 : 0)
#endif
