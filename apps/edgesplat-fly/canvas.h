// The image of the window's content: pictures first, panels over them.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/gpu/buffer.h"
#include "engine/gpu/image.h"
#include "engine/viewer/display.h"

struct ImDrawData;

/// A picture on the device.
class CanvasPicture {
  public:
    /// Sets the picture that is shown from the next frame on.
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

/// A copy of a part of a picture: left, top, right, bottom, within it.
edgesplat::viewer::ScreenPicture part_of(const edgesplat::viewer::ScreenPicture& picture, const glm::ivec4& part);

/// A part of a picture, and its place on the canvas; both as low and high corners.
struct Placed {
    CanvasPicture* picture = nullptr;
    glm::dvec4 part{0, 0, 1, 1};  ///< shares of the picture's width and height
    glm::ivec4 at{0};             ///< pixels of the canvas
};

/// An image that Dear ImGui draws into. At most one frame is in flight.
class Canvas {
  public:
    explicit Canvas(const edgesplat::gpu::Device& device);
    ~Canvas();
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;

    /// Throws Error if the device cannot create the image.
    void resize(const glm::ivec2& size);
    glm::ivec2 size() const { return size_; }

    /// Waits for the previous frame. The first call uploads ImGui's fonts.
    void begin();
    /// Paints the pictures in order, then the panels. `finish` records commands that use the image. `signals`: the
    /// semaphores that the submission waits for and signals.
    struct Signals {
        vk::Semaphore wait, done;
    };
    void end(const std::vector<Placed>& pictures, ImDrawData* panels, const Signals& signals = {},
             const std::function<void(const vk::raii::CommandBuffer&, vk::Image)>& finish = {});
    /// The last frame.
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
