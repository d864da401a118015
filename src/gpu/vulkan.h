#ifndef VERDURE_GPU_VULKAN_H_
#define VERDURE_GPU_VULKAN_H_

// The one place that includes Vulkan-Hpp: costly to compile (see the precompiled header), so only
// the rooms `gpu` and `render` include it, never a public header. The loader is opened at run time.

#define VULKAN_HPP_NO_STRUCT_CONSTRUCTORS
#define VULKAN_HPP_DISPATCH_LOADER_DYNAMIC 1
#include <vulkan/vulkan_raii.hpp>

#endif  // VERDURE_GPU_VULKAN_H_
