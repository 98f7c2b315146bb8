// The tree of the leaf in the middle of the picture: the light that it sends into the hemisphere above it, on a disc in the
// corner of the picture. Areas of the disc are solid angles (Lambert 1772), the leaf's normal is its middle and the picture's
// right its right. Dark lines part the cells, a red ring on the disc is the eye's direction, one on the picture the leaf.
#include "glsl/indirect/surface_lookup.glsl"
#include "glsl/scene/blocks.glsl"
#include "techniques/illumination_samples/leaf_tree.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;

const vec3 marked = vec3(1.0, 0.05, 0.02);
const vec3 outside = vec3(0.02);

// The unit direction, around a normal of z, that a place of the unit disc stands for; and back.
vec3 disc_direction(vec2 place) {
  float square = dot(place, place);
  return vec3(place * sqrt(2.0 - square), 1.0 - square);
}
vec2 disc_place(vec3 direction) { return direction.xy / sqrt(1.0 + direction.z); }

// A number of the cell that holds `w`, that neighbours do not share: two bits for each level on the way to it.
uint cell_number(LeafTree tree, vec3 w) {
  vec3 place = octahedral_place(w);
  uint number = 4u + octahedral_face(w);
  if (grid > 0u) {
    for (uint edges = 1u; edges < grid; edges *= 2u) number = 4u * number + octahedral_descend(place);
    return number;
  }
  uvec2 node = packed_node(tree.first, octahedral_face(w));
  while (node.x != 0u) {
    uint child = octahedral_descend(place);
    node = packed_node(tree.first, node.x + child);
    number = 4u * number + child;
  }
  return number;
}

bool on_ring(vec2 offset, float radius) { return abs(length(offset) - radius) < 1.0; }

// What the disc of the leaf shows at a place, whose pixels are `step` wide.
vec3 disc_colour(uint slot, vec2 place, float step) {
  vec3 normal = leaves[slot].normal.xyz;
  Frame around = frame_along(normal, frame.view_ray_dx.xyz);
  Frame own = frame_around(normal);
  vec3 eye = to_local(around, normalize(frame.camera_position.xyz - leaves[slot].position.xyz));
  if (on_ring((place - disc_place(eye)) / step, 3.0)) return marked;
  LeafTree tree = trees[slot];
  if (tree.first == no_tree) return vec3(0.0);
  uint number = 0u;
  for (int i = 0; i < 3; ++i) {
    vec2 beside = place + step * vec2(i == 1, i == 2);
    if (dot(beside, beside) > 1.0) continue;
    vec3 w = to_local(own, from_local(around, disc_direction(beside)));
    w.z = max(w.z, 1e-3);
    uint cell = cell_number(tree, w);
    if (i > 0 && cell != number) return outside;
    number = cell;
  }
  return leaf_radiance(slot, from_local(around, disc_direction(place)));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(frame.frame_size);
  if (any(greaterThanEqual(pixel, size))) return;
  ivec2 middle = size / 2;
  Around a = around_pixel(middle);
  if (!a.found) return;
  float radius = 0.2 * float(min(size.x, size.y));
  vec2 place = (vec2(pixel) + 0.5) / radius - 1.1;
  if (dot(place, place) < 1.0) {
    imageStore(radiance, pixel, vec4(disc_colour(a.slots[nearest_corner(a)], place, 1.0 / radius), 1.0));
  } else if (dot(place, place) < 1.1 || on_ring(vec2(pixel - middle), 4.0)) {
    imageStore(radiance, pixel, vec4(dot(place, place) < 1.1 ? outside : marked, 1.0));
  }
}
