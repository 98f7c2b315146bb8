// Materials with a model under prefiltered environments (glsl/light/prefiltered_models.glsl) against
// integration of their responses. Maps are filtered exactly, so that what is measured is one lookup for a
// lobe.
#include "glsl/light/prefiltered_models.glsl"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "glsl/light/coated_environment.glsl"
#include "tests/unit/glsl/prefiltered_skies.h"
#include "tests/unit/materials/models.h"

namespace limn::glsl {
namespace {

/// The radiance filtered by a power lobe; the radiance itself for the width 0. Each is summed once: materials
/// that differ in their reflectance alone have the same lobes.
double filteredPower(const Sky& sky, const vec3& axis, float alpha) {
  if (alpha == 0) return sky.radiance(axis);
  static std::map<std::tuple<std::string, float, float, float, float>, double> known;
  const auto [entry, added] = known.try_emplace({sky.name, axis.x, axis.y, axis.z, alpha});
  if (!added) return entry->second;
  const Frame frame = frame_around(axis);
  const float p = power_lobe_exponent(alpha);
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i)
    sum += sky.radiance(from_local(frame, sample_power_lobe(p, gridPoint(i))));
  return entry->second = sum / (kSide * kSide);
}

/// The same by the maps' levels.
double mappedPower(const Sky& sky, const vec3& axis, float alpha) {
  const PowerPlace place = power_place(alpha);
  const double weight = static_cast<double>(place.weight);
  return (1 - weight) * filteredPower(sky, axis, place.wider == 0 ? 0 : power_level_alpha(place.wider - 1)) +
         weight * filteredPower(sky, axis, power_level_alpha(place.wider));
}

/// What the lobe of a model reflects of each sky, in the first channel.
using OfSkies = std::array<double, kSkies.size()>;
OfSkies exactLobes(const MaterialModel& m, const vec3& n, const vec3& v) {
  const Frame frame = frame_around(n);
  const vec3 local = to_local(frame, v);
  OfSkies sums{};
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec3 l = model_sample(m, local, vec3(gridPoint(i), 0));
    const float pdf = model_pdf(m, local, l);
    if (!(pdf > 0)) continue;
    const auto weight = static_cast<double>(model_response(m, local, l).x / pdf);
    for (size_t s = 0; s < kSkies.size(); ++s) sums[s] += weight * kSkies[s].radiance(from_local(frame, l));
  }
  for (double& sum : sums) sum /= kSide * kSide;
  return sums;
}

/// What it reflects of one. Each lobe is sampled once for all skies.
double exactLobe(const Sky& sky, MaterialModel m, const vec3& n, const vec3& v) {
  m.kd = vec3(0);
  static std::map<std::array<float, 20>, OfSkies> known;
  const auto [entry, added] = known.try_emplace({static_cast<float>(m.kind),
                                                 static_cast<float>(m.options),
                                                 m.exponent,
                                                 m.roughness.x,
                                                 m.roughness.y,
                                                 m.eta.x,
                                                 m.eta.y,
                                                 m.eta.z,
                                                 m.k.x,
                                                 m.k.y,
                                                 m.k.z,
                                                 m.ks.x,
                                                 m.ks.y,
                                                 m.ks.z,
                                                 n.x,
                                                 n.y,
                                                 n.z,
                                                 v.x,
                                                 v.y,
                                                 v.z});
  if (added) entry->second = exactLobes(m, n, v);
  return entry->second.at(static_cast<size_t>(&sky - kSkies.data()));
}

/// Each lobe of microfacets is summed once, too: lookups differ in what they take of it.
PrefilteredLobe lobeOf(const MaterialModel& m, int lookup, const vec3& n, const vec3& v) {
  if (m.kind == model_phong) return phong_prefiltered_lobe(m, lookup, n, v);
  constexpr int count = 1024;
  static std::map<std::pair<float, float>, MicrofacetLobe> known;
  const float cosine = dot(n, v), alpha = microfacet_lobe_alpha(m);
  const auto [entry, added] = known.try_emplace({cosine, alpha});
  if (added) entry->second = microfacet_lobe(cosine, alpha, count);
  return microfacet_prefiltered_lobe(m, entry->second, lookup, n, v);
}

/// Errors of one lookup.
struct LobeErrors {
  RelativeError uncut, mirror, centroid;
  RelativeError mapped;  ///< the centroid's with widths between levels
};

