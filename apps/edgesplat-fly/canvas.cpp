#include "apps/edgesplat-fly/canvas.h"

#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/error.h"

namespace {

using edgesplat::viewer::ScreenPicture;
using Usage = vk::ImageUsageFlagBits;

constexpr vk::Format kFormat = vk::Format::eR8G8B8A8Unorm;
constexpr vk::ImageSubresourceLayers kWhole(vk::ImageAspectFlagBits::eColor, 0, 0, 1);

void check(VkResult result) {
    if (result < 0) edgesplat::fail("window: Vulkan: {}", vk::to_string(static_cast<vk::Result>(result)));
}

vk::raii::RenderPass make_pass(const edgesplat::gpu::Device& device) {
    const vk::AttachmentDescription attachment({}, kFormat, vk::SampleCountFlagBits::e1, vk::AttachmentLoadOp::eLoad,
                                               vk::AttachmentStoreOp::eStore, vk::AttachmentLoadOp::eDontCare,
                                               vk::AttachmentStoreOp::eDontCare, vk::ImageLayout::eGeneral,
                                               vk::ImageLayout::eGeneral);
    const vk::AttachmentReference reference(0, vk::ImageLayout::eGeneral);
    const vk::SubpassDescription subpass({}, vk::PipelineBindPoint::eGraphics, {}, reference);
    return {device.handle(), vk::RenderPassCreateInfo({}, attachment, subpass)};
}

}  // namespace

void CanvasPicture::set(ScreenPicture picture) {
    next_ = std::move(picture);
    size_ = {next_.width, next_.height};
    fresh_ = true;
}

ScreenPicture part_of(const ScreenPicture& picture, const glm::ivec4& part) {
    ScreenPicture out{part.z - part.x, part.w - part.y, {}};
    const auto row = 4 * static_cast<std::size_t>(out.width);
    for (int y = part.y; y < part.w; ++y) {
        const auto* begin =
            picture.pixels.data() + 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
                                         static_cast<std::size_t>(part.x));
        out.pixels.insert(out.pixels.end(), begin, begin + row);
    }
    return out;
}

Canvas::Canvas(const edgesplat::gpu::Device& device) : device_(device), pass_(make_pass(device)) {
    const vk::DescriptorPoolSize size(vk::DescriptorType::eCombinedImageSampler, 16);
    descriptors_ = {device.handle(),
                    vk::DescriptorPoolCreateInfo(vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet, 16, size)};
    pool_ = {device.handle(),
             vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, device.queue_family())};
    auto buffers = vk::raii::CommandBuffers(device.handle(),
                                            vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1));
    commands_ = std::move(buffers.front());
    fence_ = {device.handle(), vk::FenceCreateInfo()};

    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *device.instance();
    info.PhysicalDevice = *device.physical();
    info.Device = *device.handle();
    info.QueueFamily = device.queue_family();
    info.Queue = *device.queue();
    info.DescriptorPool = *descriptors_;
    info.MinImageCount = info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = &check;
#if IMGUI_VERSION_NUM >= 19020
    info.RenderPass = *pass_;
    ImGui_ImplVulkan_Init(&info);
#else
    ImGui_ImplVulkan_Init(&info, *pass_);
#endif
}

Canvas::~Canvas() {
    try {
        device_.handle().waitIdle();
    } catch (const vk::SystemError&) {
        // There is no work to wait for on a lost device.
    }
    ImGui_ImplVulkan_Shutdown();
}

void Canvas::resize(const glm::ivec2& size) {
    if (size == size_ || size.x < 1 || size.y < 1) return;
    device_.handle().waitIdle();
    framebuffer_ = nullptr;
    image_ = {};
    image_ = edgesplat::gpu::GpuImage(device_,
                                      {.format = kFormat,
                                       .size = {size, 1},
                                       .usage = Usage::eColorAttachment | Usage::eTransferDst | Usage::eTransferSrc},
                                      "canvas");
    const vk::ImageView view = image_.view();
    framebuffer_ = {device_.handle(), vk::FramebufferCreateInfo({}, *pass_, view, static_cast<std::uint32_t>(size.x),
                                                                static_cast<std::uint32_t>(size.y), 1)};
    size_ = size;
    prepared_ = false;
}

