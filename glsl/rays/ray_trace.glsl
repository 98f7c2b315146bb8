// Rays through the scene: whether anything lies on a segment, and where its first place is. rays::RayGeometry
// (core/rays/ray_geometry.h) declares the blocks, and defines RAY_STACK, the entries that no walk exceeds, and RAY_COVERAGE, 1
// where alpha masks let rays pass.
#ifndef LIMN_RAY_TRACE_GLSL
#define LIMN_RAY_TRACE_GLSL
#include "glsl/rays/ray_coverage.glsl"
#include "glsl/rays/ray_node.glsl"
#include "glsl/rays/ray_space.glsl"

layout(std430) readonly buffer RayNodes { RayNode ray_nodes[]; };
layout(std430) readonly buffer RayTriangles { vec4 ray_triangles[]; };  // three vertices each, xyz
layout(std430) readonly buffer RayBodies { RayBody ray_bodies[]; };
#if RAY_COVERAGE
layout(std430) readonly buffer RayCoverage { uint ray_words[]; };

float ray_texel(uint texels, int width, ivec2 at) {
  uint i = uint(at.y * width + at.x);
  return float(ray_words[texels + (i >> 2u)] >> 8u * (i & 3u) & 255u) * (1.0 / 255.0);
}

// Alpha of the mask's texture at full size: the bilinear filter of OpenGL.
float ray_texture(uint mask, vec2 uv) {
  ivec2 size = ivec2(ray_words[mask + ray_mask_width], ray_words[mask + ray_mask_height]);
  if (size.x == 0) return 1.0;
  uint texels = ray_words[mask + ray_mask_texels], wraps = ray_words[mask + ray_mask_wraps];
  uint s = wraps & 3u, t = wraps >> 2u;
  vec2 place = vec2(ray_wrap_near(uv.x, s), ray_wrap_near(uv.y, t)) * vec2(size) - 0.5;
  vec2 low = floor(place), w = place - low;
  int x0 = ray_wrap(int(low.x), size.x, s), x1 = ray_wrap(int(low.x) + 1, size.x, s);
  int y0 = ray_wrap(int(low.y), size.y, t), y1 = ray_wrap(int(low.y) + 1, size.y, t);
  return mix(mix(ray_texel(texels, size.x, ivec2(x0, y0)), ray_texel(texels, size.x, ivec2(x1, y0)), w.x),
             mix(ray_texel(texels, size.x, ivec2(x0, y1)), ray_texel(texels, size.x, ivec2(x1, y1)), w.x), w.y);
}

// Whether the mask covers the place with these weights of the corners.
bool ray_covered(uint mask, uint triangle, vec3 weights) {
  uint corners = ray_words[mask + ray_mask_corners] + triangle * ray_corner_words;
  vec2 uv = vec2(0.0);
  for (uint k = 0u; k < 3u; ++k)
    uv += weights[k] * uintBitsToFloat(uvec2(ray_words[corners + 2u * k], ray_words[corners + 2u * k + 1u]));
  vec3 alphas = vec3(unpackHalf2x16(ray_words[corners + 6u]), unpackHalf2x16(ray_words[corners + 7u]).x);
  float alpha = uintBitsToFloat(ray_words[mask + ray_mask_factor]) * dot(weights, alphas);
  return alpha * ray_texture(mask, uv) >= uintBitsToFloat(ray_words[mask + ray_mask_cutoff]);
}
#endif

// Whether triangle i of the buffer covers a place between the ends of the segment, which `end` becomes then.
bool ray_hits(uint i, RaySpace r, inout float end, RayBody body) {
  vec3 a = ray_triangles[3u * i].xyz, b = ray_triangles[3u * i + 1u].xyz, c = ray_triangles[3u * i + 2u].xyz;
  vec3 weights;
  float at = end;
  if (!ray_meets_triangle(r, a, b, c, at, weights)) return false;
#if RAY_COVERAGE
  float sum = weights.x + weights.y + weights.z;
  if (body.coverage != ray_opaque && sum != 0.0 && !ray_covered(body.coverage, i - body.first_triangle, weights / sum))
    return false;
#endif
  end = at;
  return true;
}

// Whether anything but body `skip` lies at origin + t direction, 0 < t <= end, which becomes the t of what was found: the nearest
// or, in less time, any.
bool ray_finds(vec3 origin, vec3 direction, inout float end, uint skip, bool nearest) {
  bool found = false;
  uint stack[RAY_STACK];
  int held = 0;
  int outside = -1;  // entries of the scene's own hierarchy that wait below a body's; < 0: the ray is outside of bodies
  uint current = 0u;
  RaySpace ray = ray_space(origin, direction);
  RayBody body;
  body.coverage = ray_opaque;
  body.first_triangle = 0u;
  while (true) {
    // Down to a leaf: all that walks along does the same work until then (Aila and Laine 2009).
    while (!ray_is_leaf(current)) {
      RayNode node = ray_nodes[current];
      bvec4 met = ray_meets_children(node, ray, end);
      for (int i = 3; i >= 0; --i)
        if (met[i]) stack[held++] = node.child[i];
      if (held == 0) return found;
      if (held == outside) {
        outside = -1;
        ray = ray_space(origin, direction);
      }
      current = stack[--held];
    }
    uint first = ray_leaf_first(current);
    if (outside < 0) {
      if (first != skip) {
        body = ray_bodies[first];
        ray = ray_into_body(body, origin, direction);
        outside = held;
        current = body.root;
        continue;
      }
    } else {
      uint after = first + ray_leaf_count(current);
      for (uint i = first; i < after; ++i) {
        if (!ray_hits(i, ray, end, body)) continue;
        if (!nearest) return true;
        found = true;
      }
    }
    if (held == 0) return found;
    if (held == outside) {
      outside = -1;
      ray = ray_space(origin, direction);
    }
    current = stack[--held];
  }
}

bool ray_occluded(vec3 origin, vec3 direction, float end, uint skip) {
  return ray_finds(origin, direction, end, skip, false);
}
bool ray_nearest(vec3 origin, vec3 direction, inout float end, uint skip) {
  return ray_finds(origin, direction, end, skip, true);
}

#endif  // LIMN_RAY_TRACE_GLSL