LobeErrors lobeErrors(const Sky& sky, const MaterialModel& m, Views views) {
  LobeErrors errors;
  for (int i = 0; i < kViews; ++i) {
    const auto [n, v] = views.next();
    const double exact = exactLobe(sky, m, n, v);
    const PrefilteredLobe uncut = lobeOf(m, prefiltered_lookup_uncut, n, v),
                          mirror = lobeOf(m, prefiltered_lookup_mirror, n, v),
                          centroid = lobeOf(m, prefiltered_lookup_centroid, n, v);
    const auto reflected = [](const PrefilteredLobe& lobe, double light) {
      return static_cast<double>(lobe.reflectance.x) * light;
    };
    const double mirrored = filteredPower(sky, mirror.towards, mirror.alpha);
    errors.uncut.add(reflected(uncut, mirrored), exact);
    errors.mirror.add(reflected(mirror, mirrored), exact);
    errors.centroid.add(reflected(centroid, filteredPower(sky, centroid.towards, centroid.alpha)), exact);
    errors.mapped.add(reflected(centroid, mappedPower(sky, centroid.towards, centroid.alpha)), exact);
  }
  return errors;
}

std::string text(const LobeErrors& errors) {
  return std::to_string(errors.uncut.value()) + " " + std::to_string(errors.mirror.value()) + " " +
         std::to_string(errors.centroid.value()) + " " + std::to_string(errors.mapped.value());
}

TEST(PrefilteredModels, PhongLobesLookAtTheirPartAboveTheHorizon) {
  for (const Sky& sky : kSkies)
    for (const float p : {10.f, 100.f, 1000.f})
      for (const auto& [low, high] : {std::pair(0., 60.), std::pair(60., 80.), std::pair(80., 90.)}) {
        const LobeErrors errors = lobeErrors(sky, phongModel(0, 1, p), Views{low, high});
        const std::string name =
            sky.name + " p " + std::to_string(int(p)) + " view " + std::to_string(int(low));
        RecordProperty(name, text(errors));
        if (low == 80) {
          EXPECT_LT(errors.centroid.value(), 0.5 * errors.mirror.value()) << name;
          EXPECT_LT(errors.mirror.value(), 0.5 * errors.uncut.value()) << name;
        }
        if (p >= 100 && &sky == &kSkies[0]) {
          EXPECT_LT(errors.centroid.value(), 0.01) << name;
          EXPECT_LT(errors.mapped.value(), 0.03) << name;
        }
      }
}

TEST(PrefilteredModels, MicrofacetsLookAtTheMiddleOfTheirLobe) {
  MaterialModel copper = microfacets(model_torrance_sparrow, vec2(0.1f));
  copper.eta = vec3(1.17f);
  copper.k = vec3(2.39f);
  MaterialModel glass = copper;
  glass.eta = vec3(1.5f);
  glass.k = vec3(0);
  const struct {
    const char* name;
    MaterialModel model;
    double bound;  ///< of views below 60 degrees under wide lamps
  } materials[] = {{"white", microfacets(model_torrance_sparrow, vec2(0.1f)), 0.04},
                   {"copper", copper, 0.04},
                   {"glass", glass, 0.18}};
  for (const Sky& sky : kSkies)
    for (const auto& material : materials)
      for (const float alpha : {0.03f, 0.1f, 0.3f, 0.6f, 1.f})
        for (const auto& [low, high] : {std::pair(0., 60.), std::pair(60., 80.), std::pair(80., 90.)}) {
          MaterialModel m = material.model;
          m.roughness = vec2(alpha);
          const LobeErrors errors = lobeErrors(sky, m, Views{low, high});
          const std::string name = sky.name + " " + material.name + " alpha " + std::to_string(alpha) +
                                   " view " + std::to_string(int(low));
          RecordProperty(name, text(errors));
          if (low == 80) {
            EXPECT_LT(errors.centroid.value(), errors.mirror.value()) << name;
          }
          if (low == 0 && &sky == &kSkies[0]) {
            EXPECT_LT(errors.centroid.value(), material.bound) << name;
          }
        }
}

