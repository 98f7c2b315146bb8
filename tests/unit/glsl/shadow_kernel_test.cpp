// Laws of the kernels of prefiltered soft shadows (glsl/shadow/shadow_kernel.glsl).
#include "glsl/shadow/shadow_kernel.glsl"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/glsl/shadow_thresholds.h"

namespace limn::glsl {
namespace {

Light squareLight(float side, vec3 position, vec3 direction) {
  const Frame frame = frame_around(direction);
  Light light{};
  light.position = position;
  light.direction = direction;
  light.axis_u = frame.t;
  light.length_u = side;
  light.axis_v = -frame.b;
  light.length_v = side;  // cross(t, -b) = -n
  light.type = light_rectangle;
  light.own_instance = no_instance;
  return light;
}

ShadowView viewOf(const Light& light, uint32_t kind, float tangent, int size) {
  ShadowView v{};
  const float scale = kind == shadow_perspective ? 0.5f / tangent : kind == shadow_orthographic ? 0.1f : 0.5f;
  v.origin = light.position;
  v.near = 0.5f;
  v.axis_x = light.axis_u;
  v.scale = scale;
  v.axis_y = light.axis_v;
  v.footprint = 1 / (scale * static_cast<float>(size));
  v.axis_z = light.direction;
  v.far = 20;
  v.middle = vec2(0.5f, 0.5f);
  v.projection = kind;
  v.size = size;
  return v;
}

TEST(ShadowKernel, IsAsWideAsTheFrameworkSays) {
  // w = S (d - z) / (d 2 z tan(theta)) of the map's width, framework step 3.
  const Light light = squareLight(2, vec3(0, 10, 0), vec3(0, -1, 0));
  const ShadowView view = viewOf(light, shadow_perspective, 0.8f, 512);
  const vec3 receiver(1.5f, 1, -2);
  const LightView seen = light_view(light, receiver, vec3(0, 1, 0), -1);
  for (const float z : {1.f, 3.f, 8.f, 8.99f}) {
    ShadowKernel kernel;
    ASSERT_TRUE(shadow_kernel(view, seen, receiver, 9 - z, true, least_kernel_width, kernel));
    const float width = 512 * shadow_kernel_width(view, 2, 9, z);
    EXPECT_NEAR(kernel.high.x - kernel.low.x, width, 1e-3f * width + 1e-3f);
    EXPECT_NEAR(kernel.high.y - kernel.low.y, width, 1e-3f * width + 1e-3f);
  }
}

/// The square that stands for a sun is as large as its disc.
TEST(ShadowKernel, OfASunIsAsLargeAsItsDisc) {
  Light sun = squareLight(0, vec3(0), vec3(0, -1, 0));
  sun.type = light_directional;
  for (const float angle : {0.01f, 0.5f}) {
    sun.angular_diameter = angle;
    const ShadowView view = viewOf(sun, shadow_orthographic, 0, 512);
    const LightView seen = light_view(sun, vec3(0), vec3(0, 1, 0), -1);
    ShadowKernel kernel;
    ASSERT_TRUE(shadow_kernel(view, seen, vec3(0), 3, true, least_kernel_width, kernel));
    const float radius = 3 * std::tan(0.5f * angle) * view.scale * 512;  // texels
    const vec2 extent = kernel.high - kernel.low;
    EXPECT_NEAR(extent.x, extent.y, 1e-3f * extent.x);
    EXPECT_NEAR(extent.x * extent.y / (pi * radius * radius), 1, 1e-3f) << angle;
  }
}

TEST(ShadowKernel, CollapsesToTheReceiversTexelAtTheReceiver) {
  const Light light = squareLight(2, vec3(0, 10, 0), vec3(0, -1, 0));
  for (const uint32_t kind : {shadow_perspective, shadow_orthographic, shadow_paraboloid}) {
    const ShadowView view = viewOf(light, kind, 0.8f, 512);
    const vec3 receiver(0.5f, 1, -2);
    ShadowKernel kernel;
    ASSERT_TRUE(shadow_kernel(view, light_view(light, receiver, vec3(0, 1, 0), -1), receiver, 0, true,
                              least_kernel_width, kernel));
    const vec2 at = 512.f * shadow_project(view, receiver).uv;
    EXPECT_NEAR(kernel.low.x, at.x, 1e-2f);
    EXPECT_NEAR(kernel.high.y, at.y, 1e-2f);
  }
}

TEST(ShadowKernel, LightsNarrowerThanRoundingKeepAKernelAboutTheReceiver) {
  for (const uint32_t kind : {shadow_perspective, shadow_orthographic, shadow_paraboloid}) {
    const Light light = squareLight(1e-8f, vec3(0, 10, 0), vec3(0, -1, 0));
    const ShadowView view = viewOf(light, kind, 0.8f, 1024);
    const vec3 receiver(1.5f, 5, -2);
    const LightView seen = light_view(light, receiver, vec3(0, 1, 0), -1);
    const vec2 at = 1024.f * shadow_project(view, receiver).uv;
    for (const bool whole : {true, false}) {
      ShadowKernel kernel;
      ASSERT_TRUE(shadow_kernel(view, seen, receiver, 0.05f, whole, least_kernel_width, kernel)) << kind;
      for (int c = 0; c < 2; ++c) {
        EXPECT_GT(kernel.high[c] - kernel.low[c], 0.5f * least_kernel_width);
        EXPECT_LT(kernel.high[c] - kernel.low[c], 2 * least_kernel_width);
        if (kind == shadow_perspective) {
          EXPECT_NEAR(0.5f * (kernel.low[c] + kernel.high[c]), at[c], 1e-2f);
        }
      }
      EXPECT_GT(kernel.weight, 0);
    }
  }
}

TEST(ShadowKernel, ThresholdIsWhereATexelStopsBlocking) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(0, 1);
  int crossings = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto kind = static_cast<uint32_t>(i % 3);
    const Light light = squareLight(1, vec3(0, 10, 0), vec3(0, -1, 0));
    ShadowView view = viewOf(light, kind, 0.8f, 256);
    if (kind == shadow_orthographic) view.origin.y = 12;
    const vec3 receiver(4 * uniform(random) - 2, uniform(random), 4 * uniform(random) - 2);
    const vec3 normal = normalize(vec3(uniform(random) - 0.5f, 0.6f, uniform(random) - 0.5f));
    const ShadowReceiver r = shadow_receiver(view, receiver, normal, vec3(0, -1, 0), 1);
    const vec2 uv(uniform(random), uniform(random));
    const float threshold = shadow_threshold(view, r, uv);
    for (const float step : {-1e-3f, 1e-3f}) {
      const float stored = threshold + step;
      if (stored <= 0 || stored >= 1) continue;
      ++crossings;
      EXPECT_EQ(shadow_blocks(r, shadow_unproject_local(view, uv, shadow_metres(view, stored))), step < 0)
          << "kind " << kind << " threshold " << threshold;
    }
  }
  EXPECT_GT(crossings, 10000);
}

