// Where taps along a row or a column of a surface fall in the picture.
#ifndef LINE_FOOTPRINT_GLSL
#define LINE_FOOTPRINT_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Of a line on a plane through a pixel's point, which the picture shows along a row or a column.
struct LineFootprint {
  float pixels;   // of a metre along the line, at the pixel itself
  float receding;  // depth that a metre along the line adds, over the pixel's own, 1/m
};

// A plane that faces the camera. step: the change of the viewing ray from one pixel of the row or column to the next.
LIMN_FN LineFootprint facing_footprint(vec3 step, float depth) {
  LineFootprint f;
  f.pixels = 1.0f / (length(step) * depth);
  f.receding = 0.0f;
  return f;
}

// The plane with this normal, which faces the camera. ray: through the pixel, 1 along the view axis, where step is 0.
LIMN_FN LineFootprint tangent_footprint(vec3 normal, vec3 ray, vec3 step, float depth) {
  float towards = min(dot(normal, ray), -1e-4f * length(ray));
  float turn = dot(normal, step) / towards;
  float metres = length(step - turn * ray) * depth;  // of a pixel
  LineFootprint f;
  f.pixels = 1.0f / metres;
  f.receding = -turn / metres;
  return f;
}

// Depth of the plane at this distance along the line, over the pixel's own; 0 or less: behind the camera.
LIMN_FN float footprint_depth(LineFootprint f, float offset) { return 1.0f + offset * f.receding; }

// Pixels to where it is seen, for a depth > 0.
LIMN_FN float footprint_shift(LineFootprint f, float offset, float depth) { return offset * f.pixels / depth; }

LIMN_END
#endif  // LINE_FOOTPRINT_GLSL
