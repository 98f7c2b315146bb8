// Declares what every technique with virtual point lights shares: how indirect light is gathered from them.
//
// The stages are those of Real-time indirect illumination with clustered visibility (thesis, chapter 6.5;
// Segovia et al. 2006): the G-buffer is split into block x block sub-buffers, each pixel shades N / block^2
// virtual lights, the sub-buffers are merged and blurred, and the result is reflected by the surfaces. Pixels
// that the blur serves badly get all virtual lights (GatherSettings::edges). With
// Interleaving::addressed the shade pass finds its pixels itself, so that nothing is split or merged; the
// picture is identical to the bit. With a history (core/history/frame_history.h) each frame has a set of
// virtual lights of its own, and what the surfaces reflect is the mean over the last frames.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <iterator>
#include <optional>
#include <string_view>
#include <vector>

#include "core/frame/frame_graph.h"
#include "core/history/frame_history.h"
#include "core/indirect/virtual_lights.h"
#include "core/shadow/visibility_pass.h"
#include "core/technique/technique.h"

namespace limn::indirect {

enum class Interleaving {
  addressed,  ///< one pass over the screen, in interleaved order
  split,      ///< as published: split, shade and merge
};
inline constexpr const char* kInterleavingNames[] = {"addressed", "split"};

/// How the inverse square of the distance to a virtual light is bounded.
enum class Bound {
  distance,  ///< no light counts as nearer than the clamp
  patch,     ///< 1 / (d^2 + A / pi) of the surface A that the light stands for
};
inline constexpr const char* kBoundNames[] = {"distance", "patch"};

/// Returns the parameters of a technique with virtual lights: their number, its own, and those that all such
/// techniques share. `block` is the default of the side of the pattern of interleaved pixels.
template <size_t N = 0>
constexpr std::array<Parameter, N + 14> gatherParameters(const std::array<Parameter, N>& own = {},
                                                         int block = 8) {
  std::array<Parameter, N + 14> all{
      integer("vpls", 1024, {1, 65536}, "lights", "Number of virtual point lights, over all lights")
          .quality()
          .logScale()};
  const Parameter shared[] = {
      integer("rsm_size", 256, {16, 8192}, "texels",
              "Width and height of each layer of the reflective shadow maps")
          .logScale(),
      integer("light_samples", 1, {1, 256}, "points",
              "Points on each area light that reflective shadow maps are drawn from; 1: its centre, "
              "which suffices unless geometry near the light hides parts of it"),
      integer("block", block, {1, 16}, "pixels",
              "Side of the pattern of interleaved pixels, each of which shades 1 / block^2 of the virtual "
              "lights"),
      choice("interleaving", 0, kInterleavingNames,
             "addressed: pixels are found by address; split: the G-buffer is split and the result merged"),
      real(
          "clamp", 0.03, {0, 1}, "scene extents",
          "Least distance that is used for a virtual light; 0: no clamping. With a history of n frames it is "
          "this over the root of n where the blur covers the pattern, and more where it does not"),
      choice(
          "bound", 0, kBoundNames,
          "distance: by clamp; patch: by the surface that each virtual light stands for, whatever clamp is"),
      boolean("compensation", false, "Spread the light that the clamp removes over neighbouring pixels"),
      integer("history", 1, {1, history::FrameHistoryService::kMostFrames}, "frames",
              "Frames whose light is averaged, each with virtual lights of its own; 1: this frame's alone"),
      boolean("blur", true, "Average over the pattern of interleaved pixels, not across edges"),
      real("blur_position", 0.1, {0, 1}, "scene extents", "Pixels farther apart than this are not averaged"),
      real("blur_plane", 0.01, {0, 1}, "scene extents",
           "Pixels farther than this from a pixel's plane, across its shading normal, do not count in its "
           "average; 1: as published"),
      real("blur_normal", 0.8, {-1, 1}, "cosine",
           "Pixels are not averaged where the cosine between their normals is below this"),
      real(
          "edges", 0, {0, 100}, "",
          "Pixels get all virtual lights where the blur finds less than a quarter of the pattern, or mixes "
          "lines of pixels whose light differs by more than this times the mean of 16 x 16 pixels around; 0: "
          "none do, as published"),
  };
  std::copy(own.begin(), own.end(), all.begin() + 1);
  std::copy(std::begin(shared), std::end(shared), all.begin() + 1 + N);
  return all;
}

/// Holds the values of the parameters above.
struct GatherSettings {
  int block = 1;
  Interleaving interleaving = Interleaving::addressed;
  float clamp = 0;
  Bound bound = Bound::distance;
  bool compensation = false;
  int history = 1;
  bool blur = false;
  float blurPosition = 0.1f, blurPlane = 0.01f, blurNormal = 0.8f;
  float edges = 0;  ///< means of the light of 16 x 16 pixels; 0: no pixels get all virtual lights
};
LIMN_API GatherSettings gatherSettings(const ParameterValues& parameters);
/// Returns the virtual lights of a request that the parameters above ask for; nothing where it has no light,
/// which is reported.
LIMN_API std::optional<VirtualLights> virtualLightsOf(frame::FrameGraph& graph, const TechniqueInputs& inputs,
                                                      const TermRequest& request, std::string_view technique);

/// Returns the side of the pattern of interleaved pixels: at most `block`, and with no more sub-buffers than
/// virtual lights, so that every pixel has a light.
LIMN_API int usableBlock(int block, int lights);

/// Describes a pass that shades from some of the virtual lights. Software renderers may take several passes
/// for it.
struct ShadePass {
  gpu::ProgramDesc program;  ///< a compute shader that includes glsl/indirect/gather_main.glsl
  int first = 0, count = 0;  ///< virtual lights that vpl_visibility() covers; count 0: all
  int areas = 0;             ///< by which the lights of a sub-buffer are sorted (VPL_AREAS)
  int areaSteps = 0;         ///< of the loops of a thread, for each of them
  std::vector<shadow::SampledTexture> sampled = {};
  std::function<void(gpu::Program&)> bind = {};           ///< sets further uniforms; may be empty
  std::function<void(frame::PassBuilder&)> declare = {};  ///< declares further reads; may be empty
};

/// Declares the passes of one technique's result: shade() once per batch of virtual lights, then finish().
class LIMN_API Gather {
 public:
  Gather(frame::FrameGraph& graph, const TechniqueInputs& inputs, std::string_view technique,
         const VirtualLights& lights, const GatherSettings& settings);
  void shade(ShadePass pass);
  /// Declares the passes that add the light to `target`, and returns the target after them.
  frame::TextureHandle finish(frame::TextureHandle target);