/// With Schlick's reflectance in place of the exact one, which is what FRESNEL_SCHLICK compiles: on narrow
/// lobes its own error shows.
TEST(PrefilteredModels, SchlicksReflectanceErrsOnNarrowLobes) {
  const struct {
    const char* name;
    float eta, k;
    std::pair<double, double> view;  ///< degrees
    double least;                    ///< error by Schlick's over that by Fresnel's
  } materials[] = {{"glass", 1.5f, 0, {0, 60}, 3},
                   {"index 5", 5, 0, {80, 90}, 8},
                   {"aluminium", 1.37f, 7.62f, {80, 90}, 4},
                   {"copper", 1.17f, 2.39f, {80, 90}, 1.5}};
  const Sky& sky = kSkies[0];
  for (const auto& [name, eta, k, view, least] : materials) {
    MaterialModel m = microfacets(model_torrance_sparrow, vec2(0.1f));
    m.eta = vec3(eta);
    m.k = vec3(k);
    RelativeError exact, schlick;
    Views views{view.first, view.second};
    for (int i = 0; i < kViews; ++i) {
      const auto [n, v] = views.next();
      const MicrofacetLobe entry = microfacet_lobe(dot(n, v), 0.1f, 1024);
      const PrefilteredLobe lobe = microfacet_prefiltered_lobe(m, entry, prefiltered_lookup_centroid, n, v);
      const double expected = exactLobe(sky, m, n, v);
      const double light =
          static_cast<double>(entry.reflectance) * filteredPower(sky, lobe.towards, lobe.alpha);
      exact.add(static_cast<double>(fresnel(entry.cosine, eta, k)) * light, expected);
      schlick.add(static_cast<double>(schlick_fresnel(entry.cosine, eta, k)) * light, expected);
    }
    RecordProperty(name, std::to_string(exact.value()) + " " + std::to_string(schlick.value()));
    EXPECT_GT(schlick.value(), least * exact.value()) << name;
  }
}

TEST(PrefilteredModels, BrushedMetalIsTakenForRound) {
  for (const Sky& sky : kSkies)
    for (const vec2 roughness : {vec2(0.06f, 0.35f), vec2(0.15f, 0.5f)}) {
      const LobeErrors errors = lobeErrors(sky, microfacets(model_ward, roughness), Views{0, 60});
      RecordProperty(sky.name + " " + std::to_string(roughness.x), text(errors));
      EXPECT_LT(errors.centroid.value(), 0.5) << sky.name << roughness.x;
    }
}

TEST(PrefilteredModels, LobesReflectOfUniformLightWhatTheirResponsesDo) {
  for (const float alpha : {0.03f, 0.1f, 0.3f, 0.6f, 1.f})
    for (const float cosine : {1.f, 0.8f, 0.5f, 0.2f, 0.05f}) {
      const vec3 n(0, 0, 1), v = directionAt(static_cast<double>(cosine), 1);
      const MaterialModel m = microfacets(model_torrance_sparrow, vec2(alpha));
      EXPECT_NEAR(static_cast<double>(lobeOf(m, prefiltered_lookup_centroid, n, v).reflectance.x),
                  furnace(m, v), 0.01)
          << alpha << ' ' << cosine;
    }
}

/// Shares of lobes above the plane of a triangle, against sums over the lobe. They are off by 3e-4 and 1e-4
/// for Phong's lobe, 0.031 and 0.005 for microfacets, root mean squares.
TEST(PrefilteredModels, LobesEndAtThePlaneOfTheTriangle) {
  MaterialModel rough = microfacets(model_torrance_sparrow, vec2(0.3f)), smooth = rough;
  smooth.roughness = vec2(0.01f);
  const struct {
    const char* name;
    MaterialModel model;
    double bound;
  } lobes[] = {{"phong p 100", phongModel(0, 1, 100), 0.005},
               {"phong p 1000", phongModel(0, 1, 1000), 0.001},
               {"alpha 0.3", rough, 0.04},
               {"alpha 0.01", smooth, 0.01}};
  for (const auto& [name, model, bound] : lobes) {
    double squares = 0;
    int count = 0;
    Views views{0, 87}, tilts{0, 70};
    for (int i = 0; i < kViews; ++i) {
      const auto [n, v] = views.next();
      const auto [axis, tilted] = tilts.next();
      const Frame frame = frame_around(n);
      const vec3 plane = from_local(frame, to_local(frame_around(axis), tilted)), local = to_local(frame, v);
      if (!(dot(plane, v) > 0)) continue;
      double above = 0, all = 0;
      for (int k = 0; k < kSide * kSide; ++k) {
        const vec3 l = model_sample(model, local, vec3(gridPoint(k), 0));
        const float pdf = model_pdf(model, local, l);
        if (!(pdf > 0)) continue;
        const auto light = static_cast<double>(model_response(model, local, l).x / pdf);
        all += light;
        if (dot(from_local(frame, l), plane) > 0) above += light;
      }
      const PrefilteredLobe lobe = lobeOf(model, prefiltered_lookup_centroid, n, v);
      squares += std::pow(static_cast<double>(prefiltered_lobe_share(lobe, n, plane)) - above / all, 2);
      ++count;
    }
    const double error = std::sqrt(squares / count);
    RecordProperty(name, std::to_string(error));
    EXPECT_LT(error, bound) << name;
  }
}

