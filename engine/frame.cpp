#include "engine/frame.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/error.h"
#include "engine/passes/1_estimate_edges.h"
#include "engine/passes/2_collect_splats.h"
#include "engine/passes/3_select_footprints.h"
#include "engine/passes/4_sort_sheets.h"
#include "engine/passes/5_draw_splats.h"
#include "engine/passes/6_composite_sheet.h"
#include "engine/passes/7_resolve.h"
#include "engine/row_box.h"

namespace edgesplat {
namespace {

using Usage = vk::ImageUsageFlagBits;

/// Runs of voxels to counts to offsets; notes the rows that hold splats. Returns the number of splats.
std::uint64_t scan_runs(const glm::ivec3& dims, VolumeResources& resources) {
    const auto runs = resources.run_offsets.mapped<std::uint32_t>(passes::collect_runs(dims));
    const std::uint64_t voxels =
        static_cast<std::uint64_t>(dims.x) * static_cast<std::uint64_t>(dims.y) * static_cast<std::uint64_t>(dims.z);
    RowBox rows(dims);
    std::uint64_t total = 0;
    for (std::uint64_t i = 0; i < runs.size(); ++i) {
        const std::uint32_t count = runs[i];
        runs[i] = static_cast<std::uint32_t>(total);
        total += count;
        const std::uint64_t first = i * shader::COLLECT_RUN;
        if (count > 0) rows.add(first, std::min(first + shader::COLLECT_RUN, voxels) - 1);
    }
    resources.box_low = rows.low();
    resources.box_high = rows.high();
    return total;
}

}  // namespace

passes::CollectSplats collect_inputs(const CollectionPlan& plan) {
    const bool marched = plan.estimator == EdgeEstimator::March || plan.estimator == EdgeEstimator::Cubic;
    return {.dims = plan.dims,
            .edges = plan.edge_field,
            .buried = plan.buried,
            .smooth = plan.edge_field && marched,
            .curved = plan.curved,
            .weighted = plan.weighted,
            .clip = plan.clip,
            .transfer = !plan.transfer.empty()};
}

std::vector<PassTime> run_collection(const gpu::Device& device, gpu::Commands& commands, const Bindings& bindings,
                                     const CollectionPlan& plan, VolumeResources& resources) {
    const auto volume_image = [&](vk::Format format, const char* name) {
        return gpu::GpuImage(
            device,
            {.format = format, .size = plan.dims, .volume = true, .usage = Usage::eStorage | Usage::eTransferSrc},
            name);
    };
    // What a change of the scene replaces is not held next to its successor.
    resources.edges = {};
    resources.buried = {};
    resources.run_offsets = {};
    resources.splats = {};
    resources.traits = {};
    resources.scene = {};
    resources.edges = plan.edge_field ? volume_image(vk::Format::eR32G32Uint, "edge field") : gpu::GpuImage();
    resources.buried = plan.buried ? volume_image(vk::Format::eR8Uint, "buried mask") : gpu::GpuImage();
    const auto runs = passes::collect_runs(plan.dims);
    resources.scene = gpu::Buffer(device, sizeof(shader::SceneParams), gpu::Buffer::Place::Host, "scene parameters");
    resources.run_offsets = gpu::Buffer(device, runs * sizeof(std::uint32_t), gpu::Buffer::Place::Host, "run offsets");
    bindings.write(resources, {}, {});

    auto& params = resources.scene.mapped<shader::SceneParams>(1)[0];
    params = plan.params;
    params.run_offsets = resources.run_offsets.address();
    resources.transfer = {};
    if (!plan.transfer.empty()) {
        resources.transfer = gpu::Buffer(device, plan.transfer.size() * sizeof(shader::TransferRow),
                                         gpu::Buffer::Place::Host, "transfer function");
        std::ranges::copy(plan.transfer, resources.transfer.mapped<shader::TransferRow>(plan.transfer.size()).begin());
        params.transfer = resources.transfer.address();
    }
    const passes::CollectSplats collect = collect_inputs(plan);

    commands.run([&] {
        if (plan.buried) {
            commands.prepare({&resources.buried});
            commands.span("1a_mark_buried", [&] { passes::mark_buried(commands, plan.dims, plan.clip); });
        }
        if (plan.edge_field) {
            commands.prepare({&resources.edges});
            commands.span("1_estimate_edges",
                          [&] { passes::estimate_edges(commands, plan.dims, plan.estimator, plan.skip_buried); });
        }
        commands.span("2_collect_splats", [&] { passes::count_splats(commands, collect); });
    });

    auto times = commands.span_times();

    resources.splat_count = scan_runs(plan.dims, resources);
    if (resources.splat_count > std::numeric_limits<std::uint32_t>::max() / sizeof(shader::Splat)) {
        fail("{} voxels can be seen at once; the splat list holds {}", resources.splat_count,
             std::numeric_limits<std::uint32_t>::max() / sizeof(shader::Splat));
    }
    resources.splats =
        gpu::Buffer(device, resources.splat_count * sizeof(shader::Splat), gpu::Buffer::Place::Device, "splat list");
    params.splats = resources.splats.address();
    if (plan.curved || plan.weighted != 0) {
        resources.traits = gpu::Buffer(device, resources.splat_count * sizeof(std::uint32_t),
                                       gpu::Buffer::Place::Device, "splat traits");
        params.traits = resources.traits.address();
    }
    resources.values = {};
    if (!plan.transfer.empty()) {
        resources.values =
            gpu::Buffer(device, resources.splat_count * sizeof(float), gpu::Buffer::Place::Device, "classified values");
        params.values = resources.values.address();
    }
    commands.run([&] { commands.span("2_collect_splats", [&] { passes::write_splats(commands, collect); }); });
    const auto edges = resources.run_offsets.mapped<std::uint32_t>(runs);
    resources.edge_splat_count = std::accumulate(edges.begin(), edges.end(), std::uint64_t{0});
    for (const auto& writing : commands.span_times())
        times.back().milliseconds += writing.milliseconds;
    return times;
}

void add_times(std::vector<PassTime>& sums, const std::vector<PassTime>& times) {
    for (const PassTime& time : times) {
        const auto same = std::ranges::find(sums, time.name, &PassTime::name);
        if (same == sums.end())
            sums.push_back(time);
        else
            same->milliseconds += time.milliseconds;
    }
}

void run_frame(gpu::Commands& commands, const FramePlan& plan, const TargetResources& targets) {
    const passes::DrawSplats draw{plan.variant, targets.sheets, targets.depth, targets.indices, targets.draws};

    commands.run([&] {
        commands.raw().fillBuffer(targets.counters.handle(), 0, VK_WHOLE_SIZE, 0);
        passes::clear_accumulated(commands, targets.accumulated);
        commands.span("3_select_footprints",
                      [&] { passes::select_footprints(commands, plan.params.splat_count, plan.variant); });
        commands.span("4_sort_sheets",
                      [&] { passes::sort_sheets(commands, plan.variant.sliced, false, plan.sort_segments); });
        for (std::uint32_t group = 0; group < plan.params.group_count; ++group) {
            commands.span("5_draw_splats", [&] { passes::draw_splats(commands, draw, group); });
            commands.span("6_composite_sheet",
                          [&] { passes::composite_sheet(commands, targets.accumulated, plan.variant.payload, group); });
        }
        commands.span("7_resolve", [&] { passes::resolve(commands, plan.variant, plan.params.size, plan.gradient); });
    });
}

}  // namespace edgesplat
