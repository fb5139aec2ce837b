// Prints a frame's description as tables with aligned columns.
#include <algorithm>
#include <array>

#include "engine/error.h"
#include "engine/forecast/description.h"

namespace edgesplat {
namespace {

/// A table whose columns are as wide as their widest cell; `right`: columns that are right-aligned.
class Table {
  public:
    explicit Table(std::vector<bool> right) : right_(std::move(right)) {}
    void row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

    std::string text() const {
        std::vector<std::size_t> width(right_.size(), 0);
        for (const auto& row : rows_)
            for (std::size_t c = 0; c < row.size(); ++c)
                width[c] = std::max(width[c], row[c].size());
        std::string out;
        for (const auto& row : rows_) {
            std::string line;
            for (std::size_t c = 0; c < row.size(); ++c) {
                line +=
                    right_[c] ? fmt::format("  {:>{}}", row[c], width[c]) : fmt::format("  {:<{}}", row[c], width[c]);
            }
            line.erase(line.find_last_not_of(' ') + 1);
            out += line + "\n";
        }
        return out;
    }

  private:
    std::vector<bool> right_;
    std::vector<std::vector<std::string>> rows_;
};

std::string mebibytes(double bytes) {
    return fmt::format("{:.3f}", bytes / (1024.0 * 1024.0));
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace

std::string to_text(const FrameDescription& d) {
    std::string text =
        fmt::format("{}; {} x {} pixels{}\n", d.volume, d.size.x, d.size.y, d.device.empty() ? "" : " on " + d.device);
    text += fmt::format("device profile {}: {}\n", d.profile, d.profile_reason);
    text += fmt::format("{} splats ({}) from {} voxels, in {} sheets, {} groups\n", d.splats, d.splats_from, d.voxels,
                        d.sheets, d.sheet_groups);
    const bool measured =
        std::ranges::any_of(d.passes, [](const auto& p) { return p.measured_milliseconds.has_value(); });
    text += "\npasses\n";
    Table passes({false, false, true, false});
    passes.row({"for", "pass", measured ? "ms" : "", "reason"});
    for (const PassDescription& pass : d.passes) {
        passes.row({pass.draw, pass.name,
                    pass.measured_milliseconds ? fmt::format("{:.2f}", *pass.measured_milliseconds) : "", pass.reason});
    }
    text += passes.text() + "\npipeline variants\n";
    for (const PassDescription& pass : d.passes)
        for (const gpu::PipelineVariant& pipeline : pass.pipelines)
            text += fmt::format("  {}: {}\n", pass.draw, text_of(pipeline));

    text += "\nmemory\n";
    Table memory({true, false, false, false, false, false, false, false});
    memory.row({"MiB", "name", "format", "shape", "contents", "written", "read", "reason"});
    for (const ResourceDescription& r : d.resources) {
        memory.row({mebibytes(static_cast<double>(r.allocated_bytes.value_or(r.device_bytes.value_or(r.bytes)))),
                    r.name, r.format, r.shape, r.contents, r.written, r.read,
                    r.transient() ? "only " + r.held : r.reason});
    }
    memory.row({mebibytes(static_cast<double>(d.total_bytes())), "peak"});
    for (const auto& [name, bytes] : d.volumes)
        memory.row({mebibytes(static_cast<double>(bytes)), "of it " + name});
    text += memory.text();

    std::uint32_t bytes = 0;
    Table record({true, false, false});
    for (const RecordDescription& field : d.record) {
        bytes += field.bytes;
        record.row({fmt::format("{}", field.bytes), field.name, field.reason});
    }
    text += fmt::format("\nsplat record, {} bytes\n", bytes) + record.text();

    text += "\nleft out\n";
    Table out({false, true, false, false});
    out.row({"effect", "MiB", "passes", "enabled with"});
    for (const LeftOut& row : d.left_out) {
        if (row.obstacle.empty())
            out.row({row.effect, fmt::format("{:+.3f}", static_cast<double>(row.bytes) / (1024.0 * 1024.0)),
                     joined(row.passes), row.call});
        else
            out.row({row.effect, "-", "", row.call + " (" + row.obstacle + ")"});
    }
    return text + out.text();
}

}  // namespace edgesplat
