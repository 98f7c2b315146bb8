// Caustic rays drawn as lines into the picture: what volume_caustics and its baseline share.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/caustics/caustic_rays.h"
#include "core/technique/technique.h"

namespace limn::caustics {

/// The parameters of every technique that asks for caustic rays.
constexpr const char* pathNames[] = {"reflection", "refraction", "both"};
constexpr Parameter bufferSizeParameter() {
  return integer("buffer_size", 256, {1, 2048}, "texels",
                 "Width and height of the specular and caustic-ray buffers")
      .quality()
      .logScale();
}
constexpr Parameter sceneMapSizeParameter() {
  return integer("scene_map_size", 512, {16, 8192}, "texels",
                 "Width and height of the lights' depth maps without specular objects")
      .quality()
      .logScale();
}
constexpr Parameter pathsParameter() {
  return choice("paths", 2, pathNames, "One reflection, two refractions, or both");
}
constexpr Parameter lightSamplesParameter() {
  return integer("light_samples", 1, {1, 64}, "points",
                 "Points on each light with extent, each with its own rays; 1: its centre")
      .quality();
}
LIMN_API CausticRayDesc causticRayDesc(const ParameterValues& parameters);

/// The rays of the request's lights. Without any (no light, no specular material, no light that meets one;
/// for media nothing that scatters) `rays` is empty, and `pass` is reported as left out.
LIMN_API CausticRays requestRays(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                 const TermRequest& request, std::string_view pass,
                                 std::string_view technique);

struct LineDraw {
  std::string_view technique;
  std::string fragmentShader;  ///< includes glsl/caustics/line_fragment.glsl
  std::map<std::string, std::string> defines = {};
  int mediumSteps = 1;  ///< as scene::MediumInput has them
  bool beams = true;    ///< lines whose beam is wider than a pixel become quads of that width
  std::function<void(gpu::Program&)> bind = {};  ///< sets the fragment shader's uniforms
};

/// One per technique; must outlive the graph.
class LIMN_API RayLines {
 public:
  /// Adds the lines of `rays` to `target`.
  frame::TextureHandle add(frame::FrameGraph& graph, const TechniqueInputs& inputs, const CausticRays& rays,
                           frame::TextureHandle target, const LineDraw& draw);

 private:
  frame::BufferHandle addRule(frame::FrameGraph& graph, std::string_view technique);
  gpu::VertexArray empty_;
};

}  // namespace limn::caustics
