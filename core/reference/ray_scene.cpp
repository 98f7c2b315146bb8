#include "core/reference/private/ray_scene.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

#include "core/base/error.h"
#include "core/scene/draw_instance.h"
#include "core/scene/normal_matrix.h"
#include "core/scene/texture_lookup.h"
#include "glsl/surface/texture_level.glsl"

namespace limn::reference {
namespace {

/// Ray query that knows which pixel asks (for the filter of view rays).
struct Context {
  RTCIntersectContext embree;
  const RayScene* scene;
  const glsl::FrameBlock* frame = nullptr;  ///< null: not a view ray
  ViewPixel pixel;
  float away = 1;  ///< 1: a view ray leads away from the camera, -1: to it

  explicit Context(const RayScene* of) : scene(of) { rtcInitIntersectContext(&embree); }
};

/// A ray from `origin` that has met nothing yet.
RTCRay rayFrom(const glm::vec3& origin, const glm::vec3& direction, float near, float far) {
  RTCRay ray{};
  ray.org_x = origin.x;
  ray.org_y = origin.y;
  ray.org_z = origin.z;
  ray.dir_x = direction.x;
  ray.dir_y = direction.y;
  ray.dir_z = direction.z;
  ray.tnear = near;
  ray.tfar = far;
  ray.mask = ~0u;
  return ray;
}

/// What a filter needs of the geometry that was hit. For instanced geometry `draw` is none: the context names
/// it.
struct GeometryUser {
  const scene::Primitive* primitive;
  const scene::Material* material;
  int draw;
  float orientation;
};

uint32_t drawOf(const GeometryUser& user, const RTCIntersectContext& context) {
  return user.draw != scene::kNone ? static_cast<uint32_t>(user.draw) : context.instID[0];
}

glm::vec2 uvAt(const scene::Primitive& primitive, uint32_t triangle, float u, float v) {
  const uint32_t* i = &primitive.indices[3 * static_cast<size_t>(triangle)];
  return (1.f - u - v) * primitive.uvs[i[0]] + u * primitive.uvs[i[1]] + v * primitive.uvs[i[2]];
}

float coverageAt(const scene::Scene& scene, const scene::Primitive& primitive,
                 const scene::Material& material, uint32_t triangle, float u, float v, float lod) {
  float alpha = material.baseColour.a;
  if (material.baseColourTexture.image != scene::kNone && !primitive.uvs.empty())
    alpha *= scene::sampleTexture(scene, material.baseColourTexture, uvAt(primitive, triangle, u, v), lod).a;
  if (!primitive.colours.empty()) {
    const uint32_t* i = &primitive.indices[3 * static_cast<size_t>(triangle)];
    alpha *= (1.f - u - v) * primitive.colours[i[0]].a + u * primitive.colours[i[1]].a +
             v * primitive.colours[i[2]].a;
  }
  return alpha;
}

bool isMasked(const scene::Material& material) {
  return material.alphaCutoff > 0.f;
}

void surfaceFilter(const RTCFilterFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const auto& context = *reinterpret_cast<const Context*>(args->context);
  const auto& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  if (context.frame && !user.material->doubleSided) {
    // The camera sees no back faces. Embree gives ray and normal in the geometry's own space, where the
    // winding is the file's.
    const float facing = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
    if (facing * user.orientation * context.away >= 0.f) {
      args->valid[0] = 0;
      return;
    }
  }
  if (!isMasked(*user.material)) return;
  const scene::Scene& scene = context.scene->scene();
  const Draw& draw = context.scene->draws()[drawOf(user, context.embree)];
  float lod = 0.f;
  if (context.frame && user.material->baseColourTexture.image != scene::kNone && !user.primitive->uvs.empty())
    lod = levelOfDetail(scene, user.material->baseColourTexture,
                        textureFootprint(draw, hit.primID, *context.frame, context.pixel));
  if (coverageAt(scene, *user.primitive, *user.material, hit.primID, hit.u, hit.v, lod) <
      user.material->alphaCutoff)
    args->valid[0] = 0;
}

void shadowFilter(const RTCFilterFunctionNArguments* args) {
  const auto& user = *static_cast<const GeometryUser*>(args->geometryUserPtr);
  const auto& context = *reinterpret_cast<const Context*>(args->context);
  const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  if (coverageAt(context.scene->scene(), *user.primitive, *user.material, hit.primID, hit.u, hit.v, 0.f) <
      user.material->alphaCutoff)
    args->valid[0] = 0;
}

/// Largest coordinate met when the box of `positions` goes through `matrix`: bounds the rounding error of the
/// result.
float largestCoordinate(const glm::vec3* positions, size_t count, const glm::mat4& matrix) {
  glm::vec3 reach(0);
  for (size_t i = 0; i < count; ++i) reach = glm::max(reach, glm::abs(positions[i]));
  float largest = 0;
  for (int row = 0; row < 3; ++row)
    largest = std::max(largest, std::abs(matrix[0][row]) * reach.x + std::abs(matrix[1][row]) * reach.y +
                                    std::abs(matrix[2][row]) * reach.z + std::abs(matrix[3][row]));
  return largest;
}

/// Embree ends the program where a ray has a larger coordinate, or one that is no number.
constexpr float kLargestOfRays = 1e18f;

bool traceable(const RTCRay& ray) {
  const auto fits = [](float value) { return std::abs(value) <= kLargestOfRays; };
  return fits(ray.org_x) && fits(ray.org_y) && fits(ray.org_z) && fits(ray.dir_x) && fits(ray.dir_y) &&
         fits(ray.dir_z);
}

void fail(RTCDevice device, const char* what) {
  const RTCError code = rtcGetDeviceError(device);
  if (code != RTC_ERROR_NONE)
    throw Error(fmt::format("reference: Embree failed to {} ({}, error {})", what,
                            code == RTC_ERROR_OUT_OF_MEMORY ? "out of memory" : "internal",
                            static_cast<int>(code)));
}

}  // namespace

glm::vec2 barycentricOnPlane(const glm::vec3& p0, const glm::vec3& p1, const glm::vec3& p2,
                             const glm::vec3& origin, const glm::vec3& direction) {
  // Moeller and Trumbore 1997, in double: the quotients lose what nearly parallel lines leave.
  const glm::dvec3 e1 = glm::dvec3(p1) - glm::dvec3(p0), e2 = glm::dvec3(p2) - glm::dvec3(p0);
  const glm::dvec3 d(direction), from = glm::dvec3(origin) - glm::dvec3(p0);
  const glm::dvec3 p = glm::cross(d, e2), q = glm::cross(from, e1);
  const double determinant = glm::dot(e1, p);
  return glm::vec2(glm::dot(from, p) / determinant, glm::dot(d, q) / determinant);
}

TextureFootprint textureFootprint(const Draw& draw, uint32_t triangle, const glsl::FrameBlock& frame,
                                  const ViewPixel& pixel) {
  const uint32_t* i = &draw.primitive->indices[3 * static_cast<size_t>(triangle)];
  glm::vec3 p[3];
  for (int k = 0; k < 3; ++k) p[k] = glm::vec3(draw.toWorld * glm::vec4(draw.positions[i[k]], 1.f));
  const glm::vec3 origin(frame.camera_position);
  const auto uvOf = [&](int px, int py) {
    const glm::vec2 b = barycentricOnPlane(p[0], p[1], p[2], origin,
                                           viewRay(frame, static_cast<float>(px), static_cast<float>(py)));
    return uvAt(*draw.primitive, triangle, b.x, b.y);
  };
  const auto& [x, y, aa] = pixel;
  const int left = (x / aa & ~1) * aa + x % aa, below = (y / aa & ~1) * aa + y % aa;
  return {uvOf(left + aa, y) - uvOf(left, y), uvOf(x, below + aa) - uvOf(x, below)};
}

float levelOfDetail(const scene::Scene& scene, const scene::TextureRef& texture,
                    const TextureFootprint& footprint) {
  return levelOfDetail(scene::textureSize(scene, texture), footprint);
}

float levelOfDetail(const glm::vec2& size, const TextureFootprint& footprint) {
  const float lod = glsl::texture_level(footprint.dx, footprint.dy, size);
  return std::isnan(lod) ? 32.f : lod;
}

struct RayScene::Hierarchy {
  RTCDevice device = nullptr;
  RTCScene top = nullptr;
  std::vector<GeometryUser> users;              ///< addresses are given to Embree: reserved once
  std::vector<std::vector<glm::vec3>> normals;  ///< of deformed primitives
  std::vector<std::vector<glm::vec4>> tangents;
  std::vector<RTCScene> shared;
  struct SharedGeometry {
    RTCScene scene;
    const glm::vec3* positions;
  };
  std::map<std::pair<int, int>, SharedGeometry> sharedOf;  ///< by mesh and primitive
  std::map<uint32_t, RTCScene> bodies;                     ///< translucent draws, each alone

