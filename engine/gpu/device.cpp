#include "engine/gpu/device.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <string>

#include "engine/error.h"
#include "shaders/shared/bindings.h"

namespace edgesplat::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<ValidationLog*>(user)->add(
        (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0 ? "error" : "warning", data->pMessage);
    return VK_FALSE;
}

// Performance messages are off: images stay in layout GENERAL on purpose (see Commands). General messages are off, too:
// they are the loader's, about the machine's drivers and layers, not about this program.
// The C struct is used because Vulkan-Hpp changed its callback type and deprecates the old one.
vk::DebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog* log) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = &on_message;
    info.pUserData = log;
    return info;
}

using Features = vk::StructureChain<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                    vk::PhysicalDeviceVulkan13Features>;

/// One device feature that every frame needs.
struct Need {
    const char* name;
    const char* reason;
    vk::Bool32& (*field)(Features&);
};

const Need kNeeds[] = {
    {"shaderStorageImageExtendedFormats", "the edge field is an rg32ui image",
     [](Features& f) -> vk::Bool32& {
         return f.get<vk::PhysicalDeviceFeatures2>().features.shaderStorageImageExtendedFormats;
     }},
    {"bufferDeviceAddress", "splat lists are larger than one storage buffer binding",
     [](Features& f) -> vk::Bool32& { return f.get<vk::PhysicalDeviceVulkan12Features>().bufferDeviceAddress; }},
    {"scalarBlockLayout", "C++ and shaders share their structs",
     [](Features& f) -> vk::Bool32& { return f.get<vk::PhysicalDeviceVulkan12Features>().scalarBlockLayout; }},
    {"synchronization2", "barriers are vkCmdPipelineBarrier2",
     [](Features& f) -> vk::Bool32& { return f.get<vk::PhysicalDeviceVulkan13Features>().synchronization2; }},
    {"maintenance4", "workgroup sizes are given by id",
     [](Features& f) -> vk::Bool32& { return f.get<vk::PhysicalDeviceVulkan13Features>().maintenance4; }},
    {"dynamicRendering", "draws use no render pass objects",
     [](Features& f) -> vk::Bool32& { return f.get<vk::PhysicalDeviceVulkan13Features>().dynamicRendering; }},
};

/// Why sheets cannot be layers of a target; empty if they can.
std::string layers_obstacle(const vk::raii::PhysicalDevice& physical) {
    const auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features>();
    if (features.get<vk::PhysicalDeviceVulkan12Features>().shaderOutputLayer != VK_TRUE)
        return "no shaderOutputLayer (each sheet is a layer of the target)";
    const auto blends = physical.getFormatProperties(vk::Format::eR32G32B32A32Sfloat).optimalTilingFeatures;
    if (!(blends & vk::FormatFeatureFlagBits::eColorAttachmentBlend)) return "no blending to RGBA32F targets (sheets)";
    return "";
}

std::optional<std::uint32_t> find_queue_family(const vk::raii::PhysicalDevice& physical) {
    const auto families = physical.getQueueFamilyProperties();
    constexpr auto wanted = vk::QueueFlagBits::eGraphics | vk::QueueFlagBits::eCompute;
    for (std::uint32_t i = 0; i < families.size(); ++i) {
        if ((families[i].queueFlags & wanted) == wanted) return i;
    }
    return std::nullopt;
}

