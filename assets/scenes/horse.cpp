#include "assets/scenes/horse.h"

#include <cmath>

#include "assets/generator/implicit.h"
#include "assets/generator/simplify.h"

namespace limn::assets {
namespace {

/// A tube through joints (position, radius), its radii blended.
struct Limb {
  std::vector<glm::vec3> path;
  std::vector<float> radii;

  Limb(std::initializer_list<glm::vec4> joints) {
    for (const glm::vec4& j : joints) {
      path.emplace_back(j);
      radii.push_back(j.w);
    }
  }
  /// `thin`: how much narrower than deep.
  float at(glm::vec3 p, float thin = 1) const {
    return polylineTube({p.x, p.y, p.z * thin}, path, radii) / thin;
  }
  /// Segments that run into each other softly.
  float soft(glm::vec3 p, float blend) const {
    float d = 1e9f;
    for (std::size_t i = 0; i + 1 < path.size(); ++i)
      d = smoothUnion(d, roundCone(p, path[i], path[i + 1], radii[i], radii[i + 1]), blend);
    return d;
  }
};

float trunk(glm::vec3 p) {
  const glm::vec3 q = mirrored(p);
  float d = ellipsoid(p, {-0.02f, 1.2f, 0}, {0.66f, 0.33f, 0.29f});                       // barrel
  d = smoothUnion(d, ellipsoid(p, {0.5f, 1.2f, 0}, {0.3f, 0.34f, 0.23f}), 0.2f);          // chest
  d = smoothUnion(d, ellipsoid(q, {0.44f, 1.26f, 0.13f}, {0.2f, 0.3f, 0.12f}), 0.12f);    // shoulder
  d = smoothUnion(d, ellipsoid(p, {0.32f, 1.48f, 0}, {0.28f, 0.14f, 0.1f}), 0.2f);        // withers
  d = smoothUnion(d, ellipsoid(p, {-0.58f, 1.3f, 0}, {0.36f, 0.29f, 0.26f}), 0.2f);       // croup
  d = smoothUnion(d, ellipsoid(q, {-0.6f, 1.14f, 0.15f}, {0.25f, 0.34f, 0.14f}), 0.14f);  // haunch
  d = smoothUnion(d, ellipsoid(q, {0.7f, 1.16f, 0.1f}, {0.12f, 0.16f, 0.1f}), 0.1f);      // breast
  return d;
}

float neck(glm::vec3 p) {
  static const Limb upper{
      {0.5f, 1.38f, 0, 0.26f}, {0.72f, 1.62f, 0, 0.19f}, {0.9f, 1.86f, 0, 0.14f}, {1.0f, 2.02f, 0, 0.115f}};
  static const Limb throat{{0.68f, 1.3f, 0, 0.19f}, {0.86f, 1.56f, 0, 0.14f}, {1.0f, 1.8f, 0, 0.1f}};
  return smoothUnion(upper.at(p, 1.5f), throat.at(p, 1.35f), 0.12f);
}

float horseHead(glm::vec3 p) {
  const glm::vec3 q = mirrored(p);
  static const Limb skull{{1.02f, 2.02f, 0, 0.12f},
                          {1.16f, 1.9f, 0, 0.115f},
                          {1.34f, 1.68f, 0, 0.082f},
                          {1.45f, 1.54f, 0, 0.07f}};
  float d = skull.at(p, 1.25f);
  d = smoothUnion(d, ellipsoid(q, {1.09f, 1.82f, 0.055f}, {0.12f, 0.13f, 0.05f}), 0.05f);       // cheek
  d = smoothUnion(d, roundCone(p, {1.12f, 1.76f, 0}, {1.38f, 1.52f, 0}, 0.05f, 0.04f), 0.06f);  // jaw
  d = smoothUnion(d, ellipsoid(p, {1.45f, 1.55f, 0}, {0.075f, 0.075f, 0.075f}), 0.05f);         // muzzle
  d = smoothUnion(d, roundCone(p, {1.4f, 1.47f, 0}, {1.44f, 1.48f, 0}, 0.035f, 0.03f), 0.03f);  // chin
  d = smoothUnion(d, ellipsoid(q, {1.17f, 1.945f, 0.083f}, {0.045f, 0.025f, 0.022f}), 0.03f);   // brow
  d = smoothUnion(d, ellipsoid(q, {1.18f, 1.92f, 0.09f}, {0.028f, 0.026f, 0.018f}), 0.006f);    // eye
  d = smoothCut(d, ellipsoid(q, {1.505f, 1.57f, 0.052f}, {0.022f, 0.03f, 0.022f}), 0.02f);      // nostril
  d = smoothCut(d, roundCone(q, {1.41f, 1.498f, 0.03f}, {1.5f, 1.5f, 0.03f}, 0.006f, 0.006f),
                0.014f);  // lips
  // Ears: cones turned forwards, hollow in front.
  const float ear = roundCone(q, {1.0f, 2.09f, 0.07f}, {1.03f, 2.25f, 0.085f}, 0.042f, 0.009f);
  const float hollow = roundCone(q, {1.045f, 2.11f, 0.08f}, {1.05f, 2.23f, 0.09f}, 0.03f, 0.006f);
  return smoothUnion(d, smoothCut(ear, hollow, 0.012f), 0.03f);
}

/// Locks of hair: waves across the direction in which `along` grows.
float locks(glm::vec3 p, float along) {
  return 0.011f * std::sin(46 * p.x + 14 * p.z + 7 * along) + 0.006f * std::sin(83 * p.x - 31 * along);
}

float mane(glm::vec3 p) {
  static const Limb crest{{0.42f, 1.6f, 0, 0.05f},  {0.6f, 1.74f, 0, 0.055f},  {0.8f, 1.97f, 0, 0.055f},
                          {0.93f, 2.13f, 0, 0.05f}, {1.04f, 2.15f, 0, 0.045f}, {1.13f, 2.06f, 0, 0.03f}};
  static const Limb fall{{0.5f, 1.62f, 0.12f, 0.05f},
                         {0.68f, 1.74f, 0.13f, 0.06f},
                         {0.84f, 1.93f, 0.1f, 0.05f},
                         {0.95f, 2.07f, 0.06f, 0.045f}};
  const float d = smoothUnion(crest.at(p, 1.3f), fall.soft(p, 0.05f), 0.09f);
  return 0.8f * (d + locks(p, p.y));
}

float tail(glm::vec3 p) {
  static const Limb hair{{-0.86f, 1.42f, 0, 0.06f},      {-0.98f, 1.42f, 0, 0.062f},
                         {-1.08f, 1.28f, 0.01f, 0.075f}, {-1.14f, 1.02f, 0.03f, 0.09f},
                         {-1.16f, 0.78f, 0.05f, 0.075f}, {-1.21f, 0.5f, 0.06f, 0.02f}};
  const float s = glm::clamp((1.4f - p.y) / 0.6f, 0.0f, 1.0f);
  return 0.8f * (hair.soft(p, 0.06f) + s * 0.012f * std::sin(70 * (p.x + 0.35f * p.y) + 4 * p.z) +
                 s * 0.01f * std::sin(64 * p.z + 9 * p.y));
}

/// Flat below: the hoof's sole at height `sole`, square to the pastern.
float hoof(glm::vec3 p, glm::vec3 top, glm::vec3 toe, float sole) {
  const float horn = roundCone(p, top, toe, 0.056f, 0.074f);
  return smoothCut(horn, p.y - sole, 0.012f);
}

float foreleg(glm::vec3 p) {
  static const Limb bones{{0.5f, 1.08f, 0.17f, 0.13f},   {0.47f, 0.9f, 0.17f, 0.1f},
                          {0.49f, 0.62f, 0.17f, 0.066f}, {0.5f, 0.53f, 0.17f, 0.062f},
                          {0.49f, 0.46f, 0.17f, 0.05f},  {0.485f, 0.24f, 0.17f, 0.043f},
                          {0.49f, 0.19f, 0.17f, 0.052f}, {0.54f, 0.1f, 0.17f, 0.045f}};
  return smoothUnion(bones.soft(p, 0.03f), hoof(p, {0.55f, 0.08f, 0.17f}, {0.59f, 0.03f, 0.17f}, 0), 0.015f);
}

/// Lifted at the walk: the knee forwards, the cannon hanging back.
float liftedForeleg(glm::vec3 p) {
  static const Limb bones{{0.52f, 1.08f, -0.17f, 0.13f},  {0.54f, 0.92f, -0.17f, 0.1f},
                          {0.73f, 0.72f, -0.17f, 0.067f}, {0.79f, 0.66f, -0.17f, 0.063f},
                          {0.77f, 0.59f, -0.17f, 0.05f},  {0.66f, 0.41f, -0.17f, 0.043f},
                          {0.63f, 0.37f, -0.17f, 0.052f}, {0.6f, 0.27f, -0.17f, 0.045f}};
  // The hoof hangs: its own frame, turned so that the sole looks backwards and down.
  const glm::vec3 q = p - glm::vec3(0.6f, 0.25f, -0.17f);
  const float c = std::cos(0.9f), s = std::sin(0.9f);
  const glm::vec3 turned(c * q.x - s * q.y, s * q.x + c * q.y, q.z);
  return smoothUnion(bones.soft(p, 0.03f), hoof(turned, {0, 0, 0}, {0.04f, -0.05f, 0}, -0.08f), 0.015f);
}

/// Stretched behind the trunk or stepping under it.
struct Hindleg {
  float step;  ///< metres to the front per metre below the hip
  float z;
  Limb bones{at(-0.58f, 1.16f, 0.2f),   at(-0.46f, 0.95f, 0.15f),  at(-0.58f, 0.74f, 0.1f),
             at(-0.74f, 0.58f, 0.066f), at(-0.75f, 0.52f, 0.06f),  at(-0.71f, 0.44f, 0.05f),
             at(-0.7f, 0.24f, 0.046f),  at(-0.69f, 0.19f, 0.055f), at(-0.64f, 0.1f, 0.047f)};

