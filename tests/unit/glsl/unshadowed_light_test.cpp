// L_u of every light type against the BRDF and against integration over the light.
#include "glsl/light/unshadowed_light.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace limn::glsl {
namespace {

Light light(uint type, vec3 position, vec3 direction) {
  Light l{};
  l.position = position;
  l.direction = normalize(direction);
  l.emission = vec3(3, 2, 1);
  l.type = type;
  l.own_instance = no_instance;
  return l;
}

Light rectangleLight(vec3 position, vec3 direction, float u, float v) {
  Light l = light(light_rectangle, position, direction);
  const Frame frame = frame_around(-l.direction);
  l.axis_u = frame.t;
  l.length_u = u;
  l.axis_v = frame.b;
  l.length_v = v;
  return l;
}

struct Receiver {
  vec3 p{0.2f, 0.1f, -0.3f}, n{0, 0, 1}, ng{0, 0, 1}, v;
};

/// The same by midpoint integration over the light.
dvec3 integrated(const Light& l, const SurfaceBrdf& s, const Receiver& r, int side = 300) {
  const Rectangle shape = rectangle_from(l, r.p);
  const dvec3 area = cross(dvec3(shape.u), dvec3(shape.v));
  dvec3 sum(0);
  for (int i = 0; i < side * side; ++i) {
    const vec3 point =
        rectangle_point(shape, vec2((i % side + 0.5f) / side, (i / side + 0.5f) / side) - vec2(0.5f));
    const vec3 d = normalize(point);
    if (dot(r.ng, d) <= 0 || dot(r.n, d) <= 0) continue;
    const double distance2 = dot(dvec3(point), dvec3(point));
    sum += dvec3(brdf(s, r.n, r.v, d)) * (dot(r.n, d) * std::abs(dot(area, dvec3(d))) / distance2);
  }
  return sum * dvec3(l.emission) / double(side * side);
}

TEST(UnshadowedLight, DeltaLightsAreTheBrdfTimesIrradiance) {
  Receiver r;
  r.v = normalize(vec3(0.3f, -0.4f, 0.6f));
  const SurfaceBrdf s = surface_brdf({0.5f, 0.6f, 0.7f}, 0.2f, 0.5f, 1, vec3(1), 1.5f);
  const vec3 to(1, 2, 2);  // length 3
  const vec3 l = to / 3.f;
  const vec3 f = brdf(s, r.n, r.v, l) * l.z;
  const Light point = light(light_point, r.p + to, vec3(0, 0, -1));
  const Light sun = light(light_directional, vec3(0), -to);
  for (int c = 0; c < 3; ++c) {
    const float emission = point.emission[c];
    EXPECT_NEAR(unshadowed_light(point, s, r.p, r.n, r.ng, r.v)[c], f[c] * emission / 9, 1e-6f);
    EXPECT_NEAR(unshadowed_light(sun, s, r.p, r.n, r.ng, r.v)[c], f[c] * emission, 1e-6f);
  }
  Light spot = light(light_spot, r.p + to, vec3(0, 0, -1));
  spot.flags = light_flag_cone;
  spot.cos_inner = 0.8f;
  spot.cos_outer = 0.5f;
  spot.range = 0;
  spot.angular_diameter = 0;
  const float ramp = (2.f / 3 - 0.5f) / 0.3f;
  EXPECT_NEAR(unshadowed_light(spot, s, r.p, r.n, r.ng, r.v).x, f.x * 3 / 9 * ramp * ramp, 1e-6f);
  // Below the geometric or the shading horizon nothing arrives.
  EXPECT_EQ(unshadowed_light(point, s, r.p, r.n, normalize(vec3(-1, -1, 0.1f)), r.v), vec3(0));
  EXPECT_EQ(unshadowed_light(point, s, r.p, normalize(vec3(-1, -1, 0.1f)), r.ng, r.v), vec3(0));
  EXPECT_EQ(unshadowed_light(point, s, point.position, r.n, r.ng, r.v), vec3(0));
}

TEST(UnshadowedLight, LambertUnderARectangleIsExact) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-1.f, 1.f);
  const SurfaceBrdf s = surface_brdf({0.5f, 0.6f, 0.7f}, 0, 1, 0, vec3(1), 1.5f);
  for (int i = 0; i < 40; ++i) {
    Receiver r;
    r.n =
        normalize(vec3(0.4f * unit(random), 0.4f * unit(random), 1));  // shading normal off the geometric one
    r.v = normalize(vec3(unit(random), unit(random), 1));
    const Light l = rectangleLight(vec3(unit(random), unit(random), unit(random) + 1),
                                   vec3(unit(random), unit(random), -1), 1, 0.5f);
    if (!rectangle_emits_towards(l, r.p)) continue;
    const dvec3 expected = integrated(l, s, r);
    EXPECT_NEAR(unshadowed_light(l, s, r.p, r.n, r.ng, r.v).y, expected.y, 3e-3 * expected.y + 1e-4) << i;
  }
}

