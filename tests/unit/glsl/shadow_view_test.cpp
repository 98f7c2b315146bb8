// Laws of the formulas that shadow techniques share (glsl/shadow/shadow_view.glsl, light_view.glsl,
// sampling.glsl).
#include "glsl/shadow/shadow_view.glsl"

#include <gtest/gtest.h>

#include <random>

#include "glsl/light/light_view.glsl"
#include "glsl/numeric/sampling.glsl"

namespace limn::glsl {
namespace {

constexpr float kTangent = 0.7f, kNearPlane = 0.5f, kFarPlane = 20.f;

ShadowView view(uint32_t kind) {
  const Frame frame = frame_around(normalize(vec3(0.3f, -0.8f, 0.4f)));
  const float scale = kind == shadow_perspective    ? 0.5f / kTangent
                      : kind == shadow_orthographic ? 1 / 12.f
                                                    : 0.5f;
  ShadowView v{};
  v.origin = vec3(1, 2, 3);
  v.near = kNearPlane;
  v.axis_x = frame.t;
  v.scale = scale;
  v.axis_y = -frame.b;
  v.footprint = 1 / (scale * 256);
  v.axis_z = frame.n;
  v.far = kFarPlane;  // cross(t, -b) = -n
  v.middle = vec2(0.5f, 0.5f);
  v.projection = kind;
  v.size = 256;
  return v;
}

TEST(ShadowView, ProjectionAndItsInverseAgreeUnderEveryKind) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.02f, 0.98f), depth(kNearPlane, kFarPlane);
  for (const uint32_t kind : {shadow_perspective, shadow_orthographic, shadow_paraboloid}) {
    const ShadowView v = view(kind);
    for (int i = 0; i < 1000; ++i) {
      const vec2 uv(uniform(random), uniform(random));
      const float d = depth(random);
      const vec3 offset = shadow_unproject_local(v, uv, d);
      const ShadowPoint q = shadow_project(v, v.origin + shadow_world_offset(v, offset));
      EXPECT_NEAR(q.uv.x, uv.x, 1e-5f);
      EXPECT_NEAR(q.uv.y, uv.y, 1e-5f);
      EXPECT_NEAR(q.depth, d, 1e-5f * d);
      EXPECT_TRUE(shadow_inside(q));
      EXPECT_NEAR(shadow_metres(v, shadow_normalise(v, d)), d, 1e-5f * d);
      if (kind == shadow_paraboloid) continue;
      // What is rasterised lands where it is looked up.
      const vec4 clip = shadow_clip(v, v.origin + shadow_world_offset(v, offset));
      EXPECT_NEAR(0.5f * clip.x / clip.w + 0.5f, uv.x, 1e-5f);
      EXPECT_NEAR(0.5f * clip.y / clip.w + 0.5f, uv.y, 1e-5f);
      EXPECT_GE(clip.z / clip.w, -1e-6f);
      EXPECT_LE(clip.z / clip.w, 1 + 1e-6f);
    }
  }
}

TEST(ShadowView, TexelsLieAtTheirCentres) {
  for (const uint32_t kind : {shadow_perspective, shadow_orthographic, shadow_paraboloid}) {
    const ShadowView v = view(kind);
    const float d = 0.5f * (kNearPlane + kFarPlane);
    const vec3 offset = shadow_texel_offset(v, {100, 40}, shadow_normalise(v, d));
    const ShadowPoint q = shadow_project_local(v, offset);
    EXPECT_NEAR(q.uv.x, 100.5f / 256, 1e-5f);
    EXPECT_NEAR(q.uv.y, 40.5f / 256, 1e-5f);
    EXPECT_NEAR(q.depth, d, 1e-5f * d);
  }
}

TEST(ShadowView, NothingBehindAViewIsInside) {
  const ShadowView v = view(shadow_perspective);
  for (const float back : {0.f, -1.f, -100.f})
    EXPECT_FALSE(shadow_inside(shadow_project(v, v.origin + back * v.axis_z)));
}

TEST(ShadowView, FacesOfACubeSeeEveryDirectionOnce) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  const ShadowView first = view(shadow_perspective);
  for (int i = 0; i < 1000; ++i) {
    const vec3 local(normal(random), normal(random), normal(random));
    const vec3 p = first.origin + shadow_world_offset(first, local);
    const uint32_t face = shadow_face(shadow_faces_cube, first, p);
    const vec3 a = abs(local);
    const float largest = max(a.x, max(a.y, a.z));
    const float expected[6] = {local.z, local.x, -local.x, local.y, -local.y, -local.z};
    EXPECT_NEAR(expected[face], largest, 1e-5f);
    if (local.z > 0) {
      EXPECT_EQ(shadow_face(shadow_faces_hemicube, first, p), face);
    }
    EXPECT_EQ(shadow_face(shadow_faces_pair, first, p), local.z >= 0 ? 0u : 1u);
    EXPECT_EQ(shadow_face(shadow_faces_single, first, p), 0u);
  }
}

