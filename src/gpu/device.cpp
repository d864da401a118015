#include "gpu/device.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <limits>

#include "verdure/error.h"

namespace verdure::gpu {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kInstallDriver = "install a driver (Debian: mesa-vulkan-drivers)";

std::string lowered(std::string text) {
  for (char& c : text) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return text;
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data,
                                         void* count) {
  ++*static_cast<std::atomic<int>*>(count);
  std::fprintf(stderr, "Vulkan validation: %s\n", data->pMessage);
  return VK_FALSE;
}

bool hasSwapchains(const vk::raii::PhysicalDevice& physical) {
  const auto present = physical.enumerateDeviceExtensionProperties();
  return std::any_of(present.begin(), present.end(), [](const vk::ExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
  });
}

/// Why a device cannot be used; empty = it can.
std::string unfit(const vk::raii::PhysicalDevice& physical, bool window) {
  if (physical.getProperties().apiVersion < VK_API_VERSION_1_3) return "has no Vulkan 1.3";
  const auto features =
      physical.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>();
  const auto& v13 = features.get<vk::PhysicalDeviceVulkan13Features>();
  if (!v13.dynamicRendering || !v13.synchronization2)
    return "lacks dynamic rendering or synchronization2";
  if (!physical.getFeatures().drawIndirectFirstInstance)
    return "lacks a first instance of indirect draws";
  if (window && !hasSwapchains(physical)) return "shows nothing in windows";
  return "";
}

}  // namespace

struct Device::Messages {
  std::atomic<int> count = 0;
};

Device::Device(const std::string& name, bool validation, const WindowSurface* window)
    : messages_(std::make_unique<Messages>()) {
  try {
    context_ = std::make_unique<vk::raii::Context>();
  } catch (const std::runtime_error&) {
    throw Error("Vulkan", "no Vulkan loader (libvulkan.so.1)",
                "install it (Debian: libvulkan1 mesa-vulkan-drivers)");
  }
  const vk::ApplicationInfo application{.pApplicationName = "verdure",
                                        .apiVersion = VK_API_VERSION_1_3};
  std::vector<const char*> layers, extensions;
  if (validation) {
    const auto present = context_->enumerateInstanceLayerProperties();
    if (std::none_of(present.begin(), present.end(), [](const vk::LayerProperties& layer) {
          return std::strcmp(layer.layerName, kValidationLayer) == 0;
        }))
      throw Error("Vulkan", "the validation layer is missing",
                  "install it (Debian: vulkan-validationlayers) or turn validation off");
    layers.push_back(kValidationLayer);
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  }
  if (window != nullptr)
    for (const std::string& extension : window->instance_extensions)
      extensions.push_back(extension.c_str());
  using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
  using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
  const vk::DebugUtilsMessengerCreateInfoEXT messenger{
      .messageSeverity = Severity::eWarning | Severity::eError,
      .messageType = Type::eValidation,
      .pfnUserCallback = &onMessage,
      .pUserData = &messages_->count};
  const auto sync = vk::ValidationFeatureEnableEXT::eSynchronizationValidation;
  const vk::ValidationFeaturesEXT checks{
      .pNext = &messenger, .enabledValidationFeatureCount = 1, .pEnabledValidationFeatures = &sync};
  try {
    instance_ = vk::raii::Instance(
        *context_, vk::InstanceCreateInfo{
                       .pNext = validation ? &checks : nullptr,
                       .pApplicationInfo = &application,
                       .enabledLayerCount = static_cast<std::uint32_t>(layers.size()),
                       .ppEnabledLayerNames = layers.data(),
                       .enabledExtensionCount = static_cast<std::uint32_t>(extensions.size()),
                       .ppEnabledExtensionNames = extensions.data()});
  } catch (const vk::SystemError& e) {
    throw Error("Vulkan", std::string("no Vulkan device: no driver starts (") + e.what() + ")",
                kInstallDriver);
  }
  if (validation) messenger_ = vk::raii::DebugUtilsMessengerEXT(instance_, messenger);
  if (window != nullptr) surface_ = vk::raii::SurfaceKHR(instance_, window->make(*instance_));
  chooseDevice(name);

  const float priority = 1.0f;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = family_, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::PhysicalDeviceFeatures available = physical_.getFeatures();
  const vk::PhysicalDeviceFeatures features{.fullDrawIndexUint32 = available.fullDrawIndexUint32,
                                            .drawIndirectFirstInstance = true,
                                            .samplerAnisotropy = available.samplerAnisotropy};
  // Software drivers walk every texel of a footprint: minutes for ground seen at a grazing angle.
  const bool software = physical_.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
  if (features.samplerAnisotropy && !software) max_anisotropy_ = limits_.maxSamplerAnisotropy;
  const vk::PhysicalDeviceVulkan13Features v13{.synchronization2 = true, .dynamicRendering = true};
  const char* const swapchains = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  device_ = vk::raii::Device(
      physical_, vk::DeviceCreateInfo{.pNext = &v13,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = window != nullptr ? 1u : 0u,
                                      .ppEnabledExtensionNames = &swapchains,
                                      .pEnabledFeatures = &features});
  queue_ = device_.getQueue(family_, 0);
  pool_ = vk::raii::CommandPool(
      device_, vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eTransient,
                                         .queueFamilyIndex = family_});
  memory_ = std::make_unique<MemoryPool>(physical_, device_);
}

