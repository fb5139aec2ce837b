// A Vulkan layer for tests: makes the N-th call of a kind fail, so that the real program's reaction can be tested.
// Enabled by VK_LAYER_PATH (or VK_ADD_LAYER_PATH) and VK_INSTANCE_LAYERS, controlled by
//   EDGESPLAT_FAULT       allocate | submit | wait | pipeline: calls of vkAllocateMemory (out of device memory);
//                         vkQueueSubmit, vkQueueSubmit2 or vkWaitForFences, vkWaitSemaphores (device lost, after the
//                         work is done: the host must hear of it, lavapipe must not run on); vkCreate*Pipelines (out of
//                         device memory); layers: no device has the feature shaderOutputLayer
//   EDGESPLAT_FAULT_AT    the first call that fails, counted from 1 over all devices; 0: none
//   EDGESPLAT_FAULT_LAST  the last one; by default the first; "ever": all from the first on
//   EDGESPLAT_FAULT_COUNT a file that takes the number of calls when an instance goes
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <string>

namespace {

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value == nullptr ? "" : value;
}

/// The calls that must fail.
struct Fault {
    std::string kind = variable("EDGESPLAT_FAULT");
    long first = std::atol(variable("EDGESPLAT_FAULT_AT").c_str());
    long last = variable("EDGESPLAT_FAULT_LAST") == "ever" ? std::numeric_limits<long>::max()
                : variable("EDGESPLAT_FAULT_LAST").empty() ? first
                                                           : std::atol(variable("EDGESPLAT_FAULT_LAST").c_str());
};

const Fault& fault() {
    static const Fault one;
    return one;
}

std::atomic<long> calls{0};

/// Counts a call of this kind; true if it must fail.
bool fails(const char* kind) {
    if (fault().kind != kind) return false;
    const long call = ++calls;
    return fault().first > 0 && call >= fault().first && call <= fault().last;
}

/// Functions of the next layer. The key is the dispatch table that an instance, or a device and its queues, share.
struct Next {
    PFN_vkGetInstanceProcAddr instance = nullptr;
    PFN_vkGetDeviceProcAddr device = nullptr;
    void* handle = nullptr;
    // Stored, since the loader would later return this layer's own functions.
    PFN_vkDestroyInstance destroy = nullptr;
    PFN_vkGetPhysicalDeviceFeatures2 features = nullptr;
};
std::mutex next_mutex;
std::map<void*, Next> next_of;

template <typename Handle>
void* key_of(Handle handle) {
    return *reinterpret_cast<void**>(handle);
}

template <typename Handle>
Next next(Handle handle) {
    const std::lock_guard lock(next_mutex);
    return next_of.at(key_of(handle));
}

template <typename Function, typename Handle>
Function of_device(Handle handle, const char* name) {
    const Next found = next(handle);
    return reinterpret_cast<Function>(found.device(static_cast<VkDevice>(found.handle), name));
}

