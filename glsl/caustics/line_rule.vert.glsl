// A line of 1000 pixels at 45 degrees in a target of 1024 x 1024 pixels.
void main() {
  float reach = 1000.0 * 0.70710678 / 1024.0;
  gl_Position = vec4(gl_VertexID == 0 ? vec2(-reach) : vec2(reach), 0.0, 1.0);
}
