// The area light of each cluster: the rectangle around its virtual lights in the plane of their mean normal, and the view
// of its paraboloid map. An empty cluster looks out of the scene, from far away: nothing is drawn for it.
#include "glsl/indirect/cluster_members.glsl"
#include "glsl/shadow/paraboloid.glsl"

layout(std430) writeonly buffer Views { ShadowView views[]; };
uniform float near;  // m: what lies nearer to the centre is not seen
uniform float far;
uniform uint map_size;  // texels

// Some normal of the cluster's, where their mean is 0.
vec3 some_normal() {
  float first = 3.0e38;
  for (uint i = gl_LocalInvocationIndex; i < light_count; i += THREADS) {
    if (member(i)) first = min(first, float(i));
  }
  first = least(vec4(first)).x;
  return first < 3.0e38 ? virtual_lights[uint(first)].normal : vec3(0.0, 0.0, 1.0);
}

void main() {
  uint k = gl_WorkGroupID.x;
  VirtualAreaLight cluster = clusters[k];
  vec3 any_normal = some_normal();
  vec3 axis = cluster.normal.xyz == vec3(0.0) ? any_normal : cluster.normal.xyz;
  bool empty = cluster.count <= 0.0;
  vec3 origin = cluster.position + (empty ? 1e3 * far * axis : vec3(0.0));
  ShadowView view = paraboloid_view(origin, axis, near, far, k, map_size);
  vec4 bounds = vec4(3.0e38);  // least along both axes, greatest negated
  for (uint i = gl_LocalInvocationIndex; i < light_count; i += THREADS) {
    if (!member(i)) continue;
    vec2 at = shadow_local(view, virtual_lights[i].position).xy;
    bounds = min(bounds, vec4(at, -at));
  }
  bounds = least(bounds);
  if (gl_LocalInvocationIndex != 0u) return;
  vec2 reach = empty ? vec2(0.0) : max(-bounds.zw - bounds.xy, vec2(0.0));
  cluster.extent = vec2(cluster_side(reach.x, cluster.count), cluster_side(reach.y, cluster.count));
  clusters[k] = cluster;
  views[k] = view;
}
