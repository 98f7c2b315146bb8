#include "core/bench/row.h"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace limn::bench {
namespace {

using Json = nlohmann::ordered_json;

/// JSON knows no infinity: such values (the PSNR of equal pictures) are written as null.
double numberOrInfinity(const Json& value) {
  return value.is_null() ? std::numeric_limits<double>::infinity() : value.get<double>();
}

Json metricsToJson(const Metrics& m) {
  Json json = {{"rmse", m.rmse},
               {"rel_mse", m.rel_mse},
               {"bias", m.bias},
               {"p999", m.p999},
               {"psnr", m.psnr},
               {"flip", m.flip},
               {"structured", m.structured},
               {"masked_share", m.masked_share},
               {"pixels", m.pixels}};
  if (m.noise_floor) json["noise_floor"] = *m.noise_floor;
  return json;
}

Metrics metricsFromJson(const Json& json) {
  Metrics m;
  m.rmse = json.at("rmse").get<double>();
  m.rel_mse = numberOrInfinity(json.at("rel_mse"));
  m.bias = json.at("bias").get<double>();
  m.p999 = json.at("p999").get<double>();
  m.psnr = numberOrInfinity(json.at("psnr"));
  m.flip = json.at("flip").get<double>();
  m.structured = json.at("structured").get<double>();
  m.masked_share = json.at("masked_share").get<double>();
  m.pixels = json.at("pixels").get<std::size_t>();
  if (json.contains("noise_floor")) m.noise_floor = json["noise_floor"].get<double>();
  return m;
}

Json misjudgedToJson(const Misjudged& m) {
  return {
      {"umbra", m.umbra}, {"lit_in_umbra", m.litInUmbra}, {"lit", m.lit}, {"dark_in_light", m.darkInLight}};
}

Misjudged misjudgedFromJson(const Json& json) {
  return {json.at("umbra").get<std::size_t>(), json.at("lit_in_umbra").get<std::size_t>(),
          json.at("lit").get<std::size_t>(), json.at("dark_in_light").get<std::size_t>()};
}

/// The keys of `limn render --stats` that tables need; the rest of the statistics beside them.
Json costToJson(const Cost& cost) {
  Json json = cost.details.empty() ? Json::object() : Json::parse(cost.details);
  json["renderer"] = cost.renderer;
  json["backend"] = cost.backend;
  json["timer"] = cost.timer;
  json["software"] = cost.software;
  json["frame_ms"] = {{"median", cost.frameMs.median},
                      {"q1", cost.frameMs.q1},
                      {"q3", cost.frameMs.q3},
                      {"n", cost.frameMs.n}};
  if (!cost.frameMs.samples.empty()) json["frame_samples_ms"] = cost.frameMs.samples;
  json["turns"] = cost.frameMs.turns;
  json["split_ms"] = {{"maps", cost.split.maps},
                      {"filters", cost.split.filters},
                      {"technique", cost.split.technique},
                      {"rest", cost.split.rest}};
  json["memory_bytes"] = cost.memoryBytes;
  if (!cost.driver.empty()) json["driver"] = cost.driver;
  if (!cost.machine.empty()) json["machine"] = cost.machine;
  if (cost.lights > 0) json["lights"] = cost.lights;
  json["quality_parameters"] = cost.qualityParameters;
  return json;
}

Cost costFromJson(const Json& json) {
  Cost cost;
  cost.renderer = json.at("renderer").get<std::string>();
  cost.backend = json.at("backend").get<std::string>();
  cost.timer = json.at("timer").get<std::string>();
  cost.software = json.at("software").get<bool>();
  const Json& time = json.at("frame_ms");
  cost.frameMs = {time.at("median").get<double>(),
                  time.at("q1").get<double>(),
                  time.at("q3").get<double>(),
                  time.at("n").get<int>(),
                  {},
                  json.value("turns", 1)};
  if (json.contains("frame_samples_ms"))
    cost.frameMs.samples = json["frame_samples_ms"].get<std::vector<double>>();
  const Json& split = json.at("split_ms");
  cost.split = {split.at("maps").get<double>(), split.at("filters").get<double>(),
                split.at("technique").get<double>(), split.at("rest").get<double>()};
  cost.memoryBytes = json.at("memory_bytes").get<std::int64_t>();
  cost.driver = json.value("driver", "");
  cost.machine = json.value("machine", "");
  cost.lights = json.value("lights", 0);
  cost.qualityParameters = json.value("quality_parameters", std::vector<std::string>{});
  cost.details = json.dump();
  return cost;
}

Json provenanceToJson(const Provenance& p) {
  Json modules = Json::array();
  for (const Provenance::Module& m : p.modules)
    modules.push_back({{"technique", m.technique}, {"file", m.file}, {"hash", m.hash}});
  return {{"program", p.program}, {"scene", p.scene}, {"techniques", modules}};
}

Provenance provenanceFromJson(const Json& json) {
  Provenance p{json.at("program").get<std::string>(), json.at("scene").get<std::string>(), {}};
  for (const Json& m : json.at("techniques"))
    p.modules.push_back({m.at("technique").get<std::string>(), m.at("file").get<std::string>(),
                         m.at("hash").get<std::string>()});
  return p;
}

/// What is changed; the rest is left out.
Json changesToJson(const SceneChanges& c) {
  const SceneChanges none;
  Json json = Json::object();
  const auto add = [&json](const char* key, const auto& value, const auto& otherwise) {
    if (value != otherwise) json[key] = value;
  };
  add("eye", c.eye, none.eye);
  add("target", c.target, none.target);
  add("fov", c.fov, none.fov);
  add("animation", c.animation, none.animation);
  add("set_light", c.setLight, none.setLight);
  add("default_lights", c.defaultLights, none.defaultLights);
  add("environment_rotation", c.environmentRotation, none.environmentRotation);
  add("environment_scale", c.environmentScale, none.environmentScale);
  add("grid", c.grid, none.grid);
  return json;
}

SceneChanges changesFromJson(const Json& json) {
  SceneChanges c;
  c.eye = json.value("eye", c.eye);
  c.target = json.value("target", c.target);
  c.fov = json.value("fov", c.fov);
  c.animation = json.value("animation", c.animation);
  c.setLight = json.value("set_light", c.setLight);
  c.defaultLights = json.value("default_lights", c.defaultLights);
  c.environmentRotation = json.value("environment_rotation", c.environmentRotation);
  c.environmentScale = json.value("environment_scale", c.environmentScale);
  c.grid = json.value("grid", c.grid);
  return c;
}

Json mediumToJson(const MediumSettings& m) {
  Json json = Json::object();
  if (!m.sigmaA.empty()) json["sigma_a"] = m.sigmaA;
  if (!m.sigmaS.empty()) json["sigma_s"] = m.sigmaS;
  if (m.g) json["g"] = *m.g;
  return json;
}

MediumSettings mediumFromJson(const Json& json) {
  const auto coefficient = [&json](const char* key) {
    const auto found = json.find(key);
    if (found == json.end()) return std::string();
    // rows of earlier versions have a number
    return found->is_number() ? fmt::format("{}", found->get<double>()) : found->get<std::string>();
  };
  MediumSettings m{coefficient("sigma_a"), coefficient("sigma_s"), {}};
  if (json.contains("g")) m.g = json["g"].get<double>();
  return m;
}

Json caseToJson(const Case& c) {
  Json parameters = Json::object();
  for (const auto& [name, value] : c.parameters) parameters[name] = value;
  const EnvironmentSettings& e = c.environment;
  Json environment = {{"map", e.map},
                      {"lights", e.lights},
                      {"resolution", e.resolution},
                      {"shape", e.shape},
                      {"reflection", e.reflection}};
  return {{"scene", c.scene},
          {"camera", c.camera},
          {"light", c.light},
          {"environment", environment},
          {"medium", mediumToJson(c.medium)},
          {"changes", changesToJson(c.changes)},
          {"time", c.time},
          {"fps", c.fps},
          {"light_size", c.lightSize},
          {"technique", c.technique},
          {"parameters", parameters},
          {"term", c.term},
          {"size", {c.width, c.height}},
          {"dynamic", c.dynamic},
          {"frames", c.frames},
          {"warmup", c.warmup},
          {"turns", c.turns},
          {"time_size", {c.timeWidth, c.timeHeight}},
          {"title", c.title},
          {"baseline", c.baseline},
          {"max_masked_share", c.maxMaskedShare},
          {"quality",
           {{"spp", c.reference.spp},
            {"noise", c.reference.noise},
            {"bounces", c.reference.bounces},
            {"interfaces", c.reference.interfaces}}}};
}

Case caseFromJson(const Json& json) {
  Case c;
  c.scene = json.at("scene").get<std::string>();
  c.camera = json.at("camera").get<std::string>();
  c.light = json.at("light").get<std::string>();
  if (json.contains("environment")) {  // rows of earlier versions have none
    const Json& e = json["environment"];
    c.environment = {e.at("map").get<std::string>(), e.at("lights").get<double>(),
                     e.at("resolution").get<int>(), e.at("shape").get<std::string>(),
                     e.at("reflection").get<std::string>()};
  }
  if (json.contains("medium")) c.medium = mediumFromJson(json["medium"]);
  if (json.contains("changes")) c.changes = changesFromJson(json["changes"]);
  c.time = json.at("time").get<double>();
  c.fps = json.value("fps", 0.0);
  c.lightSize = json.value("light_size", 0.0);
  c.technique = json.at("technique").get<std::string>();
  for (const auto& [name, value] : json.at("parameters").items()) {
    c.parameters.emplace_back(name, value.get<std::string>());
  }
  c.term = json.at("term").get<std::string>();
  c.width = json.at("size").at(0).get<int>();
  c.height = json.at("size").at(1).get<int>();
  c.dynamic = json.at("dynamic").get<bool>();
  c.frames = json.at("frames").get<int>();
  c.warmup = json.at("warmup").get<int>();
  c.turns = json.value("turns", 1);
  c.timeWidth = json.at("time_size").at(0).get<int>();
  c.timeHeight = json.at("time_size").at(1).get<int>();
  c.title = json.at("title").get<std::string>();
  c.baseline = json.at("baseline").get<bool>();
  c.maxMaskedShare = json.at("max_masked_share").get<double>();
  const Json& quality = json.at("quality");
  c.reference = {quality.at("spp").get<int>(), quality.at("noise").get<double>(),
                 quality.at("bounces").get<int>(), quality.value("interfaces", 0)};
  return c;
}

}  // namespace

