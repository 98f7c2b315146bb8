// Declares how caustic rays are drawn as lines into the picture, which volume_caustics and its baseline
// share.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/caustics/caustic_rays.h"
#include "core/caustics/specular_buffers.h"
#include "core/technique/technique.h"

namespace limn::caustics {

/// Names the values of the parameter `paths`.
constexpr const char* kPathNames[] = {"reflection", "refraction", "both"};
/// Returns the parameters of a technique that requests caustic rays: those that all of them share, then its
/// own.
template <size_t N>
constexpr std::array<Parameter, N + 6> rayParameters(const std::array<Parameter, N>& own) {
  std::array<Parameter, N + 6> all{
      integer("buffer_size", 256, {1, 2048}, "texels",
              "Width and height of the specular and caustic-ray buffers")
          .quality()
          .logScale(),
      integer("scene_map_size", 512, {16, 8192}, "texels",
              "Width and height of the lights' depth maps without specular objects")
          .quality()
          .logScale(),
      choice("paths", 2, kPathNames, "Paths that are traced: one reflection, two refractions, or both"),
      integer("light_samples", 1, {1, 64}, "points",
              "Points on each light with extent, each with its own rays; 1: its centre")
          .quality(),
      integer("ray_steps", 64, {1, 4096}, "points", "Of the search for the place where a ray meets the scene")
          .logScale(),
      exitStepsParameter()};
  std::copy(own.begin(), own.end(), all.begin() + 6);
  return all;
}
/// Returns the parameter of techniques that draw beams. It is no parameter of the rays.
constexpr Parameter beamCosineParameter() {
  return real("beam_cosine", 0.7, {-1, 1}, "cosine",
              "Neighbouring rays whose directions part by a smaller cosine are of different beams");
}
/// Returns what rayParameters() and scene::mediumStepsParameter() ask for. Of the latter the light's way to
/// an object takes no fewer than core's passes do, since each ray has one such way, however it is drawn.
LIMN_API CausticRayDesc causticRayDesc(const ParameterValues& parameters);

/// Returns the rays of the request's lights. When there are none (no light, no specular material, no light
/// that meets one, no glass where only refraction is asked for; for media, no scattering), `rays` is empty
/// and `pass` is reported as left out. Refraction is traced only where a specular material lets light
/// through, else "refracted rays" are reported as left out.
LIMN_API CausticRays requestRays(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request, std::string_view pass,
                                 std::string_view technique);

/// Sets what a program takes whose shaders include glsl/caustics/sample_shift.glsl: where the camera's frame
/// lies among the samples of its pixels.
LIMN_API void setSampleShift(gpu::Program& program, const scene::GpuScene& scene);

struct LineDraw {
  std::string_view technique;
  std::string fragmentShader;  ///< includes glsl/caustics/line_fragment.glsl and defines scattered_at()
  std::map<std::string, std::string> defines = {};
  int mediumSteps = 1;   ///< as in scene::MediumInput
  bool beams = true;     ///< lines whose beam is wider than a pixel become quads of that width
  float beamCosine = 1;  ///< least cosine between neighbours of one beam
  std::function<void(gpu::Program&)> bind = {};  ///< sets the fragment shader's uniforms
};

/// Draws the rays of one technique. Must outlive the graph.
class LIMN_API RayLines {
 public:
  /// Declares the passes that add the lines of `rays` to `target`. Returns the target after them.
  frame::TextureHandle add(frame::FrameGraph& graph, const TechniqueInputs& inputs, const CausticRays& rays,
                           frame::TextureHandle target, const LineDraw& draw);

 private:
  frame::BufferHandle addRule(frame::FrameGraph& graph, std::string_view technique);
  gpu::VertexArray empty_;
};

}  // namespace limn::caustics
