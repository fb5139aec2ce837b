// A piecewise-linear transfer function as the device holds it.
#ifndef EDGESPLAT_TRANSFER_ROWS_H
#define EDGESPLAT_TRANSFER_ROWS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint TRANSFER_ROWS = 256u;  // as many as a scene may have; one more ends them

/// Ascending; behind the last point rows of value 3e38 with its colour.
struct TransferRow {
    float value;  // scaled
    vec4 matter;  // rgb, extinction per mm
    vec4 before;  // integral of extinction times (rgb, 1) over the values from the first row's on, for rays
};

EDGESPLAT_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(edgesplat::shader::TransferRow) == 36);
namespace edgesplat::shader {
inline bool operator==(const TransferRow& a, const TransferRow& b) {
    return a.value == b.value && a.matter == b.matter;
}
}  // namespace edgesplat::shader
#else
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TransferRef {
    TransferRow at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ClassifiedRef {
    float at[];
};
#endif
#endif
