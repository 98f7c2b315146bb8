#include "core/bench/reproduction.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <ranges>
#include <set>

#include "core/base/error.h"
#include "core/base/shell.h"
#include "core/bench/private/comparison.h"
#include "core/bench/private/differing_settings.h"
#include "core/bench/private/markdown.h"
#include "core/bench/private/verdict.h"
#include "core/bench/tables.h"

namespace limn::bench {
namespace {

constexpr const char* kReading =
    "Each line compares a first and a second row of results. `thesis` and `measured` say how many times\n"
    "as long the first one's frame takes (or how many times as much memory), so that above 1 the second\n"
    "is better. `measured` stands at the suite's settings, with its 95 % interval; `n` is the smaller\n"
    "number of turns of the two. With n = 1 a ratio is refused, since nothing says how far it\n"
    "scatters. `RMSE` is that of both, for visibility in the penumbra; below the noise of a reference it\n"
    "is a bound. `differ in` lists every setting that both sides have and that differs, whether it takes\n"
    "effect or not. `at equal error` puts in the first one's place the quickest row of its technique in\n"
    "the second's table (one scene, size, reference and machine) whose RMSE is not above the second's, of\n"
    "those that the newest version measured where there are any.\n"
    "Where the rules of several verdicts apply, the later one counts. `at` is the second row's scene\n"
    "and size with renderer and machine.\n\n";

/// Whether the label contains the part; one with ^ or $ is its beginning or its end.
bool contains(const std::string& name, std::string_view part) {
  if (part.starts_with('^')) return name.starts_with(part.substr(1));
  if (part.ends_with('$')) return name.ends_with(part.substr(0, part.size() - 1));
  return name.find(part) != std::string::npos;
}

/// A row with the rows that answer the same question on the same renderer, machine and driver.
struct Found {
  const Row* row = nullptr;
  const Table* table = nullptr;
};

/// Every row that fits, the newest last; all have one label, which names neither renderer nor machine.
std::vector<Found> find(std::span<const Table> tables, const std::vector<std::string>& parts) {
  std::vector<Found> found;
  for (const Table& table : tables) {
    for (const Row& row : table.rows) {
      const std::string name = label(row.what);
      if (!std::ranges::all_of(parts, [&](const std::string& part) { return contains(name, part); }))
        continue;
      if (!found.empty() && label(found.front().row->what) != name)
        throw Error(fmt::format("two rows fit one claim: {} and {}", label(found.front().row->what), name));
      found.push_back({&row, &table});
    }
  }
  std::ranges::stable_sort(found, {}, [](const Found& f) { return f.row->line; });
  return found;
}

struct Sides {
  Found slow, fast;
};

/// The last row that fits the second side and has a first side of the same renderer and machine, with the
/// last of these; a claim of times takes untimed rows only where there are no such two that are timed.
/// Nothing where there are no such two at all.
std::optional<Sides> findSides(const Claim& claim, std::span<const Table> tables) {
  const std::vector<Found> slow = find(tables, claim.slow), fast = find(tables, claim.fast);
  std::optional<Sides> untimed;
  for (const Found& second : fast | std::views::reverse)
    for (const Found& first : slow | std::views::reverse) {
      if (!sameMachine(*first.row, *second.row)) continue;
      if (claim.measure == ClaimMeasure::memory || (isTimed(*first.row) && isTimed(*second.row)))
        return Sides{first, second};
      if (!untimed) untimed = Sides{first, second};
    }
  return untimed;
}

/// Two rows side by side: how they are shown, and what they say of the thesis's ratio.
struct Pair {
  std::string text;
  std::string turns = "-";
  Verdict verdict = Verdict::notMeasured;
  std::string withTurns() const {
    return verdict == Verdict::notMeasured ? text : fmt::format("{}, n = {}", text, turns);
  }
};

Pair byFrames(double thesis, const Row& slow, const Row& fast) {
  if (!isTimed(slow) || !isTimed(fast) || !(fast.cost.frameMs.median > 0)) return {.text = "not timed"};
  const Ratio ratio = frameRatio(slow, fast);
  const std::string n = fmt::format("{}", ratio.turns);
  if (ratio.turns < kFewestTurns) return {.text = fmt::format("refused: n = {}", n), .turns = n};
  return {ratioText(ratio), n, judged(thesis, ratio)};
}

/// Bytes do not scatter.
Pair byMemory(double thesis, const Row& slow, const Row& fast) {
  const double ratio = static_cast<double>(slow.cost.memoryBytes) /
                       static_cast<double>(std::max<std::int64_t>(1, fast.cost.memoryBytes));
  return {ratioText(ratio), "-", judged(thesis, {ratio, ratio, ratio})};
}

/// What is to be shown of the ratio at equal error, and its verdict, where there is one.
struct EqualError {
  std::string text;
  std::optional<Verdict> verdict = {};
};

EqualError atEqualError(const Claim& claim, const Row& slow, const Found& fast) {
  if (claim.measure == ClaimMeasure::memory) return {"-: a claim of memory"};
  const std::string& technique = slow.what.technique;
  if (technique == fast.row->what.technique) return {"-: two settings of one technique"};
  const Metrics& error = errorOf(*fast.row);
  if (error.noise_floor && error.rmse < *error.noise_floor)
    return {"-: the reference's noise hides the errors"};
  constexpr const MetricInfo& rmse = metricInfo(&Metrics::rmse);
  const Row* best = quickest(*fast.table, technique, rmse, *fast.row);
  if (best == nullptr) return {fmt::format("-: no row of {} reaches {}", technique, shownText(rmse, error))};
  const Pair pair = byFrames(claim.thesis, *best, *fast.row);
  return {fmt::format("{}: {}; differ in {}", pair.withTurns(), settingsName(*best),
                      differingSettings(*best, *fast.row)),
          pair.verdict};
}

const char* name(ClaimMeasure measure) {
  return measure == ClaimMeasure::frame ? "frame" : "memory";
}

std::string settings(const Row& row) {
  const Case& c = row.what;
  const int width = c.timeWidth > 0 ? c.timeWidth : c.width,
            height = c.timeWidth > 0 ? c.timeHeight : c.height;
  std::string size = c.lightSize > 0 ? fmt::format(", light {}", c.lightSize) : "";
  std::string machine = row.cost.machine.empty() ? "" : ", " + row.cost.machine;
  return fmt::format("{}{}, {}x{}, {}{}", c.scene, size, width, height, row.cost.renderer, machine);
}

/// The cells of a claim's line.
struct Answer {
  const Claim& claim;
  std::string measured = "-", turns = "-", errors = "-", differences = "-", atEqualError = "-", verdict,
              at = "-";
  bool answered = false;  ///< there are two rows, whatever they say
};

Answer answer(const Claim& claim, std::span<const Table> tables) {
  if (!claim.because.empty()) {
    return {
        .claim = claim,
        .verdict = fmt::format("{}, because {}", verdictInfo(Verdict::notReproduced).name, claim.because)};
  }
  const std::optional<Sides> sides = findSides(claim, tables);
  if (!sides) return {.claim = claim, .verdict = verdictInfo(Verdict::notMeasured).name};
  const auto& [slow, fast] = *sides;
  const auto measure = claim.measure == ClaimMeasure::memory ? byMemory : byFrames;
  const Pair pair = measure(claim.thesis, *slow.row, *fast.row);
  const EqualError equal = atEqualError(claim, *slow.row, fast);
  const auto rmse = [](const Row& row) { return shownText(metricInfo(&Metrics::rmse), errorOf(row)); };
  return {claim,
          pair.text,
          pair.turns,
          fmt::format("{} / {}", rmse(*slow.row), rmse(*fast.row)),
          differingSettings(*slow.row, *fast.row),
          equal.text,
          verdictInfo(judged(pair.verdict, equal.verdict)).name,
          settings(*fast.row),
          true};
}

const std::vector<MarkdownColumn<Answer>>& reproductionColumns() {
  static const std::vector<MarkdownColumn<Answer>> columns = {
      {{"thesis", Align::left}, [](const Answer& a) { return a.claim.where; }},
      {{"comparison", Align::left}, [](const Answer& a) { return a.claim.what; }},
      {{"of", Align::left},
       [](const Answer& a) -> std::string { return a.claim.because.empty() ? name(a.claim.measure) : "-"; }},
      {{"thesis"}, [](const Answer& a) { return a.claim.thesis > 0 ? ratioText(a.claim.thesis) : "-"; }},
      {{"measured"}, [](const Answer& a) { return a.measured; }},
      {{"n"}, [](const Answer& a) { return a.turns; }},
      {{"RMSE"}, [](const Answer& a) { return a.errors; }},
      {{"differ in", Align::left}, [](const Answer& a) { return a.differences; }},
      {{"at equal error", Align::left}, [](const Answer& a) { return a.atEqualError; }},
      {{"verdict", Align::left}, [](const Answer& a) { return a.verdict; }},
      {{"at", Align::left}, [](const Answer& a) { return a.at; }}};
  return columns;
}

std::string verdictMarkdown() {
  static const std::vector<MarkdownColumn<VerdictInfo>> columns = {
      {{"verdict", Align::left}, [](const VerdictInfo& v) -> std::string { return v.name; }},
      {{"rule", Align::left}, [](const VerdictInfo& v) -> std::string { return v.rule; }}};
  return markdownTable(columns, kVerdicts);
}

std::string benchCommands(const std::set<std::string>& suites) {
  std::string commands;
  for (const std::string& suite : suites)
    commands +=
        fmt::format("build/bin/limn bench {} --out {}\n", shellQuoted(suite), shellQuoted("out/" + suite));
  return commands;
}

/// The commands that give these rows and their page, and those of the suites that have none here. The page
/// of a run is written beside its rows, so that it does not take the place of a published one.
std::string commandMarkdown(const std::set<std::string>& measured, const std::set<std::string>& missing) {
  std::string markdown;
  if (!measured.empty()) {
    std::string folders;
    for (const std::string& suite : measured) folders += " " + shellQuoted("out/" + suite);
    markdown += fmt::format(
        "\nMeasured with\n\n```sh\n{}build/bin/limn reproduction{} --out out/reproduction.md\n```\n",
        benchCommands(measured), folders);
  }
  if (!missing.empty())
    markdown += fmt::format("\nTo measure what is missing\n\n```sh\n{}```\n", benchCommands(missing));
  return markdown;
}

}  // namespace

std::string reproductionMarkdown(std::span<const Claim> claims, std::span<const Row> rows) {
  std::vector<Row> good;  // a later failure says nothing against what was measured
  std::ranges::copy_if(rows, std::back_inserter(good), [](const Row& row) { return row.failure.empty(); });
  const std::vector<Table> tables = makeTables(good);
  std::string markdown = kReading + verdictMarkdown(), chapter;
  std::set<std::string> measured, missing;
  for (const Claim& claim : claims) {
    const std::string current = claim.where.substr(0, claim.where.find('.'));
    if (current != chapter)
      markdown +=
          fmt::format("\n## Chapter {}\n\n{}", markdownText(current), markdownHead(reproductionColumns()));
    chapter = current;
    const Answer found = answer(claim, tables);
    markdown += markdownRow(reproductionColumns(), found);
    if (!claim.suite.empty()) (found.answered ? measured : missing).insert(claim.suite);
  }
  for (const std::string& suite : measured) missing.erase(suite);
  return markdown + commandMarkdown(measured, missing);
}

}  // namespace limn::bench
