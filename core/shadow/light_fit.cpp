#include "core/shadow/light_fit.h"

#include <algorithm>
#include <cmath>

#include "glsl/geometry.glsl"
#include "glsl/light_view.glsl"

namespace limn::shadow {
namespace {

using glm::vec3;
using scene::Bounds;

/// Right, up, forward; cross(x, y) = -z, as ShadowView wants it.
struct Axes {
  vec3 x, y, z;
};

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

/// The frames of shadow_face's faces, in its order.
Axes faceAxes(const Axes& a, uint32_t face) {
  switch (face) {
    case 1:
      return {a.y, a.z, a.x};
    case 2:
      return {a.z, a.y, -a.x};
    case 3:
      return {a.z, a.x, a.y};
    case 4:
      return {a.x, a.z, -a.y};
    case 5:
      return {a.y, a.x, -a.z};
    default:
      return a;
  }
}

/// The eight corners relative to `origin`, in the frame.
std::array<vec3, 8> corners(const Bounds& box, const vec3& origin, const Axes& axes) {
  std::array<vec3, 8> out;
  for (size_t i = 0; i < 8; ++i) {
    const vec3 p = vec3((i & 1) != 0 ? box.high.x : box.low.x, (i & 2) != 0 ? box.high.y : box.low.y,
                        (i & 4) != 0 ? box.high.z : box.low.z) -
                   origin;
    out[i] = {glm::dot(axes.x, p), glm::dot(axes.y, p), glm::dot(axes.z, p)};
  }
  return out;
}

/// Tangent of the half angle of the square pyramid around the corners; infinite where the box reaches beside
/// or behind the origin, 0 where it lies wholly behind.
float tangentOf(const std::array<vec3, 8>& box) {
  float tangent = 0, nearest = box[0].z, farthest = box[0].z;
  for (const vec3& p : box) {
    nearest = std::min(nearest, p.z);
    farthest = std::max(farthest, p.z);
  }
  if (!(farthest > 0)) return 0;
  if (!(nearest > 1e-6f * farthest)) return std::numeric_limits<float>::infinity();
  for (const vec3& p : box) tangent = std::max(tangent, std::max(std::abs(p.x), std::abs(p.y)) / p.z);
  return tangent;
}

float fittedTangent(const vec3& origin, const Axes& axes, std::span<const Bounds> boxes) {
  float tangent = 0;
  for (const Bounds& box : boxes) {
    if (!box.empty()) tangent = std::max(tangent, tangentOf(corners(box, origin, axes)));
  }
  return tangent;
}

using Polygon = std::vector<vec3>;

/// The part of a polygon with dot(n, p) >= 0.
void clip(const Polygon& in, const vec3& n, Polygon& out) {
  out.clear();
  for (size_t i = 0; i < in.size(); ++i) {
    const vec3 a = in[i], b = in[(i + 1) % in.size()];
    const float ha = glm::dot(n, a), hb = glm::dot(n, b);
    if (ha >= 0) out.push_back(a);
    if ((ha >= 0) != (hb >= 0)) out.push_back(a + (ha / (ha - hb)) * (b - a));
  }
}

struct Range {
  float near = std::numeric_limits<float>::max(), far = 0;
};

/// Widens `range` by the depths of the part of the box inside the pyramid.
void addBox(const std::array<vec3, 8>& box, float tangent, Range& range) {
  float low = box[0].z, high = box[0].z;
  for (const vec3& p : box) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  if (high <= 0 || (low >= range.near && high <= range.far)) return;
  constexpr std::array<std::array<size_t, 4>, 6> sides{
      {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
  const std::array<vec3, 4> planes{vec3(1, 0, tangent), vec3(-1, 0, tangent), vec3(0, 1, tangent),
                                   vec3(0, -1, tangent)};
  Polygon polygon, clipped;
  for (const auto& side : sides) {
    polygon.clear();
    for (const size_t corner : side) polygon.push_back(box[corner]);
    for (const vec3& plane : planes) {
      clip(polygon, plane, clipped);
      polygon.swap(clipped);
    }
    for (const vec3& p : polygon) {
      range.near = std::min(range.near, std::max(p.z, 0.f));
      range.far = std::max(range.far, p.z);
    }
  }
}

/// Depths of everything inside the pyramids of `faces`; with the origin inside a box, from 0 on.
Range pyramidRange(const vec3& origin, const Axes& axes, uint32_t faceCount, uint32_t step, float tangent,
                   std::span<const Bounds> boxes) {
  Range range;
  for (uint32_t face = 0; face < faceCount; ++face) {
    const Axes frame = faceAxes(axes, face * step);
    for (const Bounds& box : boxes) {
      if (box.empty()) continue;
      addBox(corners(box, origin, frame), tangent, range);
      if (glm::all(glm::lessThanEqual(box.low, origin)) && glm::all(glm::lessThanEqual(origin, box.high)))
        range.near = 0;
    }
  }
  return range;
}

/// A little room at both ends, so that what touches them is not cut by rounding; never empty.
Range widened(Range range) {
  if (!(range.far > 0)) return {leastNear, 1};
  range.far *= 1.0001f;
  range.near = std::max(0.9999f * range.near, leastNear * range.far);
  return range;
}

glsl::ShadowView makeView(uint32_t projection, const vec3& origin, const Axes& axes, float scale,
                          const Range& range, int size, uint32_t layer, uint32_t light) {
  float footprint = 1 / (scale * static_cast<float>(size));
  // At the centre of a paraboloid map a texel spans 4 / size radians: uv = 1/2 + s tan(angle / 2).
  if (projection == glsl::shadow_paraboloid) footprint *= 2;
  return {.origin = glm::vec4(origin, range.near),
          .axis_x = glm::vec4(axes.x, scale),
          .axis_y = glm::vec4(axes.y, footprint),
          .axis_z = glm::vec4(axes.z, range.far),
          .info = {projection, layer, static_cast<uint32_t>(size), light}};
}

struct Writer {
  uint32_t lightIndex;
  int size;
  std::vector<glsl::ShadowView>& views;
  std::vector<glsl::ShadowLight>& lights;

  void light(const glm::vec4& origin, uint32_t faces) {
    lights.push_back({origin, {static_cast<uint32_t>(views.size()), faces, lightIndex, 0}});
  }
  void view(uint32_t projection, const vec3& origin, const Axes& axes, float scale, const Range& range) {
    views.push_back(makeView(projection, origin, axes, scale, range, size,
                             static_cast<uint32_t>(views.size()), lightIndex));
  }
};

void appendOrthographic(const glsl::Light& light, const vec3& direction, std::span<const Bounds> boxes,
                        Writer& out) {
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
  const float width = std::max({size.x, size.y, 1e-6f * size.z}) * (1 + 4 / static_cast<float>(out.size));
  const float depth = std::max(size.z, 1e-3f * width);
  // The plane z = 0 lies a tenth of the depth before everything, so that depths are positive.
  const vec3 origin = centre + middle.x * axes.x + middle.y * axes.y + (middle.z - 0.6f * depth) * axes.z;
  out.light(glm::vec4(-direction, 0), glsl::shadow_faces_single);
  out.view(glsl::shadow_orthographic, origin, axes, 1 / width, {0.0999f * depth, 1.1001f * depth});
}

vec3 samplePoint(const glsl::Light& light, const glm::vec2& sample) {
  const glm::vec2 ab = sample - 0.5f;
  return vec3(light.position) + ab.x * light.axis_u.w * vec3(light.axis_u) +
         ab.y * light.axis_v.w * vec3(light.axis_v);
}

/// The unit direction that a directional light's sample shines along.
vec3 sampleDirection(const glsl::Light& light, const glm::vec2& sample) {
  const glsl::LightView view = glsl::light_view(light, vec3(0), -vec3(light.direction), -1);
  return -glm::normalize(glsl::light_view_point(view, sample));
}

float spotTangent(const glsl::Light& light, int size) {
  const float angle = std::acos(std::clamp(light.cone.y, -1.f, 1.f));
  return angle <= largestHalfAngle ? std::tan(angle) * (1 + 4 / static_cast<float>(size)) : 2;
}

bool hasCone(const glsl::Light& light) {
  return (light.info.y & glsl::light_flag_cone) != 0 &&
         std::acos(std::clamp(light.cone.y, -1.f, 1.f)) <= largestHalfAngle;
}

bool twoSided(const glsl::Light& light) {
  return (light.info.y & glsl::light_flag_two_sided) != 0;
}

LightLayout paraboloidLayout(const glsl::Light& light) {
  const bool both = light.info.x == glsl::light_point || twoSided(light) ||
                    (light.info.x == glsl::light_spot && light.cone.y < 0);
  return {glsl::shadow_paraboloid, both ? glsl::shadow_faces_pair : glsl::shadow_faces_single};
}

}  // namespace

std::vector<glm::vec2> samplesOf(const glsl::Light& light, const ShadowMapDesc& desc) {
  if (desc.samples.empty()) return {glm::vec2(0.5f)};
  return glsl::light_has_extent(light) ? desc.samples : std::vector<glm::vec2>{glm::vec2(0.5f)};
}

LightLayout fitLayout(const glsl::Light& light, std::span<const Bounds> boxes, const ShadowMapDesc& desc) {
  if (light.info.x == glsl::light_directional) return {glsl::shadow_orthographic, glsl::shadow_faces_single};
  if (desc.projection == Projection::paraboloid) return paraboloidLayout(light);
  const LightLayout cube{glsl::shadow_perspective, glsl::shadow_faces_cube};
  if (light.info.x == glsl::light_point || desc.projection == Projection::cube) return cube;
  if (light.info.x == glsl::light_spot)
    return hasCone(light) ? LightLayout{glsl::shadow_perspective, glsl::shadow_faces_single} : cube;

  const Axes axes = axesOf(light);
  const bool both = twoSided(light);
  float tangent = 0;
  for (const glm::vec2& sample : samplesOf(light, desc)) {
    const vec3 origin = samplePoint(light, sample);
    tangent = std::max(tangent, fittedTangent(origin, axes, boxes));
    if (both) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
  }
  if (tangent <= std::tan(largestHalfAngle) || (!both && hasCone(light) && desc.samples.empty()))
    return {glsl::shadow_perspective, both ? glsl::shadow_faces_pair : glsl::shadow_faces_single};
  return both ? cube : LightLayout{glsl::shadow_perspective, glsl::shadow_faces_hemicube};
}

void appendViews(const glsl::Light& light, uint32_t lightIndex, const LightLayout& layout,
                 std::span<const Bounds> boxes, const ShadowMapDesc& desc,
                 std::vector<glsl::ShadowView>& views, std::vector<glsl::ShadowLight>& lights) {
  Writer out{lightIndex, desc.size, views, lights};
  const Axes axes = axesOf(light);
  const uint32_t count = glsl::shadow_face_count(layout.faces);
  const std::vector<glm::vec2> samples = samplesOf(light, desc);
  for (const glm::vec2& sample : samples) {
    if (layout.projection == glsl::shadow_orthographic) {
      appendOrthographic(light, sampleDirection(light, sample), boxes, out);
      continue;
    }
    const vec3 origin = samplePoint(light, sample);
    out.light(glm::vec4(origin, 1), layout.faces);
    // The second view of a pair looks backwards.
    const uint32_t step = layout.faces == glsl::shadow_faces_pair ? 5 : 1;
    if (layout.projection == glsl::shadow_paraboloid) {
      const Range range = widened(pyramidRange(origin, axes, 6, 1, 1, boxes));
      const Range radial{0.5f * range.near, std::sqrt(3.f) * range.far};  // corners of the cube faces
      for (uint32_t face = 0; face < count; ++face)
        out.view(glsl::shadow_paraboloid, origin, faceAxes(axes, face * step), 0.5f, radial);
      continue;
    }
    float tangent = 1;
    if (count <= 2) {
      tangent = light.info.x == glsl::light_spot ? spotTangent(light, desc.size)
                                                 : fittedTangent(origin, axes, boxes);
      if (count == 2) tangent = std::max(tangent, fittedTangent(origin, faceAxes(axes, 5), boxes));
      if (light.info.x != glsl::light_spot) tangent *= 1 + 4 / static_cast<float>(desc.size);
      if (hasCone(light) && count == 1) tangent = std::min(tangent, spotTangent(light, desc.size));
      if (!(tangent > 0)) tangent = 1;
    }
    const Range range = widened(pyramidRange(origin, axes, count, step, tangent, boxes));
    for (uint32_t face = 0; face < count; ++face)
      out.view(glsl::shadow_perspective, origin, faceAxes(axes, face * step), 0.5f / tangent, range);
  }
  for (size_t shared = samples.size(); shared < desc.samples.size(); ++shared)
    lights.push_back(lights.back());
}

scene::CullVolume cullVolume(const glsl::ShadowView& view) {
  const vec3 origin(view.origin), x(view.axis_x), y(view.axis_y), z(view.axis_z);
  const auto plane = [&](const vec3& n, float offset) { return glm::vec4(n, offset - glm::dot(n, origin)); };
  const float half = 0.5f / view.axis_x.w;
  scene::CullVolume volume;
  if (view.info.x == glsl::shadow_orthographic) {
    volume.planes = {plane(x, half),  plane(-x, half), plane(y, half),
                     plane(-y, half), plane(z, 0),     plane(-z, view.axis_z.w)};
  } else if (view.info.x == glsl::shadow_perspective) {
    volume.planes = {plane(x + half * z, 0),
                     plane(half * z - x, 0),
                     plane(y + half * z, 0),
                     plane(half * z - y, 0),
                     plane(z, 0),
                     plane(-z, view.axis_z.w)};
  } else {
    volume.planes[0] = plane(z, 0);
  }
  return volume;
}

}  // namespace limn::shadow
