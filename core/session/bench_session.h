// Declares how cases of a bench are measured: references on the CPU, pictures and times on the GPU.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/bench/runner.h"
#include "core/context/context.h"
#include "core/gpu/device.h"
#include "core/reference/reference.h"
#include "core/session/technique_choice.h"
#include "core/session/warn.h"
#include "core/technique/registry.h"

namespace limn::session {

/// Returns the techniques that answer the case, with their parameters.
LIMN_API TechniqueChoice techniqueChoice(const bench::Case& c);

/// Measures cases with one context, and keeps the scene of the last case loaded.
class LIMN_API BenchSession {
 public:
  /// Writes results to the folder `out`. `alive` is called during work: between frames, and between passes of
  /// references. `warn` receives warnings about techniques and kept references; missingThings() reports those
  /// about scenes.
  BenchSession(const ContextOptions& context, const std::filesystem::path& out, std::function<void()> alive,
               const Warn& warn = {});
  ~BenchSession();

  const std::string& rendererName() const { return context_->info().renderer; }
  /// Returns the driver as rows record it: vendor and version.
  std::string driverName() const { return context_->info().vendor + ", " + context_->info().version; }
  const TechniqueRegistry& registry() const { return registry_; }
  /// Discards the loaded scene, so that the next case starts from nothing: a failure may have left scene and
  /// renderer half changed.
  void forgetScene();
  /// Returns the reference of the case's picture, taken from the folder's references when it is there.
  bench::Reference reference(const bench::Case& c);
  /// Returns the case's picture and the cost of its frames.
  bench::Measurement measure(const bench::Case& c);
  /// Returns only the milliseconds of the case's timed frames.
  std::vector<double> time(const bench::Case& c);
  /// Returns one turn of the technique's own passes, and of the same frames with its bound in their place;
  /// nullopt where no technique of the case has a bound for its lights, and where nothing is timed.
  std::optional<bench::BoundTime> bound(const bench::Case& c);
  /// Writes pictures/NAME.png in the folder of the results and returns that path.
  std::string keepPicture(const std::string& name, const Image& image);

 private:
  struct Loaded;
  Loaded& load(const bench::Case& c);
  /// Returns the settings of the picture that is compared.
  render::Settings settingsOf(const bench::Case& c);
  /// Returns the playback of the frames that are timed.
  render::Playback playback(const Loaded& loaded, const bench::Case& c) const;
  static void configureTimed(Loaded& loaded, const bench::Case& c, render::Settings settings);
  reference::Request request(const bench::Case& c, Term term, int light);
  Image separationFloor(const bench::Case& c);
  Image unshadowed(const bench::Case& c, int light);

  std::filesystem::path out_;
  std::function<void()> alive_;
  reference::Cache cache_;
  std::unique_ptr<Context> context_;
  gpu::Device device_;
  TechniqueRegistry registry_;
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace limn::session