/// Physical devices in order of rank_of(), lowest rank first; devices of equal rank keep the loader's order.
std::vector<vk::raii::PhysicalDevice> sorted_devices(const vk::raii::Instance& instance) {
    auto devices = instance.enumeratePhysicalDevices();
    std::vector<vk::raii::PhysicalDevice> sorted;
    for (int r = 0; r <= kWorstRank; ++r) {
        for (auto& device : devices) {
            if (*device && rank_of(device.getProperties()) == r) sorted.push_back(device);
        }
    }
    return sorted;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

double mebibytes(std::uint64_t bytes) {
    return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

bool matches(const DeviceInfo& info, const std::string& choice) {
    if (choice.empty()) return true;
    if (std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) {
        return choice == std::to_string(info.index);
    }
    return lower(info.name).find(lower(choice)) != std::string::npos ||
           lower(info.driver).find(lower(choice)) != std::string::npos;
}

}  // namespace

void ValidationLog::add(const char* severity, const char* message) {
    ++messages;
    std::fprintf(stderr, "vulkan %s: %s\n", severity, message);
}

vk::raii::Instance create_instance(const vk::raii::Context& context, bool validation, ValidationLog* log,
                                   std::vector<const char*> extensions) {
    const vk::ApplicationInfo application("edgesplat", 1, "edgesplat", 1, VK_API_VERSION_1_3);
    std::vector<const char*> layers;
    if (validation) {
        const auto present = context.enumerateInstanceLayerProperties();
        if (std::none_of(present.begin(), present.end(), [](const vk::LayerProperties& layer) {
                return std::string(layer.layerName.data()) == kValidationLayer;
            })) {
            fail("validation is on, but the layer {} is not installed (Debian package: vulkan-validationlayers)",
                 kValidationLayer);
        }
        layers.push_back(kValidationLayer);
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    const auto synchronization = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
    vk::ValidationFeaturesEXT features(synchronization);
    auto messenger = messenger_info(log);
    features.pNext = &messenger;
    vk::InstanceCreateInfo info({}, &application, layers, extensions);
    if (validation) info.pNext = &features;
    try {
        return {context, info};
    } catch (const vk::SystemError& error) {
        fail(
            "no Vulkan instance could be created ({}); a driver is needed (software driver on Debian: "
            "mesa-vulkan-drivers)",
            error.what());
    }
}

DeviceInfo describe(const vk::raii::PhysicalDevice& physical, int index, const std::string& profile) {
    const auto chain = physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const auto& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
    const std::uint32_t api = properties.apiVersion;
    DeviceInfo info;
    info.index = index;
    info.name = properties.deviceName.data();
    info.type = vk::to_string(properties.deviceType);
    info.is_processor = gpu::is_processor(properties);
    const ChosenProfile chosen = choose_profile(properties, profile);
    info.profile = chosen.profile->name;
    info.profile_reason = chosen.reason;
    info.driver = driver.driverName.data();
    info.driver_version = driver.driverInfo.data();
    info.api_version =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api), VK_API_VERSION_PATCH(api));

    if (api < VK_API_VERSION_1_3) {
        info.rejections.push_back(fmt::format("Vulkan {}, 1.3 is needed", info.api_version));
        return info;
    }
    const auto features = physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan12Features,
                                                vk::PhysicalDeviceVulkan13Features>();
    Features have = features;
    for (const Need& need : kNeeds) {
        if (need.field(have) != VK_TRUE) info.rejections.push_back(fmt::format("no {} ({})", need.name, need.reason));
    }
    if (!find_queue_family(physical)) info.rejections.emplace_back("no queue that does graphics and compute");
    const auto subgroups =
        physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceSubgroupProperties>()
            .get<vk::PhysicalDeviceSubgroupProperties>();
    for (std::string& reason : exceeds_limits(properties.limits, subgroups))
        info.rejections.push_back(std::move(reason));
    return info;
}

std::vector<std::string> exceeds_limits(const vk::PhysicalDeviceLimits& limits,
                                        const vk::PhysicalDeviceSubgroupProperties& subgroups) {
    std::vector<std::string> reasons;
    // Every stage sees the whole descriptor set; texel buffers count as storage images.
    constexpr std::uint32_t kSampled = shader::BIND_SCENE - shader::BIND_SHEETS;
    constexpr std::uint32_t kBlocks = shader::BIND_PICTURE - shader::BIND_SCENE;
    constexpr std::uint32_t kStored = shader::BIND_COUNT - kSampled - kBlocks;
    const auto need = [&](const char* name, std::uint32_t have, std::uint32_t wanted) {
        if (have < wanted) reasons.push_back(fmt::format("{} is {}, {} are needed", name, have, wanted));
    };
    need("maxPerStageDescriptorStorageImages", limits.maxPerStageDescriptorStorageImages, kStored);
    need("maxDescriptorSetStorageImages", limits.maxDescriptorSetStorageImages, kStored);
    need("maxPerStageDescriptorSampledImages", limits.maxPerStageDescriptorSampledImages, kSampled);
    need("maxPerStageDescriptorSamplers", limits.maxPerStageDescriptorSamplers, kSampled);
    need("maxPerStageDescriptorUniformBuffers", limits.maxPerStageDescriptorUniformBuffers, kBlocks);
    need("maxPerStageResources", limits.maxPerStageResources, shader::BIND_COUNT + 1);  // and a colour target
    using Feature = vk::SubgroupFeatureFlagBits;
    const vk::SubgroupFeatureFlags operations = Feature::eBasic | Feature::eArithmetic | Feature::eBallot;
    if (!(subgroups.supportedStages & vk::ShaderStageFlagBits::eCompute))
        reasons.emplace_back("no subgroups in compute shaders (sums and lists of a workgroup)");
    const vk::SubgroupFeatureFlags missing = operations & ~subgroups.supportedOperations;
    if (missing) reasons.push_back(fmt::format("no subgroup operations {} (sums, lists)", vk::to_string(missing)));
    return reasons;
}