  Hierarchy() {
    device = rtcNewDevice(nullptr);
    if (!device) throw Error("reference: Embree could not be started");
    top = newScene();
  }
  ~Hierarchy() {
    for (RTCScene scene : shared) rtcReleaseScene(scene);
    for (const auto& [draw, scene] : bodies) rtcReleaseScene(scene);
    if (top) rtcReleaseScene(top);
    rtcReleaseDevice(device);
  }
  Hierarchy(const Hierarchy&) = delete;
  Hierarchy& operator=(const Hierarchy&) = delete;

  RTCScene newScene() const {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return scene;
  }

  /// Attaches `primitive`'s triangles with vertices matrix * positions and returns those vertices, which live
  /// as long as the scene.
  const glm::vec3* attach(RTCScene scene, unsigned id, const scene::Primitive& primitive,
                          const std::vector<glm::vec3>& positions, const glm::mat4& matrix,
                          GeometryUser user) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), positions.size()));
    auto* indices =
        static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                       3 * sizeof(uint32_t), primitive.indices.size() / 3));
    if (!vertices || !indices) {
      rtcReleaseGeometry(geometry);
      fail(device, "allocate a geometry");
      throw Error("reference: Embree gave no buffer for a geometry");
    }
    for (size_t i = 0; i < positions.size(); ++i)
      vertices[i] = glm::vec3(matrix * glm::vec4(positions[i], 1.f));
    std::memcpy(indices, primitive.indices.data(), primitive.indices.size() * sizeof(uint32_t));
    users.push_back(user);
    rtcSetGeometryUserData(geometry, &users.back());
    if (!user.material->doubleSided || isMasked(*user.material))
      rtcSetGeometryIntersectFilterFunction(geometry, surfaceFilter);
    if (isMasked(*user.material)) rtcSetGeometryOccludedFilterFunction(geometry, shadowFilter);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
    fail(device, "attach a geometry");
    return vertices;
  }

  /// Attaches an instance of a primitive that several draws share; built when first asked for.
  const glm::vec3* attachShared(unsigned id, std::pair<int, int> key, const scene::Primitive& primitive,
                                const glm::mat4& matrix, const GeometryUser& user) {
    auto found = sharedOf.find(key);
    if (found == sharedOf.end()) {
      RTCScene scene = newScene();
      shared.push_back(scene);
      const glm::vec3* positions = attach(scene, 0, primitive, primitive.positions, glm::mat4(1), user);
      rtcCommitScene(scene);
      fail(device, "build a hierarchy");
      found = sharedOf.emplace(key, SharedGeometry{scene, positions}).first;
    }
    RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, found->second.scene);
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR, &matrix);
    rtcCommitGeometry(instance);
    rtcAttachGeometryByID(top, instance, id);
    rtcReleaseGeometry(instance);
    fail(device, "attach an instance");
    return found->second.positions;
  }

  /// Builds the hierarchy of a draw alone.
  void addBody(uint32_t id, const Draw& draw, const std::vector<glm::vec3>& positions,
               const glm::mat4& matrix) {
    RTCScene scene = bodies.emplace(id, newScene()).first->second;
    attach(scene, 0, *draw.primitive, positions, matrix,
           {draw.primitive, draw.material, static_cast<int>(id), draw.orientation});
    rtcCommitScene(scene);
    fail(device, "build a body's hierarchy");
  }
};

