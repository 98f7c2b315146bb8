#include "core/brdf/factor_fit.h"

#include <fmt/format.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/brdf/factor_fit_error.h"
#include "core/brdf/factor_fit_kinds.h"
#include "glsl/materials/factored.glsl"

namespace limn::brdf {
namespace {

using glm::dvec3;

void check(const FitSettings& settings) {
  if (settings.texels < 2 || settings.texels > 512)
    throw UsageError(
        fmt::format("a fit has {} texels along an axis: 2 to 512 are possible", settings.texels));
  const int most = mostTerms(settings.factorisation);
  if (settings.terms < 1 || settings.terms > most)
    throw UsageError(fmt::format("a fit has {} terms: {} possible", settings.terms,
                                 most > 1 ? fmt::format("1 to {} are", most) : "1 is"));
  if (settings.samples < 100)
    throw UsageError(fmt::format("a fit has {} samples: at least 100 are needed", settings.samples));
  if (settings.factorisation == Factorisation::slopes || settings.factorisation == Factorisation::fibres)
    throw UsageError("slopes and fibres are tables of a model, not fits");
}

FactoredBrdf fitted(const Brdf& brdf, const std::vector<BrdfSample>& samples, const FitSettings& settings,
                    const dvec3& floor) {
  switch (settings.factorisation) {
    case Factorisation::svd:
      return fitSvd(brdf, settings, floor);
    case Factorisation::trilinear:
      return fitTrilinear(brdf, settings);
    case Factorisation::tables: {
      FitSettings unbaked = settings;
      unbaked.factorisation = Factorisation::dfg;
      unbaked.format = TableFormat::float32;
      return bakedTables(fitLogarithms(samples, unbaked, floor), settings.texels, settings.warped,
                         settings.format);
    }
    case Factorisation::dfg:
    case Factorisation::pqp:
    case Factorisation::pqp_disc:
    case Factorisation::dfg_disc:
    case Factorisation::slopes:
    case Factorisation::fibres:
      break;
  }
  return fitLogarithms(samples, settings, floor);
}

/// Divides a fit by its largest albedo where that is above 1.
FactoredBrdf bounded(FactoredBrdf fit) {
  const double albedo = largestAlbedo([&](const dvec3& l, const dvec3& v) { return fit.evaluate(l, v); },
                                      !followsTangent(fit.factorisation));
  if (albedo > 1) {
    fit.scale /= albedo;
    fit.floor /= albedo;
  }
  return fit;
}

double errorOf(const SpherePicture& picture, const FactoredBrdf& fit) {
  return picture.errorOf([&](const dvec3& l, const dvec3& v) { return fit.evaluate(l, v); });
}

}  // namespace

int mostTerms(Factorisation factorisation) {
  switch (factorisation) {
    case Factorisation::svd:
      return 16;
    case Factorisation::dfg:
    case Factorisation::pqp:
    case Factorisation::pqp_disc:
    case Factorisation::dfg_disc:
      return 2;
    case Factorisation::tables:
    case Factorisation::trilinear:
    case Factorisation::slopes:
    case Factorisation::fibres:
      break;
  }
  return 1;
}

bool followsTangent(Factorisation factorisation) {
  return factorisation == Factorisation::pqp_disc || factorisation == Factorisation::dfg_disc ||
         factorisation == Factorisation::svd;
}

FactoredBrdf fitBrdf(const Brdf& brdf, const FitSettings& settings) {
  check(settings);
  const std::vector<BrdfSample> samples = sampleBrdf(brdf, settings.samples);
  const Brdf exact = [&](const dvec3& l, const dvec3& v) {
    const dvec3 f = brdf(l, v);
    return finite(f) ? glm::max(f, dvec3(0)) : dvec3(0);
  };
  const dvec3 floor = diffuseFloor(samples);
  const bool floored =
      settings.floor && settings.factorisation != Factorisation::trilinear && floor != dvec3(0);
  FactoredBrdf fit, withFloor;
  const auto fitAll = [&] { fit = bounded(fitted(brdf, samples, settings, dvec3(0))); };
  const auto fitRest = [&] {
    if (floored) withFloor = bounded(fitted(brdf, samples, settings, floor));
  };
  if (settings.factorisation == Factorisation::svd) {  // asks the BRDF, which may not be asked by two threads
    fitAll();
    fitRest();
  } else {
    tbb::parallel_invoke(fitAll, fitRest);
  }
  if (floored) {
    const SpherePicture picture(exact);
    if (errorOf(picture, withFloor) < errorOf(picture, fit)) fit = std::move(withFloor);
  }
  fit.error = errorOf(SpherePicture(exact, 128, PictureLights::heldOut), fit);
  return fit;
}

FactoredBrdf bakedTables(const FactoredBrdf& fit, int texels, bool warped, TableFormat format) {
  if (fit.factorisation != Factorisation::dfg && fit.factorisation != Factorisation::pqp)
    throw UsageError("only fits of kind dfg and pqp are baked into two tables");
  if (fit.tables.front().depth > 1) throw UsageError("a sum of products is not baked into two tables");
  if (texels < 2) throw UsageError(fmt::format("factored tables need 2 texels or more, not {}", texels));
  const FactorTable& logs = fit.tables.front();
  const bool fresnel = fit.factorisation == Factorisation::dfg;
  const auto row = [&](double place, double which) {
    return dvec3(
        glsl::factored_lookup(logs, glm::vec2(static_cast<float>(place), static_cast<float>(which)), 0));
  };
  FactoredBrdf result;
  result.warped = warped;
  result.name = fmt::format("{}, baked {} x {}", fit.name, texels, texels);
  result.scale = fit.scale;
  result.floor = fit.floor;
  result.tables.push_back(FactorTable::of({texels, texels, 1}, format, [&](const dvec3& place) {
    const double half = warped ? place.y : 1 - std::sqrt(1 - place.y);
    return glm::exp(fresnel ? row(half, 0) + row(std::sqrt(place.x), 0.5) : row(half, 1));
  }));
  result.tables.push_back(FactorTable::of({texels, texels, 1}, format, [&](const dvec3& place) {
    const dvec3 root = warped ? place : glm::sqrt(place);
    const double which = fresnel ? 1 : 0;
    return glm::exp(row(root.x, which) + row(root.y, which)) * (root.x * root.x);
  }));
  return result;
}

}  // namespace limn::brdf
