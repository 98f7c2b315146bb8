// What leaves at the pixels of translucent bodies: the light of the body's points, and of what enters at the pixel, as far as
// it leaves nearer than points tell.
#include "glsl/diffusion/pixel_exit.glsl"
#include "techniques/hierarchical_subsurface/scatter_matter.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba32f) uniform image2D radiance;
layout(std430) readonly buffer Bodies { ScatterBody bodies[]; };
layout(std430) readonly buffer Nodes { ScatterNode nodes[]; };
layout(std430) readonly buffer Entering { vec4 entering_light[]; };
uniform sampler2D entering;  // E / pi
uniform float tolerance;     // sr

#include "techniques/hierarchical_subsurface/tree_walk.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  float depth = pixel_depth(pixel);
  if (depth == 0.0) return;
  GBufferSurface surface = pixel_surface(pixel);
  if ((surface.flags & gbuffer_flag_translucent) == 0u) return;
  ScatterBody body = bodies[pixel_instance(pixel)];
  DiffusionBoundary boundary = diffusion_boundary(body.eta);
  ProfileColours matter = scatter_matter(body, boundary, surface.base_colour);
  vec3 position = pixel_position(pixel, depth);
  vec3 x = (position - body.centre) / body.radius;
  vec3 leaving = scatter_near(matter, body.softening) * texelFetch(entering, pixel, 0).rgb +
                 light_of_points(body.first_node, x, matter, body.softening, tolerance);
  vec3 light = pixel_exit(pixel, boundary) * leaving;
  imageStore(radiance, pixel, imageLoad(radiance, pixel) + vec4(light, 0.0));
}