// Dielectrics and metals under rectangles of 0.3 to 3 distances anywhere above the horizon: relative to the
// light's mean reflected radiance.
TEST(UnshadowedLight, GlossySurfacesUnderARectangleKeepTheStatedError) {
  struct Case {
    const char* name;
    float metallic, albedo, bound;
  };
  for (const Case& c : {Case{"dielectric", 0, 0.8f, 0.03f}, Case{"black dielectric", 0, 0, 0.13f},
                        Case{"metal", 1, 0.8f, 0.05f}}) {
    for (float roughness : {0.2f, 0.4f, 0.6f, 1.f}) {
      std::mt19937 random(4);
      std::uniform_real_distribution<float> unit(-1.f, 1.f);
      const SurfaceBrdf s = surface_brdf(vec3(c.albedo), c.metallic, roughness, 1, vec3(1), 1.5f);
      double squares = 0, signal = 0;
      for (int i = 0; i < 120; ++i) {
        Receiver r;
        const float z = 0.525f + 0.475f * unit(random), angle = 3.14159f * unit(random);
        r.v = vec3(std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z);
        const vec3 towards = normalize(vec3(unit(random), unit(random), 0.6f + 0.6f * unit(random)));
        const Light l =
            rectangleLight(r.p + towards, -towards + 0.5f * vec3(unit(random), unit(random), unit(random)),
                           std::pow(10.f, 0.5f * unit(random)), std::pow(10.f, 0.5f * unit(random)));
        if (!rectangle_emits_towards(l, r.p)) continue;
        const double expected = integrated(l, s, r, 128).x;
        const double error = unshadowed_light(l, s, r.p, r.n, r.ng, r.v).x - expected;
        squares += error * error;
        signal += expected * expected;
      }
      const double relative = std::sqrt(squares / signal);
      RecordProperty(std::string(c.name) + " " + std::to_string(roughness), std::to_string(relative));
      EXPECT_LT(relative, c.bound) << c.name << ' ' << roughness;
    }
  }
}

TEST(UnshadowedLight, SameAtEveryScale) {
  const SurfaceBrdf s = surface_brdf(vec3(0.8f), 0, 0.3f, 1, vec3(1), 1.5f);
  Receiver r;
  r.v = normalize(vec3(0.5f, 0, 1));
  const Light l = rectangleLight(vec3(-0.3f, 0.2f, 1), vec3(0.1f, 0.2f, -1), 0.7f, 0.4f);
  const vec3 expected = unshadowed_light(l, s, r.p, r.n, r.ng, r.v);
  for (float scale : {1e-4f, 1e4f}) {
    Light scaled = l;
    scaled.position = l.position * scale;
    scaled.length_u *= scale;
    scaled.length_v *= scale;
    const vec3 got = unshadowed_light(scaled, s, r.p * scale, r.n, r.ng, r.v);
    EXPECT_NEAR(got.x, expected.x, 1e-5f * expected.x);
  }
}

TEST(UnshadowedLight, TwoSidedRectangleLightsBothSidesAlike) {
  const SurfaceBrdf s = surface_brdf(vec3(0.8f), 0, 0.3f, 1, vec3(1), 1.5f);
  const Receiver r{vec3(0), vec3(0, 0, 1), vec3(0, 0, 1), normalize(vec3(0.5f, 0, 1))};
  Light front = rectangleLight(vec3(-0.3f, 0.2f, 1), vec3(0.1f, 0.2f, -1), 0.7f, 0.4f);
  Light back = front;
  back.direction = -front.direction;
  back.axis_v = -front.axis_v;
  back.length_v = front.length_v;
  EXPECT_EQ(unshadowed_light(back, s, r.p, r.n, r.ng, r.v), vec3(0));
  back.flags = light_flag_two_sided;
  const vec3 a = unshadowed_light(front, s, r.p, r.n, r.ng, r.v),
             b = unshadowed_light(back, s, r.p, r.n, r.ng, r.v);
  EXPECT_NEAR(a.x, b.x, 1e-6f * a.x);
}

}  // namespace
}  // namespace limn::glsl
