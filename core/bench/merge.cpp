#include "core/bench/merge.h"

#include "core/base/file.h"
#include "core/bench/results_file.h"

namespace limn::bench {
namespace fs = std::filesystem;
namespace {

/// Copies a file that a row names, whole or not at all, unless it is there: its name comes from what is in it
/// or from the row's key.
void bring(const fs::path& from, const fs::path& into, const std::string& name) {
  const fs::path source = fileInFolder(from, name);
  std::error_code error;
  const fs::path relative = fs::path(name).lexically_normal();
  if (source.empty() || relative.is_absolute() || *relative.begin() == ".." ||
      fs::exists(into / relative, error))
    return;
  createFolder((into / relative).parent_path());
  writeFile(into / relative, readFile(source));
}

}  // namespace

int mergeResults(const fs::path& from, const fs::path& into) {
  ResultsFile results(into / "results.jsonl");
  int appended = 0;
  for (const Row& row : readRows(from / "results.jsonl")) {
    const Row* known = results.find(row.key);
    if (known != nullptr && (known->failure.empty() || !row.failure.empty())) continue;
    for (const std::string& file : {row.referenceFile, row.picture, row.difference, referencePicture(row)})
      bring(from, into, file);
    results.append(row);
    ++appended;
  }
  return appended;
}

}  // namespace limn::bench
