// Rays through the maps of a light (glsl/shadow/map_path.glsl) against shadow_project() in the views that the
// service makes.
#include "glsl/shadow/map_path.glsl"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

#include "core/shadow/light_fit.h"
#include "glsl/numeric/geometry.glsl"

namespace limn::glsl {
namespace {

struct Maps {
  shadow::LightLayout layout;
  std::vector<ShadowView> views;
};

/// Returns the maps of a light above a box of 4 m.
Maps mapsOf(const Light& light) {
  scene::Bounds box;
  box.add(vec3(-2));
  box.add(vec3(2));
  const shadow::ShadowMapDesc desc{.size = 256};
  Maps maps{shadow::fitLayout(light, {&box, 1}, desc), {}};
  std::vector<ShadowLight> lights;
  shadow::appendViews(light, 0, maps.layout, {&box, 1}, desc, nullptr, maps.views, lights);
  EXPECT_EQ(maps.views.size(), shadow_face_count(maps.layout.faces));
  EXPECT_EQ(lights.front().faces, maps.layout.faces);
  return maps;
}

Light lightOf(uint32_t type, const vec3& position) {
  Light light{};
  light.type = type;
  light.position = position;
  light.direction = normalize(vec3(0.2f, -1, 0.1f));
  light.emission = vec3(1);
  light.own_instance = no_instance;
  return light;
}

Light rectangleOf(const vec3& position, uint32_t flags) {
  Light light = lightOf(light_rectangle, position);
  const Frame frame = frame_around(-light.direction);
  light.axis_u = frame.t;
  light.axis_v = frame.b;
  light.length_u = light.length_v = 0.5f;
  light.flags = flags;
  return light;
}

/// Returns how many views points of random rays lie in, after holding them against the general functions.
size_t facesSeen(const Maps& maps) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> uniform(-3, 3);
  std::set<uint32_t> seen;
  int inside = 0;
  const ShadowView& first = maps.views.front();
  for (int i = 0; i < 4000; ++i) {
    const vec3 origin(uniform(random), uniform(random), uniform(random));
    const vec3 way(uniform(random), uniform(random), uniform(random));
    const MapPath path = map_path(first, origin, way);
    for (const float t : {0.f, 0.3f, 0.7f, 1.f}) {
      const vec3 p = origin + t * way;
      const MapPlace place = map_path_place(path, maps.layout.projection, maps.layout.faces, t);
      const uint32_t face = shadow_face(maps.layout.faces, first, p);
      // At the border of two views, rounding decides.
      const vec3 shift = 1e-4f * normalize(way);
      if (shadow_face(maps.layout.faces, first, p + shift) != face ||
          shadow_face(maps.layout.faces, first, p - shift) != face)
        continue;
      EXPECT_EQ(place.face, face);
      const ShadowView& view = maps.views[face];
      const ShadowPoint q = shadow_project(view, p);
      const vec2 expected = 256.f * q.uv;
      const float edge = min(min(expected.x, expected.y), min(256 - expected.x, 256 - expected.y));
      if (q.depth < 0.05f || std::abs(edge) < 0.02f) continue;
      EXPECT_EQ(map_path_inside(path, place), shadow_inside(q));
      if (!shadow_inside(q)) continue;
      ++inside;
      seen.insert(face);
      // Texels: rounding of some metres over depths of at least 5 cm, of maps that are some metres wide at 1
      // m.
      EXPECT_NEAR(place.texel.x, expected.x, 0.02f);
      EXPECT_NEAR(place.texel.y, expected.y, 0.02f);
      EXPECT_NEAR(place.depth, q.depth, 1e-5f);
      EXPECT_EQ(map_path_texel(path, place), ivec2(place.texel));
      EXPECT_NEAR(map_path_behind(path, place, 0.3f), q.depth - shadow_metres(view, 0.3f), 1e-5f);
    }
  }
  EXPECT_GT(inside, 500);
  return seen.size();
}

TEST(MapPathTest, PointsLieWhereTheViewsSeeThem) {
  EXPECT_EQ(facesSeen(mapsOf(lightOf(light_directional, vec3(0)))), 1u);
  Light spot = lightOf(light_spot, vec3(0, 6, 0));
  spot.flags = light_flag_cone;
  spot.cos_outer = 0.8f;
  spot.cos_inner = 0.9f;
  EXPECT_EQ(facesSeen(mapsOf(spot)), 1u);
  EXPECT_EQ(facesSeen(mapsOf(lightOf(light_point, vec3(0.3f, 0.2f, -0.1f)))), 6u);
  const Maps hemicube = mapsOf(rectangleOf(vec3(0, 0.5f, 0), 0));
  EXPECT_EQ(hemicube.layout.faces, shadow_faces_hemicube);
  EXPECT_EQ(facesSeen(hemicube), 5u);
}

TEST(MapPathTest, PairsLookBothWays) {
  // Two boxes, one on either side of a rectangle, far enough for one view each.
  std::vector<scene::Bounds> boxes(2);
  for (int side = 0; side < 2; ++side) {
    boxes[size_t(side)].add(vec3(-1, side == 0 ? -6 : 5, -1));
    boxes[size_t(side)].add(vec3(1, side == 0 ? -5 : 6, 1));
  }
  const Light light = rectangleOf(vec3(0), light_flag_two_sided);
  const shadow::ShadowMapDesc desc{.size = 256};
  Maps maps{shadow::fitLayout(light, boxes, desc), {}};
  std::vector<ShadowLight> lights;
  shadow::appendViews(light, 0, maps.layout, boxes, desc, nullptr, maps.views, lights);
  ASSERT_EQ(maps.layout.faces, shadow_faces_pair);
  EXPECT_EQ(facesSeen(maps), 2u);
}

TEST(MapPathTest, PlacesBesideTheMapHaveTheNearestTexel) {
  const Maps maps = mapsOf(lightOf(light_directional, vec3(0)));
  const MapPath path = map_path(maps.views.front(), vec3(0), maps.views.front().axis_x);
  const MapPlace far = map_path_place(path, maps.layout.projection, maps.layout.faces, 1000);
  EXPECT_FALSE(map_path_inside(path, far));
  EXPECT_EQ(map_path_texel(path, far).x, 255);
}

}  // namespace
}  // namespace limn::glsl