template <typename Info>
Info* link_info(const void* chain, VkStructureType type) {
    for (auto* info = static_cast<const Info*>(chain); info != nullptr; info = static_cast<const Info*>(info->pNext))
        if (info->sType == type && info->function == VK_LAYER_LINK_INFO) return const_cast<Info*>(info);
    return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
    auto* link = link_info<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    const auto get = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateInstance>(get(VK_NULL_HANDLE, "vkCreateInstance"));
    const VkResult result = create(info, allocator, instance);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(next_mutex);
    next_of[key_of(*instance)] = {
        get, nullptr, *instance, reinterpret_cast<PFN_vkDestroyInstance>(get(*instance, "vkDestroyInstance")),
        reinterpret_cast<PFN_vkGetPhysicalDeviceFeatures2>(get(*instance, "vkGetPhysicalDeviceFeatures2"))};
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_instance(VkInstance instance, const VkAllocationCallbacks* allocator) {
    if (instance == VK_NULL_HANDLE) return;
    const Next found = next(instance);
    {
        const std::lock_guard lock(next_mutex);
        next_of.erase(key_of(instance));
    }
    found.destroy(instance, allocator);
    const std::string file = variable("EDGESPLAT_FAULT_COUNT");
    if (std::FILE* out = file.empty() ? nullptr : std::fopen(file.c_str(), "w")) {
        std::fprintf(out, "%ld\n", calls.load());
        std::fclose(out);
    }
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = link_info<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
    const auto get_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const auto get_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto create = reinterpret_cast<PFN_vkCreateDevice>(
        get_instance(static_cast<VkInstance>(next(physical).handle), "vkCreateDevice"));
    const VkResult result = create(physical, info, allocator, device);
    if (result != VK_SUCCESS) return result;
    const std::lock_guard lock(next_mutex);
    next_of[key_of(*device)] = {get_instance, get_device, *device, nullptr, nullptr};
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroy_device(VkDevice device, const VkAllocationCallbacks* allocator) {
    if (device == VK_NULL_HANDLE) return;
    const auto destroy = of_device<PFN_vkDestroyDevice>(device, "vkDestroyDevice");
    {
        const std::lock_guard lock(next_mutex);
        next_of.erase(key_of(device));
    }
    destroy(device, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL allocate_memory(VkDevice device, const VkMemoryAllocateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
    if (fails("allocate")) return VK_ERROR_OUT_OF_DEVICE_MEMORY;
    return of_device<PFN_vkAllocateMemory>(device, "vkAllocateMemory")(device, info, allocator, memory);
}

/// The device finishes its work, and is lost.
VkResult lost(VkQueue queue) {
    of_device<PFN_vkQueueWaitIdle>(queue, "vkQueueWaitIdle")(queue);
    return VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo* infos,
                                            VkFence fence) {
    if (fails("submit")) return lost(queue);
    return of_device<PFN_vkQueueSubmit>(queue, "vkQueueSubmit")(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL queue_submit_2(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos,
                                              VkFence fence) {
    if (fails("submit")) return lost(queue);
    return of_device<PFN_vkQueueSubmit2>(queue, "vkQueueSubmit2")(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait_for_fences(VkDevice device, std::uint32_t count, const VkFence* fences,
                                               VkBool32 all, std::uint64_t timeout) {
    const VkResult result =
        of_device<PFN_vkWaitForFences>(device, "vkWaitForFences")(device, count, fences, all, timeout);
    return fails("wait") ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL wait_semaphores(VkDevice device, const VkSemaphoreWaitInfo* info,
                                               std::uint64_t timeout) {
    const VkResult result = of_device<PFN_vkWaitSemaphores>(device, "vkWaitSemaphores")(device, info, timeout);
    return fails("wait") ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR void VKAPI_CALL get_features_2(VkPhysicalDevice physical, VkPhysicalDeviceFeatures2* features) {
    next(physical).features(physical, features);
    if (fault().kind != "layers") return;
    for (auto* part = static_cast<VkBaseOutStructure*>(features->pNext); part != nullptr; part = part->pNext)
        if (part->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
            reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(part)->shaderOutputLayer = VK_FALSE;
}

VkResult no_pipelines(std::uint32_t count, VkPipeline* pipelines) {
    std::memset(pipelines, 0, count * sizeof *pipelines);
    return VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

VKAPI_ATTR VkResult VKAPI_CALL create_compute(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                              const VkComputePipelineCreateInfo* infos,
                                              const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
    if (fails("pipeline")) return no_pipelines(count, pipelines);
    return of_device<PFN_vkCreateComputePipelines>(device, "vkCreateComputePipelines")(device, cache, count, infos,
                                                                                       allocator, pipelines);
}

VKAPI_ATTR VkResult VKAPI_CALL create_graphics(VkDevice device, VkPipelineCache cache, std::uint32_t count,
                                               const VkGraphicsPipelineCreateInfo* infos,
                                               const VkAllocationCallbacks* allocator, VkPipeline* pipelines) {
    if (fails("pipeline")) return no_pipelines(count, pipelines);
    return of_device<PFN_vkCreateGraphicsPipelines>(device, "vkCreateGraphicsPipelines")(device, cache, count, infos,
                                                                                         allocator, pipelines);
}

PFN_vkVoidFunction own(const char* name);

}  // namespace

extern "C" {

__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
edgesplat_faults_device(VkDevice device, const char* name) {
    if (const auto function = own(name)) return function;
    return next(device).device(device, name);
}

__attribute__((visibility("default"))) VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL
edgesplat_faults_instance(VkInstance instance, const char* name) {
    if (const auto function = own(name)) return function;
    return instance == VK_NULL_HANDLE ? nullptr : next(instance).instance(instance, name);
}

__attribute__((visibility("default"))) VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = edgesplat_faults_instance;
    version->pfnGetDeviceProcAddr = edgesplat_faults_device;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}

}  // extern "C"

namespace {

PFN_vkVoidFunction own(const char* name) {
    static const std::map<std::string, PFN_vkVoidFunction> functions{
        {"vkGetInstanceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(edgesplat_faults_instance)},
        {"vkGetDeviceProcAddr", reinterpret_cast<PFN_vkVoidFunction>(edgesplat_faults_device)},
        {"vkCreateInstance", reinterpret_cast<PFN_vkVoidFunction>(create_instance)},
        {"vkDestroyInstance", reinterpret_cast<PFN_vkVoidFunction>(destroy_instance)},
        {"vkCreateDevice", reinterpret_cast<PFN_vkVoidFunction>(create_device)},
        {"vkDestroyDevice", reinterpret_cast<PFN_vkVoidFunction>(destroy_device)},
        {"vkGetPhysicalDeviceFeatures2", reinterpret_cast<PFN_vkVoidFunction>(get_features_2)},
        {"vkAllocateMemory", reinterpret_cast<PFN_vkVoidFunction>(allocate_memory)},
        {"vkQueueSubmit", reinterpret_cast<PFN_vkVoidFunction>(queue_submit)},
        {"vkQueueSubmit2", reinterpret_cast<PFN_vkVoidFunction>(queue_submit_2)},
        {"vkWaitForFences", reinterpret_cast<PFN_vkVoidFunction>(wait_for_fences)},
        {"vkWaitSemaphores", reinterpret_cast<PFN_vkVoidFunction>(wait_semaphores)},
        {"vkCreateComputePipelines", reinterpret_cast<PFN_vkVoidFunction>(create_compute)},
        {"vkCreateGraphicsPipelines", reinterpret_cast<PFN_vkVoidFunction>(create_graphics)}};
    const auto found = functions.find(name);
    return found == functions.end() ? nullptr : found->second;
}

}  // namespace
