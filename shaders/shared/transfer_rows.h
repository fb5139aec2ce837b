// A piecewise-linear transfer function, as stored on the device.
#ifndef EDGESPLAT_TRANSFER_ROWS_H
#define EDGESPLAT_TRANSFER_ROWS_H
#include "shaders/shared/glue.h"
EDGESPLAT_SHARED_BEGIN

EDGESPLAT_CONSTANT uint TRANSFER_ROWS = 256u;  // upper bound for a scene; one more row is the end

/// Ascending values. Rows after the last point have the value 3e38 and its colour.
struct TransferRow {
    float value;  // scaled
    vec4 matter;  // rgb, extinction per mm
    vec4 before;  // integral of extinction * (rgb, 1) from the first row's value up to this one, for rays
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