void Canvas::barrier() {
    const vk::MemoryBarrier2 all(vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
                                 vk::PipelineStageFlagBits2::eAllCommands,
                                 vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite);
    commands_.pipelineBarrier2(vk::DependencyInfo({}, all));
}

void Canvas::begin() {
    if (std::exchange(pending_, false)) {
        if (device_.handle().waitForFences(*fence_, VK_TRUE, std::numeric_limits<std::uint64_t>::max()) !=
            vk::Result::eSuccess)
            edgesplat::fail("window: the device does not respond");
        device_.handle().resetFences(*fence_);
    }
    commands_.reset();
    commands_.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    if (!std::exchange(fonts_, true)) {
#if IMGUI_VERSION_NUM < 19000
        ImGui_ImplVulkan_CreateFontsTexture(*commands_);
#endif
    }
    ImGui_ImplVulkan_NewFrame();
}

void Canvas::upload(CanvasPicture& picture) {
    if (!std::exchange(picture.fresh_, false)) return;
    const glm::ivec2 size = picture.size_;
    const bool fits = picture.image_ && picture.image_.shape().size == glm::ivec3(size, 1);
    if (!fits) {
        picture.image_ = {};
        picture.image_ =
            edgesplat::gpu::GpuImage(device_,
                                     {.format = kFormat,
                                      .size = {size, 1},
                                      .usage = Usage::eTransferDst | Usage::eTransferSrc | Usage::eSampled},
                                     "shown picture");
        const vk::ImageMemoryBarrier2 fresh(vk::PipelineStageFlagBits2::eNone, {},
                                            vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
                                            vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral, 0, 0,
                                            picture.image_.handle(), {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
        commands_.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, fresh));
    }
    const std::size_t bytes = picture.next_.pixels.size();
    if (!picture.staging_ || picture.staging_.bytes() < bytes)
        picture.staging_ = edgesplat::gpu::Buffer(device_, bytes, edgesplat::gpu::Buffer::Place::Host, "shown picture");
    std::ranges::copy(picture.next_.pixels, picture.staging_.mapped<std::uint8_t>(bytes).begin());
    picture.next_ = {};
    const vk::BufferImageCopy copy(0, 0, 0, kWhole, {0, 0, 0},
                                   {static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y), 1});
    commands_.copyBufferToImage(picture.staging_.handle(), picture.image_.handle(), vk::ImageLayout::eGeneral, copy);
}

void Canvas::paint(const Placed& placed) {
    const glm::dvec2 from(placed.picture->size_);
    const auto x = [&](double share) { return static_cast<int>(std::lround(share * from.x)); };
    const auto y = [&](double share) { return static_cast<int>(std::lround(share * from.y)); };
    // Blits must stay inside the image: source and target are clipped in proportion.
    glm::dvec4 part = placed.part, at(placed.at);
    const glm::dvec2 limit(size_);
    for (int axis = 0; axis < 2; ++axis) {
        const double length = at[axis + 2] - at[axis], share = part[axis + 2] - part[axis];
        if (!(length > 0)) return;
        const double low = std::max(0.0, -at[axis]) / length, high = std::max(0.0, at[axis + 2] - limit[axis]) / length;
        at[axis] += low * length;
        at[axis + 2] -= high * length;
        part[axis] += low * share;
        part[axis + 2] -= high * share;
    }
    const glm::ivec4 to(glm::round(at)), source(x(part[0]), y(part[1]), x(part[2]), y(part[3]));
    if (to.z <= to.x || to.w <= to.y || source.z <= source.x || source.w <= source.y) return;
    const vk::ImageBlit blit(kWhole, {vk::Offset3D(source.x, source.y, 0), vk::Offset3D(source.z, source.w, 1)}, kWhole,
                             {vk::Offset3D(to.x, to.y, 0), vk::Offset3D(to.z, to.w, 1)});
    commands_.blitImage(placed.picture->image_.handle(), vk::ImageLayout::eGeneral, image_.handle(),
                        vk::ImageLayout::eGeneral, blit, vk::Filter::eLinear);
    barrier();
}

