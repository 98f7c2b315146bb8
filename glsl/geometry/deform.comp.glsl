// Morphs, then skins, the vertices of one primitive instance: from their range at rest into their own range.
#include "glsl/geometry/deform.glsl"
#include "glsl/geometry/vertex.glsl"
#include "glsl/numeric/work_items.glsl"

layout(local_size_x = 64) in;

struct Job {
  uint first_rest;      // vertex
  uint first_deformed;  // vertex
  uint vertices;
  uint skin;  // first word of it, or ~0
  uint first_joint;
  uint first_weight;  // of the morph targets
  uint targets;
  uint deltas;  // first float of the targets
};
layout(std430) buffer Positions { float positions[]; };
layout(std430) buffer Attributes { VertexAttributes attributes[]; };
layout(std430) readonly buffer Skin { uint skin[]; };
layout(std430) readonly buffer Morph { float deltas[]; };
layout(std430) readonly buffer Jobs { Job jobs[]; };
layout(std430) readonly buffer Joints { mat4 joints[]; };
layout(std430) readonly buffer Weights { float weights[]; };
uniform uint job_index;

vec3 delta(uint at) { return vec3(deltas[at], deltas[at + 1u], deltas[at + 2u]); }

void main() {
  Job job = jobs[job_index];
  uint vertex = work_item_index();
  if (vertex >= job.vertices) return;
  uint source = job.first_rest + vertex;
  vec3 position = vec3(positions[3u * source], positions[3u * source + 1u], positions[3u * source + 2u]);
  VertexAttributes a = attributes[source];
  vec3 normal = vertex_unpack_normal(a.normal);
  vec4 tangent = vertex_unpack_tangent(a.tangent);

  vec3 normal_sum = normal;
  vec3 tangent_sum = tangent.xyz;
  for (uint t = 0u; t < job.targets; ++t) {
    float weight = weights[job.first_weight + t];
    if (weight == 0.0) continue;
    uint at = job.deltas + 9u * (t * job.vertices + vertex);
    position = morph(position, delta(at), weight);
    normal_sum = morph(normal_sum, delta(at + 3u), weight);
    tangent_sum = morph(tangent_sum, delta(at + 6u), weight);
  }
  normal = safe_normalize(normal_sum, normal);
  tangent.xyz = safe_normalize(tangent_sum, tangent.xyz);

  if (job.skin != 0xffffffffu) {
    uint at = job.skin + 6u * vertex;
    uvec2 packed_joints = uvec2(skin[at], skin[at + 1u]);
    uvec4 j = job.first_joint + uvec4(packed_joints.x & 0xffffu, packed_joints.x >> 16, packed_joints.y & 0xffffu,
                                      packed_joints.y >> 16);
    vec4 w = uintBitsToFloat(uvec4(skin[at + 2u], skin[at + 3u], skin[at + 4u], skin[at + 5u]));
    mat4 joint = blend_joints(joints[j.x], joints[j.y], joints[j.z], joints[j.w], w);
    position = skin_position(joint, position);
    normal = skin_normal(joint, normal);
    tangent = skin_tangent(joint, tangent);
  }

  uint target = job.first_deformed + vertex;
  positions[3u * target] = position.x;
  positions[3u * target + 1u] = position.y;
  positions[3u * target + 2u] = position.z;
  a.normal = vertex_pack_normal(normal);
  a.tangent = vertex_pack_tangent(tangent);
  attributes[target] = a;
}
