// Measures an accuracy report: errors against references, edges, times, memory and popping of every configuration.
#pragma once

#include "engine/accuracy/report.h"
#include "engine/accuracy/work_list.h"
#include "engine/renderer.h"

namespace edgesplat::accuracy {

struct Measured {
    Report report;
    std::vector<ReportPictures> pictures;  ///< per camera
};

/// Keeps a journal and the references in `options.folder` (created if missing), and continues an earlier run with the
/// same input, options and device. Throws Interrupted if `progress` returns false, Error otherwise.
Measured measure_accuracy(Renderer& renderer, const ReportInput& input, const ReportOptions& options,
                          const ProgressFunction& progress = {});

}  // namespace edgesplat::accuracy
