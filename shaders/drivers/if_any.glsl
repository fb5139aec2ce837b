// A replacement for `if` around expensive code. lavapipe runs both sides of an `if` for all eight invocations of a
// group, but skips a loop that none of them enters. On other drivers the loop has one iteration, and compilers see
// that.
#ifndef EDGESPLAT_IF_ANY_GLSL
#define EDGESPLAT_IF_ANY_GLSL
#include "shaders/shared/limits.h"
layout(constant_id = SPEC_LOOPS) const uint LOOPS = 1u;
#define IF_ANY(condition) for (int any_one = (condition) ? 1 : 0; any_one > 0; any_one = LOOPS == 1u ? any_one - 1 : 0)
#endif
