// Renderer::divide_sheets: a picture of which this renderer draws some of the sheets.
#include "engine/renderer_parts.h"

#include <algorithm>
#include <chrono>
#include <ctime>

#include "engine/error.h"
#include "engine/frame_parts.h"
#include "engine/renderer_state.h"

namespace edgesplat {
namespace {

using Clock = std::chrono::steady_clock;

/// Adds the time between its making and its end to a sum, and the processor's to another.
class AddedTime {
  public:
    explicit AddedTime(double& milliseconds, double* processor = nullptr)
        : sum_(&milliseconds), processor_(processor) {}
    ~AddedTime() {
        *sum_ += std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
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
    constexpr std::size_t kMostWords = 65536 / sizeof(std::uint32_t);  // what one vkCmdUpdateBuffer may bring
    commands.run([&] {
        for (std::size_t done = 0; done < values.size(); done += kMostWords) {
            const auto piece = values.subspan(done, std::min(kMostWords, values.size() - done));
            commands.raw().updateBuffer<std::uint32_t>(buffer.handle(), done * sizeof(std::uint32_t),
                                                       {static_cast<std::uint32_t>(piece.size()), piece.data()});
        }
        commands.barrier();
    });
}

}  // namespace

void Renderer::divide_sheets(PartExchange* exchange) {
    state_->exchange = exchange;
}

void RendererState::draw_part(passes::TileDraw how) {
    const bool sums = plan.variant.payload == shader::PAYLOAD_TAU;
    const auto& size = plan.params.size;
    const auto count = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y);
    const auto pixels = targets.output.mapped<glm::vec4>(count);
    std::uint32_t chunks = 0;
    {
        const AddedTime time(share.draw_milliseconds, &share.processor_milliseconds);
        const Chunks planned = sort_frame(commands, plan, targets, {exchange->part(), slab});
        draw_times = commands.span_times();
        share.first_sheet = planned.sheets.x;
        share.end_sheet = planned.sheets.y;
        share.splats = plan.params.splat_count;
        share.pairs += planned.pairs;
        provide_chunks(planned);
        chunks = static_cast<std::uint32_t>(planned.parts.size());
        add_times(draw_times, draw_frame(commands, plan, targets, chunks, how));
    }
    const auto wait = [&] {
        const AddedTime time(share.wait_milliseconds);
        exchange->wait();
    };
    wait();
    std::vector<glm::vec4> part(pixels.begin(), pixels.end());
    if (!sums) {
        std::vector<float> in_front(count);
        {
            const AddedTime time(share.composite_milliseconds);
            std::ranges::transform(part, in_front.begin(), [](const glm::vec4& p) { return 1.0F - p.a; });
            exchange->pass_back(in_front);
        }
        if (exchange->part().index > 0) {
            const AddedTime time(share.redraw_milliseconds, &share.processor_milliseconds);
            const PixelsBehind behind(in_front, plan.params.saturation, part, pixels);
            if (behind.any()) {
                write(commands, targets.tile_closed, behind.closed_pixels(size, plan.params.tiles));
                add_times(draw_times, draw_frame(commands, plan, targets, chunks, how));
                behind.take(in_front, pixels, part);
            }
        }
        wait();
    }
    const AddedTime time(share.composite_milliseconds);
    sums ? exchange->add(part) : exchange->fold(part);
    if (exchange->part().index > 0) return;
    std::ranges::copy(part, pixels.begin());
    add_times(draw_times, resolve_frame(commands, plan));
}

}  // namespace edgesplat
