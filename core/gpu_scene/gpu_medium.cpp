#include "core/gpu_scene/gpu_medium.h"

#include <cstring>

#include "core/scene/density_grid.h"

namespace limn::scene {
namespace {

constexpr int kGroup = 4;

gpu::Texture makeVolume(gpu::Device& device, const glm::ivec3& size) {
  gpu::Texture volume(
      device, "density",
      {.target = GL_TEXTURE_3D, .format = GL_R32F, .width = size.x, .height = size.y, .layers = size.z});
  volume.setSampling(GL_LINEAR, GL_LINEAR, GL_CLAMP_TO_EDGE, GL_CLAMP_TO_EDGE);
  return volume;
}

}  // namespace

GpuMedium::GpuMedium(gpu::Device& device, const Medium& medium) : medium_(medium) {
  if (!medium.inhomogeneous()) return;
  if (medium.grid) {
    const DensityGrid& grid = *medium.grid;
    volume_ = makeVolume(device, grid.size);
    const size_t slice = static_cast<size_t>(grid.size.x) * static_cast<size_t>(grid.size.y);
    for (int z = 0; z < grid.size.z; ++z)
      volume_.upload(0, z, GL_RED, GL_FLOAT, grid.values.data() + slice * static_cast<size_t>(z));
    return;
  }
  volume_ = makeVolume(device, smokeVoxels(*medium.smoke));
  smoke_ = gpu::Buffer(device, "smoke", sizeof(glsl::SmokeBlock), gpu::BufferUse::updated);
}

bool GpuMedium::update(double time) {
  if (!smoke_) return false;
  const glsl::SmokeBlock next = smokeBlock(*medium_.smoke, time);
  if (std::memcmp(&next, &current_, sizeof(next)) == 0) return false;
  current_ = next;
  smoke_.update(0, &current_, sizeof(current_));
  return true;
}

frame::TextureHandle GpuMedium::addPass(frame::FrameGraph& graph) {
  forget();
  if (!volume_) return {};
  const frame::TextureHandle volume = graph.importTexture("density", volume_);
  if (!smoke_) return volume;
  block_ = graph.importBuffer("smoke", smoke_);
  frame::PassBuilder pass = graph.addPass("smoke");
  pass.read(block_, frame::Access::uniformBuffer, "SmokeBlock", "its time").cacheable();
  const frame::TextureHandle filled =
      pass.write(volume, frame::Access::imageStore, "density", "how dense it is");
  const auto program = pass.program({.files = {"glsl/media/smoke.comp.glsl"}, .defines = {}});
  pass.execute([program, size = smokeVoxels(*medium_.smoke)](frame::PassContext& context) {
    context.use(program);
    context.dispatch(size.x, size.y, size.z, kGroup, kGroup, kGroup);
  });
  return filled;
}

void GpuMedium::touch(frame::FrameGraph& graph) const {
  if (block_) graph.touch(block_);
}

void MediumInput::define(std::map<std::string, std::string>& defines) const {
  defines["MEDIUM_STEPS"] = std::to_string(density_ ? steps_ : 0);
}

void MediumInput::declare(frame::PassBuilder& pass) const {
  if (density_) pass.read(density_, frame::Access::sampled, "medium_volume", "density of the medium");
}

}  // namespace limn::scene
