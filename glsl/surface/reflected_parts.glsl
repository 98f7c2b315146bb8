// Reflected light, or a response to light, in the parts that are shadowed and filtered apart.
#ifndef LIMN_REFLECTED_PARTS_GLSL
#define LIMN_REFLECTED_PARTS_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

struct ReflectedParts {
  vec3 diffuse;
  vec3 lobe;  // what is not diffuse
};

LIMN_FN vec3 reflected_whole(ReflectedParts p) { return p.diffuse + p.lobe; }

LIMN_FN void add_parts(LIMN_INOUT(ReflectedParts) sum, ReflectedParts light) {
  sum.diffuse += light.diffuse;
  sum.lobe += light.lobe;
}

LIMN_FN ReflectedParts scaled_parts(ReflectedParts p, vec3 factor) {
  p.diffuse *= factor;
  p.lobe *= factor;
  return p;
}

LIMN_FN ReflectedParts mixed_parts(ReflectedParts a, ReflectedParts b, float share) {
  a.diffuse = mix(a.diffuse, b.diffuse, share);
  a.lobe = mix(a.lobe, b.lobe, share);
  return a;
}

// The share that is hidden, [0, 1], where `seen` is left of `all`; where there is nothing to be hidden, `otherwise`.
LIMN_FN float hidden_share(float seen, float all, float otherwise) {
  return all > 1e-37f ? 1.0f - min(seen / all, 1.0f) : otherwise;
}
LIMN_FN vec3 hidden_share(vec3 seen, vec3 all, vec3 otherwise) {
  return vec3(hidden_share(seen.x, all.x, otherwise.x), hidden_share(seen.y, all.y, otherwise.y),
              hidden_share(seen.z, all.z, otherwise.z));
}

// The same of each part: a lobe in which nothing arrives is hidden as the diffuse part is, and where nothing arrives at all,
// nothing is hidden.
LIMN_FN ReflectedParts hidden_parts(ReflectedParts seen, ReflectedParts all) {
  ReflectedParts hidden;
  hidden.diffuse = hidden_share(seen.diffuse, all.diffuse, vec3(0.0f));
  hidden.lobe = hidden_share(seen.lobe, all.lobe, hidden.diffuse);
  return hidden;
}

// What is left where that share is hidden; means of shares may exceed 1 by rounding.
LIMN_FN vec3 share_left(vec3 hidden) { return max(vec3(1.0f) - hidden, vec3(0.0f)); }

// What is left of light of which these shares are hidden.
LIMN_FN vec3 reflected_left(ReflectedParts light, ReflectedParts hidden) {
  return light.diffuse * share_left(hidden.diffuse) + light.lobe * share_left(hidden.lobe);
}

LIMN_END
#endif  // LIMN_REFLECTED_PARTS_GLSL