std::string toJson(const Row& row) {
  Json json = caseToJson(row.what);
  json["key"] = row.key;
  json["reference"] = {{"file", row.referenceFile}};
  if (row.referenceNoise) json["reference"]["noise_rms"] = *row.referenceNoise;
  if (row.referenceSeconds) json["reference"]["seconds"] = *row.referenceSeconds;
  if (!row.provenance.program.empty()) json["provenance"] = provenanceToJson(row.provenance);
  if (!row.picture.empty()) json["picture"] = row.picture;
  if (!row.difference.empty()) json["difference"] = row.difference;
  if (row.failure.empty()) {
    json["error"] = metricsToJson(row.error);
    if (row.penumbra) json["penumbra"] = metricsToJson(*row.penumbra);
    if (row.misjudged) json["misjudged"] = misjudgedToJson(*row.misjudged);
    if (!row.spectrum.empty()) json["spectrum"] = row.spectrum;
    json["stats"] = costToJson(row.cost);
  } else {
    json["failure"] = row.failure;
    json["renderer"] = row.cost.renderer;
  }
  // Foreign text (driver names, file names) may be no UTF-8; it must not stop the bench.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Row rowFromJson(const std::string& line) {
  try {
    const Json json = Json::parse(line);
    Row row;
    row.key = json.at("key").get<std::string>();
    row.what = caseFromJson(json);
    row.referenceFile = json.at("reference").at("file").get<std::string>();
    if (json["reference"].contains("noise_rms"))
      row.referenceNoise = json["reference"]["noise_rms"].get<double>();
    if (json["reference"].contains("seconds"))
      row.referenceSeconds = json["reference"]["seconds"].get<double>();
    if (json.contains("provenance")) row.provenance = provenanceFromJson(json["provenance"]);
    row.what.picture = json.contains("picture");
    if (row.what.picture) row.picture = json["picture"].get<std::string>();
    row.difference = json.value("difference", "");
    if (json.contains("failure")) {
      row.failure = json["failure"].get<std::string>();
      row.cost.renderer = json.at("renderer").get<std::string>();
      return row;
    }
    row.error = metricsFromJson(json.at("error"));
    if (json.contains("penumbra")) row.penumbra = metricsFromJson(json["penumbra"]);
    if (json.contains("misjudged")) row.misjudged = misjudgedFromJson(json["misjudged"]);
    row.spectrum = json.value("spectrum", std::vector<double>{});
    row.cost = costFromJson(json.at("stats"));
    return row;
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("not a row of results: {}", error.what()));
  }
}

std::string referencePicture(const Row& row) {
  if (row.picture.empty()) return {};
  const std::filesystem::path name = std::filesystem::path(row.referenceFile).stem().concat(".png");
  return (std::filesystem::path(row.picture).parent_path() / name).string();
}

}  // namespace limn::bench