TEST(ShadowKernel, FacesOfACubeShareAKernelBetweenThem) {
  // A kernel across the edge of two faces: both hold a part, in proportion to its solid angle.
  Light light{};
  light.position = vec3(0, 0, 0);
  light.direction = vec3(0, 0, 1);
  light.type = light_point;
  light.own_instance = no_instance;
  ShadowView front{}, side{};
  front.near = side.near = 0.1f;
  front.axis_x = vec3(1, 0, 0);
  front.scale = 0.5f;
  front.axis_y = vec3(0, -1, 0);
  front.footprint = 2.f / 256;
  front.axis_z = vec3(0, 0, 1);
  front.far = 20;
  side.axis_x = vec3(0, -1, 0);
  side.scale = 0.5f;
  side.axis_y = vec3(0, 0, 1);
  side.footprint = 2.f / 256;
  side.axis_z = vec3(1, 0, 0);
  side.far = 20;
  front.middle = side.middle = vec2(0.5f);
  front.projection = side.projection = shadow_perspective;
  front.size = side.size = 256;
  const vec3 receiver(3, 0.3f, 3);
  const LightView seen = light_view(light, receiver, normalize(-receiver), 0.5f);
  ShadowKernel a, b;
  ASSERT_TRUE(shadow_kernel(front, seen, receiver, 2, false, least_kernel_width, a));
  ASSERT_TRUE(shadow_kernel(side, seen, receiver, 2, false, least_kernel_width, b));
  EXPECT_NEAR(a.high.x, 256, 1e-3f);
  EXPECT_NEAR(a.weight / b.weight, 1, 0.05f);
  // One within a texel is widened before the faces share it.
  const LightView narrow = light_view(light, receiver, normalize(-receiver), 1e-6f);
  ASSERT_TRUE(shadow_kernel(front, narrow, receiver, 2, false, 1, a));
  ASSERT_TRUE(shadow_kernel(side, narrow, receiver, 2, false, 1, b));
  EXPECT_NEAR(a.low.x, 255.5f, 1e-2f);
  EXPECT_EQ(a.high.x, 256);
  EXPECT_NEAR(b.low.y, 255.5f, 1e-2f);
  EXPECT_EQ(b.high.y, 256);
  EXPECT_NEAR(a.weight / b.weight, 1, 0.05f);
  ShadowKernel none;
  ShadowView back = front;
  back.axis_x = vec3(0, 1, 0);
  back.scale = 0.5f;
  back.axis_y = vec3(1, 0, 0);
  back.footprint = 2.f / 256;
  back.axis_z = vec3(0, 0, -1);
  back.far = 20;
  EXPECT_FALSE(shadow_kernel(back, seen, receiver, 2, false, least_kernel_width, none));
}

