// PictureDrawer: draws one part of a picture whose sheets are divided between processes.
#include <algorithm>
#include <bit>
#include <chrono>
#include <ctime>
#include <functional>

#include "engine/clock.h"
#include "engine/distribute/parts.h"
#include "engine/frame/picture.h"
#include "engine/gpu/read_back.h"
#include "engine/passes/5_refine_pixels.h"
#include "engine/passes/7_resolve.h"

namespace edgesplat {
namespace {

/// Adds its lifetime to a sum (ms), and the processor time meanwhile to another.
class AddedTime {
  public:
    explicit AddedTime(double& milliseconds, double* processor = nullptr)
        : sum_(&milliseconds), processor_(processor) {}
    ~AddedTime() {
        *sum_ += milliseconds_since(start_);
        if (processor_) *processor_ += 1e3 * static_cast<double>(std::clock() - ticks_) / CLOCKS_PER_SEC;
    }
    AddedTime(const AddedTime&) = delete;
    AddedTime& operator=(const AddedTime&) = delete;

  private:
    double *sum_, *processor_;
    Clock::time_point start_ = Clock::now();
    std::clock_t ticks_ = std::clock();
};

/// Writes `values` to the beginning of a buffer on the device.
void write(gpu::Commands& commands, const gpu::Buffer& buffer, std::span<const std::uint32_t> values) {
    constexpr std::size_t kMostWords = 65536 / sizeof(std::uint32_t);  // limit of vkCmdUpdateBuffer
    commands.run([&] {
        for (std::size_t done = 0; done < values.size(); done += kMostWords) {
            const auto piece = values.subspan(done, std::min(kMostWords, values.size() - done));
            commands.update(buffer, done * sizeof(std::uint32_t), piece);
        }
        commands.barrier();
    });
}

/// Marks tiles in which the parts in front leave a pixel of the first step unsaturated. `in_front`: their
/// transmittance.
void mark_reached(const FramePlan& plan, std::span<const float> in_front, std::vector<bool>& reached) {
    constexpr std::size_t kStep = shader::REFINE_STEP, kTile = shader::TILE;
    const glm::u64vec2 size(plan.params.size), tiles(plan.params.tiles);
    for (std::size_t y = 0; y < size.y; y += kStep)
        for (std::size_t x = 0; x < size.x; x += kStep)
            if (1.0F - in_front[y * size.x + x] < plan.params.saturation)
                reached[y / kTile * tiles.x + x / kTile] = true;
}

}  // namespace

bool PictureDrawer::parts_refine(const Chunks& own) {
    if (!plan_.refined) return false;
    PartExchange& exchange = *options_->exchange;
    std::vector<glm::vec4> sum{{static_cast<float>(own.pairs), static_cast<float>(own.entries), 0, 0}};
    exchange.add(sum);
    std::vector<std::uint32_t> decision{0};
    if (exchange.part().index == 0) {
        Chunks all;
        all.pairs = static_cast<std::uint64_t>(sum[0].x);
        all.entries = static_cast<std::uint64_t>(sum[0].y);
        decision[0] = should_refine(all) ? 1 : 0;
    }
    exchange.share(decision);
    return decision[0] == 1;
}

void PictureDrawer::share_pixels(std::uint32_t step, const std::vector<bool>& reached, std::span<glm::vec4> whole) {
    PartExchange& exchange = *options_->exchange;
    gpu::Commands& commands = session_->commands();
    const gpu::Device& device = session_->device();
    const TargetResources& targets = targets_.resources();
    const std::size_t tiles = tile_count(plan_), of_tile = std::size_t{shader::TILE} * shader::TILE;
    const auto todo = targets.tile_todo.mapped<std::uint32_t>(tiles);
    const bool first = exchange.part().index == 0;
    std::vector<std::uint32_t> lists(tiles * of_tile), counts(tiles);
    const auto finest = gpu::read_back<std::uint32_t>(device, commands, targets.tile_finest, 0, tiles);
    std::vector<glm::vec4> too_fine(tiles);
    for (std::size_t tile = 0; tile < tiles; ++tile)
        too_fine[tile].x = reached[tile] && std::bit_cast<float>(finest[tile]) < static_cast<float>(step) ? 1 : 0;
    exchange.add(too_fine);
    if (first) {
        std::vector<std::uint32_t> of_all = finest;
        for (std::size_t tile = 0; tile < tiles; ++tile)
            if (too_fine[tile].x > 0) of_all[tile] = 0;
        write(commands, targets.tile_finest, of_all);
        const std::span<glm::vec4> pixels = targets_.pixels(plan_);
        std::ranges::copy(whole, pixels.begin());
        commands.run([&] {
            commands.to_device(targets.output);
            commands.span("5_refine_pixels",
                          [&] { passes::refine_pixels(commands, plan_.variant, tile_count(plan_), step); });
            for (const gpu::Buffer* seen : {&targets.output, &targets.tile_todo})
                commands.to_host(*seen);
        });
        add_times(times_, commands.span_times());
        std::ranges::copy(pixels, whole.begin());
        lists = gpu::read_back<std::uint32_t>(device, commands, targets.tile_pixels, 0, lists.size());
        std::ranges::copy(todo, counts.begin());
        write(commands, targets.tile_finest, finest);
    }
    exchange.share(counts);
    exchange.share(lists);
    if (!first) {
        std::ranges::copy(counts, todo.begin());
        write(commands, targets.tile_pixels, lists);
    }
    write(commands, targets.tile_closed, std::vector<std::uint32_t>(tiles));
    std::ranges::fill(targets_.pixels(plan_), glm::vec4(0));
    commands.run([&] { commands.to_device(targets.output); });
}

void PictureDrawer::draw_part(passes::TileDraw how) {
    PartExchange& exchange = *options_->exchange;
    gpu::Commands& commands = session_->commands();
    const TargetResources& targets = targets_.resources();
    std::uint32_t chunks = 0;
    {
        const AddedTime time(share_.draw_milliseconds, &share_.processor_milliseconds);
        const Chunks planned = sort_frame(commands, plan_, targets, {exchange.part(), slab_});
        times_ = commands.span_times();
        share_.first_sheet = planned.sheets.x;
        share_.end_sheet = planned.sheets.y;
        share_.splats = plan_.params.splat_count;
        share_.pairs += planned.pairs;
        targets_.provide_chunks(plan_, planned);
        chunks = static_cast<std::uint32_t>(planned.parts.size());
        plan_.refined = parts_refine(planned);
    }
    std::vector<glm::vec4> whole(targets_.pixels(plan_).size());
    std::vector<bool> reached(tile_count(plan_), exchange.part().index == 0);
    for (std::uint32_t step = first_step(plan_); step > 0; step /= 2) {
        const std::vector<glm::vec4> drawn = draw_part_step(how, chunks, step, reached);
        std::ranges::transform(whole, drawn, whole.begin(), std::plus{});
        if (step > 1) share_pixels(step, reached, whole);
    }
    if (exchange.part().index > 0) return;
    std::ranges::copy(whole, targets_.pixels(plan_).begin());
    commands.run([&] {
        commands.to_device(targets.output);
        commands.span("7_resolve",
                      [&] { passes::resolve(commands, plan_.variant, plan_.params.size, plan_.gradient); });
        commands.to_host(targets.output);
    });
    add_times(times_, commands.span_times());
}

std::vector<glm::vec4> PictureDrawer::draw_part_step(passes::TileDraw how, std::uint32_t chunks, std::uint32_t step,
                                                     std::vector<bool>& reached) {
    PartExchange& exchange = *options_->exchange;
    gpu::Commands& commands = session_->commands();
    const TargetResources& targets = targets_.resources();
    const bool is_sum = plan_.variant.payload == shader::PAYLOAD_TAU;
    const auto& size = plan_.params.size;
    const std::span<glm::vec4> pixels = targets_.pixels(plan_);
    {
        const AddedTime time(share_.draw_milliseconds, &share_.processor_milliseconds);
        add_times(times_, draw_step(commands, plan_, targets, chunks, how, step));
    }
    const auto wait = [&] {
        const AddedTime time(share_.wait_milliseconds);
        exchange.wait();
    };
    wait();
    std::vector<glm::vec4> part(pixels.begin(), pixels.end());
    if (!is_sum) {
        std::vector<float> in_front(pixels.size());
        {
            const AddedTime time(share_.composite_milliseconds);
            std::ranges::transform(part, in_front.begin(), [](const glm::vec4& p) { return 1.0F - p.a; });
            exchange.pass_back(in_front);
        }
        if (exchange.part().index > 0) {
            const AddedTime time(share_.redraw_milliseconds, &share_.processor_milliseconds);
            if (step == shader::REFINE_STEP) mark_reached(plan_, in_front, reached);
            const PixelsBehind behind(in_front, plan_.params.saturation, part, pixels);
            if (behind.any()) {
                const auto todo = targets.tile_todo.mapped<std::uint32_t>(tile_count(plan_));
                write(commands, targets.tile_closed, behind.closed_pixels(size, plan_.params.tiles, todo));
                commands.run([&] { commands.to_device(targets.output); });
                add_times(times_, draw_step(commands, plan_, targets, chunks, how, step));
                behind.take(in_front, pixels, part);
            }
        }
        wait();
    }
    const AddedTime time(share_.composite_milliseconds);
    is_sum ? exchange.add(part) : exchange.fold(part);
    return part;
}

}  // namespace edgesplat