RayScene::RayScene(const scene::Scene& scene, const scene::Pose& pose, bool unshadowed)
    : scene_(scene),
      unshadowed_(unshadowed),
      medium_(scene, pose),
      hierarchy_(std::make_unique<Hierarchy>()) {
  Hierarchy& h = *hierarchy_;
  for (const relief::HeightField& field : scene.heights) slopes_.push_back(relief::slopeLevels(field));
  std::map<std::pair<int, int>, int> uses;
  for (const auto& instance : pose.instances)
    if (instance.node != scene::kNone && instance.deformed == scene::kNone)
      ++uses[{instance.mesh, instance.primitive}];
  h.users.reserve(2 * pose.instances.size() + uses.size());
  draws_.reserve(pose.instances.size());

  for (const scene::DrawInstance& instance : pose.instances) {
    const auto id = static_cast<unsigned>(draws_.size());
    const bool dynamic = instance.node == scene::kNone;
    const scene::Primitive& primitive = scene::primitiveOf(scene, pose, instance);
    Draw& draw = draws_.emplace_back();
    draw.primitive = &primitive;
    draw.material = &scene::materialOf(scene, instance);
    draw.normals = primitive.normals.data();
    draw.tangents = primitive.tangents.empty() ? nullptr : primitive.tangents.data();
    const glm::mat4& matrix = instance.objectToWorld;
    draw.tangentToWorld = glm::mat3(matrix);
    draw.normalToWorld = scene::normalMatrix(matrix);
    draw.orientation = scene::mirrored(instance) ? -1.f : 1.f;
    // A source may have no triangles for a while, and Embree makes no buffer without a size.
    if (primitive.indices.empty()) continue;

    const std::pair<int, int> key{instance.mesh, instance.primitive};
    if (!dynamic && instance.deformed == scene::kNone && uses[key] > 1 && takesRays(matrix)) {
      draw.toWorld = matrix;
      draw.positions =
          h.attachShared(id, key, primitive, matrix, {&primitive, draw.material, scene::kNone, 1.f});
      if (draw.material->subsurface) h.addBody(id, draw, primitive.positions, matrix);
    } else {
      std::vector<glm::vec3> deformedPositions;
      const std::vector<glm::vec3>* positions = &primitive.positions;
      if (instance.deformed != scene::kNone) {
        auto& normals = h.normals.emplace_back();
        auto& tangents = h.tangents.emplace_back();
        scene::deform(primitive, pose.deformed[static_cast<size_t>(instance.deformed)], deformedPositions,
                      normals, tangents);
        positions = &deformedPositions;
        draw.normals = normals.data();
        draw.tangents = tangents.empty() ? nullptr : tangents.data();
      }
      draw.positions = h.attach(h.top, id, primitive, *positions, matrix,
                                {&primitive, draw.material, static_cast<int>(id), draw.orientation});
      if (draw.material->subsurface) h.addBody(id, draw, *positions, matrix);
    }
    if (draw.material->height != scene::kNone && !primitive.uvs.empty() && draw.tangents) {
      const relief::HeightField& heights = scene.heights[static_cast<size_t>(draw.material->height)];
      if (heights.lowest() < heights.highest()) draw.heights = &heights;
    }
    draw.rayOffset = 0x1p-20f * largestCoordinate(draw.positions, primitive.positions.size(), draw.toWorld);
  }
  rtcCommitScene(h.top);
  fail(h.device, "build the hierarchy");
}

