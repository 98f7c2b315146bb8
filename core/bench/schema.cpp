#include "core/bench/schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "core/bench/private/misjudged_table.h"
#include "core/image/metric_table.h"
#include "core/question/question_fields.h"
#include "core/render/frame_stats.h"

namespace limn::bench {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kDialect = "https://json-schema.org/draft/2020-12/schema";

Json typed(const char* type, std::string_view description) {
  return {{"type", type}, {"description", description}};
}
Json text(std::string_view description) {
  return typed("string", description);
}
Json number(std::string_view description) {
  return typed("number", description);
}
Json integer(std::string_view description) {
  return typed("integer", description);
}
Json boolean(std::string_view description) {
  return typed("boolean", description);
}

template <class... Names>
Json oneOf(std::string_view description, Names... names) {
  Json json = text(description);
  json["enum"] = {std::string(names)...};
  return json;
}

Json listOf(Json items, std::string_view description) {
  Json json = typed("array", description);
  json["items"] = std::move(items);
  return json;
}

Json pairOf(std::string_view description) {
  Json json = listOf({{"type", "integer"}}, description);
  json["minItems"] = json["maxItems"] = 2;
  return json;
}

/// An object all of whose properties are there, but for those that `optional` names.
Json object(std::string_view description, Json properties, std::span<const char* const> optional = {}) {
  Json json = typed("object", description);
  json["properties"] = std::move(properties);
  json["required"] = Json::array();
  for (const auto& [key, value] : json["properties"].items())
    if (std::ranges::find(optional, key) == optional.end()) json["required"].push_back(key);
  return json;
}

Json parameters() {
  Json json = typed("object", "values as texts, by \"technique.parameter\"");
  json["additionalProperties"] = {{"type", "string"}};
  return json;
}

Json quartiles(std::string_view description) {
  return object(description, {{"median", number("milliseconds")},
                              {"q1", number("lower quartile, milliseconds")},
                              {"q3", number("upper quartile, milliseconds")},
                              {"n", integer("number of frames; 0: not timed")}});
}

Json passSchema() {
  using Role = frame::PassRole;
  using State = frame::PassState;
  static constexpr const char* kAddedLater[] = {"role", "triangles"};
  return object(
      "a pass of the frame",
      {{"name", text("name of the pass")},
       {"technique", text("whose pass it is; core's own have core's name")},
       {"role", oneOf("the part of split_ms that it counts in", name(Role::core), name(Role::map),
                      name(Role::filter), name(Role::technique))},
       {"state", oneOf("what became of it", name(State::run), name(State::cached), name(State::leftOut))},
       {"reason", text("why it was left out or kept; empty otherwise")},
       {"ms", quartiles("time of the pass")},
       {"bytes", integer("GPU memory of what it writes")},
       {"triangles", integer("drawn in a frame, views counted")}},
      kAddedLater);
}

Json shadowMapSchema() {
  return object("how the shadow maps of a light were placed in the last frame",
                {{"light", text("name of the light")},
                 {"projection", text("perspective, orthographic, cube or hemicube")},
                 {"layers", integer("number of layers")},
                 {"near", number("metres")},
                 {"far", number("metres")},
                 {"half_angle", number("radians, of perspective maps")}});
}

Json statsProperties() {
  return {{"renderer", text("as OpenGL says")},
          {"backend", text("egl, osmesa or glfw")},
          {"software", boolean("whether the renderer runs on the processor")},
          {"timer", oneOf("how passes were timed", name(frame::Timing::off), name(frame::Timing::query),
                          name(frame::Timing::finish))},
          {"dynamic", boolean("whether timed frames compute everything again")},
          {"size", pairOf("width and height of the frames, pixels")},
          {"frames_per_picture", integer("frames that a picture averages; times are those of one")},
          {"scene", text("the scene")},
          {"technique", text("names joined by commas; NAME:TERM+TERM is asked for these terms alone")},
          {"parameters", parameters()},
          {"frame_ms", quartiles("wall clock of whole frames, without pass timing")},
          {"frame_samples_ms", listOf({{"type", "number"}}, "each of them, in the order measured")},
          {"pass_sum_ms", number("median over frames of the passes' sum, in a run with pass timing")},
          {"memory_bytes", integer("GPU memory of the frame")},
          {"passes", listOf(passSchema(), "every pass of the frame")},
          {"shadow_maps", listOf(shadowMapSchema(), "of each light")},
          {"uncovered_pixels", integer("receivers that no map of a light covers: V is 1 there")}};
}

/// What a bench adds to the statistics of a frame.
Json costSchema() {
  Json properties = statsProperties();
  properties.update(
      Json{{"turns", integer("in how many turns frames were timed, with those of other rows in between")},
           {"split_ms", object("medians of the passes, summed, milliseconds",
                               {{"maps", number("drawing the scene into maps")},
                                {"filters", number("what is derived from maps")},
                                {"technique", number("the technique's own passes")},
                                {"rest", number("G-buffer and shading")}})},
           {"x_bound", object("the technique's own passes over the least kernel with the same fetches",
                              {{"value", number("ratio of the medians")},
                               {"low", number("lower end of its interval of 95 %")},
                               {"high", number("upper end of the same")},
                               {"own_ms", listOf({{"type", "number"}}, "each frame")},
                               {"bound_ms", listOf({{"type", "number"}}, "each frame with the bound")},
                               {"turns", integer("in which they were taken")}})},
           {"driver", text("vendor and version, as OpenGL says")},
           {"machine", text("processor and system")},
           {"lights", integer("that the picture asks for")},
           {"quality_parameters", listOf({{"type", "string"}}, "those that trade error for time")}});
  static constexpr const char* kOptional[] = {"dynamic",
                                              "size",
                                              "frames_per_picture",
                                              "scene",
                                              "technique",
                                              "parameters",
                                              "passes",
                                              "pass_sum_ms",
                                              "frame_samples_ms",
                                              "x_bound",
                                              "shadow_maps",
                                              "uncovered_pixels",
                                              "driver",
                                              "machine",
                                              "lights",
                                              "turns",
                                              "quality_parameters"};
  return object("what it cost; rows of earlier versions lack some of it", properties, kOptional);
}

Json metricsSchema(std::string_view description) {
  Json properties = Json::object();
  std::vector<const char*> optional;
  for (const MetricInfo& info : kMetrics) {
    Json value = number(std::string(info.label) + ": " + std::string(info.help));
    if (std::holds_alternative<std::size_t Metrics::*>(info.member)) value["type"] = "integer";
    if (info.unbounded) value["type"] = {"number", "null"};
    if (std::holds_alternative<std::optional<double> Metrics::*>(info.member))
      optional.push_back(info.key.data());
    properties[std::string(info.key)] = std::move(value);
  }
  return object(description, std::move(properties), optional);
}

Json misjudgedSchema() {
  Json properties = Json::object();
  for (const MisjudgedInfo& info : kMisjudged) {
    properties[info.wholeKey] = integer("pixels that could be");
    properties[info.key] = integer(info.help);
  }
  return object("pixels whose visibility is wrong in kind", std::move(properties));
}

Json fieldSchema(const QuestionField& field) {
  switch (field.kind) {
    case QuestionKind::text:
    case QuestionKind::choice:
      return text(field.doc);
    case QuestionKind::texts:
      return listOf({{"type", "string"}}, field.doc);
    case QuestionKind::real:
    case QuestionKind::optionalReal:  // where it is not set, the row lacks it
      return number(field.doc);
    case QuestionKind::integer:
      return integer(field.doc);
    case QuestionKind::coefficient: {
      Json json = text(field.doc);
      json["type"] = {"string", "number"};  // rows of earlier versions have numbers
      return json;
    }
    case QuestionKind::size:
      return pairOf(field.doc);
  }
  return {};
}

/// The question's fields, beside the case's own or in an object for each group.
Json questionProperties() {
  Json properties = Json::object();
  for (const QuestionField& field : questionFields()) {
    if (field.group == QuestionGroup::subject) {
      properties[keyInRow(field)] = fieldSchema(field);
      continue;
    }
    Json& group = properties[name(field.group)];
    if (group.is_null()) group = {{"type", "object"}, {"properties", Json::object()}};
    group["properties"][keyInRow(field)] = fieldSchema(field);
  }
  return properties;
}

Json rowProperties() {
  Json properties = questionProperties();
  properties.update(Json{
      {"fps", number("frames per second of the scene's time; 0: it stands still")},
      {"technique", text("names joined by commas, with terms as in --technique, or separation_floor")},
      {"parameters", parameters()},
      {"dynamic", boolean("whether timed frames compute everything again")},
      {"frames", integer("timed frames of a turn")},
      {"warmup", integer("frames before them")},
      {"turns", integer("number of turns")},
      {"bound", boolean("whether the technique's bound was asked for")},
      {"time_size", pairOf("size of the timed frames; 0, 0: as the picture")},
      {"title", text("of the technique with its parameters, for people")},
      {"baseline", boolean("whether other rows of its table are compared with it")},
      {"max_masked_share", number("share of masked pixels beyond which the comparison fails")},
      {"quality",
       object("of the reference", {{"spp", integer("samples per pixel, the most of them if noise is given")},
                                   {"noise", number("RMS relative to the mean that is asked for; 0: none")},
                                   {"bounces", integer("of indirect light")},
                                   {"interfaces", integer("of caustics and specular paths; -1: all")}})},
      {"key", text("16 hexadecimal digits, the same for the same case on the same renderer")},
      {"reference", {}},
      {"provenance", object("hashes of what it was measured with",
                            {{"program", text("the program and limn's libraries")},
                             {"scene", text("every file of the scene")},
                             {"techniques", listOf(object("a module", {{"technique", text("its name")},
                                                                       {"file", text("its file's name")},
                                                                       {"hash", text("its hash")}}),
                                                   "the modules of the techniques")}})},
      {"picture", text("PNG file in the folder of the results")},
      {"difference", text("PNG file of the FLIP difference")},
      {"error", metricsSchema("how wrong it is, over all pixels that are not masked")},
      {"penumbra", metricsSchema("the same over pixels whose reference visibility lies in (0.02, 0.98)")},
      {"misjudged", misjudgedSchema()},
      {"spectrum", listOf({{"type", "number"}}, "radially averaged power of the error, in 32 rings")},
      {"stats", costSchema()},
      {"failure", text("why there is no picture; such a row has no error and no stats")},
      {"renderer", text("of rows without a picture")}});
  static constexpr const char* kOptional[] = {"noise_rms", "seconds"};
  properties["reference"] = object("what it was compared with",
                                   {{"file", text("EXR file in the folder of the results")},
                                    {"noise_rms", number("RMS noise relative to the mean")},
                                    {"seconds", number("that it took on all cores")}},
                                   kOptional);
  return properties;
}

std::string schema(const char* title, const Json& body) {
  Json json = {{"$schema", kDialect}, {"title", title}};
  json.update(body);
  return json.dump(2) + "\n";
}

}  // namespace

std::string rowSchema() {
  Json row = typed("object", "A line of results.jsonl: one picture by one technique.");
  row["properties"] = rowProperties();
  row["required"] = {"scene", "technique", "parameters", "term", "size", "key", "reference"};
  row["oneOf"] = Json::array({{{"required", {"error", "stats"}}}, {{"required", {"failure", "renderer"}}}});
  return schema("limn: a row of results.jsonl", row);
}

std::string statsSchema() {
  return schema("limn: what limn render --stats writes", object("The cost of a frame.", statsProperties()));
}

}  // namespace limn::bench