TEST(PrefilteredModels, LevelsOfPowerLobesMeetTheirWidths) {
  for (int level = 0; level < power_levels; ++level) {
    const PowerPlace place = power_place(power_level_alpha(level));
    EXPECT_FLOAT_EQ(static_cast<float>(place.wider) + place.weight, static_cast<float>(level + 1));
  }
  EXPECT_EQ(power_place(0).wider, 0);
  EXPECT_EQ(power_place(0).weight, 0);
  EXPECT_FLOAT_EQ(power_lobe_exponent(power_lobe_alpha(100)), 100);
}

/// int w(n.l) L cos over the hemisphere.
template <class Weight>
double irradiance(const Sky& sky, const vec3& n, const Weight& weight) {
  const Frame frame = frame_around(n);
  double sum = 0;
  for (int i = 0; i < kSide * kSide; ++i) {
    const vec3 l = sample_cosine(gridPoint(i));
    sum += static_cast<double>(weight(l.z)) * sky.radiance(from_local(frame, l));
  }
  return M_PI * sum / (kSide * kSide);
}

/// What a coat and its base reflect, in the first channel.
double coatedLight(const MaterialModel& m, const Sky& sky, const vec3& n, const vec3& v) {
  const double whole = irradiance(sky, n, [](float) { return 1; }),
               grazing = irradiance(sky, n, schlick_weight);
  const auto mirrored = static_cast<float>(sky.radiance(2 * dot(n, v) * n - v));
  const ReflectedParts light = coated_environment(m, dot(n, v), vec3(static_cast<float>(whole)),
                                                  vec3(static_cast<float>(grazing)), vec3(mirrored));
  return static_cast<double>(reflected_whole(light).x);
}

double exactCoatedLight(const MaterialModel& m, const Sky& sky, const vec3& n, const vec3& v) {
  const vec3 local = to_local(frame_around(n), v);
  return irradiance(sky, n,
                    [&](float cosine) {
                      const vec3 l(std::sqrt(std::max(0.f, 1 - cosine * cosine)), 0, cosine);
                      return cosine > 0 ? model_response(m, local, l).x / cosine : 0.f;
                    }) +
         static_cast<double>(coated_mirror(m, local.z).x) * sky.radiance(2 * dot(n, v) * n - v);
}

TEST(PrefilteredModels, CoatsShowMirrorAndBase) {
  for (const Sky& sky : kSkies)
    for (const uint options : {0u, model_option_blend, model_option_physical})
      for (const float eta : {1.f, 1.3f, 1.5f, 2.f, 5.f, 200.f}) {
        const MaterialModel m = coatedModel(0.5f, eta, options);
        Views views{0, 90};
        RelativeError error;
        for (int i = 0; i < kViews; ++i) {
          const auto [n, v] = views.next();
          error.add(coatedLight(m, sky, n, v), exactCoatedLight(m, sky, n, v));
        }
        RecordProperty(sky.name + " " + std::to_string(options) + " eta " + std::to_string(eta),
                       std::to_string(error.value()));
        EXPECT_LT(error.value(), options == model_option_physical ? 0.01 : 1e-5)
            << sky.name << options << ' ' << eta;
      }
}

/// Physical coats by Schlick's reflectance, by 0.03 to 0.3 of their light: F(v), the light that enters and
/// the means that follow from it.
TEST(PrefilteredModels, CoatsBySchlicksReflectanceErr) {
  for (const Sky& sky : kSkies)
    for (const float eta : {1.3f, 1.5f, 2.f, 5.f}) {
      const MaterialModel m = coatedModel(0.5f, eta, model_option_physical);
      const double headOn = static_cast<double>(schlick_fresnel(1, eta, 0)),
                   mean = static_cast<double>(schlick_mean_reflectance(eta, 0)),
                   escape = (1 - mean) / static_cast<double>(eta * eta);
      RelativeError error;
      Views views{0, 90};
      for (int i = 0; i < kViews; ++i) {
        const auto [n, v] = views.next();
        const double entering =
            (1 - headOn) * (irradiance(sky, n, [](float) { return 1; }) - irradiance(sky, n, schlick_weight));
        const double mirror = static_cast<double>(schlick_fresnel(dot(n, v), eta, 0));
        const double base = 0.5 * M_1_PI * entering * escape / (0.5 + 0.5 * escape) / (1 - mean);
        error.add(mirror * sky.radiance(2 * dot(n, v) * n - v) + (1 - mirror) * base,
                  exactCoatedLight(m, sky, n, v));
      }
      RecordProperty(sky.name + " eta " + std::to_string(eta), std::to_string(error.value()));
      EXPECT_GT(error.value(), 0.03) << sky.name << ' ' << eta;
      EXPECT_LT(error.value(), 0.35) << sky.name << ' ' << eta;
    }
}

