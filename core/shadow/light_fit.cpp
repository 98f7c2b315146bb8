#include "core/shadow/light_fit.h"

#include <algorithm>
#include <optional>

#include "core/shadow/private/light_parts.h"
#include "core/shadow/private/light_window.h"
#include "core/shadow/private/pyramid_fit.h"
#include "core/shadow/private/window_fit.h"
#include "glsl/light/light_view.glsl"

namespace limn::shadow {
namespace {

using glm::vec3;
using scene::Bounds;

glsl::ShadowView makeView(uint32_t projection, const vec3& origin, const MapAxes& axes,
                          const MapWindow& window, int size, uint32_t layer, uint32_t light) {
  const float scale = 1 / (window.high.x - window.low.x);
  return {.origin = origin,
          .near = window.near,
          .axis_x = axes.x,
          .scale = scale,
          .axis_y = axes.y,
          .footprint = 1 / (scale * static_cast<float>(size)),
          .axis_z = axes.z,
          .far = window.far,
          .middle = 0.5f - 0.5f * scale * (window.low + window.high),
          .unused = {},
          .projection = projection,
          .layer = layer,
          .size = static_cast<uint32_t>(size),
          .light = light};
}

struct Writer {
  uint32_t lightIndex;
  int size;
  std::vector<glsl::ShadowView>& views;
  std::vector<glsl::ShadowLight>& lights;