 private:
  int parts() const { return 1 + (specular_ ? 1 : 0) + (residual_ || falling_ ? 1 : 0); }
  frame::TextureHandle screen(std::string_view name, glm::ivec2 size, int layers) const;
  void defineParts(gpu::ProgramDesc& program) const;
  void declareShading(frame::PassBuilder& pass, ShadePass& shade, const GBuffer& from) const;
  std::function<void(gpu::Program&)> shadingUniforms(const ShadePass& shade) const;
  std::vector<ShadePass> passesOf(const ShadePass& shade, int subBuffers) const;
  void addShadePass(ShadePass shade);
  GBuffer split();
  frame::TextureHandle merge(frame::TextureHandle shaded);
  frame::TextureHandle shadeEdges(frame::TextureHandle rows, frame::TextureHandle columns,
                                  frame::TextureHandle blurred);
  frame::TextureHandle addEdgePass(ShadePass shade, frame::TextureHandle rows, frame::TextureHandle columns,
                                   frame::TextureHandle blurred, frame::TextureHandle target);
  frame::TextureHandle blur(std::string_view name, frame::TextureHandle from, int width, int stride,
                            int blurredParts, bool vertical, bool last);

  frame::FrameGraph& graph_;
  TechniqueInputs inputs_;
  std::string_view technique_;
  VirtualLights lights_;
  GatherSettings settings_;
  bool lambertian_;  ///< no surface that is lit reflects otherwise
  bool specular_, residual_;
  bool blurred_ = false;
  bool falling_ = false;  ///< the clamp of a pixel falls with the lights of which the blur makes it the mean
  bool glossyBound_ = false;  ///< the specular part has a bound of its own: that of one frame
  GBuffer gbuffer_;           ///< split if the settings say so
  glm::ivec2 size_;           ///< of the shaded screen: whole sub-buffers
  frame::TextureHandle shaded_;
  std::optional<ShadePass> edges_;  ///< what shades edges: the pass that has all virtual lights
};

}  // namespace limn::indirect
