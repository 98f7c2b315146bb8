// The profiles of glsl/diffusion for three channels at once, per unit of length: a channel's mean free path is 1 / extinction.
// A channel that absorbs what it does not scatter at all (a' = 0) has a density, of a reflectance of 0.
#ifndef LIMN_DIFFUSION_COLOURS_GLSL
#define LIMN_DIFFUSION_COLOURS_GLSL
#include "glsl/diffusion/dipole.glsl"
#include "glsl/diffusion/normalised.glsl"
LIMN_BEGIN

// The mean distance between where light enters and where it leaves, by normalised diffusion, whose mean is finite at any
// absorption: int 2 pi r^2 R dr / A = 2.5 d.
LIMN_FN vec3 diffusion_reach(vec3 extinction, vec3 absorption, WalkReflectance walk) {
  vec3 width = vec3(normalised_diffusion(absorption.x, walk).width, normalised_diffusion(absorption.y, walk).width,
                    normalised_diffusion(absorption.z, walk).width);
  return 2.5f * width / extinction;
}

// Of which channels points are drawn, as shares: of the one that reaches farthest alone, and of all where another reaches less
// than a quarter as far, whose light few of the farthest one's points would meet.
LIMN_FN vec3 diffusion_drawn_channels(vec3 reach) {
  float farthest = max(reach.x, max(reach.y, reach.z));
  float nearest = min(reach.x, min(reach.y, reach.z));
  if (farthest > 4.0f * nearest) return vec3(1.0f / 3.0f);
  if (reach.x == farthest) return vec3(1.0f, 0.0f, 0.0f);
  return reach.y == farthest ? vec3(0.0f, 1.0f, 0.0f) : vec3(0.0f, 0.0f, 1.0f);
}

struct DipoleColours {
  vec3 extinction;
  float virtual_height;
  vec3 decay;
  vec3 real_share;
  vec3 reflectance;
  vec3 strength;  // what both sources' densities have in common, per area
};

LIMN_FN DipoleColours dipole_colours(vec3 extinction, vec3 absorption, DiffusionBoundary boundary) {
  DiffusionDipole x = diffusion_dipole(absorption.x, boundary);
  DiffusionDipole y = diffusion_dipole(absorption.y, boundary);
  DiffusionDipole z = diffusion_dipole(absorption.z, boundary);
  DipoleColours c;
  c.extinction = extinction;
  c.virtual_height = x.virtual_height;
  c.decay = vec3(x.decay, y.decay, z.decay);
  c.real_share = vec3(x.real_share, y.real_share, z.real_share);
  c.reflectance = vec3(x.reflectance, y.reflectance, z.reflectance);
  c.strength = 0.5f * inverse_pi * extinction * extinction * c.real_share * exp(c.decay);
  return c;
}

// Share of each channel's light per area at distance r; of one channel's, what leaves within r, and the radius within which the
// share xi does.
LIMN_FN vec3 diffusion_density(DipoleColours c, float r) {
  vec3 away = min(r * c.extinction, vec3(1e10f));
  float z = c.virtual_height;
  vec3 real_squared = away * away + vec3(1.0f);
  vec3 virtual_squared = away * away + vec3(z * z);
  vec3 real = inversesqrt(real_squared);
  vec3 image = inversesqrt(virtual_squared);
  vec3 real_decay = c.decay * real_squared * real;
  vec3 virtual_decay = c.decay * virtual_squared * image;
  return c.strength * ((vec3(1.0f) + real_decay) * exp(-real_decay) * (real * real * real) +
                       (vec3(1.0f) + virtual_decay) * exp(-virtual_decay) * (z * image * image * image));
}
LIMN_FN DiffusionDipole diffusion_channel(DipoleColours c, int channel) {
  DiffusionDipole d;
  d.decay = c.decay[channel];
  d.virtual_height = c.virtual_height;
  d.real_share = c.real_share[channel];
  d.reflectance = c.reflectance[channel];
  return d;
}
LIMN_FN float diffusion_share(DipoleColours c, int channel, float r) {
  return diffusion_dipole_share(diffusion_channel(c, channel), min(r * c.extinction[channel], 1e10f));
}
LIMN_FN float diffusion_radius(DipoleColours c, int channel, float xi) {
  return diffusion_dipole_radius(diffusion_channel(c, channel), xi) / c.extinction[channel];
}

struct NormalisedColours {
  vec3 reflectance;
  vec3 width;  // d
};

LIMN_FN NormalisedColours normalised_colours(vec3 extinction, vec3 absorption, DiffusionBoundary boundary) {
  WalkReflectance walk = walk_reflectance(boundary);
  NormalisedDiffusion x = normalised_diffusion(absorption.x, walk);
  NormalisedDiffusion y = normalised_diffusion(absorption.y, walk);
  NormalisedDiffusion z = normalised_diffusion(absorption.z, walk);
  NormalisedColours c;
  c.reflectance = vec3(x.reflectance, y.reflectance, z.reflectance);
  c.width = vec3(x.width, y.width, z.width) / extinction;
  return c;
}

// r > 0.
LIMN_FN vec3 diffusion_density(NormalisedColours c, float r) {
  vec3 wide = exp(vec3(-r / 3.0f) / c.width);
  return 0.125f * inverse_pi * (wide * wide * wide + wide) / (r * c.width);
}
LIMN_FN NormalisedDiffusion diffusion_channel(NormalisedColours c, int channel) {
  NormalisedDiffusion n;
  n.reflectance = c.reflectance[channel];
  n.width = c.width[channel];
  return n;
}
LIMN_FN float diffusion_share(NormalisedColours c, int channel, float r) {
  return normalised_diffusion_share(diffusion_channel(c, channel), r);
}
LIMN_FN float diffusion_radius(NormalisedColours c, int channel, float xi) {
  return normalised_diffusion_radius(diffusion_channel(c, channel), xi);
}

LIMN_END
#endif  // LIMN_DIFFUSION_COLOURS_GLSL
