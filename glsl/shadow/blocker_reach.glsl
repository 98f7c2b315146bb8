// How far from the receiver the blocker search of percentage-closer soft shadows looks.
//
// Define SEARCH 0: at the near plane, 1: through the cone up to it, 2: at the plane to which bounds of the depths narrow the
// kernel.
#ifndef LIMN_BLOCKER_REACH_GLSL
#define LIMN_BLOCKER_REACH_GLSL
#include "glsl/shadow/visibility.glsl"
#if SEARCH == 2
#define BOUNDS_DEPTH min_max_windows_depth
#include "glsl/shadow/blocker_search.glsl"

uniform int search_rounds;
#endif

// True: blockers are to be sought up to `reach` metres from the receiver along the light's axis. False: they need not be,
// and reach is 0 where there are none, V = 1, and negative where nothing else is there, V = 0.
bool blocker_reach(inout ShadowCursor cursor, VisibilityQuery q, out float reach) {
#if SEARCH == 2
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  bool partial = search.answer == search_partial;
  reach = partial ? search.gap : search.answer == search_lit ? 0.0 : -1.0;
  return partial;
#else
  reach = shadow_near_gap(cursor, q);
  return true;
#endif
}

#endif  // LIMN_BLOCKER_REACH_GLSL
