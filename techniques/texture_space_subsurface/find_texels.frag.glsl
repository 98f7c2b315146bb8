// Where in its body's texture a pixel lies.
layout(location = 0) in vec2 place;
layout(location = 1) flat in uvec3 part;
layout(location = 0) out vec4 found;  // texels; layer; chart
uniform sampler2D gbuffer_depth;
uniform usampler2D gbuffer_instance;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(gbuffer_depth, pixel, 0).x;
  bool seen = texelFetch(gbuffer_instance, pixel, 0).x == part.z && abs(1.0 / gl_FragCoord.w - depth) <= 1e-4 * depth;
  if (!seen) discard;
  found = vec4(place, vec2(part.xy));
}
