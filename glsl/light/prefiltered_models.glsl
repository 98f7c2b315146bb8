// Materials with a model (glsl/materials/) under prefiltered environments: where their lobes look into maps that are filtered
// with power lobes, and what they reflect of the light there. MATERIAL_MODELS: as for glsl/materials/model.glsl.
//
// A power lobe cos^p, p = 1 / (2 alpha^2) - 1/2, is Phong's own, and nearly that of Gaussian slopes alpha at normal incidence:
// GGX lobes of equal width have tails that neither has.
#ifndef LIMN_PREFILTERED_MODELS_GLSL
#define LIMN_PREFILTERED_MODELS_GLSL
#include "glsl/light/prefiltered.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/materials/power_lobe.glsl"
LIMN_BEGIN

// --- Maps filtered with power lobes ---

// As many as maps for GGX have. Widths double from level to level up to 1; below the first one the narrower neighbour is radiance
// itself.
LIMN_CONST int power_levels = environment_levels - 1;

LIMN_FN float power_level_alpha(int level) { return exp2(float(level + 1 - power_levels)); }

// Where a width lies: between `wider` and the level before it, or the radiance where that is level 0.
struct PowerPlace {
  int wider;
  float weight;  // of the wider
};

// Weights mix variances below the first level, whose neighbour has none, and widths above.
LIMN_FN PowerPlace power_place(float alpha) {
  PowerPlace place;
  float narrowest = power_level_alpha(0);
  float ratio = clamp(alpha, 0.0f, 1.0f) / narrowest;
  place.wider = 0;
  place.weight = ratio * ratio;
  if (ratio < 1.0f) return place;
  place.wider = min(int(log2(ratio)) + 1, power_levels - 1);
  place.weight = clamp(alpha / power_level_alpha(place.wider - 1) - 1.0f, 0.0f, 1.0f);
  return place;
}

LIMN_FN float power_lobe_exponent(float alpha) { return max(0.5f / (alpha * alpha) - 0.5f, 0.0f); }

// As prefilter_sample(), of a power lobe: all samples weigh the same.
LIMN_FN PrefilterSample power_prefilter_sample(float alpha, int i, int count) {
  float p = power_lobe_exponent(alpha);
  PrefilterSample s;
  s.direction = sample_power_lobe(p, vec2((float(i) + 0.5f) / float(count), fract(0.61803399f * float(i))));
  s.weight = 1.0f;
  s.spread = 2.0f * pi / ((p + 1.0f) * float(count) * max(pow(s.direction.z, p), 1e-12f));
  return s;
}

// --- Lobes ---

// One lookup, and what the surface reflects of it.
struct PrefilteredLobe {
  vec3 towards;  // unit
  float alpha;   // width of the map
  vec3 reflectance;
};

// As environment_lobe_share(), of a power lobe.
LIMN_FN float prefiltered_lobe_share(PrefilteredLobe lobe, vec3 n, vec3 ng) {
  float p = power_lobe_exponent(lobe.alpha);
  float above = phong_above_horizon(dot(n, lobe.towards), p).share;
  return min(phong_above_horizon(dot(ng, lobe.towards), p).share / max(above, 1e-30f), 1.0f);
}

#if (MATERIAL_MODELS & 16) != 0
// The whole lobe times its share above the horizon, or with prefiltered_lookup_centroid the part above: its middle, its width.
LIMN_FN PrefilteredLobe phong_prefiltered_lobe(MaterialModel m, int lookup, vec3 n, vec3 v) {
  float n_dot_v = dot(n, v);
  PhongPart part = phong_above_horizon(n_dot_v, m.exponent);
  PrefilteredLobe lobe;
  lobe.towards = mirror_direction(n, v);
  lobe.alpha = power_lobe_alpha(m.exponent);
  lobe.reflectance = lookup == prefiltered_lookup_uncut ? m.ks : m.ks * part.share;
  vec3 across = n - n_dot_v * lobe.towards;
  float size = length(across);
  if (lookup != prefiltered_lookup_centroid || size < 1e-6f) return lobe;
  float lift = min(part.lift, atan(size, n_dot_v));
  lobe.towards = normalize(cos(lift) * lobe.towards + (sin(lift) / size) * across);
  lobe.alpha = part.alpha;
  return lobe;
}
#endif