Device::~Device() = default;

void Device::chooseDevice(const std::string& name) {
  std::string seen;
  int best_rank = -1;
  for (vk::raii::PhysicalDevice& physical : vk::raii::PhysicalDevices(instance_)) {
    const vk::PhysicalDeviceProperties properties = physical.getProperties();
    const std::string device_name = properties.deviceName;
    const bool window = *surface_ != vk::SurfaceKHR();
    std::string reason = unfit(physical, window);
    const auto families = physical.getQueueFamilyProperties();
    const auto fits = [&](const vk::QueueFamilyProperties& family) {
      const auto index = static_cast<std::uint32_t>(&family - families.data());
      return bool(family.queueFlags & vk::QueueFlagBits::eGraphics) &&
             (!window || physical.getSurfaceSupportKHR(index, *surface_));
    };
    const auto graphics = std::find_if(families.begin(), families.end(), fits);
    if (reason.empty() && graphics == families.end())
      reason = window ? "cannot draw to this window" : "has no graphics queue";
    if (reason.empty() && lowered(device_name).find(lowered(name)) == std::string::npos)
      reason = "is not called so";
    if (!reason.empty()) {
      seen += (seen.empty() ? "" : ", ") + device_name + " " + reason;
      continue;
    }
    const auto type = properties.deviceType;
    const int rank = type == vk::PhysicalDeviceType::eDiscreteGpu     ? 3
                     : type == vk::PhysicalDeviceType::eIntegratedGpu ? 2
                     : type == vk::PhysicalDeviceType::eVirtualGpu    ? 1
                                                                      : 0;
    if (rank <= best_rank) continue;
    best_rank = rank;
    family_ = static_cast<std::uint32_t>(graphics - families.begin());
    limits_ = properties.limits;
    name_ = device_name;
    physical_ = std::move(physical);
  }
  if (best_rank >= 0) return;
  if (seen.empty()) throw Error("Vulkan", "no Vulkan device: no driver lists any", kInstallDriver);
  throw Error("Vulkan",
              "no Vulkan device" + (name.empty() ? "" : " \"" + name + "\"") + ": " + seen,
              name.empty() ? kInstallDriver : "choose one of those, or none");
}

int Device::validationMessages() const {
  return messages_->count;
}

void Device::submit(const std::function<void(const vk::raii::CommandBuffer&)>& record) const {
  const vk::raii::CommandBuffers buffers(
      device_, vk::CommandBufferAllocateInfo{.commandPool = *pool_,
                                             .level = vk::CommandBufferLevel::ePrimary,
                                             .commandBufferCount = 1});
  const vk::raii::CommandBuffer& commands = buffers[0];
  commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
  record(commands);
  commands.end();
  const vk::raii::Fence fence = device_.createFence({});
  const vk::CommandBufferSubmitInfo info{.commandBuffer = *commands};
  queue_.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &info},
                 *fence);
  if (device_.waitForFences({*fence}, true, std::numeric_limits<std::uint64_t>::max()) !=
      vk::Result::eSuccess)
    throw Error("Vulkan", "the GPU did not finish", "try a smaller scene");
}

}  // namespace verdure::gpu
