// Variance soft shadow maps (Yang et al. 2010): percentage-closer soft shadows of which both steps, the mean blocker depth
// and the share of light, come from a summed-area table of z and z^2.
//
// What the bounds of the search kernel prove lit or dark is so, whatever the moments say. EARLY_OUT 0: the rest is computed all
// the same. BLOCKERS_ADAPTIVE and VISIBILITY_ADAPTIVE: which subdivision. CONTACT 1: narrow penumbrae from jittered bilinear
// texels.
// NVIDIA's compiler would write the loops over a light's views out, which takes it minutes. Frames of one view take as long.
#pragma optionNV(unroll none)
#include "glsl/numeric/sampling.glsl"
#include "glsl/shadow/kernel_blockers.glsl"
#include "glsl/shadow/sub_kernels.glsl"
#include "glsl/shadow/visibility_main.glsl"

uniform int search_rounds;
uniform int blocker_cells;
uniform int passes;
uniform float pass_gap;  // of a kernel's: blockers nearer than this are looked for in a kernel of their own
uniform int visibility_cells;
uniform int tree_height;
uniform float contact_texels;

// Adds what blocks in one view.
void add_blockers(inout BlockerSums sums, KernelFamily f, float gap, vec2 depths, int use, bool wanted) {
  bool blockers = use == kernel_search;
  ShadowKernel kernel;
  bool seen = family_kernel(f, gap, blockers, kernel) && wanted;
  KernelTally tally = KernelTally(gap, kernel.low, kernel.high, 0.0, 0.0, vec4(0.0));
  if (blockers) {
    tally.low = floor(kernel.low);
    tally.high = ceil(kernel.high);
  }
  f.nearest = threshold_quanta(f.thresholds, depths.x);
  f.thresholds.deepest = f.thresholds.inverse ? 1.0 / depths.y : -depths.y;
  KernelAxes axes = kernel_axes(kernel, f.size, blockers);
  bool adaptive = blockers ? BLOCKERS_ADAPTIVE == 1 : VISIBILITY_ADAPTIVE == 1;
#if VISIBILITY_ADAPTIVE
  int parts = adaptive ? 1 : blocker_cells;
#else
  int parts = blockers ? blocker_cells : visibility_cells;
#endif
  bool open = tally_uniform(tally, f, axes, parts, blockers ? 0 : 1, adaptive, seen);
#if VISIBILITY_ADAPTIVE
  tally_adaptive(tally, f, axes, tree_height, open);
#endif
  tally_pooled(tally);
  if (seen) add_kernel(sums, kernel, KernelBlockers(tally.blocked, tally.reach));
}

// The light's views in turn.
Blockers blockers_at(inout ShadowCursor cursor, VisibilityQuery q, inout KernelFamily f, float gap, vec2 depths, int use,
                     bool wanted) {
  BlockerSums sums = no_blockers();
#if SIMILAR_KERNELS
  add_blockers(sums, f, gap, depths, use, wanted);
#else
  uint faces = wanted ? shadow_face_count(q.maps.faces) : 0u;
  uint face = 0u;
  do {
    if (face != cursor.face) {
      cursor = shadow_cursor_at(q, face);
      f = kernel_family(cursor, q);
    }
    add_blockers(sums, f, gap, depths, use, wanted);
  } while (++face < faces);
#endif
  return mean_blockers(sums, gap);
}

struct Search {
  bool lit;       // proven by bounds
  bool umbra;     // likewise
  bool open;      // there is more to compute
  float gap;      // of the search kernel, metres
  vec2 depths;    // least and greatest stored in it, metres
};