void Canvas::end(const std::vector<Placed>& pictures, ImDrawData* panels, const Signals& signals,
                 const std::function<void(const vk::raii::CommandBuffer&, vk::Image)>& finish) {
    if (!std::exchange(prepared_, true)) {
        const vk::ImageMemoryBarrier2 fresh(vk::PipelineStageFlagBits2::eNone, {},
                                            vk::PipelineStageFlagBits2::eAllCommands, vk::AccessFlagBits2::eMemoryWrite,
                                            vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral, 0, 0,
                                            image_.handle(), {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
        commands_.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, fresh));
    }
    for (const Placed& placed : pictures)
        upload(*placed.picture);
    const vk::ClearColorValue background(std::array<float, 4>{0.05F, 0.05F, 0.06F, 1.0F});
    commands_.clearColorImage(image_.handle(), vk::ImageLayout::eGeneral, background,
                              vk::ImageSubresourceRange(vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1));
    barrier();
    for (const Placed& placed : pictures)
        paint(placed);
    const vk::Rect2D area({}, {static_cast<std::uint32_t>(size_.x), static_cast<std::uint32_t>(size_.y)});
    commands_.beginRenderPass(vk::RenderPassBeginInfo(*pass_, *framebuffer_, area), vk::SubpassContents::eInline);
    ImGui_ImplVulkan_RenderDrawData(panels, *commands_);
    commands_.endRenderPass();
    barrier();
    if (finish) finish(commands_, image_.handle());
    commands_.end();
    vk::SubmitInfo submit;
    const vk::PipelineStageFlags stage = vk::PipelineStageFlagBits::eTransfer;
    if (signals.wait) submit.setWaitSemaphores(signals.wait).setWaitDstStageMask(stage);
    if (signals.done) submit.setSignalSemaphores(signals.done);
    const vk::CommandBuffer recorded = *commands_;
    submit.setCommandBuffers(recorded);
    device_.queue().submit(submit, *fence_);
    pending_ = true;
}

ScreenPicture Canvas::read() {
    device_.handle().waitIdle();
    const std::size_t bytes = 4 * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
    const edgesplat::gpu::Buffer buffer(device_, bytes, edgesplat::gpu::Buffer::Place::Host, "screenshot");
    auto buffers = vk::raii::CommandBuffers(device_.handle(),
                                            vk::CommandBufferAllocateInfo(*pool_, vk::CommandBufferLevel::ePrimary, 1));
    const auto& commands = buffers.front();
    commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
    const vk::BufferImageCopy copy(0, 0, 0, kWhole, {0, 0, 0},
                                   {static_cast<std::uint32_t>(size_.x), static_cast<std::uint32_t>(size_.y), 1});
    commands.copyImageToBuffer(image_.handle(), vk::ImageLayout::eGeneral, buffer.handle(), copy);
    const vk::MemoryBarrier2 visible(vk::PipelineStageFlagBits2::eTransfer, vk::AccessFlagBits2::eTransferWrite,
                                     vk::PipelineStageFlagBits2::eHost, vk::AccessFlagBits2::eHostRead);
    commands.pipelineBarrier2(vk::DependencyInfo({}, visible));
    commands.end();
    const vk::CommandBuffer recorded = *commands;
    device_.queue().submit(vk::SubmitInfo({}, {}, recorded));
    device_.queue().waitIdle();
    ScreenPicture out{size_.x, size_.y, {}};
    const auto mapped = buffer.mapped<std::uint8_t>(bytes);
    out.pixels.assign(mapped.begin(), mapped.end());
    return out;
}
