// Declares the GPU as the rest of limn uses it: the function table, the limits, and counts of all live
// objects.
#pragma once

#include <cstdint>

#include "core/base/export.h"
#include "core/context/context.h"

namespace limn::gpu {

struct Limits {
  int maxTextureSize = 0;
  int max3dTextureSize = 0;
  int maxCubeMapSize = 0;
  int maxArrayLayers = 0;
  int maxColourAttachments = 0;
  int64_t maxStorageBlockBytes = 0;
  int maxUniformBlockBytes = 0;
  int maxSharedMemoryBytes = 0;
  int uniformAlignment = 0;
  bool layerFromVertexShader = false;  ///< ARB_shader_viewport_layer_array or AMD_vertex_shader_layer
};

/// Counts live objects and their bytes. Tests compare the counts before and after to check that nothing leaks
/// and that a left-out pass allocates nothing.
struct Counters {
  int buffers = 0, textures = 0, framebuffers = 0, programs = 0, queries = 0, samplers = 0, vertexArrays = 0;
  int programsCompiled = 0;  ///< all since the start, not only live ones
  int64_t bufferBytes = 0, textureBytes = 0;
  bool operator==(const Counters&) const = default;
};

/// Wraps a context. It must outlive every GPU object made with it and be destroyed before the context. It
/// sets state that nothing else changes: pixel rows tightly packed, seamless cube maps on, sRGB encoding of
/// framebuffers and dithering off. An object is destroyed in its own context, which is made current for that
/// where it is not.
class LIMN_API Device {
 public:
  explicit Device(Context& context);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Context& context() const { return context_; }
  const gl::Functions& gl() const { return context_.gl(); }
  const Limits& limits() const { return limits_; }
  /// Says whether code that has one path for software renderers and one for GPUs should take the former. It
  /// is false on a software renderer, too, if the environment variable LIMN_HARDWARE_PATHS is set, so that
  /// tests cover the paths for GPUs.
  bool software() const { return software_; }
  const Counters& counters() const { return counters_; }
  Counters& mutableCounters() { return counters_; }  ///< for the GPU objects themselves

 private:
  Context& context_;
  Limits limits_;
  Counters counters_;
  bool software_;
};

}  // namespace limn::gpu
