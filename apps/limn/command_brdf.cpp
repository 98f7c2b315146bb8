// limn brdf: what a BRDF is like, a measured one made by simulation, and what factorisations make of it.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/limn/brdf_fits.h"
#include "apps/limn/brdf_source.h"
#include "apps/limn/commands.h"
#include "apps/limn/options.h"
#include "apps/limn/provenance.h"
#include "core/base/error.h"
#include "core/brdf/factor_fit_error.h"
#include "core/brdf/groove.h"
#include "core/brdf/lobe_picture.h"
#include "core/brdf/measured_file.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

constexpr int kAlbedoAngles[] = {0, 45, 80};  // degrees from the normal

// ---- info

struct InfoOptions {
  BrdfChoice choice;
  fs::path picture;
  bool json = false;
};

struct AlbedoRow {
  int angle, azimuth;  // degrees
  glm::dvec3 albedo;
};

std::vector<AlbedoRow> albedosOf(const BrdfSource& source) {
  std::vector<AlbedoRow> rows;
  const brdf::Response response = brdf::responseOf(source.f);
  for (const int azimuth : {0, 90}) {
    if (azimuth > 0 && source.isotropic) break;
    for (const int angle : kAlbedoAngles)
      rows.push_back(
          {angle, azimuth,
           brdf::albedoOfResponse(response, brdf::directionAt(angle, azimuth * std::numbers::pi / 180))});
  }
  return rows;
}

nlohmann::ordered_json infoJson(const BrdfSource& source, double reciprocity,
                                const std::vector<AlbedoRow>& rows) {
  nlohmann::ordered_json json = {{"source", source.name},
                                 {"kind", source.kind},
                                 {"isotropic", source.isotropic},
                                 {"nodes", source.nodes},
                                 {"bytes", source.bytes}};
  if (!source.nodes.empty()) json["largest"] = source.largest;
  json["reciprocity_defect"] = reciprocity;
  json["albedo"] = nlohmann::ordered_json::array();
  for (const AlbedoRow& row : rows)
    json["albedo"].push_back({{"angle", row.angle},
                              {"azimuth", row.azimuth},
                              {"albedo", {row.albedo.x, row.albedo.y, row.albedo.z}}});
  return json;
}

void printInfo(const BrdfSource& source, double reciprocity, const std::vector<AlbedoRow>& rows) {
  fmt::print("{}: {}{}\n", source.name, source.kind, source.isotropic ? "" : ", anisotropic");
  if (!source.nodes.empty()) {
    fmt::print("nodes               {}\n", fmt::join(source.nodes, " x "));
    fmt::print("bytes               {}\n", source.bytes);
    fmt::print("largest value       {:.4g} /sr\n", source.largest);
  }
  fmt::print("reciprocity defect  {:.2g}\n", reciprocity);
  for (const AlbedoRow& row : rows)
    fmt::print("albedo, {:>2} degrees {} {:.4f} {:.4f} {:.4f}\n", row.angle,
               source.isotropic   ? ""
               : row.azimuth == 0 ? "to x"
                                  : "to y",
               row.albedo.x, row.albedo.y, row.albedo.z);
}

int info(const InfoOptions& options) {
  if (!options.picture.empty()) {
    checkExtension("--picture", options.picture, {".png", ".exr"});
    checkWritable(options.picture);
  }
  const BrdfSource source = openBrdf(options.choice);
  if (!options.picture.empty()) loadPictureLibrary();
  const double reciprocity = brdf::reciprocityDefect(source.f);
  const std::vector<AlbedoRow> rows = albedosOf(source);
  if (options.json)
    printAsJson(infoJson(source, reciprocity, rows));
  else
    printInfo(source, reciprocity, rows);
  if (!options.picture.empty()) {
    Image picture = brdf::lobePicture(source.f, source.isotropic);
    sign(picture);
    writeImage(options.picture, picture);
    sayWritten(options.picture);
  }
  return 0;
}

