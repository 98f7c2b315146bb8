// The shape library: every solid the scenes are made of, with smooth normals and texture coordinates.
#pragma once

#include "assets/generator/mesh.h"

namespace limn::assets {

using SurfaceFunction = std::function<glm::vec3(glm::vec2)>;

/// The image of [0, 1]^2 as a grid of nu x nv quads. Front side: dP/du x dP/dv. Normals by central
/// differences.
Mesh surface(int nu, int nv, const SurfaceFunction& position);

/// Two triangles: `centre` +- `right` +- `up`, facing right x up. Texture coordinates span [0, 1]^2.
Mesh quad(glm::vec3 centre, glm::vec3 right, glm::vec3 up);

/// A horizontal plane at height 0 facing +Y, its texture repeated every `tile` metres.
Mesh ground(float halfWidth, float halfDepth, float tile);

/// A floor from z = `front` to z = -`back` that bends up into a wall of height `height` (a photographer's
/// backdrop). The texture repeats every `tile` metres.
Mesh backdrop(float halfWidth, float front, float back, float height, float tile);

/// A box with sharp edges, texture coordinates in metres.
Mesh box(glm::vec3 centre, glm::vec3 halfSize);

/// A box with edges rounded by `radius`, `segments` quads over each rounding.
Mesh roundedBox(glm::vec3 halfSize, float radius, int segments);

/// A sphere of radius `radius` about the origin with `rings` rings of 2 `rings` quads.
Mesh sphere(float radius, int rings);

/// A capsule-like body about the Y axis between heights 0 and `length`, radii interpolated.
Mesh capsule(float bottomRadius, float topRadius, float length, int segments);

/// A ring about the Y axis.
Mesh torus(float majorRadius, float minorRadius, int majorSegments, int minorSegments);

/// A solid of revolution about the Y axis. `profile` holds (radius, height) with the solid on the left when
/// walking from point to point in the direction that makes normals point away from the axis for rising
/// heights. Corners sharper than `creaseDegrees` stay sharp.
Mesh lathe(std::span<const glm::vec2> profile, int segments, float creaseDegrees = 35);

/// A tube along `path` with one radius per point; ends closed by cones of no height (flat caps).
Mesh tube(std::span<const glm::vec3> path, std::span<const float> radii, int segments, bool caps = true);

/// `outline` (counter-clockwise seen from +Z, star-shaped about `hub`) extruded from z = 0 to z = depth.
/// Corners of the outline sharper than `creaseDegrees` stay sharp.
Mesh extrude(std::span<const glm::vec2> outline, glm::vec2 hub, float depth, float creaseDegrees = 35);

/// Points of a Catmull-Rom spline through `points`, `perSegment` per gap, ends included.
std::vector<glm::vec2> spline(std::span<const glm::vec2> points, int perSegment);
std::vector<glm::vec3> spline(std::span<const glm::vec3> points, int perSegment);

}  // namespace limn::assets
