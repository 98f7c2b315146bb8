// Laws of paraboloid maps (glsl/shadow/paraboloid.glsl).
#include "glsl/shadow/paraboloid.glsl"

#include <gtest/gtest.h>

#include "tests/unit/glsl/random.h"

namespace limn::glsl {
namespace {

vec3 inclined(float theta, float phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

TEST(Paraboloid, InverseScaleAndRadius) {
  Random random(11);
  for (int i = 0; i < 2000; ++i) {
    vec3 d = random.direction();
    d.z = std::abs(d.z);
    const vec2 p = paraboloid_map(d);
    EXPECT_LE(length(p), 1 + 1e-6f);
    EXPECT_NEAR(length(p), std::tan(0.5f * std::acos(d.z)), 1e-4f);
    EXPECT_LT(length(paraboloid_direction(p) - d), 1e-6f);
    // The same scale along and across.
    const Frame around = frame_around(d);
    for (const vec3 t : {around.t, around.b, normalize(around.t + around.b)}) {
      const float step = 1e-2f;
      const float moved =
          length(paraboloid_map(normalize(d + step * t)) - paraboloid_map(normalize(d - step * t)));
      EXPECT_NEAR(moved / (2 * step), paraboloid_scale(dot(p, p)), 2e-4f);
    }
  }
}

TEST(Paraboloid, ShadowViewsAgree) {
  Random random(11);
  const ShadowView view = paraboloid_view(vec3(1, 2, 3), normalize(vec3(-1, 0.4f, 0.2f)), 0.5f, 9, 7, 64);
  for (int i = 0; i < 200; ++i) {
    const vec3 d = random.direction(), local = shadow_view_axes(view, d);
    if (local.z < 0) continue;
    const ShadowPoint q = shadow_project(view, view.origin + 3.f * d);
    EXPECT_LT(length(q.uv - (0.5f * paraboloid_map(local) + 0.5f)), 1e-6f);
    EXPECT_NEAR(q.depth, 3, 1e-5f);
  }
  EXPECT_EQ(view.layer, 7u);
  EXPECT_NEAR(view.footprint, 1 / (64 * 0.5f * paraboloid_scale(0)), 1e-6f)
      << "a texel at the centre, radians";
}

/// Circles on the sphere project to circles: exactly those of the kernel.
TEST(Paraboloid, KernelIsTheProjectedCone) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const float theta = random(0, 0.5f * pi), alpha = random(0.01f, 2.f);
    const vec3 axis = inclined(theta, random(0, 2 * pi));
    const ParaboloidKernel kernel = paraboloid_kernel(axis, alpha);
    const Frame around = frame_around(axis);
    for (int k = 0; k < 32; ++k) {
      const float phi = 2 * pi * static_cast<float>(k) / 32;
      const vec3 edge = std::cos(0.5f * alpha) * axis +
                        std::sin(0.5f * alpha) * (std::cos(phi) * around.t + std::sin(phi) * around.b);
      // The width is a share of the map's side, 2: as a radius of the disc it is the same number.
      EXPECT_NEAR(length(paraboloid_map(edge) - kernel.centre), kernel.width, 2e-5f * (1 + kernel.width));
    }
    EXPECT_NEAR(length(kernel.centre), std::sin(theta) / (std::cos(theta) + std::cos(0.5f * alpha)), 1e-4f);
  }
}

/// The thesis's width, as if radians were spread evenly: 27 % too wide on the axis, right at 55 degrees, 36 %
/// too narrow at the rim.
TEST(Paraboloid, WidthOfTheThesis) {
  const auto ratio = [](float theta) {
    const vec3 d = inclined(theta, 0.3f);
    return paraboloid_rectangle_kernel_thesis(d, vec2(0.02f), 2, 1).z / paraboloid_kernel(d, 0.01f).width;
  };
  EXPECT_NEAR(ratio(0), 1.273f, 1e-3f);
  EXPECT_NEAR(ratio(55.2f * pi / 180), 1, 2e-3f);
  EXPECT_NEAR(ratio(0.5f * pi), 0.637f, 1e-3f);
  // Small cones: alpha (1 + rho^2) / 4.
  for (const float theta : {0.f, 0.4f, 0.9f, 1.5f}) {
    const vec3 d = inclined(theta, 1);
    const vec2 p = paraboloid_map(d);
    EXPECT_NEAR(paraboloid_kernel(d, 0.02f).width, 0.02f * (1 + dot(p, p)) / 4, 1e-5f);
  }
}

/// A sender seen from a receiver through a hole at the blocker's distance.
TEST(Paraboloid, PenumbraAngleByConstruction) {
  Random random(11);
  for (int i = 0; i < 300; ++i) {
    const float d = random(1, 5), z = random(0.1f, d), size = random(0.01f, 2);
    const vec3 axis = random.direction(), across = frame_around(axis).t;
    const vec3 receiver = d * axis;
    const auto at =
        [&](float side) {  // on the line from the receiver to the sender's edge, at depth z along the axis
          return receiver + (1 - z / d) * (0.5f * side * size * across - receiver);
        };
    const float angle = std::acos(std::min(dot(normalize(at(1)), normalize(at(-1))), 1.f));
    EXPECT_NEAR(paraboloid_penumbra_angle(size, d, z), angle, 2e-3f);
  }
  EXPECT_EQ(paraboloid_penumbra_angle(1, 2, 2), 0);
  EXPECT_EQ(paraboloid_penumbra_angle(1, 2, 3), 0) << "a blocker behind the receiver";
}

/// The mean on the map of where the lines from a receiver to points of a rectangle pass at the blockers'
/// distance, and the widths of the box with their variances, of the map's side.
struct Penumbra {
  dvec2 mean, widths;
};

Penumbra penumbraOf(const vec3& w, const vec2& sides, float d, float z) {
  dvec2 sum(0), squares(0);
  constexpr int n = 24;
  for (int a = 0; a < n * n; ++a) {
    const vec2 at = (vec2(a % n, a / n) + 0.5f) / static_cast<float>(n) - 0.5f;
    const vec3 from = d * w, line = vec3(sides * at, 0) - from;
    float low = 0, high = 1;  // of the line, where its distance from the centre is z
    for (int k = 0; k < 40; ++k) {
      const float middle = 0.5f * (low + high);
      (length(from + middle * line) > z ? low : high) = middle;
    }
    const dvec2 p = paraboloid_map(normalize(from + low * line));
    sum += p;
    squares += p * p;
  }
  const dvec2 mean = sum / double(n * n), variance = squares / double(n * n) - mean * mean;
  // The variance of a box of width b is b^2 / 12; the map's side is 2.
  return {mean, sqrt(12.0 * variance) / 2.0};
}

TEST(Paraboloid, RectangleKernelHasTheMomentsOfThePenumbra) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    const float theta = random(0, 1.3f), d = random(2, 5), z = random(0.5f, 0.9f) * d;
    const vec3 w = inclined(theta, random(0, 2 * pi));
    const vec2 sides(random(0.02f, 0.8f), random(0.02f, 0.8f));
    const Penumbra penumbra = penumbraOf(w, sides, d, z);
    const vec4 kernel = paraboloid_rectangle_kernel(w, sides, d, z);
    for (int axis = 0; axis < 2; ++axis) {
      const double width = penumbra.widths[axis];
      EXPECT_NEAR(kernel[2 + axis], width, 0.06 * width + 2e-4) << theta << " " << z / d;
      EXPECT_NEAR(kernel[axis], penumbra.mean[axis], 0.01 * std::max(kernel.z, kernel.w) + 1e-3);
    }
  }
  // A square seen head-on is a disc's equal.
  EXPECT_NEAR(paraboloid_rectangle_kernel(vec3(0, 0, 1), vec2(0.3f), 3, 2).z,
              paraboloid_kernel(vec3(0, 0, 1), paraboloid_penumbra_angle(0.3f, 3, 2)).width, 1e-6f);
  // A blocker in the sender's plane hides half of the sphere, and a point has no kernel, whatever is before
  // it.
  EXPECT_NEAR(paraboloid_rectangle_kernel(vec3(0, 0, 1), vec2(0.3f), 3, 0).z, 1, 1e-6f);
  EXPECT_EQ(paraboloid_rectangle_kernel(vec3(0, 0, 1), vec2(0), 3, 0).z, 0);
}

