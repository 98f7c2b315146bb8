// Variance soft shadow maps (Yang et al. 2010): percentage-closer soft shadows of which both steps, the mean blocker depth
// and the share of light, come from a summed-area table of z and z^2.
//
// EARLY_OUT 0: none, 1: min-max pyramid. BLOCKERS_ADAPTIVE and VISIBILITY_ADAPTIVE: which subdivision. CONTACT 1: narrow
// penumbrae from jittered bilinear texels.
#include "glsl/blocker_search.glsl"
#include "glsl/sampling.glsl"
#include "glsl/sub_kernels.glsl"
#include "glsl/visibility_main.glsl"

uniform int search_rounds;
uniform int blocker_cells;
uniform int passes;
uniform int visibility_cells;
uniform int tree_height;
uniform float contact_texels;

// What a kernel holds, over all faces: (share blocked, metres to the blockers times that share, texels blocked).
struct Contents {
  float blocked;
  float gap;
  float texels;
};

void add_contents(inout Contents contents, ShadowCursor cursor, VisibilityQuery q, ShadowKernel kernel, float gap,
                  bool blockers) {
  KernelTally tally = kernel_tally(cursor, q, kernel, gap, kernel_depth_bounds(cursor, kernel).y);
  KernelAxes axes = kernel_axes(kernel, tally.size, blockers);
  bool adaptive = blockers ? BLOCKERS_ADAPTIVE == 1 : VISIBILITY_ADAPTIVE == 1;
#if VISIBILITY_ADAPTIVE
  int parts = adaptive ? 1 : blocker_cells;
#else
  int parts = blockers ? blocker_cells : visibility_cells;
#endif
  bool open = tally_uniform(tally, axes, parts, blockers ? 0 : 1, adaptive);
#if VISIBILITY_ADAPTIVE
  tally_adaptive(tally, axes, tree_height, open);
#endif
  tally_pooled(tally);
  vec2 extent = kernel.high - kernel.low;
  float share = kernel.weight / (extent.x * extent.y);
  contents.blocked += share * tally.blocked;
  contents.gap += share * tally.gap;
  contents.texels += tally.blocked;
}

Contents kernel_contents(inout ShadowCursor cursor, VisibilityQuery q, float gap, bool blockers, bool wanted) {
  Contents contents = Contents(0.0, 0.0, 0.0);
  float weights = 0.0;
  uint faces = wanted ? shadow_face_count(q.maps.info.y) : 0u;
  uint face = 0u;
  do {
    ShadowKernel kernel;
    bool seen = shadow_kernel_in_face(cursor, q, face, gap, kernel) && wanted;
    weights += seen ? kernel.weight : 0.0;
    if (seen) add_contents(contents, cursor, q, kernel, gap, blockers);
  } while (++face < faces);
  float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
  contents.blocked *= inverse;
  contents.gap *= inverse;
  return contents;
}

// Where SATs are imprecise and a few texels are all there is: 3 x 3 of them, bilinear and jittered.
float contact_visibility(ShadowCursor cursor, VisibilityQuery q, float gap, vec2 jitter, bool wanted) {
  float lit = 0.0;
  float total = 0.0;
  int i = wanted ? 0 : 8;
  do {
    vec3 slope;
    if (light_view_sample(q.light, (vec2(i % 3, i / 3) + jitter) / 3.0, slope)) {
      lit += shadow_tap_2x2(cursor, q.position + gap * slope);
      total += 1.0;
    }
  } while (++i < 9);
  return total > 0.0 ? lit / total : 1.0;
}

// Whether the kernel at `gap` is too narrow for the table.
bool contact(ShadowCursor cursor, VisibilityQuery q, float gap) {
  ShadowKernel kernel;
  bool seen = shadow_kernel(cursor.view, q.light, q.position, gap, true, kernel);
  return seen && max(kernel.high.x - kernel.low.x, kernel.high.y - kernel.low.y) < contact_texels;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  ShadowCursor home = cursor;
  // Step 1: the search kernel, and what its bounds decide.
  BlockerSearch search = blocker_search(cursor, q, search_rounds);
  bool open = search.answer == search_partial;
  bool narrow = false;
  float v = search.answer == search_umbra ? 0.0 : 1.0;
  float gap = search.gap;
  // Steps 2 to 4: first the distance of the blockers, then their share of the penumbra kernel, which is taken anew where
  // the blockers in it turn out to be much nearer than those that gave its size.
  int pass = 0;
  do {
    bool searching = pass == 0;
    Contents contents = kernel_contents(cursor, q, gap, searching, open);
    float found = clamp(contents.gap / max(contents.blocked, 1e-30), 0.0, gap);
    if (open && !searching) v = clamp(1.0 - contents.blocked, 0.0, 1.0);
    bool none = contents.texels < (searching ? 0.5 : 1e-3);
    open = open && !none && (searching || found < 0.8 * gap);
    gap = open ? found : gap;
#if CONTACT
    narrow = narrow || (open && contact(home, q, gap));
    open = open && !narrow;
#endif
  } while (open && ++pass <= passes);
#if CONTACT
  vec2 jitter = pixel_noise(uint(pixel.x), uint(pixel.y), 0u).xy;
  float soft = contact_visibility(home, q, gap, jitter, narrow);
  v = narrow ? soft : v;
#endif
  return v;
}
