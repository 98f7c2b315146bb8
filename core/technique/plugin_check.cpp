#include "core/technique/private/plugin_check.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/text.h"

namespace limn {
namespace {

constexpr size_t kMostEntries = 1000;  // beyond this a table is a mistake

/// Reads the text to its end, so that a wild pointer does its harm where the module is tried.
bool isText(const char* text) {
  constexpr size_t longest = size_t{1} << 24;
  return text && strnlen(text, longest) < longest;
}

/// Letters, digits, '_' and '-'.
bool isIdentifier(const char* text) {
  constexpr const char* accepted = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return text && *text != 0 && text[std::strspn(text, accepted)] == 0;
}

std::string choicesProblem(const Parameter& p) {
  if (!p.choices || p.choiceCount < 1 || static_cast<size_t>(p.choiceCount) > kMostEntries)
    return "has no choices";
  for (int i = 0; i < p.choiceCount; ++i)
    if (!isText(p.choices[i])) return fmt::format("has no name for choice {}", i);
  if (p.range.low != 0 || p.range.high != p.choiceCount - 1) return "has another range than its choices";
  return {};
}

/// ParameterValues::integer() returns an int.
std::string wholeProblem(const Parameter& p) {
  constexpr double least = std::numeric_limits<int>::min(), most = std::numeric_limits<int>::max();
  for (const double value : {p.range.low, p.range.high, p.defaultValue})
    if (!(value >= least && value <= most) || value != std::floor(value))
      return fmt::format("has {} where a whole number of 32 bits is expected", value);
  return {};
}

std::string parameterProblem(const Parameter& p) {
  if (!isText(p.unit) || !isText(p.doc)) return "has no unit or description";
  if (p.forcing && !isText(p.forcing)) return "has no end to its forcing value";
  if (!(p.range.low <= p.range.high) || !std::isfinite(p.range.low) || !std::isfinite(p.range.high))
    return fmt::format("has the range {}..{}", p.range.low, p.range.high);
  if (!(p.defaultValue >= p.range.low && p.defaultValue <= p.range.high))
    return fmt::format("has the default {} outside of {}..{}", p.defaultValue, p.range.low, p.range.high);
  switch (p.type) {
    case ParameterType::boolean:
    case ParameterType::real:
      return {};
    case ParameterType::integer:
      return wholeProblem(p);
    case ParameterType::choice:
      return choicesProblem(p);
  }
  return "is of an unknown type";
}

std::string termsProblem(TermSet terms) {
  constexpr TermSet known = termsWhere([](const TermInfo&) { return true; });
  if (terms == 0 || (terms & ~known) != 0)
    return fmt::format("it answers the terms {:#x}, which are none or not known", terms);
  if (const TermSet foreign = terms & ~kAnswerableTerms)
    return fmt::format("it answers {}, which is not for techniques to answer", joined(termNames(foreign)));
  return {};
}

std::string parametersProblem(std::span<const Parameter> parameters) {
  if (parameters.size() > kMostEntries || (!parameters.empty() && !parameters.data()))
    return fmt::format("it declares {} parameters", parameters.size());
  for (size_t i = 0; i < parameters.size(); ++i) {
    if (!isIdentifier(parameters[i].name)) return fmt::format("its parameter {} has no name", i);
    for (size_t j = 0; j < i; ++j)
      if (std::strcmp(parameters[i].name, parameters[j].name) == 0)
        return fmt::format("it declares parameter {} twice", parameters[i].name);
    if (const std::string problem = parameterProblem(parameters[i]); !problem.empty())
      return fmt::format("its parameter {} {}", parameters[i].name, problem);
  }
  return {};
}

std::string stressProblem(std::span<const StressCase> cases) {
  if (cases.size() > kMostEntries || (!cases.empty() && !cases.data()))
    return fmt::format("it declares {} stability cases", cases.size());
  for (size_t i = 0; i < cases.size(); ++i)
    if (!isText(cases[i].name) || !isText(cases[i].scene) || !isText(cases[i].settings) ||
        !isText(cases[i].beside))
      return fmt::format("its stability case {} has no name, scene, settings or technique beside it", i);
  return {};
}

std::string sourcesProblem(std::span<const gpu::EmbeddedSource> sources) {
  if (sources.size() > kMostEntries || (!sources.empty() && !sources.data()))
    return fmt::format("it brings {} shader files", sources.size());
  for (size_t i = 0; i < sources.size(); ++i)
    if (!isText(sources[i].path) || !isText(sources[i].text))
      return fmt::format("its shader file {} has no name or text", i);
  return {};
}

}  // namespace

std::string pluginProblem(const TechniquePlugin& plugin, std::string_view name) {
  if (!plugin.info) return "it gives no TechniqueInfo";
  if (!plugin.sources || !plugin.create) return "it gives no function for its shaders or none that makes it";
  const TechniqueInfo& info = *plugin.info;
  if (!isIdentifier(info.name)) return "it gives no name";
  if (info.name != name) return fmt::format("it calls itself {:.64}", info.name);
  if (!isText(info.title) || !isText(info.source)) return "it gives no title or source";
  if (std::string problem = termsProblem(info.terms); !problem.empty()) return problem;
  if (std::string problem = parametersProblem(info.parameters); !problem.empty()) return problem;
  if (std::string problem = stressProblem(info.stress); !problem.empty()) return problem;
  return sourcesProblem(plugin.sources());
}

}  // namespace limn