  glm::vec4 at(float x, float y, float radius) const { return {x + step * (1.1f - y), y, z, radius}; }
  float distance(glm::vec3 p) const {
    const glm::vec3 heel(at(-0.76f, 0.6f, 0)), hock(at(-0.8f, 0.62f, 0));
    const glm::vec3 top(at(-0.63f, 0.08f, 0)), toe(at(-0.59f, 0.03f, 0));
    const float shank = smoothUnion(bones.soft(p, 0.04f), roundCone(p, heel, hock, 0.045f, 0.03f), 0.04f);
    return smoothUnion(shank, hoof(p, top, toe, 0), 0.015f);
  }
};

float body(glm::vec3 p) {
  static const Hindleg left{0.14f, 0.16f}, right{-0.1f, -0.16f};
  float d = trunk(p);
  d = smoothUnion(d, neck(p), 0.16f);
  d = smoothUnion(d, horseHead(p), 0.06f);
  d = smoothUnion(d, foreleg(p), 0.08f);
  d = smoothUnion(d, liftedForeleg(p), 0.08f);
  d = smoothUnion(d, left.distance(p), 0.1f);
  d = smoothUnion(d, right.distance(p), 0.1f);
  d = smoothUnion(d, tail(p), 0.02f);
  return smoothUnion(d, mane(p), 0.012f);
}

}  // namespace

Mesh horse(std::size_t triangles) {
  return simplified(polygonise(body, {-1.4f, -0.05f, -0.5f}, {1.7f, 2.4f, 0.5f}, 0.016f), triangles);
}

}  // namespace limn::assets
