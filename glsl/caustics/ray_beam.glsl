// The caustic-ray buffer as drawing passes read it, and the beam that a ray stands for: the light between it and its
// neighbours in the buffer.
#ifndef LIMN_RAY_BEAM_GLSL
#define LIMN_RAY_BEAM_GLSL
#include "glsl/caustics/caustic_ray.glsl"

layout(std430) readonly buffer Rays { CausticRay rays[]; };
uniform int buffer_size;    // rays per side of a layer
uniform float beam_cosine;  // rays that go further apart than this are not of one beam

// The neighbour of ray `index` one step along x or y, on the side that goes more nearly the same way: not across the edge of
// a facet. Itself if there is none. `along`: the step of the index; `at`: the ray's place along that axis.
int beam_neighbour(int index, int along, int at) {
  vec3 direction = rays[index].direction;
  int best = index;
  float nearest = beam_cosine;
  for (int side = 1; side >= -1; side -= 2) {
    if (at + side < 0 || at + side >= buffer_size) continue;
    CausticRay other = rays[index + side * along];
    float cosine = other.kind == caustic_ray_none ? -1.0 : dot(other.direction, direction);
    if (cosine > nearest) {
      nearest = cosine;
      best = index + side * along;
    }
  }
  return best;
}

// The neighbours along both axes of the buffer.
struct BeamNeighbours {
  CausticRay beside;
  CausticRay above;
};

BeamNeighbours beam_neighbours(int index) {
  int x = index % buffer_size;
  int y = index / buffer_size % buffer_size;
  return BeamNeighbours(rays[beam_neighbour(index, 1, x)], rays[beam_neighbour(index, buffer_size, y)]);
}

// The side of the beam towards a neighbour at `l` metres along the ray, perpendicular to it.
vec3 beam_side(CausticRay ray, CausticRay other, float l) {
  vec3 offset = other.start + l * other.direction - ray.start - l * ray.direction;
  return offset - dot(offset, ray.direction) * ray.direction;
}

#endif  // LIMN_RAY_BEAM_GLSL
