#include "core/bench/row.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "core/base/json_depth.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/misjudged_table.h"
#include "core/bench/private/provenance_json.h"
#include "core/bench/private/question_json.h"
#include "core/image/metric_json.h"

namespace limn::bench {
namespace {

using Json = nlohmann::ordered_json;

Json misjudgedToJson(const Misjudged& m) {
  Json json;
  for (const MisjudgedInfo& info : kMisjudged) {
    json[info.wholeKey] = m.*info.whole;
    json[info.key] = m.*info.part;
  }
  return json;
}

Misjudged misjudgedFromJson(const Json& json) {
  Misjudged m;
  for (const MisjudgedInfo& info : kMisjudged) {
    m.*info.whole = json.at(info.wholeKey).get<std::size_t>();
    m.*info.part = json.at(info.key).get<std::size_t>();
  }
  return m;
}

Json boundToJson(const BoundTime& time) {
  const Ratio ratio = xBound(time);
  return {{"value", ratio.value}, {"low", ratio.low},       {"high", ratio.high},
          {"own_ms", time.own},   {"bound_ms", time.bound}, {"turns", time.turns}};
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
  if (cost.bound) json["x_bound"] = boundToJson(*cost.bound);
  json["memory_bytes"] = cost.memoryBytes;
  if (!cost.driver.empty()) json["driver"] = cost.driver;
  if (!cost.machine.empty()) json["machine"] = cost.machine;
  if (cost.lights > 0) json["lights"] = cost.lights;
  if (cost.framesPerPicture > 1) json["frames_per_picture"] = cost.framesPerPicture;
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
  if (json.contains("x_bound")) {
    cost.bound = {json["x_bound"].at("own_ms").get<std::vector<double>>(),
                  json["x_bound"].at("bound_ms").get<std::vector<double>>(),
                  json["x_bound"].at("turns").get<int>()};
    if (cost.bound->own.empty() || cost.bound->bound.empty())
      throw Error("not a row of results: x_bound has no times");
  }
  cost.memoryBytes = json.at("memory_bytes").get<std::int64_t>();
  cost.driver = json.value("driver", "");
  cost.machine = json.value("machine", "");
  cost.lights = json.value("lights", 0);
  cost.framesPerPicture = json.value("frames_per_picture", 1);
  cost.qualityParameters = json.value("quality_parameters", std::vector<std::string>{});
  cost.details = json.dump();
  return cost;
}

Json caseToJson(const Case& c) {
  Json parameters = Json::object();
  for (const auto& [name, value] : c.parameters) parameters[name] = value;
  Json json = Json::object();
  addQuestion(json, c);
  json.update(Json{{"fps", c.fps},
                   {"technique", c.technique},
                   {"parameters", parameters},
                   {"dynamic", c.dynamic},
                   {"frames", c.frames},
                   {"warmup", c.warmup},
                   {"turns", c.turns},
                   {"bound", c.bound},
                   {"time_size", {c.timeWidth, c.timeHeight}},
                   {"title", c.title},
                   {"baseline", c.baseline},
                   {"max_masked_share", c.maxMaskedShare},
                   {"quality",
                    {{"spp", c.reference.spp},
                     {"noise", c.reference.noise},
                     {"bounces", c.reference.bounces},
                     {"interfaces", c.reference.interfaces}}}});
  return json;
}

Case caseFromJson(const Json& json) {
  Case c;
  static_cast<SceneQuestion&>(c) = questionFromJson(json);
  c.fps = json.value("fps", 0.0);
  c.technique = json.at("technique").get<std::string>();
  for (const auto& [name, value] : json.at("parameters").items()) {
    c.parameters.emplace_back(name, value.get<std::string>());
  }
  c.dynamic = json.at("dynamic").get<bool>();
  c.frames = json.at("frames").get<int>();
  c.warmup = json.at("warmup").get<int>();
  c.turns = json.value("turns", 1);
  c.bound = json.value("bound", false);
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
  if (isTooDeepJson(line))
    throw Error(fmt::format("not a row of results: JSON nested deeper than {} levels", kMaxJsonDepth));
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