/// Senders as wide as the receiver is far, and blockers near them: kernels lie where the penumbra does, from
/// the side, too. Their widths are rougher.
TEST(Paraboloid, KernelsOfWideSendersLieAboutTheMeanOfThePenumbra) {
  Random random(11);
  int wide = 0;
  for (int i = 0; i < 300; ++i) {
    const float theta = random(0, 1.3f), d = random(1, 5), z = random(0.3f, 0.9f) * d;
    const vec3 w = inclined(theta, random(0, 2 * pi));
    const vec2 sides(random(0.02f, 1) * d, random(0.02f, 1) * d);
    const float widest = max(sides.x, sides.y);
    const bool nearer = 0.5f * length(sides) < z;  // than all blockers
    if (!nearer || 0.5f * widest * (d - z) / (d * z) > 0.6f) continue;
    ++wide;
    const Penumbra penumbra = penumbraOf(w, sides, d, z);
    const vec4 kernel = paraboloid_rectangle_kernel(w, sides, d, z);
    const double wider = std::max(penumbra.widths.x, penumbra.widths.y);
    for (int axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(kernel[axis], penumbra.mean[axis], 0.03 * wider + 0.01) << theta << " " << z / d;
      EXPECT_NEAR(kernel[2 + axis], penumbra.widths[axis], 0.3 * wider) << theta << " " << z / d;
    }
  }
  EXPECT_GT(wide, 100);
  // Blockers in the sender's plane: the middle of the hemisphere, which they hide.
  const vec4 touching = paraboloid_rectangle_kernel(inclined(1.3f, 0.5f), vec2(0.3f), 3, 0);
  EXPECT_LT(length(vec2(touching.x, touching.y)), 0.5f);
}