/// What lies before a light beyond the edge of its first view is seen by another face of a cube or half cube.
TEST(ShadowView, OnlyFacesOfCubesGoOnWhereAnotherEnds) {
  const ShadowView first = view(shadow_perspective);
  const vec3 beyond = first.origin + shadow_world_offset(first, {1.1f, 0, 1});
  for (const uint32_t faces :
       {shadow_faces_single, shadow_faces_pair, shadow_faces_hemicube, shadow_faces_cube})
    EXPECT_EQ(shadow_views_apart(faces), shadow_face(faces, first, beyond) == 0) << faces;
}

/// The cone from a receiver to a square light, cut at depth z, is S (d - z) / d wide; the map is 2 z
/// tan(theta) wide there.
TEST(ShadowView, KernelWidthIsThatOfTheCone) {
  const ShadowView v = view(shadow_perspective);
  const float size = 0.8f, d = 10, z = 4;
  EXPECT_NEAR(shadow_kernel_width(v, size, d, z), size * (d - z) / (d * 2 * z * kTangent), 1e-6f);
  EXPECT_EQ(shadow_kernel_width(v, size, d, d), 0.f);
  EXPECT_EQ(shadow_kernel_width(v, size, d, 2 * d), 0.f);
  const ShadowView o = view(shadow_orthographic);
  EXPECT_NEAR(shadow_kernel_width(o, 0.1f, d, z), 0.1f * (d - z) / 12, 1e-6f);
}

TEST(ShadowView, APlaneNeverBlocksItselfWhateverItsSlope) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (const uint32_t kind : {shadow_perspective, shadow_orthographic}) {
    const ShadowView v = view(kind);
    for (int i = 0; i < 2000; ++i) {
      const vec3 on =
          shadow_unproject_local(v, vec2(0.2f + 0.6f * uniform(random), 0.2f + 0.6f * uniform(random)), 8);
      const vec3 n = normalize(vec3(2 * uniform(random) - 1, 2 * uniform(random) - 1, -uniform(random)));
      const vec3 x = v.origin + shadow_world_offset(v, on);
      const ShadowReceiver r = shadow_receiver(v, x, shadow_world_offset(v, n), v.axis_z, 1);
      // The plane along the ray through another texel.
      const vec3 ray = shadow_unproject_local(v, vec2(uniform(random), uniform(random)), 1);
      const vec3 start = kind == shadow_orthographic ? vec3(ray.x, ray.y, 0) : vec3(0);
      const vec3 direction = kind == shadow_orthographic ? vec3(0, 0, 1) : ray;
      const float t = dot(n, on - start) / dot(n, direction);
      if (!(t > 0.1f && t < 100)) continue;
      EXPECT_FALSE(shadow_blocks(r, start + t * direction));
      // Two texels above the plane, and nearer than the receiver: a blocker.
      const vec3 above = on + 2.5f * shadow_footprint(v, length(on)) * n;
      if (above.z < on.z - 1e-3f) {
        EXPECT_TRUE(shadow_blocks(r, above));
      }
    }
  }
}

Light rectangle(vec3 position, vec3 u, vec3 v, float width, float height) {
  Light light{};
  light.position = position;
  light.direction = -cross(u, v);
  light.axis_u = u;
  light.length_u = width;
  light.axis_v = v;
  light.length_v = height;
  light.type = light_rectangle;
  light.own_instance = no_instance;
  return light;
}

