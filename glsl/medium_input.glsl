// The scene's medium as passes read it that bind the frame block.
#ifndef LIMN_MEDIUM_INPUT_GLSL
#define LIMN_MEDIUM_INPUT_GLSL
#include "glsl/blocks.glsl"

Medium scene_medium() {
  return frame_medium(frame.medium_extinction, frame.medium_scattering, frame.medium_ball);
}

#endif  // LIMN_MEDIUM_INPUT_GLSL
