#include "core/shadow/light_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/shadow/private/pyramid_fit.h"
#include "core/shadow/private/window_fit.h"
#include "glsl/light/light_part.glsl"
#include "glsl/light/light_view.glsl"
#include "glsl/light/rectangle_light.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::shadow {
namespace {

using glm::vec3;
using scene::Bounds;

using Axes = MapAxes;

Axes axesOf(const glsl::Light& light) {
  const vec3 z(light.direction), u(light.axis_u), v(light.axis_v);
  if (glsl::light_is_distant_rectangle(light)) {
    const vec3 x = glm::normalize(u - glm::dot(u, z) * z);
    return {x, glm::cross(x, z), z};
  }
  const vec3 other = glm::cross(u, v);
  if (glm::dot(u, u) > 0.5f && glm::dot(v, v) > 0.5f && glm::dot(other, z) < -0.5f) return {u, v, z};
  const glsl::Frame frame = glsl::frame_around(-z);
  return {frame.t, frame.b, z};
}

glsl::ShadowView makeView(uint32_t projection, const vec3& origin, const Axes& axes, const MapWindow& window,
                          int size, uint32_t layer, uint32_t light) {
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

MapWindow square(float half, const DepthRange& range) {
  return {glm::vec2(-half), glm::vec2(half), range.near, range.far};
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
  void view(uint32_t projection, const vec3& origin, const Axes& axes, const MapWindow& window) {
    views.push_back(
        makeView(projection, origin, axes, window, size, static_cast<uint32_t>(views.size()), lightIndex));
  }
};

/// Half of a light's sides, each as far as it reaches along the axes of its map. `size` as in light_view().
vec3 spreadOf(const glsl::Light& light, const Axes& axes, float size) {
  if (light.type == glsl::light_directional && !glsl::light_is_distant_rectangle(light))
    return vec3(glm::vec2(std::tan(std::min(0.5f * (size < 0 ? light.angular_diameter : size), 1.55f))), 0);
  // A square that faces the receiver, whichever way.
  if (light.type == glsl::light_point || light.type == glsl::light_spot)
    return vec3(std::sqrt(0.5f) * std::max(size, 0.f));
  vec3 u = light.length_u * light.axis_u, v = light.length_v * light.axis_v;
  const bool distant = glsl::light_is_distant_rectangle(light);
  if (size >= 0) {
    const float side = distant ? 2 * std::tan(std::min(0.5f * size, 1.5f)) : size;
    u = side * light.axis_u;
    v = side * light.axis_v;
  }
  const auto reach = [&](const vec3& axis) {
    return 0.5f * (std::abs(glm::dot(axis, u)) + std::abs(glm::dot(axis, v)));
  };
  const vec3 half(reach(axes.x), reach(axes.y), reach(axes.z));
  if (!distant) return half;
  // Points are directions centre + a u + b v: across the map's axis per metre along it.
  const float along = std::max(glm::length(light.position) - half.z, 1e-3f);
  return {half.x / along, half.y / along, 0};
}

/// The window in the axes of the view backwards.
MapWindow swapped(const MapWindow& w) {
  return {{w.low.y, w.low.x}, {w.high.y, w.high.x}, w.near, w.far};
}

/// By how much a map is wider than what it shows: two texels more on each side, of few texels an eighth of
/// that width, so that no map shows far more of its surroundings than of what it is for.
float widening(int size) {
  return 1 + std::min(4 / static_cast<float>(size), 0.25f);
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
  Axes axes = axesOf(light);
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
  const MapWindow whole = square(0.5f * width, {0.0999f * depth, 1.1001f * depth});
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

vec3 samplePoint(const glsl::Light& light, const glm::vec2& sample) {
  return glsl::rectangle_point(light, sample - 0.5f);
}

/// The unit direction that a directional light's sample shines along.
vec3 sampleDirection(const glsl::Light& light, const glm::vec2& sample) {
  const glsl::LightView view = glsl::light_view(light, vec3(0), -light.direction, -1);
  return -glm::normalize(glsl::light_view_point(view, sample));
}

float outerHalfAngle(const glsl::Light& light) {
  return std::acos(std::clamp(light.cos_outer, -1.f, 1.f));
}

/// Whether the light has a cone that one perspective view can hold.
bool hasCone(const glsl::Light& light) {
  return (light.flags & glsl::light_flag_cone) != 0 && outerHalfAngle(light) <= kLargestHalfAngle;
}

/// Of a light with hasCone(): half the width of its map at unit distance.
float coneTangent(const glsl::Light& light, int size) {
  return std::tan(outerHalfAngle(light)) * widening(size);
}

bool twoSided(const glsl::Light& light) {
  return (light.flags & glsl::light_flag_two_sided) != 0;
}

/// Of perspective views from `origin`: all boxes that they may see, as far as there is light.
MapWindow wholeWindow(const glsl::Light& light, const vec3& origin, const Axes& axes,
                      const LightLayout& layout, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  float tangent = 1;
  if (count <= 2) {
    tangent =
        light.type == glsl::light_spot ? coneTangent(light, desc.size) : fittedTangent(origin, axes, boxes);
    if (count == 2) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
    if (light.type != glsl::light_spot) tangent *= widening(desc.size);
    // The cone is that of the light's centre: a sample aside of it sees what lies in it at a wider angle.
    if (hasCone(light) && count == 1 && desc.samples.empty())
      tangent = std::min(tangent, coneTangent(light, desc.size));
    if (!(tangent > 0)) tangent = 1;
  }
  const uint32_t step = layout.faces == glsl::shadow_faces_pair ? 5 : 1;
  return square(tangent, widened(pyramidRange(origin, axes, count, step, tangent, boxes)));
}

/// The layout of a light that is not cut.
LightLayout fitWhole(const glsl::Light& light, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  const uint32_t kind = glsl::light_kind(light);
  if (light.type == glsl::light_directional)
    return {glsl::shadow_orthographic, glsl::shadow_faces_single, kind};
  const LightLayout cube{glsl::shadow_perspective, glsl::shadow_faces_cube, kind};
  const LightLayout single{glsl::shadow_perspective, glsl::shadow_faces_single, kind};
  if (light.type == glsl::light_point || desc.projection == Projection::cube) return cube;
  if (light.type == glsl::light_spot) return hasCone(light) ? single : cube;

  const Axes axes = axesOf(light);
  const bool both = twoSided(light);
  float tangent = 0;
  for (const glm::vec2& sample : samplesOf(light, desc)) {
    const vec3 origin = samplePoint(light, sample);
    tangent = std::max(tangent, fittedTangent(origin, axes, boxes));
    if (both) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
  }
  if (tangent <= std::tan(kLargestHalfAngle) || (!both && hasCone(light) && desc.samples.empty()))
    return both ? LightLayout{glsl::shadow_perspective, glsl::shadow_faces_pair, kind} : single;
  return both ? cube : LightLayout{glsl::shadow_perspective, glsl::shadow_faces_hemicube, kind};
}

/// Appends the faces of the cubes or half cubes of a light's samples, fitted to the view: what blocks a
/// receiver's light lies in its direction. In an empty face nothing is drawn, and a receiver that it should
/// have shown would count as uncovered.
void appendFaces(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                 const ShadowMapDesc& desc, const VisibleScene& visible, Writer& out) {
  const Axes axes = axesOf(light);
  const uint32_t faces = glsl::shadow_face_count(layout.faces);
  const std::vector<glm::vec2> samples = samplesOf(light, desc);
  const auto offsetOf = [&](const glm::vec2& sample, const Axes& along) {
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
      const Axes own = faceAxes(axes, face);
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
  const Axes axes = axesOf(light);
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

/// Parts along each side of a light, as many as its views make.
glm::uvec2 partsAlongSides(const glsl::Light& light, const ShadowMapDesc& desc, uint32_t views) {
  if (glsl::light_kind(light) == glsl::light_kind_disc) return glm::uvec2(views);
  const glm::vec2 sides = glsl::light_sides(light, glsl::light_kind(light), desc.lightSize);
  const float longer = std::max(sides.x, sides.y);
  if (!(longer > 0)) return glm::uvec2(1);
  return glm::uvec2(glm::max(glm::ceil(static_cast<float>(views) * sides / longer - 1e-3f), 1.f));
}

/// Whether each of several views may have a part of the light.
bool isDivisible(const glsl::Light& light, const ShadowMapDesc& desc) {
  return desc.views != 1 && desc.samples.empty() && glsl::light_has_extent(light) && desc.lightSize != 0;
}

/// The width of the light's kernel, texels, before blockers half way between it and the middle of the scene.
float kernelTexels(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                   const ShadowMapDesc& desc) {
  const vec3 spread = spreadOf(light, axesOf(light), desc.lightSize);
  const float width = 2 * std::max(spread.x, spread.y);
  const auto size = static_cast<float>(desc.size);
  // The scene is as deep as the map is wide.
  if (layout.projection == glsl::shadow_orthographic) return 0.5f * size * width;
  Bounds all;
  for (const Bounds& box : boxes) all.add(box);
  if (all.empty()) return 0;
  const vec3 origin(light.position);
  const float tangent = wholeWindow(light, origin, axesOf(light), layout, boxes, desc).high.x;
  return size * width / (2 * tangent * glm::distance(origin, all.centre()));
}

/// The views of a light that chooses their number. Lights that stand for an environment are many, and each is
/// a part already.
uint32_t viewsOf(const glsl::Light& light, const LightLayout& layout, std::span<const Bounds> boxes,
                 const ShadowMapDesc& desc) {
  if ((light.flags & glsl::light_flag_environment) != 0) return 1;
  return kernelTexels(light, layout, boxes, desc) > kWideKernel ? 2 : 1;
}

/// Of one perspective view, or two, of a part: what the light's own hold from an eighth of their depth on.
/// Nearer to the light only parts on the receiver's side are sure to see it: the others do not count there.
std::optional<MapWindow> partWindow(const glsl::Light& light, const glsl::Light& part,
                                    const LightLayout& layout, std::span<const Bounds> boxes,
                                    const ShadowMapDesc& desc) {
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  if (layout.projection != glsl::shadow_perspective || count > 2) return {};
  const Axes axes = axesOf(light);
  const MapWindow whole = wholeWindow(light, light.position, axes, layout, boxes, desc);
  const vec3 r = part.position - light.position;
  const glm::vec2 shift =
      glm::vec2(glm::dot(axes.x, r), glm::dot(axes.y, r)) / std::max(whole.near, 0.125f * whole.far);
  const glm::vec2 low = whole.low - glm::max(shift, 0.f);
  const glm::vec2 high = low + (whole.high - whole.low) + std::max(std::abs(shift.x), std::abs(shift.y));
  const float tangent = std::max({-low.x, -low.y, high.x, high.y});
  const DepthRange range = widened(pyramidRange(part.position, axes, count, 5, tangent, boxes));
  return MapWindow{low, high, range.near, range.far};
}

/// Of the boxes, with MapFit::view, what lies as near to the light's centre as its range, or as points of the
/// light themselves: no more is lit, or lies on the way there. Other maps may be asked where light goes on
/// to. `kept` holds them.
std::span<const Bounds> withinRange(const glsl::Light& light, std::span<const Bounds> boxes,
                                    const ShadowMapDesc& desc, std::vector<Bounds>& kept) {
  if (desc.fit != MapFit::view || light.type == glsl::light_directional || !(light.range > 0)) return boxes;
  const glm::vec2 sides = glsl::light_sides(light, glsl::light_kind(light), desc.lightSize);
  return boxesAround(light.position, 1.001f * std::max(light.range, 0.5f * glm::length(sides)), boxes, kept);
}

std::vector<glsl::Light> partsOf(const glsl::Light& light, const LightLayout& layout,
                                 const ShadowMapDesc& desc) {
  if (layout.parts() == 1) return {light};
  std::vector<glsl::Light> parts;
  for (uint32_t i = 0; i < layout.parts(); ++i)
    parts.push_back(glsl::light_part(light, layout.kind, desc.lightSize, {layout.partsU, layout.partsV}, i));
  return parts;
}

}  // namespace

std::vector<glm::vec2> samplesOf(const glsl::Light& light, const ShadowMapDesc& desc) {
  if (desc.samples.empty()) return {glm::vec2(0.5f)};
  return glsl::light_has_extent(light) ? desc.samples : std::vector<glm::vec2>{glm::vec2(0.5f)};
}

LightLayout fitLayout(const glsl::Light& light, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  std::vector<Bounds> kept;
  const std::span<const Bounds> lit = withinRange(light, boxes, desc, kept);
  LightLayout layout = fitWhole(light, lit, desc);
  if (!isDivisible(light, desc)) return layout;
  const auto views = desc.views > 0 ? static_cast<uint32_t>(desc.views) : viewsOf(light, layout, lit, desc);
  const glm::uvec2 parts = partsAlongSides(light, desc, views);
  layout.partsU = parts.x;
  layout.partsV = parts.y;
  return layout;
}

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
