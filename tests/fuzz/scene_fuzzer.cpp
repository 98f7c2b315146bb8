// libFuzzer target of the scene loader: any bytes either load, or end in limn::Error of one line. What loads
// must also evaluate and deform.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/scene_io/load.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

void use(const limn::scene::Scene& scene) {
  limn::scene::Pose pose;
  for (const double time : {0.0, 0.37, -1e6}) limn::scene::evaluate(scene, time, limn::scene::kNone, pose);
  require(pose.lights.size() == pose.lightNames.size());
  std::vector<glm::vec3> positions, normals;
  std::vector<glm::vec4> tangents;
  for (const limn::scene::Deformation& state : pose.deformed) {
    const auto& mesh = scene.meshes.at(static_cast<std::size_t>(state.mesh));
    const auto& primitive = mesh.primitives.at(static_cast<std::size_t>(state.primitive));
    limn::scene::deform(primitive, state, positions, normals, tangents);
    require(positions.size() == primitive.positions.size());
  }
  for (const auto& mesh : scene.meshes) {
    for (const auto& primitive : mesh.primitives) {
      for (const std::uint32_t index : primitive.indices) require(index < primitive.positions.size());
      require(primitive.normals.size() == primitive.positions.size());
      for (const glm::vec4& c : primitive.colours) require(c == glm::clamp(c, 0.f, 1.f));
      require(static_cast<std::size_t>(primitive.material) < scene.materials.size());
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // Small limits: the fuzzer looks for wrong code, not for large memory.
  limn::scene::LoadLimits limits;
  limits.vertices = 100'000;
  limits.imageTexels = 1 << 16;
  limits.nodes = 1000;
  limits.instances = 1000;
  try {
    use(limn::scene::loadMemory(std::as_bytes(std::span(data, size)), limits));
  } catch (const limn::Error& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
  }
  return 0;
}
