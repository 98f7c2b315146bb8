#include "apps/limn/results_folder.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/limn/worker.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/bench/machine.h"
#include "core/bench/report.h"
#include "core/bench/tables.h"
#include "core/image/image.h"
#include "core/session/bench_session.h"
#include "core/session/case_origins.h"
#include "core/session/suite_check.h"

namespace limn::app {
namespace fs = std::filesystem;

namespace {

/// Cases on their way into a folder of results.
class CaseWork {
 public:
  CaseWork(const std::vector<bench::Case>& cases, const fs::path& out, const BackendOptions& backend,
           double stallTimeout, const std::string& progressName = {}, Measured counts = Measured::anywhere)
      : cases_(cases),
        out_(out),
        file_(out / "results.jsonl"),
        backend_(backend),
        stallTimeout_(stallTimeout),
        progressName_(progressName),
        counts_(counts),
        report_(cases.size()) {
    for (std::size_t i = 0; i < cases.size(); ++i) left_.push_back(i);
  }

  /// Throws UsageError when something is missing that an unfinished case needs; it says the last such thing,
  /// stderr the others. Throws Error when pictures are to be kept and cannot be written.
  void check() {
    // What crashes here crashes in its own row again.
    runInWorker(report_, stallTimeout_, [&] {
      const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
      session::CaseOrigins origins(registry);
      const auto rows = fs::exists(file_) ? bench::readRows(file_) : std::vector<bench::Row>();
      const auto unfinished =
          bench::unfinishedCases(cases_, rows, [&](const bench::Case& c) { return origins.of(c); });
      const auto missing = session::missingThings(
          unfinished, registry, [&] { report_.alive(); }, warn);
      for (std::size_t i = 0; i + 1 < missing.size(); ++i) sayError(missing[i]);
      if (!missing.empty()) throw UsageError(missing.back());
      if (std::ranges::any_of(unfinished, &bench::Case::picture)) loadPictureLibrary();
    });
  }

  bench::Summary run() {
    while (!left_.empty()) {
      const auto crash = runInWorker(report_, stallTimeout_, [&] { measure(); });
      if (!crash) break;
      recordCrash(crash->what);
    }
    bench::Summary summary;
    for (std::size_t i = 0; i < cases_.size(); ++i) {
      const WorkerReport::State state = report_.state(i);
      ++(state == WorkerReport::State::skipped ? summary.skipped
         : state == WorkerReport::State::done  ? summary.done
                                               : summary.failed);
    }
    if (fs::exists(file_))
      summary.shortened = bench::shortenedRows(cases_, report_.renderer(), bench::readRows(file_));
    return summary;
  }

  std::string renderer() const { return report_.renderer(); }

  /// Whether each case failed, in their order.
  std::vector<bool> failed() const {
    std::vector<bool> failed;
    for (std::size_t i = 0; i < cases_.size(); ++i)
      failed.push_back(report_.state(i) == WorkerReport::State::failed ||
                       report_.state(i) == WorkerReport::State::open);
    return failed;
  }

 private:
  /// In the worker: measures what there is no row for.
  void measure() {
    bench::ResultsFile results(file_);
    session::BenchSession benchSession(
        backend_.contextOptions(), out_, [this] { report_.alive(); }, warn);
    session::CaseOrigins origins(benchSession.registry());
    report_.renderer(benchSession.rendererName());
    std::vector<bench::Case> cases;
    for (const std::size_t i : left_) cases.push_back(cases_[i]);
    const auto provenance = [&](const bench::Case& c) { return origins.of(c); };
    if (left_.size() == cases_.size())  // not after a crash, when it has been said
      sayStale(bench::staleRows(cases, benchSession.rendererName(), results, provenance));
    Progress bar(progressName_);
    bench::Callbacks callbacks;
    callbacks.provenance = provenance;
    callbacks.machine = bench::machineName();
    callbacks.driver = benchSession.driverName();
    callbacks.hereAlone = counts_ == Measured::here;
    callbacks.reference = [&](const bench::Case& c) { return benchSession.reference(c); };
    callbacks.measure = [&](const bench::Case& c) { return benchSession.measure(c); };
    callbacks.time = [&](const bench::Case& c) { return benchSession.time(c); };
    callbacks.bound = [&](const bench::Case& c) { return benchSession.bound(c); };
    callbacks.keepPicture = [&](const std::string& name, const Image& image) {
      return benchSession.keepPicture(name, image);
    };
    callbacks.progress = [&](const bench::Progress& progress) {
      tell(progress);
      bar.update((progress.turn - 1 + double(progress.place) / progress.count) / progress.turns,
                 bench::label(progress.what));
      if (progress.state != bench::Progress::State::failed) return;
      benchSession.forgetScene();
      sayError(fmt::format("{}: {}", bench::label(progress.what), progress.failure));
    };
    bench::runCases(cases, benchSession.rendererName(), results, callbacks);
  }

