// Reflectance of smooth interfaces, exact, unpolarised. Light comes from air; eta, k: indices of refraction and absorption
// behind the interface, eta - i k. With FRESNEL_SCHLICK defined, fresnel() and its means are Schlick's approximation instead.
#ifndef LIMN_FRESNEL_GLSL
#define LIMN_FRESNEL_GLSL
#include "glsl/numeric/exp_log.glsl"
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// Schlick's approximation (1994) from the exact value at normal incidence. Off by 0.036 for an index of 1.5, 0.26 for 5 and 0.12
// for aluminium, at the most; an index of 1 reflects as well.
LIMN_FN float schlick_fresnel(float cosine, float eta, float k) {
  float k2 = k * k;
  float facing = ((eta - 1.0f) * (eta - 1.0f) + k2) / ((eta + 1.0f) * (eta + 1.0f) + k2);
  float rest = 1.0f - clamp(cosine, 0.0f, 1.0f);
  float rest2 = rest * rest;
  return facing + (1.0f - facing) * (rest2 * rest2 * rest);
}

// Its mean over light from all sides, int F cos / pi.
LIMN_FN float schlick_mean_reflectance(float eta, float k) {
  float facing = schlick_fresnel(1.0f, eta, k);
  return facing + (1.0f - facing) / 21.0f;
}

#ifdef FRESNEL_SCHLICK
LIMN_FN float fresnel(float cosine, float eta, float k) { return schlick_fresnel(cosine, eta, k); }
LIMN_FN float dielectric_mean_reflectance(float eta) { return schlick_mean_reflectance(max(eta, 1.0f), 0.0f); }
LIMN_FN float mean_reflectance(float eta, float k) { return schlick_mean_reflectance(eta, k); }
#else

// cosine: of the angle of incidence; below 0 it counts as 0. With (a - i b)^2 = (eta - i k)^2 - sin^2:
//   Rs = |cos - (a - i b)|^2 / |cos + (a - i b)|^2,   Rp / Rs = |a - i b - sin tan|^2 / |a - i b + sin tan|^2.
// a - cos is taken from the difference of the squares, so that eta = 1, k = 0 reflects nothing and eta = 1.0001 keeps its
// digits. Of a and b, the smaller follows from a b = eta k.
LIMN_FN float fresnel(float cosine, float eta, float k) {
  float c = clamp(cosine, 0.0f, 1.0f);
  float sine2 = 1.0f - c * c;
  float above = (eta - 1.0f) * (eta + 1.0f) - k * k;  // a^2 - b^2 - cos^2
  float real = above + c * c;
  float imaginary = 2.0f * eta * k;
  float larger2 = 0.5f * (sqrt(real * real + imaginary * imaginary) + abs(real));
  float smaller2 = 0.25f * imaginary * imaginary / max(larger2, 1e-30f);
  float a = sqrt(real >= 0.0f ? larger2 : smaller2);
  float b2 = real >= 0.0f ? smaller2 : larger2;
  float difference = (above + b2) / max(a + c, 1e-15f);  // a - cos
  float s = (difference * difference + b2) / max((a + c) * (a + c) + b2, 1e-30f);
  float near = a * c - sine2;
  float far = a * c + sine2;
  float p_over_s = (near * near + b2 * c * c) / max(far * far + b2 * c * c, 1e-30f);
  return min(0.5f * s * (1.0f + p_over_s), 1.0f);
}

// Mean reflectance of light from all sides, int F cos / pi, of a dielectric with eta >= 1 (Walsh; Duntley 1942, The Optical
// Properties of Diffusing Materials). Its terms cancel near 1, where a series in eta - 1 is taken. Within 1e-5.
LIMN_FN float dielectric_mean_reflectance(float eta) {
  float n = max(eta, 1.0f);
  float rest = n - 1.0f;
  if (rest < 0.04f) return rest * (0.33333333f + rest * (0.5f * log(max(rest, 1e-10f)) + 0.445f - 1.3f * rest));
  float n2 = n * n;
  float n4 = n2 * n2;
  float sum = n2 + 1.0f;
  float difference = rest * (n + 1.0f);
  float slope = difference / sum;
  return 0.5f + rest * (3.0f * n + 1.0f) / (6.0f * (n + 1.0f) * (n + 1.0f)) +
         n2 * slope * slope / sum * log(rest / (n + 1.0f)) -
         2.0f * n * n2 * (n2 + 2.0f * n - 1.0f) / (sum * sum * difference) +
         8.0f * n4 * (n4 + 1.0f) / (sum * sum * sum * difference * difference) * log_one_plus(rest);
}

// The same of any interface. That of a dielectric with eta < 1 follows from its other side: what is passed, times n^2, is the same
// both ways. Where there is absorption it is the rule of Gauss and Legendre with three nodes over cos^2, within 0.012, but up to
// 0.18 where eta is below 1 and k below 0.1: total reflection is almost cut off there.
LIMN_FN float mean_reflectance(float eta, float k) {
  if (k == 0.0f && eta < 1.0f) return 1.0f - eta * eta * (1.0f - dielectric_mean_reflectance(1.0f / eta));
  if (k == 0.0f) return dielectric_mean_reflectance(eta);
  return (5.0f * fresnel(0.33571069f, eta, k) + 8.0f * fresnel(0.70710678f, eta, k) +
          5.0f * fresnel(0.94196515f, eta, k)) / 18.0f;
}
#endif

LIMN_FN vec3 fresnel(float cosine, vec3 eta, vec3 k) {
  return vec3(fresnel(cosine, eta.x, k.x), fresnel(cosine, eta.y, k.y), fresnel(cosine, eta.z, k.z));
}
LIMN_FN vec3 dielectric_mean_reflectance(vec3 eta) {
  return vec3(dielectric_mean_reflectance(eta.x), dielectric_mean_reflectance(eta.y), dielectric_mean_reflectance(eta.z));
}
LIMN_FN vec3 mean_reflectance(vec3 eta, vec3 k) {
  return vec3(mean_reflectance(eta.x, k.x), mean_reflectance(eta.y, k.y), mean_reflectance(eta.z, k.z));
}

LIMN_END
#endif  // LIMN_FRESNEL_GLSL
