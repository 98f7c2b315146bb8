// Points around a place, drawn in a plane from the profile of channels or uniformly from a disc.
#ifndef LIMN_DIFFUSION_DRAWN_POINTS_GLSL
#define LIMN_DIFFUSION_DRAWN_POINTS_GLSL
#include "glsl/diffusion/colours.glsl"
#include "glsl/numeric/sampling.glsl"
LIMN_BEGIN

// From what distribution points are drawn; densities are per area of the plane.
struct PointSource {
  vec3 channels;         // shares of those points that are drawn from profiles
  float uniform_share;   // of points that are drawn from a disc
  float uniform_radius;  // of that disc
};

// What is random about a point, before it is known what scatters. An element of a uniform or storage block.
struct PointDraw {
  vec2 direction;  // unit
  float radius;    // share of the light within it, [0, 1)
  float choice;    // of a channel, [0, 1); below 0: the point is drawn from the disc
};

// A point in the plane for known matter: an element of a uniform or storage block.
struct DrawnPoint {
  vec2 offset;
  float inverse_density;
  float unused;
};

// Number `index` of a sequence that covers the plane evenly from any start and at any stride.
LIMN_FN PointDraw point_draw(uint index, bool from_disc) {
  vec3 u = r3_sequence(index + 1u);
  float angle = 2.0f * pi * u.x;
  PointDraw d;
  d.direction = vec2(cos(angle), sin(angle));
  d.radius = u.y;
  d.choice = from_disc ? -1.0f : u.z;
  return d;
}

LIMN_FN int drawn_channel(vec3 channels, float choice) {
  if (choice < channels.x) return 0;
  return choice < channels.x + channels.y || channels.z == 0.0f ? 1 : 2;
}

LIMN_FN float drawn_radius(DipoleColours colours, PointSource source, PointDraw draw) {
  if (draw.choice < 0.0f) return source.uniform_radius * sqrt(draw.radius);
  return diffusion_radius(colours, drawn_channel(source.channels, draw.choice), draw.radius);
}
LIMN_FN float drawn_radius(NormalisedColours colours, PointSource source, PointDraw draw) {
  if (draw.choice < 0.0f) return source.uniform_radius * sqrt(draw.radius);
  return diffusion_radius(colours, drawn_channel(source.channels, draw.choice), draw.radius);
}

// Of a pixel's points the last ones may be drawn from the disc. The others are drawn from two profiles where light between two
// colours goes by both: the third and fourth of each four from the one that reaches farther.
LIMN_FN bool drawn_from_wider(int point) { return (point & 2) != 0; }

// The part of the first `count` points that drawn_from_wider() holds for.
LIMN_FN float drawn_wider_share(int count) {
  return float(count / 4 * 2 + max(count % 4 - 2, 0)) / float(max(count, 1));
}

// The density at distance r of all that points are drawn from (Veach's balance heuristic). `density`: diffusion_density() there.
LIMN_FN float drawn_density(vec3 density, PointSource source, float r) {
  float disc = r <= source.uniform_radius ? inverse_pi / (source.uniform_radius * source.uniform_radius) : 0.0f;
  return mix(dot(density, source.channels), disc, source.uniform_share);
}

LIMN_END
#endif  // LIMN_DIFFUSION_DRAWN_POINTS_GLSL