#if (MATERIAL_MODELS & 6) != 0
// The lobe of a surface of microfacets with Gaussian slopes that reflect everything, as a power lobe. Entries of a table over
// sqrt(n.v) and the width's place, whose texels' centres lie on the ends; each is smooth along both.
struct MicrofacetLobe {
  float reflectance;  // of uniform light
  float cosine;       // v.h at which Schlick's weight is the lobe's mean of it
  float tilt;         // angle of the lobe's middle from n over that of v
  float widening;     // width about the middle over alpha
};

LIMN_CONST int microfacet_lobe_table_size = 32;

// Place in the table, in [0, 1]^2. The width's row: as environment_level() has it.
LIMN_FN vec2 microfacet_lobe_place(float n_dot_v, float alpha) {
  return vec2(sqrt(clamp(n_dot_v, 0.0f, 1.0f)), environment_level(alpha) / float(environment_levels - 1));
}

LIMN_FN MicrofacetLobe microfacet_lobe(float n_dot_v, float alpha, int count) {
  float z = clamp(n_dot_v, 1e-3f, 0.9999f);
  vec3 v = vec3(sqrt(1.0f - z * z), 0.0f, z);
  vec3 mirror = vec3(-v.x, 0.0f, v.z);
  float sum = 0.0f;
  float schlick = 0.0f;
  float apart2 = 0.0f;
  vec3 apart = vec3(0.0f);
  for (int i = 0; i < count; ++i) {
    vec2 u = vec2(fract(0.61803399f * float(i)), (float(i) + 0.5f) / float(count));
    vec3 h = sample_visible_normal(v, vec2(alpha), u);
    float v_dot_h = dot(v, h);
    vec3 l = 2.0f * v_dot_h * h - v;
    if (!(l.z > 0.0f)) continue;
    float weight = gaussian_slope_distribution(h, vec2(alpha)) * masking_over_view(v, l, vec2(alpha), false) /
                   visible_normal_pdf(v, h, vec2(alpha));
    vec3 difference = l - mirror;
    sum += weight;
    schlick += weight * schlick_weight(v_dot_h);
    apart += weight * difference;
    apart2 += weight * dot(difference, difference);
  }
  vec3 middle = mirror + apart / sum;
  float variance = max(apart2 - dot(apart, apart) / sum, 0.0f) / sum;  // 1 - |middle|^2
  float size = length(middle);
  MicrofacetLobe lobe;
  lobe.reflectance = sum / float(count);
  lobe.cosine = 1.0f - pow(schlick / sum, 0.2f);
  lobe.tilt = atan(-middle.x, middle.z) / atan(v.x, v.z);
  // The mean cosine about the middle is (p + 1) / (p + 2).
  lobe.widening = sqrt(variance / ((1.0f + size) * max(3.0f * size - 1.0f, 0.1f))) / alpha;
  return lobe;
}

// Width of the lobe; of brushed metal, whose lobe is not round, the geometric mean.
LIMN_FN float microfacet_lobe_alpha(MaterialModel m) {
  vec2 alpha = model_alpha(m);
  return m.kind == model_ward ? sqrt(alpha.x * alpha.y) : alpha.x;
}

// entry: of n.v and microfacet_lobe_alpha(). Looked up along the mirror direction or at the lobe's middle.
LIMN_FN PrefilteredLobe microfacet_prefiltered_lobe(MaterialModel m, MicrofacetLobe entry, int lookup, vec3 n, vec3 v) {
  PrefilteredLobe lobe;
  lobe.towards = mirror_direction(n, v);
  lobe.alpha = microfacet_lobe_alpha(m);
  lobe.reflectance = m.ks * fresnel(entry.cosine, m.eta, m.k) * entry.reflectance;
  float sine = length(cross(n, v));
  if (lookup != prefiltered_lookup_centroid || sine < 1e-6f) return lobe;
  float n_dot_v = dot(n, v);
  float tilt = entry.tilt * atan(sine, max(n_dot_v, 0.0f));
  vec3 along = (n_dot_v * n - v) / sine;
  lobe.towards = normalize(cos(tilt) * n + sin(tilt) * along);
  lobe.alpha = lobe.alpha * entry.widening;
  return lobe;
}
#endif

LIMN_END
#endif  // LIMN_PREFILTERED_MODELS_GLSL
