// Morphs, then skins, the vertices of one primitive instance: from their range at rest into their own range.
#include "glsl/deform.glsl"
#include "glsl/vertex.glsl"

layout(local_size_x = 64) in;

struct Job {
  uvec4 range;  // x: first vertex at rest, y: first deformed vertex, z: vertices, w: first word of the skin or ~0
  uvec4 state;  // x: first joint, y: first morph weight, z: morph targets, w: first float of the targets
};
layout(std430, binding = 0) buffer Positions { float positions[]; };
layout(std430, binding = 1) buffer Attributes { VertexAttributes attributes[]; };
layout(std430, binding = 2) readonly buffer Skin { uint skin[]; };
layout(std430, binding = 3) readonly buffer Morph { float deltas[]; };
layout(std430, binding = 4) readonly buffer Jobs { Job jobs[]; };
layout(std430, binding = 5) readonly buffer Joints { mat4 joints[]; };
layout(std430, binding = 6) readonly buffer Weights { float weights[]; };
uniform uint job_index;

vec3 delta(uint at) { return vec3(deltas[at], deltas[at + 1u], deltas[at + 2u]); }

void main() {
  Job job = jobs[job_index];
  uint vertex = gl_GlobalInvocationID.x;
  if (vertex >= job.range.z) return;
  uint source = job.range.x + vertex;
  vec3 position = vec3(positions[3u * source], positions[3u * source + 1u], positions[3u * source + 2u]);
  VertexAttributes a = attributes[source];
  vec3 normal = vertex_unpack_normal(a.normal);
  vec4 tangent = vertex_unpack_tangent(a.tangent);

  vec3 normal_sum = normal;
  vec3 tangent_sum = tangent.xyz;
  for (uint t = 0u; t < job.state.z; ++t) {
    float weight = weights[job.state.y + t];
    if (weight == 0.0) continue;
    uint at = job.state.w + 9u * (t * job.range.z + vertex);
    position = morph(position, delta(at), weight);
    normal_sum = morph(normal_sum, delta(at + 3u), weight);
    tangent_sum = morph(tangent_sum, delta(at + 6u), weight);
  }
  normal = safe_normalize(normal_sum, normal);
  tangent.xyz = safe_normalize(tangent_sum, tangent.xyz);

  if (job.range.w != 0xffffffffu) {
    uint at = job.range.w + 6u * vertex;
    uvec2 packed_joints = uvec2(skin[at], skin[at + 1u]);
    uvec4 j = job.state.x + uvec4(packed_joints.x & 0xffffu, packed_joints.x >> 16, packed_joints.y & 0xffffu,
                                  packed_joints.y >> 16);
    vec4 w = uintBitsToFloat(uvec4(skin[at + 2u], skin[at + 3u], skin[at + 4u], skin[at + 5u]));
    mat4 joint = blend_joints(joints[j.x], joints[j.y], joints[j.z], joints[j.w], w);
    position = skin_position(joint, position);
    normal = skin_normal(joint, normal);
    tangent = skin_tangent(joint, tangent);
  }

  uint target = job.range.y + vertex;
  positions[3u * target] = position.x;
  positions[3u * target + 1u] = position.y;
  positions[3u * target + 2u] = position.z;
  a.normal = vertex_pack_normal(normal);
  a.tangent = vertex_pack_tangent(tangent);
  attributes[target] = a;
}
