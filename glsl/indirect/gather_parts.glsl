// What the passes of indirect light pass on: an array of screens (RGBA32F) with a layer for each part of the light.
// rgb / a is the value; a is 0 where nothing can be lit, and until it is blurred that of the specular part is 0 where the surface
// has none. GATHER_SPECULAR, GATHER_RESIDUAL: whether these parts exist.
#ifndef LIMN_GATHER_PARTS_GLSL
#define LIMN_GATHER_PARTS_GLSL

const int gather_part_diffuse = 0;  // per unit of the diffuse albedo: textures are not blurred with it
const int gather_part_specular = 1;
const int gather_part_residual = 1 + GATHER_SPECULAR;  // of the diffuse part, what bounding 1/d^2 cut off
const int gather_parts = 1 + GATHER_SPECULAR + GATHER_RESIDUAL;

// Diagonal of the scene's bounds, m.
float gather_extent() { return 2.0 * frame.scene_radius; }

// Where a pixel lies in a screen that is split into block x block sub-buffers.
ivec2 split_texel(ivec2 pixel, int block, ivec2 size) {
  ivec2 part = (size + block - 1) / block;
  return pixel % block * part + pixel / block;
}

#endif  // LIMN_GATHER_PARTS_GLSL
