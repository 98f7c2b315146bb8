// The surface elements (leaves) around a pixel, as limn::indirect::SurfaceLookup finds them.
#ifndef LIMN_SURFACE_LOOKUP_GLSL
#define LIMN_SURFACE_LOOKUP_GLSL

uniform usampler2D surface_lookup;

struct Around {
  uvec3 slots;
  vec3 weights;
  bool found;
};

// Which of the leaves weighs most.
int nearest_corner(Around a) {
  int second = a.weights.y > a.weights.x ? 1 : 0;
  return a.weights.z > a.weights[second] ? 2 : second;
}

Around around_texel(ivec2 pixel) {
  uvec4 texel = texelFetch(surface_lookup, pixel, 0);
  Around a;
  a.slots = texel.xyz;
  vec2 place = unpackUnorm2x16(texel.w);
  a.weights = vec3(max(1.0 - place.x - place.y, 0.0), place);
  a.found = texel.x != 0xffffffffu;
  return a;
}

// At outlines the triangles between surfels may miss a pixel that the G-buffer shows: then a neighbour's.
Around around_pixel(ivec2 pixel) {
  Around a = around_texel(pixel);
  ivec2 last = textureSize(surface_lookup, 0) - 1;
  for (int i = 0; i < 8 && !a.found; ++i) {
    ivec2 step = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1), ivec2(1, 1), ivec2(-1, 1), ivec2(1, -1),
                         ivec2(-1, -1))[i];
    a = around_texel(clamp(pixel + step, ivec2(0), last));
  }
  return a;
}

#endif
