// How far the camera's picture lies aside where its frame is a sample beside the middle of the pixels, on the view plane at
// distance 1 (setSampleShift() in core/caustics/ray_lines.h).
//
// Lines and photons hold the mean over a pixel already. They are drawn at the pixels' middles for all samples of these: moved by
// parts of a pixel they would have that mean taken twice. So samples differ only by what hides them and what they fall on.
#ifndef LIMN_SAMPLE_SHIFT_GLSL
#define LIMN_SAMPLE_SHIFT_GLSL

uniform float sample_shift_x;
uniform float sample_shift_y;

vec2 sample_shift() { return vec2(sample_shift_x, sample_shift_y); }

#endif  // LIMN_SAMPLE_SHIFT_GLSL
