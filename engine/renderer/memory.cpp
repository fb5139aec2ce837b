// RendererState: what is held, and whether what comes next can be.
#include "engine/error.h"
#include "engine/renderer/state.h"
#include "engine/volume/packed_volume.h"

namespace edgesplat {

void RendererState::provide_volume() {
    if (!volume_resources.volume) return upload_volume(*this);
    if (!changed) return;
    const std::vector<float> samples = scaled_box(*volume, *changed);
    upload_box(commands, device, volume_resources.volume, changed->low, changed->size(), samples.data(), sizeof(float));
}

bool RendererState::take_changes(const std::shared_ptr<const Volume>& next) {
    // The same object's samples may have been written to meanwhile.
    if (!next || !original || next == original || in_blocks || volume != original || !volume_resources.volume ||
        !collected)
        return false;
    const auto box = changed_box(*original, *next);
    if (!box) return false;
    other = {};
    raycast.reset();
    volume_resources.coefficients = {};
    original = volume = next;
    levels = {next};
    if (!changed) changed.emplace();
    changed->add(*box);
    if (changed->empty()) changed.reset();
    return true;
}

std::optional<SplatCount> RendererState::collected_splats(const CollectionPlan& wanted) const {
    if (changed || !collected || !(*collected == wanted)) return std::nullopt;
    return SplatCount{SplatCount::From::Frame, volume_resources.splat_count, volume_resources.box_low,
                      volume_resources.box_high};
}

std::optional<MemoryNeed> RendererState::beyond_memory(const FrameRequest& request) {
    const double reach = kernel_reach(drawn_settings(request));
    const CollectionPlan wanted = planned_collection(request);
    const auto known = collected_splats(wanted);
    const SplatCount splats = known.value_or(most_splats(volume->geometry));
    FrameForecast forecast = forecast_frame(request, wanted, splats, reach, device.profile());
    std::vector<std::pair<std::string, std::uint64_t>> asked;
    for (const PlannedResource& resource : forecast.resources)
        asked.emplace_back(resource.text.name, resource.bytes);
    if (asked == checked) return checked_need;
    MemoryNeed need = memory_need(device, forecast, memory_budget);
    // The bound by the number of voxels is too high for most volumes; counting takes longer.
    if (!need.fits() && !known) {
        forecast = forecast_frame(request, wanted, count_splats(*volume, wanted), reach, device.profile());
        need = memory_need(device, forecast, memory_budget);
    }
    checked = std::move(asked);
    checked_need = need.fits() ? std::nullopt : std::optional(std::move(need));
    return checked_need;
}

FrameForecast Renderer::forecast(const FrameRequest& request) {
    need_samples(*request.volume, "a forecast of the frame");
    const CollectionPlan wanted = planned_collection(request);
    const auto known = request.volume == state_->volume ? state_->collected_splats(wanted) : std::nullopt;
    return forecast_frame(request, wanted, known ? *known : count_splats(*request.volume, wanted),
                          kernel_reach(drawn_settings(request)), state_->device.profile());
}

std::vector<FittingChange> Renderer::what_fits(const FrameRequest& request) const {
    return edgesplat::what_fits(state_->device, request, state_->memory_budget);
}

std::uint64_t Renderer::held_bytes() const {
    return state_->device.allocated_bytes();
}

std::uint64_t Renderer::required_bytes(const PlannedResource& resource) const {
    const gpu::Device& device = state_->device;
    if (!resource.image) return gpu::Buffer::required_bytes(device, resource.bytes);
    return gpu::beyond_limits(device, *resource.image).empty() ? gpu::required_bytes(device, *resource.image)
                                                               : resource.bytes;
}

}  // namespace edgesplat
