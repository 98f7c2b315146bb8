#include "apps/limn/brdf_fits.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "apps/limn/brdf_source.h"
#include "apps/limn/options.h"
#include "core/base/error.h"
#include "core/base/text.h"
#include "core/brdf/factor_fit.h"
#include "core/brdf/factor_fit_error.h"
#include "core/brdf/lobe_picture.h"
#include "core/brdf/tabulated.h"

namespace limn::app {
namespace {

using brdf::Factorisation;
using brdf::TableFormat;

/// A kind of fit, and the texels along an axis that it has unless something else is asked for.
struct Kind {
  const char* name;
  Factorisation factorisation;
  int texels;
  bool floored, refined, warped;  ///< whether --no-floor, --no-refine and --no-warp change it
  const char* help;
};
constexpr std::array kKinds{
    Kind{"dfg", Factorisation::dfg, 64, true, true, false, "exp(D(n.h) + F(h.l) + G(n.l) + G(n.v))"},
    Kind{"tables", Factorisation::tables, 64, true, true, true,
         "dfg baked into two tables of two dimensions"},
    Kind{"pqp", Factorisation::pqp, 64, true, true, false, "exp(p(n.l) + q(n.h) + p(n.v))"},
    Kind{"pqp_disc", Factorisation::pqp_disc, 32, true, true, true, "the same over whole directions"},
    Kind{"dfg_disc", Factorisation::dfg_disc, 32, true, true, true, "dfg with D and G over whole directions"},
    Kind{"svd", Factorisation::svd, 24, true, false, false,
         "sum of products over half vector and difference"},
    Kind{"trilinear", Factorisation::trilinear, 32, false, false, false,
         "one table over half vector and difference, half the texels in the others"},
};

struct Format {
  const char* name;
  TableFormat format;
};
constexpr std::array kFormats{Format{"half", TableFormat::half}, Format{"float32", TableFormat::float32}};

template <class FitRow, std::size_t count>
const FitRow& rowNamed(const std::array<FitRow, count>& rows, const std::string& name, const char* flag) {
  std::vector<std::string> known;
  for (const FitRow& row : rows) {
    if (name == row.name) return row;
    known.emplace_back(row.name);
  }
  throw UsageError(fmt::format("{} '{}' is not accepted{}; known are {}", flag, oneLine(name, 40),
                               didYouMean(name, known), joined(known)));
}

/// The names as help and completion have choices.
template <class FitRow, std::size_t count>
std::string bracedNames(const std::array<FitRow, count>& rows) {
  std::vector<std::string> names;
  for (const FitRow& row : rows) names.emplace_back(row.name);
  return fmt::format("{{{}}}", fmt::join(names, ","));
}

struct BrdfFitsArguments {
  BrdfChoice choice;
  std::string kind;
  int texels = 0, terms = 0;
  bool noFloor = false, noRefine = false, noWarp = false, json = false;
  std::string format = "half";
};

brdf::FitSettings settingsOf(const Kind& kind, const BrdfFitsArguments& options) {
  brdf::FitSettings settings;
  settings.factorisation = kind.factorisation;
  settings.texels = options.texels > 0 ? options.texels : kind.texels;
  settings.terms = std::max(options.terms, 1);
  settings.warped = !options.noWarp;
  settings.floor = !options.noFloor;
  settings.refine = !options.noRefine;
  settings.format = rowNamed(kFormats, options.format, "--format").format;
  return settings;
}

/// Throws UsageError for a flag that leaves the one fit as it is.
void refuseIdleFlags(const Kind& kind, const BrdfFitsArguments& options) {
  const auto refuse = [&](const char* flag, bool given, bool changes) {
    if (given && !changes)
      throw UsageError(
          fmt::format("{} is not accepted with --fit {}, which it does not change", flag, kind.name));
  };
  refuse("--no-floor", options.noFloor, kind.floored);
  refuse("--no-refine", options.noRefine, kind.refined);
  refuse("--no-warp", options.noWarp, kind.warped);
}

/// What is asked for: one fit, or all kinds, with the coordinates and terms that they are compared with.
/// Throws UsageError for more terms than a kind takes, more texels than svd does and flags that change
/// nothing, where it is the one fit; among all kinds each has what it takes.
std::vector<brdf::FitSettings> settingsOf(const BrdfFitsArguments& options) {
  if (!options.kind.empty()) {
    const Kind& kind = rowNamed(kKinds, options.kind, "--fit");
    refuseIdleFlags(kind, options);
    if (kind.factorisation == Factorisation::svd && options.texels > brdf::kMostSvdTexels)
      throw UsageError(fmt::format("--texels {} is not accepted with --fit svd, which takes 2 to {}",
                                   options.texels, brdf::kMostSvdTexels));
    const int most = brdf::mostTerms(kind.factorisation);
    if (options.terms > most)
      throw UsageError(fmt::format("--terms {} is not accepted with --fit {}, which takes {}", options.terms,
                                   options.kind, most > 1 ? fmt::format("1 to {}", most) : "1"));
    return {settingsOf(kind, options)};
  }
  std::vector<brdf::FitSettings> all;
  for (const Kind& kind : kKinds) {
    all.push_back(settingsOf(kind, options));
    all.back().terms = std::min(all.back().terms, brdf::mostTerms(kind.factorisation));
    if (kind.factorisation == Factorisation::svd)
      all.back().texels = std::min(all.back().texels, brdf::kMostSvdTexels);
    if (kind.factorisation == Factorisation::pqp_disc && !options.noWarp) {
      all.push_back(all.back());
      all.back().warped = false;
    }
    if (kind.factorisation == Factorisation::svd && options.terms == 0) {
      all.push_back(all.back());
      all.back().terms = 4;
    }
  }
  return all;
}

/// Directional albedos over angles up to 85 degrees, at eight azimuths around the normal where these matter.
std::vector<glm::dvec3> albedosOf(const brdf::Response& response, bool isotropic) {
  std::vector<glm::dvec3> albedos;
  for (int azimuth = 0; azimuth < (isotropic ? 1 : 8); ++azimuth)
    for (const int degrees : {0, 20, 40, 60, 75, 85})
      albedos.push_back(
          brdf::albedoOfResponse(response, brdf::directionAt(degrees, azimuth * std::numbers::pi / 4)));
  return albedos;
}

struct FitRow {
  std::string name;
  double error = 0, albedo = 0, deviation = 0;
  std::size_t bytes = 0;
};

FitRow rowOf(std::string name, const brdf::Response& response, double error, std::size_t bytes,
             const std::vector<glm::dvec3>& exact, bool isotropic) {
  const std::vector<glm::dvec3> albedos = albedosOf(response, isotropic);
  FitRow row{.name = std::move(name), .error = error, .bytes = bytes};
  for (std::size_t i = 0; i < albedos.size(); ++i)
    for (int channel = 0; channel < 3; ++channel) {
      row.albedo = std::max(row.albedo, albedos[i][channel]);
      row.deviation = std::max(row.deviation, std::abs(albedos[i][channel] - exact[i][channel]));
    }
  return row;
}

/// The rival of factors where azimuths matter: a table over both directions.
FitRow pairsOf(const brdf::Brdf& exact, const std::vector<glm::dvec3>& albedos) {
  constexpr int kSide = 20;
  const brdf::AnisotropicTable table = brdf::tabulateAnisotropic(
      kSide,
      [&](const glm::vec3& l, const glm::vec3& v) { return glm::vec3(exact(glm::dvec3(l), glm::dvec3(v))); });
  const brdf::Response response = [&](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(table.evaluate(glm::vec3(l), glm::vec3(v))) * l.z;
  };
  return rowOf(fmt::format("pairs of directions, {0} x {0} each", kSide), response,
               brdf::SpherePicture(exact, 128, brdf::PictureLights::heldOut).errorOf(response),
               table.values.size() * 6, albedos, false);
}

nlohmann::ordered_json toJson(const BrdfSource& source, const std::vector<FitRow>& rows) {
  nlohmann::ordered_json json = {
      {"source", source.name}, {"kind", source.kind}, {"fits", nlohmann::ordered_json::array()}};
  for (const FitRow& row : rows)
    json["fits"].push_back({{"fit", row.name},
                            {"error", row.error},
                            {"largest_albedo", row.albedo},
                            {"albedo_deviation", row.deviation},
                            {"bytes", row.bytes}});
  return json;
}

void printFits(const std::vector<FitRow>& rows) {
  fmt::print("{:<34} {:>8} {:>8} {:>10} {:>9}\n", "fit", "error", "albedo", "deviation", "bytes");
  for (const FitRow& row : rows)
    fmt::print("{:<34} {:>8.4f} {:>8.3f} {:>10.4f} {:>9}\n", row.name, row.error, row.albedo, row.deviation,
               row.bytes);
}

int runBrdfFits(const BrdfFitsArguments& options) {
  const std::vector<brdf::FitSettings> fits = settingsOf(options);
  const BrdfSource source = openBrdf(options.choice);
  const std::vector<glm::dvec3> exact = albedosOf(brdf::responseOf(source.f), source.isotropic);
  std::vector<FitRow> rows;
  {
    Progress progress("fits of " + source.name, 2);
    for (const brdf::FitSettings& settings : fits) {
      progress.update(static_cast<double>(rows.size()) / static_cast<double>(fits.size()));
      const brdf::FactoredBrdf fit = brdf::fitBrdf(source.f, settings);
      rows.push_back(rowOf(
          fit.name, [&](const glm::dvec3& l, const glm::dvec3& v) { return fit.evaluate(l, v); }, fit.error,
          fit.bytes(), exact, source.isotropic));
    }
  }
  if (options.kind.empty() && !source.isotropic) rows.push_back(pairsOf(source.f, exact));
  if (options.json) {
    printAsJson(toJson(source, rows));
  } else {
    fmt::print("{}: {}\n", source.name, source.kind);
    printFits(rows);
  }
  return 0;
}

std::string kindsHelp() {
  std::string help = "Kinds of fits, with their texels unless --texels says otherwise:\n";
  for (const Kind& kind : kKinds)
    help += fmt::format("  {:<10} {:>3}  {}\n", kind.name, kind.texels, kind.help);
  return help +
         "Surfaces with a grain have a row of a table over both directions beside them.\n"
         "Columns: error, the root mean square over that of the exact picture, of a sphere under five "
         "lights;\n"
         "the largest directional albedo up to 85 degrees; its largest deviation from the exact one; bytes.";
}

}  // namespace

std::function<int()> addBrdfFit(CLI::App& command) {
  auto options = std::make_shared<BrdfFitsArguments>();
  options->choice.addTo(command);
  command.add_option("--fit", options->kind, "Kind of fit, see below; without it all kinds")
      ->type_name(bracedNames(kKinds));
  command
      .add_option("--texels", options->texels,
                  fmt::format("Texels along an axis of a factor; svd has {} at most", brdf::kMostSvdTexels))
      ->transform(wholeRange(2, 512));
  command
      .add_option("--terms", options->terms,
                  "Products that the fit is the sum of: at most 16 of svd, 2 of dfg, pqp and those over "
                  "directions, 1 of the others")
      ->transform(wholeRange(1, 16));
  command.add_flag("--no-floor", options->noFloor, "Fit the product alone, without a diffuse part beside it");
  command.add_flag("--no-refine", options->noRefine, "Keep the least squares of the logarithms");
  command.add_flag("--no-warp", options->noWarp, "Coordinates of pqp_disc, dfg_disc and tables as published");
  command.add_option("--format", options->format, "Format of the tables")
      ->type_name(bracedNames(kFormats))
      ->capture_default_str();
  command.add_flag("--json", options->json, "Print JSON instead of a table");
  command.footer(kindsHelp());
  return [options] { return runBrdfFits(*options); };
}

}  // namespace limn::app
