#include "core/bench/merge.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/base/file.h"
#include "core/bench/results_file.h"

namespace limn::bench {
namespace fs = std::filesystem;
namespace {

/// Copies a file with that extension which a row names, whole or not at all. Any other file might take the
/// place of one of the folder's own, such as its rows.
void bring(const fs::path& from, const fs::path& into, const std::string& name, const char* extension) {
  const fs::path source = fileInFolder(from, name);
  const fs::path relative = fs::path(name).lexically_normal();
  if (source.empty() || relative.is_absolute() || *relative.begin() == ".." ||
      relative.extension() != extension)
    return;
  createFolder((into / relative).parent_path());
  writeFile(into / relative, readFile(source));
}

/// Whether `row` is to take the place of `known`. Each such step leads to a row that is valid where the one
/// before was not, else to a good one, else to one of more turns, else to one with a picture, so that merging
/// again changes nothing. Of two good rows that others than the present program measured, nothing says which
/// is newer.
bool replaces(const Row& row, const Row& known, const std::function<Provenance(const Case&)>& provenance) {
  const bool sameOrigin = staleness(known.provenance, row.provenance).empty();
  if (!sameOrigin && provenance) {
    const Provenance now = provenance(row.what);
    const bool valid = staleness(row.provenance, now).empty();
    if (valid != staleness(known.provenance, now).empty()) return valid;
  }
  if (!row.failure.empty()) return false;
  const auto rank = [](const Row& of) { return std::pair(of.cost.frameMs.turns, !of.picture.empty()); };
  return !known.failure.empty() || (sameOrigin && rank(row) > rank(known));
}

/// The rows of a folder in the order of their first appearance, but those of a program behind those of one
/// that measured nothing after it: tables take the last line for the newest row.
std::vector<Row> rowsByAge(const fs::path& folder) {
  std::vector<Row> rows = readRows(folder / "results.jsonl");
  std::map<std::string, std::size_t> last;  // line of a program
  for (const Row& row : rows) {
    std::size_t& line = last[row.provenance.program];
    line = std::max(line, row.line);
  }
  std::ranges::stable_sort(rows, {}, [&](const Row& row) { return last.at(row.provenance.program); });
  return rows;
}

/// Appends what one folder has to the rows of `into`, which are `results`; lastOther: the last line of what
/// another version measured.
int mergeFolder(const fs::path& from, const fs::path& into, ResultsFile& results,
                const std::function<Provenance(const Case&)>& provenance, std::size_t& lastOther) {
  int appended = 0;
  for (const Row& row : rowsByAge(from)) {
    const Row* known = results.find(row.key);
    if (known != nullptr && !replaces(row, *known, provenance)) continue;
    std::error_code error;
    // References have names by what is in them, pictures by the row's key.
    for (const auto& [file, extension] :
         {std::pair(row.referenceFile, ".exr"), {referencePicture(row), ".png"}})
      if (!fs::exists(into / file, error)) bring(from, into, file, extension);
    for (const std::string& file : {row.picture, row.difference}) bring(from, into, file, ".png");
    results.append(row);
    if (provenance && !row.provenance.program.empty() &&
        !staleness(row.provenance, provenance(row.what)).empty())
      lastOther = results.find(row.key)->line;
    ++appended;
  }
  return appended;
}

/// Writes rows before that line once more that are valid now: tables would take what was brought from another
/// folder for newer.
void putValidLast(ResultsFile& results, const std::function<Provenance(const Case&)>& provenance,
                  std::size_t lastOther) {
  std::vector<std::string> valid;
  for (const Row& row : results.rows())
    if (row.line < lastOther && staleness(row.provenance, provenance(row.what)).empty())
      valid.push_back(row.key);
  for (const std::string& key : valid) results.append(*results.find(key));
}

}  // namespace

int mergeResults(std::span<const fs::path> from, const fs::path& into,
                 const std::function<Provenance(const Case&)>& provenance) {
  ResultsFile results(into / "results.jsonl");  // read once: a sweep has hundreds of parts
  int appended = 0;
  std::size_t lastOther = 0;
  for (const fs::path& folder : from) appended += mergeFolder(folder, into, results, provenance, lastOther);
  if (lastOther > 0) putValidLast(results, provenance, lastOther);
  return appended;
}

}  // namespace limn::bench
