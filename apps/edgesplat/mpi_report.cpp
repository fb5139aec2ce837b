#include "apps/edgesplat/mpi_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "apps/edgesplat/mpi_ranks.h"
#include "engine/error.h"

namespace {

/// Throws if a sheet is drawn twice or not at all: different drivers may round the division differently.
void check(const std::vector<RankReport>& reports) {
    std::uint32_t end = 0;
    for (std::size_t i = 0; i < reports.size(); ++i) {
        const RankReport& report = reports[i];
        if (report.checksum != reports.front().checksum)
            edgesplat::fail("rank {} has read a different volume than rank 0", i);
        if (report.level != reports.front().level)
            edgesplat::fail(
                "rank {} draws level {} of the volume, rank 0 level {}: give all ranks the same --memory-budget", i,
                report.level, reports.front().level);
        if (report.sheets != reports.front().sheets || report.share.first_sheet != end)
            edgesplat::fail(
                "rank {} divides the sheets differently from the ranks before it: all ranks need the same device, "
                "driver and options",
                i);
        end = report.share.end_sheet;
    }
    if (end != reports.front().sheets) edgesplat::fail("{} of {} sheets were drawn", end, reports.front().sheets);
}

}  // namespace

std::vector<RankReport> gather_reports(const edgesplat::RenderStats& stats, const edgesplat::Volume& volume) {
    if (!stats.share) return {};
    std::vector<RankReport> reports = ranks::gather(RankReport{
        volume.checksum, stats.sheets, stats.level, stats.validation_messages, stats.setup_milliseconds, *stats.share});
    if (!reports.empty()) check(reports);
    return reports;
}

nlohmann::ordered_json to_json(const std::vector<RankReport>& reports) {
    auto json = nlohmann::ordered_json::array();
    for (const RankReport& report : reports) {
        const edgesplat::SheetShare& share = report.share;
        json.push_back({{"first_sheet", share.first_sheet},
                        {"end_sheet", share.end_sheet},
                        {"splats", share.splats},
                        {"pairs", share.pairs},
                        {"setup_ms", report.setup_milliseconds},
                        {"draw_ms", share.draw_milliseconds},
                        {"redraw_ms", share.redraw_milliseconds},
                        {"processor_ms", share.processor_milliseconds},
                        {"wait_ms", share.wait_milliseconds},
                        {"composite_ms", share.composite_milliseconds}});
    }
    return json;
}

std::string to_text(const std::vector<RankReport>& reports) {
    if (reports.empty()) return "";
    std::vector<std::string> sheets, times;
    for (const RankReport& report : reports) {
        const edgesplat::SheetShare& share = report.share;
        sheets.push_back(fmt::format("{}", share.end_sheet - share.first_sheet));
        times.push_back(fmt::format("{:.1f}", share.draw_milliseconds + share.redraw_milliseconds));
    }
    return fmt::format(", by {} ranks: {} sheets, drawn in {} ms, composited in {:.1f} ms", reports.size(),
                       fmt::join(sheets, " + "), fmt::join(times, " + "), reports.front().share.composite_milliseconds);
}
