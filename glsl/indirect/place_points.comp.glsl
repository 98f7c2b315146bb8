// Where the points of the scene are now.
#include "glsl/scene/blocks.glsl"
#include "glsl/indirect/scene_point.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Points { ScenePoint points[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer Positions { float positions[]; };
layout(std430) writeonly buffer Placed { PlacedPoint placed[]; };
uniform uint count;

vec3 corner(Instance instance, uint vertex) {
  uint at = 3u * (instance.first_vertex + vertex);
  return vec3(instance.object_to_world * vec4(positions[at], positions[at + 1u], positions[at + 2u], 1.0));
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= count) return;
  ScenePoint point = points[index];
  Instance instance = instances[point.instance];
  vec3 a = corner(instance, point.corners.x);
  vec3 e = corner(instance, point.corners.y) - a;
  vec3 f = corner(instance, point.corners.z) - a;
  vec3 position = a + point.place.x * e + point.place.y * f;
  float scale = max(max(max(abs(e.x), abs(e.y)), abs(e.z)), max(max(abs(f.x), abs(f.y)), abs(f.z)));
  vec3 n = scale > 0.0 ? cross(e / scale, f / scale) : vec3(0.0);
  float squared = dot(n, n);
  placed[index] = PlacedPoint(vec4(position, 0.0), vec4(squared > 0.0 ? n * inversesqrt(squared) : vec3(0.0), 0.0));
}
