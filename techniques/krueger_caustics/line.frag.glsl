// A line of light as Krueger et al. draw it: the flux of its ray times a constant.
#include "glsl/caustics/line_fragment.glsl"

uniform float scale;

void main() {
  LineFragment f = line_fragment();
  if (f.share == 0.0) discard;
  radiance = vec4(rays[ray_index].power * (scale * f.share), 0.0);
}