Device::Device(const DeviceChoice& choice, const DeviceExtensions& extensions) {
    instance_ = create_instance(context_, choice.validation, log_.get(), extensions.instance);
    if (choice.validation) messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, messenger_info(log_.get()));

    std::string seen;
    int index = 0;
    for (auto& candidate : sorted_devices(instance_)) {
        DeviceInfo info = describe(candidate, index++, choice.profile);
        std::string verdict = info.rejections.empty() ? "usable" : "rejected:";
        for (const auto& rejection : info.rejections)
            verdict += " " + rejection + ";";
        seen += fmt::format("\n  {}: {} ({}): {}", info.index, info.name, info.driver, verdict);
        if (!*physical_ && info.rejections.empty() && matches(info, choice.device)) {
            physical_ = std::move(candidate);
            info_ = std::move(info);
        }
    }
    if (!*physical_) {
        if (seen.empty())
            fail("no Vulkan device found; a driver is needed (software driver on Debian: mesa-vulkan-drivers)");
        fail("no usable Vulkan device{}:{}", choice.device.empty() ? "" : " matches --device " + choice.device, seen);
    }

    profile_ = &profile_named(info_.profile);
    // 8192 x 8192 pixels.
    constexpr std::uint32_t kTexels = 1U << 26U;
    loads_texels_ = profile_->texels && physical_.getProperties().limits.maxTexelBufferElements >= kTexels;
    queue_family_ = *find_queue_family(physical_);
    const bool timestamps = physical_.getQueueFamilyProperties()[queue_family_].timestampValidBits > 0;
    timestamp_period_ = timestamps ? static_cast<double>(physical_.getProperties().limits.timestampPeriod) : 0.0;

    Features enabled;
    for (const Need& need : kNeeds)
        need.field(enabled) = VK_TRUE;
    layers_obstacle_ = gpu::layers_obstacle(physical_);
    enabled.get<vk::PhysicalDeviceVulkan12Features>().shaderOutputLayer = layers_obstacle_.empty() ? VK_TRUE : VK_FALSE;
    const auto optional = physical_.getFeatures();
    counts_draws_ = optional.pipelineStatisticsQuery == VK_TRUE && optional.occlusionQueryPrecise == VK_TRUE;
    auto& features = enabled.get<vk::PhysicalDeviceFeatures2>().features;
    features.setPipelineStatisticsQuery(counts_draws_ ? VK_TRUE : VK_FALSE);
    features.setOcclusionQueryPrecise(counts_draws_ ? VK_TRUE : VK_FALSE);
    const float priority = 1.0F;
    const vk::DeviceQueueCreateInfo queue_info({}, queue_family_, 1, &priority);
    vk::DeviceCreateInfo device_info({}, queue_info, {}, extensions.device);
    device_info.pNext = &enabled.get<vk::PhysicalDeviceFeatures2>();
    device_ = vk::raii::Device(physical_, device_info);
    queue_ = device_.getQueue(queue_family_, 0);
    memory_ = physical_.getMemoryProperties();
    guards_buffers_ = choice.validation &&
                      std::all_of(memory_.memoryTypes.begin(), memory_.memoryTypes.begin() + memory_.memoryTypeCount,
                                  [](const vk::MemoryType& type) {
                                      return bool(type.propertyFlags & vk::MemoryPropertyFlagBits::eHostVisible);
                                  });
    const auto known = physical_.enumerateDeviceExtensionProperties();
    has_memory_budget_ = std::ranges::any_of(known, [](const vk::ExtensionProperties& e) {
        return std::string_view(e.extensionName.data()) == VK_EXT_MEMORY_BUDGET_EXTENSION_NAME;
    });
}

