// Shadow maps and the lights of one dispatch, which are alike: core/shadow/alike_lights.h makes the dispatches, and defines
// what their lights have in common, so that no loop asks for it again: SHADOW_PROJECTION (shadow_perspective, ...),
// SHADOW_FACES (shadow_faces_*) and LIGHT_KIND (light_kind_*) as numbers. Where they are undefined, each light says it. Lights
// that are cut (glsl/light/light_part.glsl) have LIGHT_PARTS_U x LIGHT_PARTS_V parts, each with maps of its own.
#ifndef LIMN_ALIKE_LIGHTS_GLSL
#define LIMN_ALIKE_LIGHTS_GLSL
#include "glsl/scene/light.glsl"
#include "glsl/shadow/shadow_view.glsl"

// 1: every light of the dispatch has one view (shadow_faces_single), so that no loop moves to another.
#define ONE_VIEW 0
#ifdef SHADOW_FACES
#if SHADOW_FACES == 0
#undef ONE_VIEW
#define ONE_VIEW 1
#endif
#endif

#ifndef LIGHT_PARTS_U
#define LIGHT_PARTS_U 1
#define LIGHT_PARTS_V 1
#endif
// Entries of shadow_lights for each light.
#ifndef SHADOW_LIGHT_STRIDE
#define SHADOW_LIGHT_STRIDE 1
#endif

uniform sampler2DArray shadow_depth;
layout(std430) readonly buffer Lights { Light lights[]; };
#ifdef SHADOW_VIEW_COUNT  // they fit a uniform block, from which all invocations load at once
layout(std140) uniform ShadowViews { ShadowView shadow_views[SHADOW_VIEW_COUNT]; };
#else
layout(std430) readonly buffer ShadowViews { ShadowView shadow_views[]; };
#endif
#ifdef SHADOW_LIGHT_COUNT  // likewise
layout(std140) uniform ShadowLights { ShadowLight shadow_lights[SHADOW_LIGHT_COUNT]; };
#else
layout(std430) readonly buffer ShadowLights { ShadowLight shadow_lights[]; };
#endif
uniform int light_layers[8];  // places in the request of the lights of this dispatch

ShadowView view_of_layer(uint layer) {
  ShadowView view = shadow_views[layer];
#ifdef SHADOW_PROJECTION
  view.projection = uint(SHADOW_PROJECTION);
#endif
  return view;
}

ShadowLight maps_at(uint index) {
  ShadowLight maps = shadow_lights[index];
#ifdef SHADOW_FACES
  maps.faces = uint(SHADOW_FACES);
#endif
  return maps;
}

uint kind_of_light(Light light) {
#ifdef LIGHT_KIND
  return uint(LIGHT_KIND);
#else
  return light_kind(light);
#endif
}

#endif  // LIMN_ALIKE_LIGHTS_GLSL