  void light(const vec3& origin, bool finite, uint32_t faces) {
    lights.push_back({.origin = origin,
                      .finite = finite ? 1.f : 0.f,
                      .first_layer = static_cast<uint32_t>(views.size()),
                      .faces = faces,
                      .light = lightIndex,
                      .unused = 0});
  }
  void view(uint32_t projection, const vec3& origin, const MapAxes& axes, const MapWindow& window) {
    views.push_back(
        makeView(projection, origin, axes, window, size, static_cast<uint32_t>(views.size()), lightIndex));
  }
};

/// The window in the axes of the view backwards.
MapWindow swapped(const MapWindow& w) {
  return {{w.low.y, w.low.x}, {w.high.y, w.high.x}, w.near, w.far};
}

/// What a map is fitted to besides the boxes: null, or what the camera sees, for all points of the light as
/// far as `spread` says.
struct ViewFit {
  const VisibleScene* visible = nullptr;
  vec3 spread{0};
};

/// The window of a map that needs to show nothing: past all of its directions and behind all that is there.
MapWindow emptyWindow(const MapWindow& whole) {
  const glm::vec2 edge(std::max(whole.high.x, whole.high.y));
  return {2.f * edge, 3.f * edge, whole.far, 2 * whole.far};
}

void appendOrthographic(const glsl::Light& light, const vec3& direction, std::span<const Bounds> boxes,
                        const ViewFit& fit, Writer& out) {
  MapAxes axes = axesOf(light);
  if (direction != axes.z) {  // a sample off the disc's centre: turn the frame
    const vec3 x = glm::normalize(axes.x - glm::dot(axes.x, direction) * direction);
    axes = {x, glm::cross(x, direction), direction};
  }
  Bounds all, local;
  for (const Bounds& box : boxes) all.add(box);
  const vec3 centre = all.centre();
  for (const Bounds& box : boxes) {
    if (box.empty()) continue;
    for (const vec3& p : corners(box, centre, axes)) local.add(p);
  }
  if (local.empty()) local = {vec3(-0.5f), vec3(0.5f)};
  const vec3 size = local.high - local.low, middle = local.centre();
  const float width = std::max({size.x, size.y, 1e-6f * size.z}) * widening(out.size);
  const float depth = std::max(size.z, 1e-3f * width);
  // The plane z = 0 lies a tenth of the depth before everything, so that depths are positive.
  const vec3 origin = centre + middle.x * axes.x + middle.y * axes.y + (middle.z - 0.6f * depth) * axes.z;
  out.light(-direction, false, glsl::shadow_faces_single);
  const MapWindow whole = squareWindow(0.5f * width, {0.0999f * depth, 1.1001f * depth});
  MapWindow shown = whole;
  if (fit.visible != nullptr) {
    MapWindow window;
    std::vector<vec3> receivers;
    const bool some = fitWindow({origin, axes, false, fit.spread}, *fit.visible, light.own_instance, whole,
                                window, receivers);
    shown = some ? steadyWindow(window, whole, out.size) : emptyWindow(whole);
  }
  out.view(glsl::shadow_orthographic, origin, axes, shown);
}

/// The unit direction that a directional light's sample shines along.
vec3 sampleDirection(const glsl::Light& light, const glm::vec2& sample) {
  const glsl::LightView view = glsl::light_view(light, vec3(0), -light.direction, -1);
  return -glm::normalize(glsl::light_view_point(view, sample));
}

/// Appends the faces of the cubes or half cubes of a light's samples, fitted to the view: what blocks a
/// receiver's light lies in its direction. In an empty face nothing is drawn, and a receiver that it should
/// have shown would count as uncovered.
void appendFaces(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                 const ShadowMapDesc& desc, const VisibleScene& visible, Writer& out) {
  const MapAxes axes = axesOf(light);
  const uint32_t faces = glsl::shadow_face_count(layout.faces);
  const std::vector<glm::vec2> samples = samplesOf(light, desc);
  const auto offsetOf = [&](const glm::vec2& sample, const MapAxes& along) {
    const vec3 r = samplePoint(light, sample) - light.position;
    return vec3(glm::dot(along.x, r), glm::dot(along.y, r), glm::dot(along.z, r));
  };
  vec3 reach(0);
  for (const glm::vec2& sample : samples) reach = glm::max(reach, glm::abs(offsetOf(sample, axes)));
  const MapWindow around = wholeWindow(light, light.position, axes, layout, boxes, desc);
  FaceReceivers receivers;
  findFaceReceivers(light.position, axes, visible, light.own_instance, faces, reach, around, receivers);
  for (const glm::vec2& sample : samples) {
    const vec3 origin = samplePoint(light, sample);
    out.light(origin, true, layout.faces);
    const MapWindow whole = wholeWindow(light, origin, axes, layout, boxes, desc);
    for (uint32_t face = 0; face < faces; ++face) {
      const MapAxes own = faceAxes(axes, face);
      MapWindow window = shiftedFaceWindow(receivers[face], offsetOf(sample, own), whole);
      const bool shows =
          window.low.x <= window.high.x && window.low.y <= window.high.y && window.far > whole.near;
      if (shows) {
        window.near = whole.near;
        window = steadyWindow(window, whole, desc.size);
      } else {
        window = emptyWindow(whole);
      }
      out.view(glsl::shadow_perspective, origin, own, window);
    }
  }
}

/// Appends the views of a light, or of a part of one, whose perspective views have the window `given`.
void appendWhole(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                 const ShadowMapDesc& desc, const VisibleScene* visible, Writer& out,
                 const std::optional<MapWindow>& given = {}) {
  const MapAxes axes = axesOf(light);
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  const std::vector<glm::vec2> samples = samplesOf(light, desc);
  const bool perspective = layout.projection == glsl::shadow_perspective;
  ViewFit fit;
  const bool toView = desc.fit == MapFit::view;
  if (toView && layout.faces == glsl::shadow_faces_single) fit.visible = visible;
  const bool sampled = !desc.samples.empty();
  if (!sampled || perspective) fit.spread = spreadOf(light, axes, desc.lightSize);
  std::optional<MapWindow> window;
  std::vector<vec3> receivers;
  bool unseen = false;  // of all that the light reaches the camera sees nothing
  if (fit.visible != nullptr && perspective) {
    const vec3 origin(light.position);
    const MapWindow whole = given ? *given : wholeWindow(light, origin, axes, layout, boxes, desc);
    MapWindow fitted;
    unseen = !fitWindow({origin, axes, true, fit.spread}, *fit.visible, light.own_instance, whole, fitted,
                        receivers);
    if (!unseen) window = fitted;
  }
  if (toView && sampled && visible != nullptr && count > 2) {
    appendFaces(light, layout, boxes, desc, *visible, out);
    return;
  }
  for (const glm::vec2& sample : samples) {
    if (layout.projection == glsl::shadow_orthographic) {
      appendOrthographic(light, sampleDirection(light, sample), boxes, fit, out);
      continue;
    }
    const vec3 origin = samplePoint(light, sample);
    out.light(origin, true, layout.faces);
    // The second view of a pair looks backwards.
    const uint32_t step = layout.faces == glsl::shadow_faces_pair ? 5 : 1;
    const MapWindow whole = given ? *given : wholeWindow(light, origin, axes, layout, boxes, desc);
    if (unseen) {
      out.view(glsl::shadow_perspective, origin, axes, emptyWindow(whole));
      continue;
    }
    if (window) {
      const vec3 r = origin - light.position;
      MapWindow own =
          sampled ? shiftedWindow(receivers, {glm::dot(axes.x, r), glm::dot(axes.y, r)}) : *window;
      own.low = glm::max(own.low, whole.low);
      own.high = glm::min(own.high, whole.high);
      own.near = window->near;
      out.view(glsl::shadow_perspective, origin, axes, steadyWindow(own, whole, desc.size));
      continue;
    }
    for (uint32_t face = 0; face < count; ++face)
      out.view(glsl::shadow_perspective, origin, faceAxes(axes, face * step),
               face * step == 5 ? swapped(whole) : whole);
  }
}

}  // namespace

bool showsNothing(const glsl::ShadowView& view) {
  // That of emptyWindow(), whose depths and place no window of receivers has together.
  return view.far == 2 * view.near && view.middle.x < -1.5f && view.middle.y < -1.5f;
}

void appendViews(const glsl::Light& light, uint32_t lightIndex, const LightLayout& layout,
                 std::span<const Bounds> boxes, const ShadowMapDesc& desc, const VisibleScene* visible,
                 std::vector<glsl::ShadowView>& views, std::vector<glsl::ShadowLight>& lights) {
  std::vector<Bounds> kept;
  const std::span<const Bounds> lit = withinRange(light, boxes, desc, kept);
  Writer out{lightIndex, desc.size, views, lights};
  if (layout.parts() == 1) {
    appendWhole(light, layout, lit, desc, visible, out);
    return;
  }
  ShadowMapDesc own = desc;
  own.lightSize = -1;
  for (const glsl::Light& part : partsOf(light, layout, desc))
    appendWhole(part, layout, lit, own, visible, out, partWindow(light, part, layout, lit, desc));
}

scene::CullVolume cullVolume(const glsl::ShadowView& view) {
  const vec3 origin(view.origin), x(view.axis_x), y(view.axis_y), z(view.axis_z);
  const auto plane = [&](const vec3& n, float offset) { return glm::vec4(n, offset - glm::dot(n, origin)); };
  const glm::vec2 low = -view.middle / view.scale, high = low + 1 / view.scale;
  scene::CullVolume volume;
  if (view.projection == glsl::shadow_orthographic) {
    volume.planes = {plane(x, -low.x),  plane(-x, high.x),    plane(y, -low.y),
                     plane(-y, high.y), plane(z, -view.near), plane(-z, view.far)};
  } else {
    volume.planes = {plane(x - low.x * z, 0),  plane(high.x * z - x, 0), plane(y - low.y * z, 0),
                     plane(high.y * z - y, 0), plane(z, -view.near),     plane(-z, view.far)};
  }
  return volume;
}

}  // namespace limn::shadow
