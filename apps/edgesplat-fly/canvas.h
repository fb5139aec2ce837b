// What the window's content is painted on: pictures first, the panels over them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/gpu/buffer.h"
#include "engine/gpu/image.h"
#include "engine/viewer/display.h"

struct ImDrawData;

/// A picture on the device, as large as it was made for or smaller.
class CanvasPicture {
  public:
    /// What is to be shown from the next frame on.
    void set(edgesplat::viewer::ScreenPicture picture);
    bool empty() const { return size_ == glm::ivec2(0); }
    glm::ivec2 size() const { return size_; }

  private:
    friend class Canvas;
    edgesplat::viewer::ScreenPicture next_;
    bool fresh_ = false;
    glm::ivec2 size_{0};
    edgesplat::gpu::GpuImage image_;
    edgesplat::gpu::Buffer staging_;
};

/// A part of a picture: left, top, right, bottom, within it.
edgesplat::viewer::ScreenPicture part_of(const edgesplat::viewer::ScreenPicture& picture, const glm::ivec4& part);

/// A part of a picture, and where it is shown; both as low and high corners in pixels.
struct Placed {
    CanvasPicture* picture = nullptr;
    glm::dvec4 part{0, 0, 1, 1};  ///< shares of the picture's width and height
    glm::ivec4 at{0};             ///< pixels of the canvas
};

/// An image that Dear ImGui draws into. One frame is in flight at a time.
class Canvas {
  public:
    explicit Canvas(const edgesplat::gpu::Device& device);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// Throws Error where the device cannot do that.
    void resize(const glm::ivec2& size);
    glm::ivec2 size() const { return size_; }

    /// Waits for the frame before; ImGui's fonts are brought there with the first one.
    void begin();
    /// Paints the pictures in their order, then the panels. `finish` records what becomes of the image, and `signals`
    /// says what the submission waits for and signals.
    struct Signals {
        vk::Semaphore wait, done;
    };
    void end(const std::vector<Placed>& pictures, ImDrawData* panels, const Signals& signals = {},
             const std::function<void(const vk::raii::CommandBuffer&, vk::Image)>& finish = {});
    /// The frame just ended.
    edgesplat::viewer::ScreenPicture read();

  private:
    void upload(CanvasPicture& picture);
    void paint(const Placed& placed);
    void barrier();

    const edgesplat::gpu::Device& device_;
    glm::ivec2 size_{0};
    edgesplat::gpu::GpuImage image_;
    vk::raii::RenderPass pass_ = nullptr;
    vk::raii::Framebuffer framebuffer_ = nullptr;
    vk::raii::DescriptorPool descriptors_ = nullptr;
    vk::raii::CommandPool pool_ = nullptr;
    vk::raii::CommandBuffer commands_ = nullptr;
    vk::raii::Fence fence_ = nullptr;
    bool fonts_ = false, pending_ = false, prepared_ = false;
};
