#include "apps/edgesplat-fly/surface.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <limits>

#include "engine/error.h"

namespace {

using edgesplat::fail;

constexpr std::array<vk::Format, 2> kFormats{vk::Format::eB8G8R8A8Unorm, vk::Format::eR8G8B8A8Unorm};

vk::SurfaceFormatKHR chosen_format(const std::vector<vk::SurfaceFormatKHR>& formats) {
    for (const vk::Format wanted : kFormats)
        for (const vk::SurfaceFormatKHR& format : formats)
            if (format.format == wanted && format.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear) return format;
    fail("window: the screen supports no suitable format (8 bit RGBA or BGRA)");
}

vk::ImageMemoryBarrier2 transition(vk::Image image, vk::ImageLayout from, vk::ImageLayout to) {
    const auto all = vk::PipelineStageFlagBits2::eAllCommands;
    const auto access = vk::AccessFlagBits2::eMemoryRead | vk::AccessFlagBits2::eMemoryWrite;
    // The image's semaphore is waited for at the transfer stage, so the first transition starts at that stage.
    const bool first = from == vk::ImageLayout::eUndefined;
    return {first ? vk::PipelineStageFlagBits2::eTransfer : all,
            first ? vk::AccessFlags2{} : vk::AccessFlags2(access),
            all,
            first ? vk::AccessFlags2(access) : vk::AccessFlags2{},
            from,
            to,
            0,
            0,
            image,
            {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}};
}

}  // namespace

Surface::Surface(const edgesplat::gpu::Device& device, GLFWwindow* window) : device_(device), window_(window) {
    if (glfwGetPhysicalDevicePresentationSupport(*device.instance(), *device.physical(), device.queue_family()) == 0)
        fail("window: {} cannot draw to this screen; choose another --device", device.info().name);
    make_surface();
    free_ = {device.handle(), vk::SemaphoreCreateInfo()};
}

Surface::~Surface() {
    try {
        device_.handle().waitIdle();
    } catch (const vk::SystemError&) {
        // There is no work to wait for on a lost device.
    }
}

void Surface::make_surface() {
    swapchain_ = nullptr;
    surface_ = nullptr;
    VkSurfaceKHR made = VK_NULL_HANDLE;
    const VkResult result = glfwCreateWindowSurface(*device_.instance(), window_, nullptr, &made);
    if (result != VK_SUCCESS)
        fail("window: cannot create a Vulkan surface ({})", vk::to_string(static_cast<vk::Result>(result)));
    surface_ = {device_.instance(), made};
    outdated_ = true;
}

void Surface::make_swapchain(const glm::ivec2& size) {
    device_.handle().waitIdle();
    const auto abilities = device_.physical().getSurfaceCapabilitiesKHR(*surface_);
    vk::Extent2D extent = abilities.currentExtent;
    if (extent.width == std::numeric_limits<std::uint32_t>::max()) {
        extent = vk::Extent2D(static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y));
        extent.width = std::clamp(extent.width, abilities.minImageExtent.width, abilities.maxImageExtent.width);
        extent.height = std::clamp(extent.height, abilities.minImageExtent.height, abilities.maxImageExtent.height);
    }
    extent_ = {static_cast<int>(extent.width), static_cast<int>(extent.height)};
    if (extent.width == 0 || extent.height == 0) return;
    if (!(abilities.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferDst))
        fail("window: the screen does not allow copies to its images");
    const vk::SurfaceFormatKHR format = chosen_format(device_.physical().getSurfaceFormatsKHR(*surface_));
    std::uint32_t count = abilities.minImageCount + 1;
    if (abilities.maxImageCount > 0) count = std::min(count, abilities.maxImageCount);
    vk::SwapchainCreateInfoKHR info({}, *surface_, count, format.format, format.colorSpace, extent, 1,
                                    vk::ImageUsageFlagBits::eTransferDst);
    info.preTransform = abilities.currentTransform;
    info.presentMode = vk::PresentModeKHR::eFifo;
    info.clipped = VK_TRUE;
    info.oldSwapchain = *swapchain_;
    vk::raii::SwapchainKHR made(device_.handle(), info);
    swapchain_ = std::move(made);
    images_.clear();
    for (const auto image : swapchain_.getImages())
        images_.emplace_back(image);
    painted_.clear();
    for (std::size_t i = 0; i < images_.size(); ++i)
        painted_.emplace_back(device_.handle(), vk::SemaphoreCreateInfo());
    free_ = {device_.handle(), vk::SemaphoreCreateInfo()};
    outdated_ = false;
}

std::optional<Surface::Target> Surface::acquire(const glm::ivec2& size) {
    if (size.x < 1 || size.y < 1) return std::nullopt;
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            if (outdated_ || extent_ != size) make_swapchain(size);
            if (extent_.x < 1 || extent_.y < 1) return std::nullopt;
            const auto [result, index] = swapchain_.acquireNextImage(std::numeric_limits<std::uint64_t>::max(), *free_);
            outdated_ = result == vk::Result::eSuboptimalKHR;
            return Target{index, *free_, *painted_[index]};
        } catch (const vk::OutOfDateKHRError&) {
            outdated_ = true;
        } catch (const vk::SurfaceLostKHRError&) {
            make_surface();
        }
    }
    return std::nullopt;
}

void Surface::record(const vk::raii::CommandBuffer& commands, const Target& target, vk::Image canvas,
                     const glm::ivec2& size) const {
    const vk::Image image = images_[target.index];
    const auto open = transition(image, vk::ImageLayout::eUndefined, vk::ImageLayout::eTransferDstOptimal);
    commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, open));
    constexpr vk::ImageSubresourceLayers kWhole(vk::ImageAspectFlagBits::eColor, 0, 0, 1);
    const vk::Offset3D none(0, 0, 0);
    const vk::ImageBlit blit(kWhole, {none, vk::Offset3D(size.x, size.y, 1)}, kWhole,
                             {none, vk::Offset3D(extent_.x, extent_.y, 1)});
    commands.blitImage(canvas, vk::ImageLayout::eGeneral, image, vk::ImageLayout::eTransferDstOptimal, blit,
                       vk::Filter::eNearest);
    const auto shown = transition(image, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::ePresentSrcKHR);
    commands.pipelineBarrier2(vk::DependencyInfo({}, {}, {}, shown));
}

void Surface::present(const Target& target) {
    const vk::PresentInfoKHR info(target.painted, *swapchain_, target.index);
    try {
        if (device_.queue().presentKHR(info) == vk::Result::eSuboptimalKHR) outdated_ = true;
    } catch (const vk::OutOfDateKHRError&) {
        outdated_ = true;
    } catch (const vk::SurfaceLostKHRError&) {
        make_surface();
    }
}
