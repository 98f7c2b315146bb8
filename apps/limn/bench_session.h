// What `limn bench` hands to the bench logic: references from the CPU, pictures and times from the GPU.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "apps/limn/options.h"
#include "core/bench/runner.h"
#include "core/gpu/device.h"
#include "core/reference/reference.h"

namespace limn::app {

/// A suite by its file, or by its name if it came with limn. Throws Error when there is neither.
std::filesystem::path findSuite(const std::filesystem::path& nameOrFile);

/// Runs the cases of a suite that `out` has no row for yet, with a progress bar, and writes tables and
/// report. Measures in a process of its own: a case that crashes loses its own row only. No thread and no
/// OpenGL context may exist. Returns how many rows were measured, found and failed. `filters` and `shard`:
/// bench::selectCases().
bench::Summary runSuite(const std::filesystem::path& suite, const std::filesystem::path& out,
                        const BackendOptions& backend, const std::vector<std::string>& filters = {},
                        bench::Shard shard = {});

/// One context; the scene of the last case stays loaded.
class BenchSession {
 public:
  BenchSession(const BackendOptions& backend, const std::filesystem::path& out);
  ~BenchSession();

  const std::string& rendererName() const { return context_->info().renderer; }
  bench::Reference reference(const bench::Case& c);
  bench::Measurement measure(const bench::Case& c);
  /// Milliseconds of the case's timed frames alone.
  std::vector<double> time(const bench::Case& c);
  /// Writes pictures/NAME.png in the folder of the results and returns that path.
  std::string keepPicture(const std::string& name, const Image& image);

 private:
  struct Loaded;
  Loaded& load(const bench::Case& c);
  /// Of the picture that is compared.
  render::Settings settingsOf(const bench::Case& c);
  /// Prepares the frames that are timed.
  static render::Playback playback(const Loaded& loaded, const bench::Case& c);
  static void configureTimed(Loaded& loaded, const bench::Case& c, render::Settings settings);
  reference::Request request(const bench::Case& c, reference::Term term, int light);
  Image separationFloor(const bench::Case& c);
  Image unshadowed(const bench::Case& c, int light);

  std::filesystem::path out_;
  reference::Cache cache_;
  std::unique_ptr<Context> context_;
  gpu::Device device_;
  TechniqueRegistry registry_;
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace limn::app