// The search kernel starts at the near plane; `search_rounds` times it moves to the nearest depth that was found in it. Bounds may
// decide in every kernel but the last one that it moves to.
Search search_kernel(inout ShadowCursor cursor, VisibilityQuery q, inout KernelFamily f) {
  Search search;
  search.gap = shadow_near_gap(cursor, q);
  int round = 0;
#if !EARLY_OUT
  bool lit = false;
  bool umbra = false;
#endif
  do {
    search.lit = true;
    search.umbra = true;
    search.depths = vec2(3.0e38, 0.0);
    float widest = 0.0;
    ShadowKernel kernel;
#if SIMILAR_KERNELS
    family_kernel(f, search.gap, true, kernel);
    KernelBounds bounds = family_bounds(f, cursor, kernel);
    search.lit = bounds.lit;
    search.umbra = bounds.umbra;
    search.depths = bounds.depths;
    widest = bounds.gap;
#else
    uint face = 0u;
    do {
      if (face != cursor.face) {
        cursor = shadow_cursor_at(q, face);
        f = kernel_family(cursor, q);
      }
      bool seen = family_kernel(f, search.gap, true, kernel);
      KernelBounds bounds = family_bounds(f, cursor, kernel);
      search.lit = search.lit && (bounds.lit || !seen);
      search.umbra = search.umbra && (bounds.umbra || !seen);
      search.depths.x = min(search.depths.x, seen ? bounds.depths.x : search.depths.x);
      search.depths.y = max(search.depths.y, seen ? bounds.depths.y : 0.0);
      widest = max(widest, seen ? bounds.gap : 0.0);
    } while (++face < shadow_face_count(q.maps.faces));
#endif
    search.open = !(search.lit || search.umbra);
#if !EARLY_OUT
    lit = lit || (search.lit && !umbra);
    umbra = umbra || (search.umbra && !lit);
    search.open = true;
#endif
    search.gap = search.open && search_rounds > 0 ? clamp(widest, 0.0, search.gap) : search.gap;
  } while (search.open && ++round < search_rounds);
#if !EARLY_OUT
  search.lit = lit;
  search.umbra = umbra;
#endif
  return search;
}

// Where SATs are imprecise and a few texels are all there is: 3 x 3 of them, bilinear and jittered.
float contact_visibility(ShadowCursor cursor, VisibilityQuery q, float gap, vec2 jitter, bool wanted) {
  float lit = 0.0;
  float total = 0.0;
  int i = wanted ? 0 : 8;
  do {
    vec3 slope;
    if (light_view_sample(q.light, (vec2(i % 3, i / 3) + jitter) / 3.0, slope)) {
      lit += shadow_tap_2x2(cursor, q, q.position + gap * slope);
      total += 1.0;
    }
  } while (++i < 9);
  return total > 0.0 ? lit / total : 1.0;
}

// Whether the kernel at `gap` is too narrow for the table.
bool contact(KernelFamily f, float gap) {
  ShadowKernel kernel;
  bool seen = family_kernel(f, gap, false, kernel);
  return seen && max(kernel.high.x - kernel.low.x, kernel.high.y - kernel.low.y) < contact_texels;
}

float light_visibility(ShadowCursor cursor, VisibilityQuery q, ivec2 pixel) {
  KernelFamily f = kernel_family(cursor, q);
#if CONTACT && !SIMILAR_KERNELS
  KernelFamily home_kernels = f;
#endif
  // Step 1: the search kernel, and what its bounds decide.
  Search search = search_kernel(cursor, q, f);
  bool open = search.open;
  bool narrow = false;
  float v = search.umbra && !search.lit ? 0.0 : 1.0;
  float gap = search.gap;
  // Steps 2 to 4: first the distance of the blockers, then their share of the penumbra kernel, which is taken again where
  // the blockers in it turn out to be much nearer than those that gave its size.
  int pass = 0;
  do {
    bool searching = pass == 0;
    Blockers found = blockers_at(cursor, q, f, gap, search.depths, searching ? kernel_search : kernel_filter, open);
    // The kernel is a box around what of the light counts; what blocks hides none of the rest.
    if (open && !searching) v = clamp(1.0 - found.share / light_view_box_share(q.light), 0.0, 1.0);
    bool none = found.texels < (searching ? 0.5 : 1e-3);
    open = open && !none && (searching || found.gap < pass_gap * gap);
    gap = open ? found.gap : gap;
#if CONTACT
#if SIMILAR_KERNELS
    narrow = narrow || (open && contact(f, gap));
#else
    narrow = narrow || (open && contact(home_kernels, gap));
#endif
    open = open && !narrow;
#endif
  } while (open && ++pass <= passes);
#if CONTACT
  vec2 jitter = pixel_noise(uint(pixel.x), uint(pixel.y), 0u).xy;
  float soft = contact_visibility(cursor, q, gap, jitter, narrow);
  v = narrow ? soft : v;
#endif
#if !EARLY_OUT
  v = search.lit ? 1.0 : search.umbra ? 0.0 : v;
#endif
  return v;
}