TEST(Paraboloid, BoundsHoldWhatTheHemisphereSees) {
  Random random(11);
  double covered = 0, boxes = 0;
  for (int i = 0; i < 3000; ++i) {
    const float scale = std::pow(10.f, random(-2, 1));
    const vec3 a = random.direction() * random(0.2f, 3);
    const vec3 b = a + scale * random.direction(), c = a + scale * random.direction();
    const vec4 box = paraboloid_bounds(a, b, c);
    vec4 tight = paraboloid_nowhere;
    for (int k = 0; k < 200; ++k) {
      float u = random(0, 1), v = random(0, 1);
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (k % 4 == 0) v = 0;
      const vec3 p = a + u * (b - a) + v * (c - a);
      if (p.z < 0) continue;
      const vec2 q = paraboloid_map(normalize(p));
      const float slack = 1e-4f;
      EXPECT_TRUE(q.x >= box.x - slack && q.y >= box.y - slack && q.x <= box.z + slack &&
                  q.y <= box.w + slack)
          << "triangle " << i;
      tight = vec4(std::min(tight.x, q.x), std::min(tight.y, q.y), std::max(tight.z, q.x),
                   std::max(tight.w, q.y));
    }
    if (a.z < 0 && b.z < 0 && c.z < 0) {
      EXPECT_GT(box.x, box.z) << "behind";
    }
    if (tight.x > tight.z) continue;
    covered += (tight.z - tight.x) * (tight.w - tight.y);
    boxes += (box.z - box.x) * (box.w - box.y);
  }
  EXPECT_LT(boxes, 1.6 * covered) << "boxes are tight";
}

TEST(Paraboloid, RaysMeetTrianglesAndMissNoneOfTwoNeighbours) {
  Random random(11);
  for (int i = 0; i < 20000; ++i) {
    const vec3 a = random.direction() * 2.f, b = random.direction() * 2.f, c = random.direction() * 2.f,
               d = random.direction() * 2.f;
    vec3 shares;
    const float u = random(0.01f, 0.5f), v = random(0.01f, 0.49f);
    const vec3 inside = a + u * (b - a) + v * (c - a);
    const float t = paraboloid_hit(a, b, c, normalize(inside), shares);
    if (std::abs(dot(cross(b - a, c - a), a)) > 0.1f) {
      EXPECT_NEAR(t, length(inside), 2e-3f);
      EXPECT_NEAR(shares.y, u, 2e-3f);
      EXPECT_NEAR(shares.z, v, 2e-3f);
      EXPECT_LT(paraboloid_hit(a, b, c, -normalize(inside), shares), 0) << "behind the origin";
    }
    // A ray through the edge a-b, which both sides share, meets one of them.
    if (dot(cross(a, b), c) * dot(cross(a, b), d) >= 0) continue;
    const vec3 edge = normalize(a + random(0.1f, 0.9f) * (b - a));
    const float near = 0.1f;
    if (dot(edge, normalize(a)) < near || dot(edge, normalize(b)) < near) continue;
    EXPECT_TRUE(paraboloid_hit(a, b, c, edge, shares) > 0 || paraboloid_hit(b, a, d, edge, shares) > 0) << i;
  }
}

}  // namespace
}  // namespace limn::glsl
