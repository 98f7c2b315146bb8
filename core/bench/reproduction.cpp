#include "core/bench/reproduction.h"

#include <fmt/format.h>

#include <algorithm>
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
    "is better. `measured` stands at the suite's settings, with its 95 % interval; `n` is the number of\n"
    "turns in which both were timed. With n = 1 a ratio is refused, since nothing says how far it\n"
    "scatters. `RMSE` is that of both, for visibility in the penumbra; below the noise of a reference it\n"
    "is a bound. `differ in` lists every setting that both sides have and that differs. `at equal error`\n"
    "puts in the first one's place the quickest row of its technique, of the same suite and scene, whose\n"
    "RMSE is not above the second's. Where the rules of several verdicts apply, the later one counts.\n\n";

/// Whether the label contains the part; one with ^ or $ is its beginning or its end.
bool contains(const std::string& name, std::string_view part) {
  if (part.starts_with('^')) return name.starts_with(part.substr(1));
  if (part.ends_with('$')) return name.ends_with(part.substr(0, part.size() - 1));
  return name.find(part) != std::string::npos;
}

/// A row with the rows that answer the same question on the same renderer and machine.
struct Found {
  const Row* row = nullptr;
  const Table* table = nullptr;
};

/// Every row that fits; all have one label, which names neither renderer nor machine.
std::vector<Found> find(std::span<const Table> tables, const std::vector<std::string>& parts) {
  std::vector<Found> found;
  for (const Table& table : tables) {
    for (const Row& row : table.rows) {
      const std::string name = label(row.what);
      const bool fits = row.failure.empty() && std::ranges::all_of(parts, [&](const std::string& part) {
                          return contains(name, part);
                        });
      if (!fits) continue;
      if (!found.empty() && label(found.front().row->what) != name)
        throw Error(fmt::format("two rows fit one claim: {} and {}", label(found.front().row->what), name));
      found.push_back({&row, &table});
    }
  }
  return found;
}

/// As in tables, a row of an earlier version, which does not say its machine, stands with any.
bool sameMachine(const Row& a, const Row& b) {
  return a.cost.renderer == b.cost.renderer &&
         (a.cost.machine == b.cost.machine || a.cost.machine.empty() || b.cost.machine.empty());
}

struct Sides {
  Found slow, fast;
};

/// The last row that fits the second side and has a first side of the same renderer and machine, with the
/// last of these; nothing where there are no such two.
std::optional<Sides> findSides(const Claim& claim, std::span<const Table> tables) {
  const std::vector<Found> slow = find(tables, claim.slow), fast = find(tables, claim.fast);
  for (const Found& second : fast | std::views::reverse)
    for (const Found& first : slow | std::views::reverse)
      if (sameMachine(*first.row, *second.row)) return Sides{first, second};
  return std::nullopt;
}

constexpr int kFewestTurns = 2;

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
  const int turns = pairedTurns(slow, fast);
  const std::string n = fmt::format("{}", turns);
  if (turns < kFewestTurns) return {.text = fmt::format("refused: n = {}", turns), .turns = n};
  const Ratio ratio = frameRatio(slow, fast);
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
  const Row* best = quickest(fast.table->rows, technique, rmse, error.rmse);
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
  return fmt::format("{}{}, {}x{}, {}", c.scene, size, width, height, row.cost.renderer);
}

/// The cells of a claim's line.
struct Answer {
  const Claim& claim;
  std::string measured = "-", turns = "-", errors = "-", differences = "-", atEqualError = "-", verdict,
              at = "-";
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
          settings(*fast.row)};
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

}  // namespace

std::string reproductionMarkdown(std::span<const Claim> claims, std::span<const Row> rows) {
  const std::vector<Table> tables = makeTables(rows);
  std::string markdown = kReading + verdictMarkdown(), chapter;
  std::set<std::string> suites;
  for (const Claim& claim : claims) {
    const std::string current = claim.where.substr(0, claim.where.find('.'));
    if (current != chapter)
      markdown +=
          fmt::format("\n## Chapter {}\n\n{}", markdownText(current), markdownHead(reproductionColumns()));
    chapter = current;
    markdown += markdownRow(reproductionColumns(), answer(claim, tables));
    if (!claim.suite.empty()) suites.insert(claim.suite);
  }
  markdown += "\nMeasured with\n\n```sh\n";
  std::string folders;
  for (const std::string& suite : suites) {
    const std::string folder = shellQuoted("out/" + suite);
    markdown += fmt::format("build/bin/limn bench {} --out {}\n", shellQuoted(suite), folder);
    folders += " " + folder;
  }
  return markdown + fmt::format("build/bin/limn reproduction{} --out docs/reproduction.md\n```\n", folders);
}

}  // namespace limn::bench