/// Where the normal is turned away from the viewer the mirror direction lies behind the surface, and
/// Fresnel's reflectance is 1: only a sum still has a base, as the model has.
TEST(PrefilteredModels, CoatsTurnedAwayMirrorNothing) {
  for (const uint options : {0u, model_option_blend, model_option_physical})
    for (const float cosine : {0.f, -0.1f, -1.f}) {
      const MaterialModel m = coatedModel(0.5f, 1.5f, options);
      const ReflectedParts light = coated_environment(m, cosine, vec3(pi), vec3(pi / 21), vec3(1));
      EXPECT_EQ(light.lobe, vec3(0)) << options << ' ' << cosine;
      EXPECT_NEAR(light.diffuse.x, options == 0 ? 0.5f : 0.f, 1e-6f) << options << ' ' << cosine;
    }
}

/// The other two ways to combine coat and base, against the physical one at an index of 1.5: the sum keeps in
/// the base what the coat mirrors, and both are too bright below an albedo of 1.
TEST(PrefilteredModels, CoatsThatAreNotPhysicalErrByTheirBase) {
  for (const Sky& sky : kSkies)
    for (const float kd : {0.2f, 0.5f, 0.8f, 1.f}) {
      RelativeError sum, blend;
      Views views{0, 90};
      for (int i = 0; i < kViews; ++i) {
        const auto [n, v] = views.next();
        const double exact = exactCoatedLight(coatedModel(kd, 1.5f, model_option_physical), sky, n, v);
        sum.add(exactCoatedLight(coatedModel(kd, 1.5f, 0), sky, n, v), exact);
        blend.add(exactCoatedLight(coatedModel(kd, 1.5f, model_option_blend), sky, n, v), exact);
      }
      const std::string name = sky.name + " kd " + std::to_string(kd);
      RecordProperty(name, std::to_string(sum.value()) + " " + std::to_string(blend.value()));
      EXPECT_GT(sum.value(), blend.value()) << name;
    }
}

/// What reflects of uniform light.
double coatedFurnace(float kd, uint options, double cosine) {
  const MaterialModel m = coatedModel(kd, 1.5f, options);
  const ReflectedParts light =
      coated_environment(m, static_cast<float>(cosine), vec3(static_cast<float>(M_PI)),
                         vec3(static_cast<float>(M_PI) / 21), vec3(1));
  return static_cast<double>(reflected_whole(light).x);
}

/// Of uniform light under coats that absorb, and coats of a thinner medium than air.
TEST(PrefilteredModels, BasesOfAnyPhysicalCoatGetWhatEntersIt) {
  for (const vec2 index : {vec2(1.5f, 1), vec2(1.5f, 2), vec2(0.9f, 0), vec2(0.5f, 0)})
    for (const double cosine : {1., 0.9, 0.5}) {
      MaterialModel m = coatedModel(0.8f, index.x, model_option_physical);
      m.k = vec3(index.y);
      const vec3 light = coated_environment_base(
          m, static_cast<float>(cosine), vec3(static_cast<float>(M_PI)), vec3(static_cast<float>(M_PI) / 21));
      EXPECT_NEAR(static_cast<double>(light.x), furnace(m, directionAt(cosine, 0)), 0.01)
          << index.x << ' ' << index.y << ' ' << cosine;
    }
}

TEST(PrefilteredModels, SumsOfCoatAndBaseGainEnergyAndPhysicalOnesKeepIt) {
  EXPECT_NEAR(coatedFurnace(1, 0, 1), 1.04, 1e-4);
  EXPECT_NEAR(coatedFurnace(1, 0, 0.2), 1.34, 0.01);
  for (const double cosine : {1., 0.5, 0.2, 0.05}) {
    EXPECT_NEAR(coatedFurnace(1, model_option_blend, cosine), 1, 1e-6);
    EXPECT_NEAR(coatedFurnace(1, model_option_physical, cosine), 1, 1e-4);
    EXPECT_LT(coatedFurnace(0.5f, model_option_physical, cosine), 1);
    // The base alone, over what a coat leaves of it.
    const double mirror = static_cast<double>(fresnel(static_cast<float>(cosine), 1.5f, 0.f));
    EXPECT_NEAR((coatedFurnace(0.5f, model_option_blend, cosine) - mirror) /
                    (coatedFurnace(0.5f, model_option_physical, cosine) - mirror),
                1.74, 0.01);
  }
}

}  // namespace
}  // namespace limn::glsl
