// The window's swapchain: acquires images, paints and presents them. It is recreated when the window changes.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vulkan/vulkan_raii.hpp>

#include "engine/gpu/device.h"

struct GLFWwindow;

class Surface {
  public:
    /// Throws Error if the device cannot draw to windows.
    Surface(const edgesplat::gpu::Device& device, GLFWwindow* window);
    ~Surface();
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;

    /// The next image, for content of that size; nullopt if there is none (minimised, just resized).
    struct Target {
        std::uint32_t index = 0;
        vk::Semaphore free, painted;
    };
    std::optional<Target> acquire(const glm::ivec2& size);
    /// Records the copy of `canvas` (layout GENERAL, `size` pixels) into the image.
    void record(const vk::raii::CommandBuffer& commands, const Target& target, vk::Image canvas,
                const glm::ivec2& size) const;
    void present(const Target& target);

  private:
    void make_swapchain(const glm::ivec2& size);
    void make_surface();

    const edgesplat::gpu::Device& device_;
    GLFWwindow* window_;
    vk::raii::SurfaceKHR surface_ = nullptr;
    vk::raii::SwapchainKHR swapchain_ = nullptr;
    std::vector<vk::Image> images_;
    std::vector<vk::raii::Semaphore> painted_;  ///< one per image: in use until the image is acquired again
    vk::raii::Semaphore free_ = nullptr;
    glm::ivec2 extent_{0};
    bool outdated_ = true;
};
