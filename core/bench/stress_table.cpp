// Writes and reads the stress table: a row for each case, whose figures are those of the term that did worst.
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/error.h"
#include "core/bench/private/columns.h"
#include "core/bench/private/markdown.h"
#include "core/bench/private/provenance_json.h"
#include "core/bench/stress.h"
#include "core/image/metric_table.h"

namespace limn::bench {
namespace {

using Json = nlohmann::ordered_json;

StressVerdict verdictFrom(const std::string& text) {
  for (const StressVerdict verdict :
       {StressVerdict::pass, StressVerdict::degraded, StressVerdict::refused, StressVerdict::failed})
    if (text == name(verdict)) return verdict;
  throw Error(fmt::format("verdict '{}' is unknown; expected pass, degraded, refused or failed", text));
}

bool isMeasured(const StressAnswer& answer) {
  return answer.verdict == StressVerdict::pass || answer.verdict == StressVerdict::degraded;
}

/// The factor, or the verdict where there is none.
std::string factorText(const StressResult& result, const StressAnswer& answer) {
  if (!isMeasured(answer)) return name(answer.verdict);
  return result.allowed > 0 ? fmt::format("{:.2f}", answer.factor) : "-";
}

/// The worst term, and the others with their factors: "indirect (visibility 1.00, environment 1.02)".
std::string termText(const StressResult& result) {
  std::string others;
  for (std::size_t i = 1; i < result.answers.size(); ++i)
    others += fmt::format("{}{} {}", others.empty() ? "" : ", ", result.answers[i].term,
                          factorText(result, result.answers[i]));
  return others.empty() ? result.worst().term : fmt::format("{} ({})", result.worst().term, others);
}

/// What distinguishes the case: "four steps (steps=4, beside airlight)".
std::string caseText(const StressResult& result) {
  std::string details = result.settings;
  if (!result.beside.empty())
    details += fmt::format("{}beside {}", details.empty() ? "" : ", ", result.beside);
  return details.empty() ? result.name : fmt::format("{} ({})", result.name, details);
}

/// Results stand in the order in which they were measured.
NewestProvenance newestOfResults(std::span<const StressResult> results) {
  NewestProvenance newest;
  for (const StressResult& result : results) newest.add(result.scene, result.provenance);
  return newest;
}

std::vector<MarkdownColumn<StressResult>> stressColumns() {
  static constexpr const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  const auto isBounded = [](const StressResult& r) { return isMeasured(r.worst()) && r.allowed > 0; };
  return {
      {{headOf("technique"), Align::left}, [](const StressResult& r) { return r.technique; }},
      {{"case", Align::left}, caseText},
      {{headOf("scene"), Align::left}, [](const StressResult& r) { return r.scene; }},
      {{"verdict", Align::left},
       [](const StressResult& r) {
         const StressAnswer& a = r.worst();
         return a.message.empty() ? name(a.verdict) : fmt::format("{}: {}", name(a.verdict), a.message);
       }},
      {{"term that counts (others)", Align::left}, termText},
      {{std::string(rmse.head)},
       [](const StressResult& r) { return isMeasured(r.worst()) ? shownText(rmse, r.worst().error) : "-"; }},
      {{fmt::format("{} unchanged", rmse.head)},
       [](const StressResult& r) { return shownText(rmse, r.worst().benign); }},
      {{"factor"}, [=](const StressResult& r) { return isBounded(r) ? factorText(r, r.worst()) : "-"; }},
      {{"allowed"},
       [=](const StressResult& r) { return isBounded(r) ? fmt::format("{:.1f}", r.allowed) : "-"; }},
  };
}

Json toJson(const StressAnswer& answer) {
  return {{"term", answer.term},     {"verdict", name(answer.verdict)}, {"error", answer.error},
          {"benign", answer.benign}, {"factor", answer.factor},         {"message", answer.message}};
}

StressAnswer answerFrom(const Json& json) {
  return {.term = json.at("term"),
          .verdict = verdictFrom(json.at("verdict")),
          .error = json.at("error"),
          .benign = json.at("benign"),
          .factor = json.at("factor"),
          .message = json.at("message")};
}

}  // namespace

const char* name(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::pass:
      return "pass";
    case StressVerdict::degraded:
      return "degraded";
    case StressVerdict::refused:
      return "refused";
    case StressVerdict::failed:
      break;
  }
  return "failed";
}

const StressAnswer& StressResult::worst() const {
  static const StressAnswer none;
  return answers.empty() ? none : answers.front();
}

std::string toMarkdown(std::span<const StressResult> results) {
  const NewestProvenance newest = newestOfResults(results);
  bool mixed = false;
  std::vector<MarkdownColumn<StressResult>> columns = stressColumns();
  columns.front().cell = [&](const StressResult& r) {
    const bool outdated = newest.differs(r.scene, r.provenance);
    mixed |= outdated;
    return outdated ? r.technique + " \u2020" : r.technique;
  };
  const std::string table = markdownTable(columns, results);
  return mixed ? table +
                     "\n\u2020 measured with another version of the program, of a technique or of the scene "
                     "than the newest case\n"
               : table;
}

std::string toJson(std::span<const StressResult> results, const std::string& renderer) {
  Json list = Json::array();
  for (const StressResult& r : results) {
    Json answers = Json::array();
    for (const StressAnswer& answer : r.answers) answers.push_back(toJson(answer));
    list.push_back({{"technique", r.technique},
                    {"case", r.name},
                    {"scene", r.scene},
                    {"settings", r.settings},
                    {"beside", r.beside},
                    {"own", r.own},
                    {"allowed", r.allowed},
                    {"answers", std::move(answers)}});
    if (!r.provenance.program.empty()) list.back()["provenance"] = provenanceToJson(r.provenance);
  }
  return Json{{"renderer", renderer}, {"results", list}}.dump(1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

std::vector<StressResult> stressFromJson(const std::string& text, const std::string& renderer) {
  try {
    const auto json = Json::parse(text);
    std::vector<StressResult> results;
    if (const std::string& other = json.at("renderer").get_ref<const std::string&>(); other != renderer)
      throw Error(fmt::format("holds results of {}, not of {}; take another folder", other, renderer));
    for (const Json& r : json.at("results")) {
      if (!r.contains("answers")) continue;
      StressResult result{.technique = r.at("technique"),
                          .name = r.at("case"),
                          .scene = r.at("scene"),
                          .settings = r.at("settings"),
                          .beside = r.value("beside", ""),
                          .own = r.at("own"),
                          .allowed = r.at("allowed")};
      for (const Json& answer : r.at("answers")) result.answers.push_back(answerFrom(answer));
      if (r.contains("provenance")) result.provenance = provenanceFromJson(r["provenance"]);
      results.push_back(std::move(result));
    }
    return results;
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("not what limn stress writes: {}", error.what()));
  }
}

}  // namespace limn::bench