RayScene::~RayScene() = default;

const scene::EnvironmentLight& RayScene::environment() const {
  std::call_once(environmentAsked_, [&] { environment_.emplace(scene_.environment); });
  return *environment_;
}

namespace {

/// The nearest surface that the query's filter lets pass.
bool intersect(RTCScene top, Context& context, const RTCRay& ray, Hit& hit) {
  if (!traceable(ray)) return false;
  RTCRayHit query{};
  query.ray = ray;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(top, &context.embree, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit.draw = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID ? query.hit.instID[0] : query.hit.geomID;
  hit.triangle = query.hit.primID;
  hit.u = query.hit.u;
  hit.v = query.hit.v;
  hit.depth = query.ray.tfar;
  return true;
}

}  // namespace

bool RayScene::see(const glsl::FrameBlock& frame, float near, const ViewPixel& pixel, Hit& hit) const {
  Context context(this);
  context.frame = &frame;
  context.pixel = pixel;
  const glm::vec3 direction = viewRay(frame, static_cast<float>(pixel.x), static_cast<float>(pixel.y));
  return intersect(
      hierarchy_->top, context,
      rayFrom(glm::vec3(frame.camera_position), direction, near, std::numeric_limits<float>::infinity()),
      hit);
}

bool RayScene::hidden(const glsl::FrameBlock& frame, float near, const ViewPixel& pixel,
                      const glm::vec3& origin) const {
  Context context(this);
  context.frame = &frame;
  context.pixel = pixel;
  context.away = -1;
  const glm::vec3 towards = glm::vec3(frame.camera_position) - origin;
  const float depth = -(frame.world_to_view * glm::vec4(origin, 1)).z;
  Hit hit;
  return intersect(hierarchy_->top, context, rayFrom(origin, towards, 0.f, 1 - near / depth), hit);
}

bool RayScene::nearest(const glm::vec3& origin, const glm::vec3& direction, Hit& hit) const {
  Context context(this);
  return intersect(hierarchy_->top, context,
                   rayFrom(origin, direction, 0.f, std::numeric_limits<float>::infinity()), hit);
}

bool RayScene::nearestOfBody(uint32_t draw, const glm::vec3& origin, const glm::vec3& direction, float from,
                             float to, Hit& hit) const {
  Context context(this);
  if (!intersect(hierarchy_->bodies.at(draw), context, rayFrom(origin, direction, from, to), hit))
    return false;
  hit.draw = draw;
  return true;
}

scene::Bounds RayScene::bodyBounds(uint32_t draw) const {
  RTCBounds b{};
  rtcGetSceneBounds(hierarchy_->bodies.at(draw), &b);
  scene::Bounds bounds;
  bounds.add({b.lower_x, b.lower_y, b.lower_z});
  bounds.add({b.upper_x, b.upper_y, b.upper_z});
  return bounds;
}

bool RayScene::occluded(const glm::vec3& origin, const glm::vec3& direction, float end) const {
  Context context(this);
  RTCRay ray = rayFrom(origin, direction, 0.f, end);
  if (!traceable(ray)) return false;
  rtcOccluded1(hierarchy_->top, &context.embree, &ray);
  return ray.tfar < 0.f;
}

}  // namespace limn::reference
