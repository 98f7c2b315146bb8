// Keeps fragments that lie on the G-buffer's surface.
layout(location = 0) in vec2 place;
layout(location = 1) flat in uvec3 around;
layout(location = 0) out uvec4 found;  // leaf slots; barycentric coordinates, 2 x 16 bits
uniform sampler2D gbuffer_depth;

void main() {
  float depth = texelFetch(gbuffer_depth, ivec2(gl_FragCoord.xy), 0).x;
  if (abs(1.0 / gl_FragCoord.w - depth) > 0.01 * depth) discard;
  found = uvec4(around, packUnorm2x16(place));
}