TEST(LightView, SamplesAreOfThePartAboveTheTangentPlaneAndFillIt) {
  const Light light = rectangle(vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, -1), 2, 1);
  for (const vec3 n : {vec3(0, 1, 0), normalize(vec3(1, 0.2f, 0)), normalize(vec3(1, -0.2f, 0.3f)),
                       normalize(vec3(-1, 0.3f, -1))}) {
    const vec3 x(0.3f, 0, 0.1f);
    const LightView v = light_view(light, x, n, -1);
    ASSERT_FALSE(v.masked);
    int accepted = 0;
    constexpr int count = 4096;
    for (uint32_t i = 0; i < count; ++i) {
      vec3 slope;
      if (!light_view_sample(v, r2_sequence(i), slope)) continue;
      ++accepted;
      const vec3 p = x + slope * v.depth;
      EXPECT_NEAR(p.y, 2, 1e-5f);
      EXPECT_LE(std::abs(p.x), 1.00001f);
      EXPECT_LE(std::abs(p.z), 0.50001f);
      EXPECT_GE(dot(n, p - x), 0.f);
      EXPECT_TRUE(light_view_contains(v, slope, 1e-5f));
    }
    // The accepted share of the box is the part's share of the light.
    const vec2 box = v.high - v.low;
    const float share = rectangle_part_share(rectangle_visible_part(light, x, n));
    EXPECT_NEAR(box.x * box.y * static_cast<float>(accepted) / count, share, 0.005f);
    EXPECT_GE(accepted, count / 2 - 40);
  }
  EXPECT_TRUE(light_view(light, vec3(0, 3, 0), vec3(0, -1, 0), -1).masked) << "behind the light";
  EXPECT_TRUE(light_view(light, vec3(0), vec3(0, -1, 0), -1).masked) << "below the horizon";
}

TEST(LightView, NothingOfALightIsHigherThanItsHighestPoint) {
  Light disc{};
  disc.direction = normalize(vec3(0.2f, -1, 0.1f));
  disc.angular_diameter = 1;
  disc.type = light_directional;
  disc.own_instance = no_instance;
  const vec3 along = -disc.direction, across = normalize(cross(along, vec3(0, 0, 1)));
  const Light flat = rectangle(vec3(0, 2, 0), vec3(1, 0, 0), vec3(0, 0, -1), 2, 1);
  // Of the height of the disc's centre above the plane; that of its half angle is 0.48.
  for (const float sine : {0.3f, -0.1f, -0.4f}) {
    const vec3 n = sine * along + std::sqrt(1 - sine * sine) * across;
    for (const Light& light : {disc, flat}) {
      const LightView v = light_view(light, vec3(0.1f, 0, 0.2f), n, -1);
      if (v.masked) continue;
      const vec3 highest = light_view_highest(v);
      for (const vec3& point : {highest, light_view_single_point(v)}) {
        EXPECT_GT(dot(point, n), 0.f);
        EXPECT_TRUE(light_view_contains(v, point, 1e-5f));
      }
      for (uint32_t i = 0; i < 1000; ++i)
        EXPECT_LE(dot(light_view_point(v, r2_sequence(i)), n), dot(highest, n) + 1e-5f);
    }
    EXPECT_FALSE(light_view(disc, vec3(0), n, -1).masked);
  }
}

TEST(LightView, DirectionsAreUniformInTheCone) {
  Light light{};
  light.direction = normalize(vec3(0.2f, -1, 0.1f));
  light.angular_diameter = 1.2f;
  light.type = light_directional;
  light.own_instance = no_instance;
  const LightView v = light_view(light, vec3(1, 2, 3), vec3(0, 1, 0), -1);
  double cosine = 0;
  int accepted = 0;
  for (uint32_t i = 0; i < 20000; ++i) {
    vec3 slope;
    if (!light_view_sample(v, r2_sequence(i), slope)) continue;
    ++accepted;
    EXPECT_NEAR(dot(slope, -v.axis), 1, 1e-5f) << "one metre of depth";
    const float c = dot(normalize(slope), -v.axis);
    EXPECT_GE(c, std::cos(0.6f) - 1e-5f);
    cosine += c;
  }
  EXPECT_NEAR(accepted / 20000.0, 0.7854, 0.01);
  EXPECT_NEAR(cosine / accepted, 0.5 * (1 + std::cos(0.6)), 1e-3);
}

TEST(Sampling, SequencesFillTheSquareEvenly) {
  constexpr uint32_t count = 4096;
  int cells[16][16] = {};
  for (uint32_t i = 0; i < count; ++i) {
    const vec2 u = r2_sequence(i);
    ASSERT_GE(min(u.x, u.y), 0.f);
    ASSERT_LT(max(u.x, u.y), 1.f);
    ++cells[static_cast<int>(u.x * 16)][static_cast<int>(u.y * 16)];
  }
  for (const auto& row : cells) {
    for (const int cell : row) EXPECT_NEAR(cell, 16, 4);
  }
  vec3 mean(0);
  for (uint32_t i = 0; i < count; ++i) mean += pixel_noise(i % 64, i / 64, 1) / float(count);
  EXPECT_NEAR(mean.x, 0.5f, 0.02f);
  EXPECT_NEAR(mean.y, 0.5f, 0.02f);
  EXPECT_NEAR(mean.z, 0.5f, 0.02f);
}

}  // namespace
}  // namespace limn::glsl
