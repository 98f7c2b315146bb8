// One level of the mip chains of all Fourier basis images of a shadow map. BASE 1: the finest, from depth; else from the
// level before. HALVED 1: whose sizes are twice this level's, so that four texels count alike: software renderers take every
// turn of a loop whose length varies. GROUPS: texels of four values that hold the ORDER terms.
#include "glsl/shadow/fourier_shadow.glsl"
#include "glsl/numeric/mip_weights.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba8_snorm) writeonly uniform image2DArray coarser_basis;
layout(rgba16_snorm) writeonly uniform image2DArray coarser_depth_basis;
layout(r16) writeonly uniform image2DArray coarser_depth;

#if BASE
uniform sampler2DArray depth;
layout(std430) readonly buffer Ranges { FourierRange ranges[]; };
uniform float span;

void write_level(ivec3 at, ivec2 size) {
  vec2 uv = (vec2(at.xy) + 0.5) / vec2(size);
  float z = fourier_texel_depth(ranges[at.z], uv, texelFetch(depth, at, 0).r, span);
  vec2 phase = fourier_phase(1, z);
  vec2 step = fourier_phase_step(phase);
  for (int g = 0; g < GROUPS; ++g) {
    vec2 next = fourier_next_phase(phase, step);
    // z times what is stored, not what was meant: both reconstructions then see the same series.
    vec4 basis = round(127.0 * fourier_basis(phase, next)) / 127.0;
    imageStore(coarser_basis, ivec3(at.xy, GROUPS * at.z + g), basis);
    imageStore(coarser_depth_basis, ivec3(at.xy, GROUPS * at.z + g), z * basis);
    phase = fourier_next_phase(next, step);
  }
  imageStore(coarser_depth, at, vec4(z));
}

#else
layout(rgba8_snorm) readonly uniform image2DArray finer_basis;
layout(rgba16_snorm) readonly uniform image2DArray finer_depth_basis;
layout(r16) readonly uniform image2DArray finer_depth;

void write_level(ivec3 at, ivec2 size) {
  ivec2 fine = imageSize(finer_depth).xy;
  vec3 wx = mip_weights(at.x, fine.x, size.x);
  vec3 wy = mip_weights(at.y, fine.y, size.y);
#if HALVED
  const ivec2 count = ivec2(2);
#else
  ivec2 count = ivec2(wx.z > 0.0 ? 3 : wx.y > 0.0 ? 2 : 1, wy.z > 0.0 ? 3 : wy.y > 0.0 ? 2 : 1);
#endif
  for (int g = 0; g < GROUPS; ++g) {
    vec4 basis = vec4(0.0);
    vec4 depth_basis = vec4(0.0);
    for (int j = 0; j < count.y; ++j) {
      for (int i = 0; i < count.x; ++i) {
        ivec3 from = ivec3(2 * at.xy + ivec2(i, j), GROUPS * at.z + g);
        basis += wx[i] * wy[j] * imageLoad(finer_basis, from);
        depth_basis += wx[i] * wy[j] * imageLoad(finer_depth_basis, from);
      }
    }
    imageStore(coarser_basis, ivec3(at.xy, GROUPS * at.z + g), basis);
    imageStore(coarser_depth_basis, ivec3(at.xy, GROUPS * at.z + g), depth_basis);
  }
  float depth = 0.0;
  for (int j = 0; j < count.y; ++j) {
    for (int i = 0; i < count.x; ++i)
      depth += wx[i] * wy[j] * imageLoad(finer_depth, ivec3(2 * at.xy + ivec2(i, j), at.z)).x;
  }
  imageStore(coarser_depth, at, vec4(depth));
}
#endif

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 size = imageSize(coarser_depth);
  if (all(lessThan(at, size))) write_level(at, size.xy);
}
