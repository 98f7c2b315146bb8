// How the unshadowed light U of a surface and what samples tell of its shadows make the shadowed light. COMBINE: how; DEMODULATE 1:
// light is kept without the surface's colours, so that blocks of pixels may share it across a texture. SHOW 1: a picture may show
// what the shadowed light is made of in its place.
//
// The values of the shadow buffer are 0 where nothing is in shadow: the share that is hidden (by ratio), the hidden light
// (subtract); but the light that is seen (add). With SAMPLE_PARTS 1 there are values for the diffuse part and for the lobe; always
// so in scenes with coats. What coats mirror has a value of its own, by whatever way the rest is combined.
#ifndef LIMN_COMBINE_GLSL
#define LIMN_COMBINE_GLSL

#define COMBINE_SUBTRACT 0
#define COMBINE_RATIO 1
#define COMBINE_RATIO_SPLIT 2
#define COMBINE_ADD 3
#define COMBINE_BY_RATIO (COMBINE == COMBINE_RATIO || COMBINE == COMBINE_RATIO_SPLIT)
#if COMBINE == COMBINE_ADD
#define SAMPLE_TOTALS 0
#else
#define SAMPLE_TOTALS 1
#endif
#if COMBINE == COMBINE_RATIO_SPLIT || (DEMODULATE && !COMBINE_BY_RATIO) || (MATERIAL_MODELS & 32) != 0
#define SAMPLE_PARTS 1
#else
#define SAMPLE_PARTS 0
#endif
#include "glsl/shadow/sampled_pixel.glsl"
#include "glsl/surface/reflectance.glsl"

// The colours by which a surface's parts reflect: albedo, and the mean of Schlick's Fresnel term. That of the view is next to 0 in
// a channel without f0 where the surface faces the viewer, and changes manifold across a block where it turns away, while light of
// other half vectors is in the lobe all over.
ReflectedParts surface_colours(SampledPixel p) {
#if DEMODULATE
  SurfaceBrdf s = p.material.brdf;
#if MATERIAL_MODELS
  if (has_model(p.material)) s = nearest_brdf(p.material);
#endif
  return ReflectedParts(s.diffuse, specular_reflectance(s));
#else
  return ReflectedParts(vec3(1.0), vec3(1.0));
#endif
}

// Of a picture that fades into one with other blocks, this one's share.
#if SAMPLE_FADE
uniform float picture_share;
#else
const float picture_share = 1.0;
#endif

struct ShadowValues {
  ReflectedParts parts;
  float mirror;  // hidden share of what a coat mirrors, or would mirror there: blocks without a coat know it, too
};

// The shadowed light of the pixel; unshadowed: its U; shadows: of the shadow buffer.
vec3 shadowed_light(SampledPixel p, ReflectedParts unshadowed, ShadowValues shadows) {
  ReflectedParts values = shadows.parts;
#if COMBINE_BY_RATIO
  if (SAMPLE_PARTS == 0) values.lobe = values.diffuse;
  if (is_coated(p)) values.lobe = vec3(shadows.mirror);
  return reflected_left(unshadowed, values);
#else
  ReflectedParts colours = surface_colours(p);
  vec3 mirrored = vec3(0.0);
  if (is_coated(p)) {
    mirrored = unshadowed.lobe * share_left(vec3(shadows.mirror));
    unshadowed.lobe = values.lobe = vec3(0.0);
  }
  vec3 light = values.diffuse * colours.diffuse;
  if (SAMPLE_PARTS == 1) light += values.lobe * colours.lobe;
#if COMBINE == COMBINE_SUBTRACT
  light = max(reflected_whole(unshadowed) - light, vec3(0.0));
#endif
  return light + mirrored;
#endif
}

#define SHOWN_LIGHT 0
#define SHOWN_UNSHADOWED 1
#define SHOWN_SHADOW_BUFFER 2  // what is hidden, as the pixel's own block alone knows it
#define SHOWN_HIDDEN 3
#if SHOW
uniform int shown_part;
#else
const int shown_part = SHOWN_LIGHT;
#endif

// What the picture shows of the pixel: the shadowed light, the unshadowed one, or what lies between them.
vec3 shown_light(SampledPixel p, ReflectedParts unshadowed, ShadowValues shadows) {
  vec3 light = shadowed_light(p, unshadowed, shadows);
  if (shown_part == SHOWN_LIGHT) return light;
  vec3 whole = reflected_whole(unshadowed);
  return shown_part == SHOWN_UNSHADOWED ? whole : max(whole - light, vec3(0.0));
}

#endif  // LIMN_COMBINE_GLSL