/// Faces 0 to 4 of the half cube of a light whose face 0 is given.
ShadowView faceOf(const ShadowView& first, int face) {
  const vec3 x = first.axis_x, y = first.axis_y, z = first.axis_z;
  const vec3 axes[5][3] = {{x, y, z}, {y, z, x}, {z, y, -x}, {z, x, y}, {x, z, -y}};
  ShadowView view = first;
  view.axis_x = axes[face][0];
  view.axis_y = axes[face][1];
  view.axis_z = axes[face][2];
  return view;
}

/// What blocks lies on a ray to the light, no nearer than the near plane in the face that sees it: the
/// kernels at the depth where that may begin hold all of it, beside the light's axis, too.
TEST(ShadowKernel, KernelsWhereTheFacesOfAHalfCubeBeginHoldAllThatBlocks) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(0, 1);
  const Light light = squareLight(0.6f, vec3(0, 1, 0), vec3(0, -1, 0));
  int beside = 0, nearer = 0;
  for (int i = 0; i < 20000; ++i) {
    ShadowView first = viewOf(light, shadow_perspective, 1, 512);
    // Some of them within reach of the light's own edges.
    first.near = 0.05f + 0.9f * uniform(random);
    const vec3 receiver(16 * uniform(random) - 8, 0.02f * uniform(random) - 0.02f, 16 * uniform(random) - 8);
    const LightView seen = light_view(light, receiver, vec3(0, 1, 0), -1);
    const float nearest = shadow_faces_nearest(first, seen, receiver);
    ASSERT_LE(nearest, first.near);
    ASSERT_GT(nearest, 0);
    const vec2 p(uniform(random) - 0.5f, uniform(random) - 0.5f);
    const float gap = seen.depth * uniform(random);
    const vec3 blocker = receiver + gap * (seen.centre + p.x * seen.side_u + p.y * seen.side_v);
    const uint32_t face = shadow_face(shadow_faces_hemicube, first, blocker);
    const ShadowView view = faceOf(first, static_cast<int>(face));
    if (shadow_view_depth(view, blocker) < first.near) continue;
    const float depth = seen.depth - gap;
    // Within reach of the light's edges what lies all but in the light's plane is left out.
    const bool reached = first.near <= 0.3f;
    if (reached && depth < 0.004f * 0.3f) continue;
    EXPECT_GT(depth, nearest * (1 - 1e-4f) - 1e-6f) << "near " << first.near << ", face " << face;
    if (face > 0) ++beside;
    if (depth < first.near) ++nearer;
    ShadowKernel kernel;
    ASSERT_TRUE(shadow_kernel(view, seen, receiver, seen.depth - nearest, false, least_kernel_width, kernel))
        << "near " << first.near << ", face " << face;
    const vec2 at = 512.f * shadow_project(view, blocker).uv;
    for (int c = 0; c < 2; ++c) {
      EXPECT_GT(at[c], kernel.low[c] - 0.1f) << "near " << first.near << ", face " << face;
      EXPECT_LT(at[c], kernel.high[c] + 0.1f) << "near " << first.near << ", face " << face;
    }
  }
  EXPECT_GT(beside, 5000);
  EXPECT_GT(nearer, 1000);
}

}  // namespace
}  // namespace limn::glsl
