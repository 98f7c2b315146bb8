// Declares the services that limn gives to techniques.
#pragma once

#include "core/gpu_scene/gpu_scene.h"
#include "core/technique/frame_service.h"

namespace limn::render {

/// Makes all services. `device` and `scene` must outlive them.
LIMN_API FrameServices makeServices(gpu::Device& device, scene::GpuScene& scene);

}  // namespace limn::render
