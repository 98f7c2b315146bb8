#include "core/bench/suite.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/question/question_fields.h"

namespace limn::bench {

namespace {

/// In the order of keys; labels begin with the last.
constexpr QuestionGroup kDescribed[] = {QuestionGroup::environment, QuestionGroup::subject,
                                        QuestionGroup::medium, QuestionGroup::changes};

}  // namespace

std::string question(const Case& c) {
  std::string text = fmt::format("{}/spp{}/noise{}/bounces{}", subjectText(c, QuestionWording::key),
                                 c.reference.spp, c.reference.noise, c.reference.bounces);
  if (c.reference.interfaces != 0) text += fmt::format("/interfaces{}", c.reference.interfaces);
  for (const QuestionGroup group : kDescribed)
    if (const std::string words = describe(c, group); !words.empty()) text += "/" + words;
  // All light together is asked of the map itself.
  if (!c.light.empty()) text += describeEnvironmentLights(c);
  return text;
}

std::string label(const Case& c) {
  const std::string timed =
      c.timeWidth > 0 ? fmt::format(" times at {}x{}", c.timeWidth, c.timeHeight) : std::string();
  std::string text = fmt::format("{}{}/{}/{}", subjectText(c, QuestionWording::label), timed,
                                 c.dynamic ? "dynamic" : "static", c.technique);
  const auto begin = [&text](const std::string& words) {
    if (!words.empty()) text = words + "/" + text;
  };
  for (const QuestionGroup group : kDescribed) {
    begin(describe(c, group, QuestionWording::label));
    if (group != QuestionGroup::subject) continue;
    if (c.fps > 0) begin(fmt::format("{} fps", c.fps));
    if (c.environmentLights > 0) begin("environment lights " + describeEnvironmentLights(c));
  }
  char separator = '?';
  for (const auto& [name, value] : c.parameters) {
    text += fmt::format("{}{}={}", separator, name, value);
    separator = '&';
  }
  return text;
}

std::string rowKey(const Case& c, std::string_view renderer) {
  // Separators that no name contains keep different cases different.
  std::string text = fmt::format("{}\x1f{}\x1f{}\x1f{}\x1f{}\x1f{}", question(c), c.technique, c.dynamic,
                                 c.frames, c.warmup, renderer);
  for (const auto& [name, value] : c.parameters) text += fmt::format("\x1e{}\x1f{}", name, value);
  if (c.timeWidth > 0) text += fmt::format("\x1d{}x{}", c.timeWidth, c.timeHeight);
  if (c.fps > 0) text += fmt::format("\x1b{}", c.fps);
  if (c.bound) text += "\x1a";
  if (c.environmentLights > 0) text += "\x1c" + describeEnvironmentLights(c);
  return fmt::format("{:016x}", XXH3_64bits(text.data(), text.size()));
}

Shard parseShard(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = parseWhole<int>(text.substr(0, slash));
  const auto count = slash < text.size() ? parseWhole<int>(text.substr(slash + 1)) : std::nullopt;
  if (!index || !count || *index < 1 || *index > *count)
    throw UsageError(fmt::format("--shard '{}': i/n with 1 <= i <= n is accepted, such as 2/4", text));
  return {*index, *count};
}

std::vector<int> partsOf(std::span<const Case> cases, int count) {
  std::map<std::string, int> questions;  // in order of appearance
  std::vector<int> positions;
  for (const Case& c : cases)
    positions.push_back(questions.emplace(question(c), static_cast<int>(questions.size())).first->second);
  if (static_cast<int>(questions.size()) < count) std::iota(positions.begin(), positions.end(), 0);
  for (int& position : positions) position = position % count + 1;
  return positions;
}

std::vector<Case> selectCases(std::span<const Case> cases, std::span<const std::string> filters,
                              Shard shard) {
  std::vector<Case> matching;
  for (const Case& c : cases) {
    const std::string text = label(c);
    if (std::all_of(filters.begin(), filters.end(),
                    [&](const std::string& filter) { return text.find(filter) != std::string::npos; })) {
      matching.push_back(c);
    }
  }
  const std::vector<int> parts = partsOf(matching, shard.count);
  std::vector<Case> selected;
  for (std::size_t i = 0; i < matching.size(); ++i)
    if (parts[i] == shard.index) selected.push_back(matching[i]);
  return selected;
}

}  // namespace limn::bench
