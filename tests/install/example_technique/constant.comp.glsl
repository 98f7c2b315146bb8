// V = value for every pixel of every light of the batch.
layout(local_size_x = 8, local_size_y = 8) in;
layout(r16) writeonly uniform image2DArray visibility;
uniform float value;

void main() { imageStore(visibility, ivec3(gl_GlobalInvocationID), vec4(value)); }
