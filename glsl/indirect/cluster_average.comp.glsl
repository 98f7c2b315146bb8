// Mean position and normal of each cluster's virtual lights; a cluster that has none stays where it is. Sums are taken
// about the cluster's former place, so that they are as exact far from the world's origin as near it.
#include "glsl/indirect/cluster_members.glsl"

void main() {
  uint k = gl_WorkGroupID.x;
  VirtualAreaLight cluster = clusters[k];
  vec4 offsets = vec4(0.0);
  vec4 normals = vec4(0.0);
  for (uint i = gl_LocalInvocationIndex; i < light_count; i += THREADS) {
    if (!member(i)) continue;
    offsets += vec4(virtual_lights[i].position - cluster.position, 1.0);
    normals += vec4(virtual_lights[i].normal, 0.0);
  }
  offsets = total(offsets);
  normals = total(normals);
  if (gl_LocalInvocationIndex != 0u) return;
  float count = offsets.w;
  if (count > 0.0) {
    cluster.position += offsets.xyz / count;
    cluster.normal.xyz = cluster_normal(normals.xyz, count);
  }
  if (cluster.count >= 0.0) cluster.count = count;
  clusters[k] = cluster;
}
