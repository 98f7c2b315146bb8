// Handles in the picture: where they are, and where they take a thing.
#include "apps/view/gizmo.h"

#include <gtest/gtest.h>

#include "core/scene/camera.h"

namespace limn::app {
namespace {

using Kind = GizmoHandle::Kind;

ScreenCamera screen() {
  return {scene::lookAt({3, 2, 5}, {0.5f, 0.25f, 0}, 0.8f), {400, 0}, {640, 480}};
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance) << "component " << c;
}

TEST(Gizmo, PixelsAndDirectionsAreInverse) {
  const ScreenCamera camera = screen();
  const glm::vec3 point(0.3f, -0.4f, 0.7f);
  const glm::vec2 pixel = *camera.pixel(point);
  expectNear(camera.direction(pixel), glm::normalize(point - camera.eye()), 1e-5f);
  EXPECT_NEAR(camera.pixel({0.5f, 0.25f, 0})->x, 400 + 320, 1e-2f) << "what is looked at is in the middle";
  EXPECT_FALSE(camera.pixel({6, 4, 10})) << "behind the camera";
}

/// On a monitor where text is twice as large, an arm is twice as long and as wide for the mouse.
TEST(Gizmo, HandlesGrowWithTheText) {
  const ScreenCamera usual = screen();
  ScreenCamera large = usual;
  large.handleScale = 2;
  const glm::vec3 centre(0.2f, 0.1f, -0.3f);
  const GizmoHandle arm{Kind::axis, 1};
  const auto tip = [&](const ScreenCamera& camera) {
    return *camera.pixel(outlineOf(camera, centre, arm)[1]);
  };
  const glm::vec2 start = *usual.pixel(centre);
  EXPECT_NEAR(glm::distance(tip(large), start) / glm::distance(tip(usual), start), 2, 0.25) << "perspective";
  const glm::vec2 beyond(0, -10);
  EXPECT_FALSE(handleAt(usual, centre, GizmoMode::move, tip(usual) + beyond));
  EXPECT_EQ(handleAt(large, centre, GizmoMode::move, tip(large) + beyond), arm);
}

/// A handle follows the mouse: held by its end and dragged to where the end would be, it takes the thing
/// there.
TEST(Gizmo, AxesAndPlanesFollowTheMouse) {
  const ScreenCamera camera = screen();
  const GizmoPose start{{0.2f, 0.1f, -0.3f}, glm::mat3(1)};
  for (int axis = 0; axis < 3; ++axis) {
    const GizmoHandle arm{Kind::axis, axis};
    const glm::vec3 tip = outlineOf(camera, start.position, arm)[1];
    ASSERT_EQ(handleAt(camera, start.position, GizmoMode::move, *camera.pixel(tip)), arm);
    glm::vec3 along(0), across(0.3f, -0.2f, 0.25f);
    along[axis] = 0.35f;
    across[axis] = 0;
    expectNear(dragged(camera, {arm, start, *camera.pixel(tip)}, *camera.pixel(tip + along)).position,
               start.position + along, 1e-3f);
    const GizmoHandle plane{Kind::plane, axis};
    const std::vector<glm::vec3> corners = outlineOf(camera, start.position, plane);
    const glm::vec3 middle = 0.5f * (corners[0] + corners[2]);
    EXPECT_EQ(handleAt(camera, start.position, GizmoMode::move, *camera.pixel(middle)), plane);
    expectNear(
        dragged(camera, {plane, start, *camera.pixel(middle)}, *camera.pixel(middle + across)).position,
        start.position + across, 1e-3f);
  }
}

TEST(Gizmo, RingsTurnByTheAngleTheyAreDragged) {
  const ScreenCamera camera = screen();
  const GizmoPose start{{0, 0, 0}, glm::mat3(1)};
  for (int axis = 0; axis < 3; ++axis) {
    const GizmoHandle ring{Kind::ring, axis};
    const std::vector<glm::vec3> corners = outlineOf(camera, start.position, ring);
    const GizmoPose turned =
        dragged(camera, {ring, start, *camera.pixel(corners[0])}, *camera.pixel(corners[corners.size() / 4]));
    const glm::vec3 from = glm::normalize(corners[0]), to = glm::normalize(corners[corners.size() / 4]);
    expectNear(turned.rotation * from, to, 1e-3f);
    expectNear(turned.position, start.position, 0);
  }
}

/// A lamp that is moved still shines where it shone, and one that is turned stays in its place.
TEST(Gizmo, WhatAHandleLeavesKeepsItsDigits) {
  const session::LightEdit now{.position = glm::dvec3(0.123456, 2, 3),
                               .rotation = glm::vec3(-33.333f, 1, 2),
                               .size = {},
                               .colour = {},
                               .intensity = {}};
  const glm::dvec3 origin(100, 0, 0);
  const GizmoPose pose{{0.5554321f, 1, 2}, session::rotationOf({-40.04f, 0, 0})};
  const session::LightEdit moved = placedBy({Kind::axis, 0}, pose, now, {}, origin, 2);
  EXPECT_NEAR(moved.position->x, 100.555, 1e-6) << "a millimetre";
  EXPECT_EQ(moved.rotation, now.rotation);
  session::LightEdit edit = placedBy({Kind::ring, 1}, pose, now, {}, origin, 2);
  EXPECT_EQ(edit.position, now.position);
  EXPECT_NEAR(edit.rotation->x, -40, 1e-4f) << "a tenth of a degree";
  edit.intensity = 7;
  const session::LightEdit both = placedBy({Kind::plane, 1}, pose, now, edit, origin, 2);
  EXPECT_EQ(both.position, moved.position);
  EXPECT_EQ(both.rotation, edit.rotation) << "as it was turned before";
  EXPECT_EQ(both.intensity, edit.intensity);
}

TEST(Gizmo, PlacesLightsAsFarAsTheyHaveAPlace) {
  session::LightEdit lamp, sun;
  lamp.position = glm::dvec3(1, 2, 3);
  sun.rotation = glm::vec3(-60, 0, 0);
  for (const Kind kind : {Kind::axis, Kind::ring}) {
    EXPECT_FALSE(placedBy({kind, 0}, {}, lamp, {}, glm::dvec3(0), 1).rotation);
    EXPECT_FALSE(placedBy({kind, 0}, {}, sun, {}, glm::dvec3(0), 1).position);
  }
}

/// In a scene of a millimetre as in one of a metre; the command line accepts what comes of it.
TEST(Gizmo, LightsOfSmallScenesMayBeSmall) {
  EXPECT_EQ(leastSide(50), 1e-4f);
  EXPECT_LT(leastSide(1e-3f), 1e-6f);
  for (const float radius : {0.f, 1e-12f, 1e-3f, 1e30f}) {
    session::LightEdits edits;
    edits["lamp"].size = glm::vec2(leastSide(radius));
    EXPECT_TRUE(session::parseLightEdits(session::printed(edits)) == edits) << radius;
  }
}

TEST(Gizmo, NothingIsHeldElsewhere) {
  const ScreenCamera camera = screen();
  EXPECT_FALSE(handleAt(camera, {0, 0, 0}, GizmoMode::move, {410, 10}));
  // Along its own axis nothing can be said of a movement.
  const GizmoPose start{{0, 0, 0}, glm::mat3(1)};
  const ScreenCamera above{scene::lookAt({0.001f, 5, 0}, {0, 0, 0}, 0.8f), {0, 0}, {100, 100}};
  expectNear(dragged(above, {{Kind::axis, 1}, start, {50, 50}}, {60, 50}).position, start.position, 0.05f);
}

}  // namespace
}  // namespace limn::app