std::function<int()> addInfo(CLI::App& command) {
  auto options = std::make_shared<InfoOptions>();
  options->choice.addTo(command);
  command.add_option("--picture", options->picture, "Write the lobes and the furnace: .png or .exr");
  command.add_flag("--json", options->json, "Print JSON");
  command.footer(
      fmt::format("The picture: discs of f cos over all directions, areas kept, for light from the left (in "
                  "a second row\n"
                  "from below, for surfaces with a grain) at {} degrees; a ring is where the light comes "
                  "from. Brightness\n"
                  "is the root of f cos over its largest value. Beneath them the albedo of each channel over "
                  "the angle of\n"
                  "the view, 0 to 90 degrees; a level is a quarter, the bright one is 1. Dim lines: views "
                  "across the grain.",
                  fmt::join(brdf::kLobeAngles, ", ")));
  return [options] { return info(*options); };
}

// ---- simulate

struct SimulateOptions {
  fs::path out;
  double slope = 45;
  std::string rising = "0.1,0.15,0.8", falling = "0.8,0.1,0.1";
  int strips = brdf::Groove{}.strips, size = 20;
  bool float32 = false;
};

int simulate(const SimulateOptions& options) {
  checkExtension("--out", options.out, {".bsdf"});
  const brdf::Groove groove{.slope = static_cast<float>(options.slope * std::numbers::pi / 180),
                            .rising = parseAlbedo("--rising", options.rising),
                            .falling = parseAlbedo("--falling", options.falling),
                            .strips = options.strips};
  checkWritable(options.out);
  const brdf::GrooveBrdf simulated(groove);
  const brdf::AnisotropicTable table = simulated.table(options.size);
  const auto format = options.float32 ? brdf::MeasuredFormat::float32 : brdf::MeasuredFormat::half;
  brdf::writeMeasured(options.out, table, format);
  sayWritten(options.out);
  const double error = brdf::SpherePicture([&](const glm::dvec3& l, const glm::dvec3& v) {
                         return simulated.evaluate(l, v);
                       }).errorOf([&](const glm::dvec3& l, const glm::dvec3& v) {
    return glm::dvec3(table.evaluate(glm::vec3(l), glm::vec3(v))) * l.z;
  });
  fmt::print("{}: {} texels a side, {} bytes, error of its picture of a sphere {:.3f}\n",
             options.out.string(), options.size, fs::file_size(options.out), error);
  return 0;
}

std::function<int()> addSimulate(CLI::App& command) {
  auto options = std::make_shared<SimulateOptions>();
  command.add_option("out,-o,--out", options->out, "File to write: .bsdf")->required();
  command.add_option("--slope", options->slope, "Angle of the walls against the surface, degrees")
      ->capture_default_str()
      ->check(realRange(0.1, 89.0));
  command
      .add_option("--rising", options->rising,
                  "Albedo of the wall that rises towards +x: one number or red,green,blue")
      ->capture_default_str();
  command.add_option("--falling", options->falling, "Albedo of the wall that falls towards +x")
      ->capture_default_str();
  command.add_option("--strips", options->strips, "Strips of one radiosity each that a wall is cut into")
      ->capture_default_str()
      ->transform(wholeRange(1, 256));
  command.add_option("--size", options->size, "Texels along each side of the discs of l and v")
      ->capture_default_str()
      ->transform(wholeRange(2, brdf::kMostDiscTexels));
  command.add_flag("--float32", options->float32, "Keep numbers of 32 bits, not of 16");
  return [options] { return simulate(*options); };
}

}  // namespace

Action addBrdfCommand(CLI::App& command) {
  command.require_subcommand(0, 1);  // an unknown word is named as such
  auto chosen = std::make_shared<Action>();
  const auto add = [&](const char* name, const char* description, Action (*build)(CLI::App&)) {
    CLI::App* subcommand = command.add_subcommand(name, description);
    subcommand->fallthrough();  // --quiet is the command's
    subcommand->callback([chosen, run = build(*subcommand)] { *chosen = run; });
  };
  add("info", "Say what a BRDF is like and draw its lobes: nodes, largest value, albedo, reciprocity",
      addInfo);
  add("simulate", "Write the BRDF of V-shaped grooves of two colours as measured data", addSimulate);
  add("fit", "Factorise a BRDF: error, albedo and bytes of each kind of fit", addBrdfFit);
  return [chosen] {
    if (!*chosen) throw UsageError("limn brdf: info, simulate or fit is expected; see limn brdf --help");
    return (*chosen)();
  };
}

}  // namespace limn::app