  static void sayStale(const std::map<std::string, int>& reasons) {
    if (reasons.empty()) return;
    int count = 0;
    std::string why;
    for (const auto& [reason, rows] : reasons) {
      count += rows;
      why += fmt::format("{}{} ({})", why.empty() ? "" : ", ", reason, rows);
    }
    fmt::print(stderr, "limn: {} rows are measured again: {}\n", count, why);
  }

  void tell(const bench::Progress& progress) {
    using State = bench::Progress::State;
    const std::size_t index = left_[static_cast<std::size_t>(progress.index)];
    if (progress.state == State::started) return report_.started(index);
    if (progress.turn > 1) return;  // a turn that fails leaves the row as it is
    report_.finished(index, progress.state == State::skipped ? WorkerReport::State::skipped
                            : progress.state == State::done  ? WorkerReport::State::done
                                                             : WorkerReport::State::failed);
  }

  /// A row for the case that ended the worker, unless it has a good one of this program. Neither it nor what
  /// failed before it is tried again in this run.
  void recordCrash(const std::string& what) {
    const auto current = report_.current();
    if (!current) throw Error("no case could be started by the process that measures: " + what);
    const bench::Case& c = cases_[*current];
    sayError(fmt::format("{}: {}", bench::label(c), what));
    std::erase_if(left_, [&](std::size_t i) {
      return i == *current || report_.state(i) == WorkerReport::State::failed;
    });
    const WorkerReport::State state = report_.state(*current);
    if (state == WorkerReport::State::done || state == WorkerReport::State::skipped) return;
    bench::Row row;
    row.what = c;
    row.key = bench::rowKey(c, report_.renderer());
    row.failure = what;
    row.cost.renderer = report_.renderer();
    // Reading the scene's files may be what crashes.
    const auto crash = runInWorker(report_, stallTimeout_, [&] {
      const TechniqueRegistry registry(TechniqueRegistry::defaultFolders());
      row.provenance = session::CaseOrigins(registry).of(c);
      bench::ResultsFile(file_).append(row);
    });
    if (crash) bench::ResultsFile(file_).append(row);
  }

  const std::vector<bench::Case>& cases_;
  const fs::path& out_;
  const fs::path file_;
  const BackendOptions& backend_;
  const double stallTimeout_;
  const std::string progressName_;
  const Measured counts_;
  WorkerReport report_;
  std::vector<std::size_t> left_;  ///< indices of the cases that are still to be looked at
};

/// Returns the folder, which exists then.
fs::path created(const fs::path& folder) {
  createFolder(folder);
  return folder;
}

}  // namespace

ResultsFolder::ResultsFolder(fs::path folder, BackendOptions backend, double stallTimeout)
    : folder_(created(folder)),
      backend_(std::move(backend)),
      stallTimeout_(stallTimeout),
      lock_(folder_ / ".lock", fmt::format("folder {}", folder_.string())) {
  for (const fs::path& part : {folder_, folder_ / "pictures", folder_ / "references"})
    removeAbandonedFiles(part);
}

void ResultsFolder::check(const std::vector<bench::Case>& cases) {
  CaseWork(cases, folder_, backend_, stallTimeout_).check();
}

bench::Summary ResultsFolder::measure(const std::vector<bench::Case>& cases, const std::string& progressName,
                                      Measured counts) {
  CaseWork work(cases, folder_, backend_, stallTimeout_, progressName, counts);
  const bench::Summary summary = work.run();
  renderer_ = work.renderer();
  failed_ = work.failed();
  return summary;
}

std::vector<bench::Row> ResultsFolder::rows() const {
  return fs::exists(file()) ? bench::readRows(file()) : std::vector<bench::Row>();
}

void ResultsFolder::writeReport() const {
  const std::vector<bench::Row> all = rows();
  bench::writeTables(all, folder_);
  bench::writeReport(all, folder_);
}

}  // namespace limn::app
