// The GPU as the rest of limn sees it: the function table, the limits, and a count of every live object.
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
  int storageAlignment = 0;
  int uniformAlignment = 0;
  bool layerFromVertexShader = false;  ///< ARB_shader_viewport_layer_array or AMD_vertex_shader_layer
};

/// Live objects and the bytes behind them. Tests compare it before and after to prove that nothing leaks and
/// that a left-out pass allocates nothing.
struct Counters {
  int buffers = 0, textures = 0, framebuffers = 0, programs = 0, queries = 0, samplers = 0, vertexArrays = 0;
  int programsCompiled = 0;  ///< ever, not live
  int64_t bufferBytes = 0, textureBytes = 0;
  bool operator==(const Counters&) const = default;
};

/// Wraps a context; must outlive every GPU object made with it and be destroyed before the context.
/// State set once, which nobody changes: pixel rows tightly packed, seamless cube maps on, sRGB encoding of
/// framebuffers and dithering off.
/// An object is destroyed in its own context, which is made current for the moment where it is not.
class LIMN_API Device {
 public:
  explicit Device(Context& context);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  Context& context() const { return context_; }
  const gl::Functions& gl() const { return context_.gl(); }
  const Limits& limits() const { return limits_; }
  /// Which of two ways suits the renderer where they differ: the processor's or a GPU's. A renderer on the
  /// processor is given the GPU's where the environment has LIMN_HARDWARE_PATHS, so that tests meet these,
  /// too.
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