void Device::count_bytes(const std::string& name, std::int64_t change) const {
    for (Allocation* counted : {&(*allocations_)[name], &(*allocations_)[kTotal]}) {
        counted->bytes += static_cast<std::uint64_t>(change);
        counted->peak = std::max(counted->peak, counted->bytes);
    }
}

void Device::forget_peaks() const {
    std::erase_if(*allocations_, [](const auto& entry) { return entry.second.bytes == 0 && entry.first != kTotal; });
    for (auto& [name, allocation] : *allocations_)
        allocation.peak = allocation.bytes;
}

std::optional<std::uint32_t> Device::memory_type(std::uint32_t allowed, vk::MemoryPropertyFlags wanted,
                                                 vk::MemoryPropertyFlags needed) const {
    for (const auto flags : {wanted | needed, needed}) {
        for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
            if ((allowed >> i & 1U) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
        }
    }
    return std::nullopt;
}

void Device::report(const std::string& message) const {
    log_->add("error", message.c_str());
}

std::uint32_t Device::heap_of(bool host) const {
    using Memory = vk::MemoryPropertyFlagBits;
    const auto type = host ? memory_type(~0U, Memory::eHostCached, Memory::eHostVisible | Memory::eHostCoherent)
                           : memory_type(~0U, Memory::eDeviceLocal, {});
    return memory_.memoryTypes[type.value_or(0)].heapIndex;
}

std::uint64_t Device::free_bytes(std::uint32_t heap) const {
    if (has_memory_budget_) {
        const auto chain = physical_.getMemoryProperties2<vk::PhysicalDeviceMemoryProperties2,
                                                          vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
        const auto& budget = chain.get<vk::PhysicalDeviceMemoryBudgetPropertiesEXT>();
        return budget.heapBudget[heap] - std::min(budget.heapBudget[heap], budget.heapUsage[heap]);
    }
    return memory_.memoryHeaps[heap].size - std::min<std::uint64_t>(memory_.memoryHeaps[heap].size, allocated_bytes());
}

std::uint64_t Device::largest_allocation() const {
    const auto limits =
        physical_.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceMaintenance3Properties>();
    return limits.get<vk::PhysicalDeviceMaintenance3Properties>().maxMemoryAllocationSize;
}

vk::raii::DeviceMemory Device::allocate(const vk::MemoryRequirements& requirements, vk::MemoryPropertyFlags wanted,
                                        vk::MemoryPropertyFlags needed, bool device_address, const char* name) const {
    const auto type = memory_type(requirements.memoryTypeBits, wanted, needed);
    if (!type) fail("{}: the device {} has no memory of the type needed", name, info_.name);
    const auto most = largest_allocation();
    if (requirements.size > most) {
        fail("{} needs {} MiB of device memory in one piece; {} allows {} MiB", name, requirements.size >> 20U,
             info_.name, most >> 20U);
    }
    const vk::MemoryAllocateFlagsInfo address(vk::MemoryAllocateFlagBits::eDeviceAddress);
    vk::MemoryAllocateInfo info(requirements.size, *type);
    if (device_address) info.pNext = &address;
    try {
        return {device_, info};
    } catch (const vk::OutOfDeviceMemoryError&) {
        const std::uint32_t heap = memory_.memoryTypes[*type].heapIndex;
        fail(
            "{} needs {:.1f} MiB of device memory, but {} has not enough: {:.1f} MiB are in use here, and {:.1f} MiB "
            "of a heap of {:.1f} MiB should be free; --memory-budget MIB limits the memory of a picture, or suggests "
            "settings that fit, such as a smaller --size",
            name, mebibytes(requirements.size), info_.name, mebibytes(allocated_bytes()), mebibytes(free_bytes(heap)),
            mebibytes(memory_.memoryHeaps[heap].size));
    } catch (const vk::OutOfHostMemoryError&) {
        fail("{} needs {:.1f} MiB of memory; this machine has not enough ({:.1f} MiB are in use here)", name,
             mebibytes(requirements.size), mebibytes(allocated_bytes()));
    }
}

}  // namespace edgesplat::gpu

namespace edgesplat {

std::vector<DeviceInfo> list_devices() {
    std::vector<DeviceInfo> infos;
    const vk::raii::Context context;
    const auto instance = gpu::create_instance(context, false, nullptr);
    for (const auto& device : gpu::sorted_devices(instance))
        infos.push_back(gpu::describe(device, static_cast<int>(infos.size()), ""));
    return infos;
}

}  // namespace edgesplat
