// What `limn bench` hands to the bench logic: references from the CPU, pictures and times from the GPU.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "apps/limn/options.h"
#include "core/bench/runner.h"
#include "core/gpu/device.h"
#include "core/reference/reference.h"

namespace limn::app {

/// What the case looks at.
SceneOptions sceneOptions(const bench::Case& c);
/// What answers the case, with its parameters.
TechniqueOptions techniqueOptions(const bench::Case& c);

/// One context; the scene of the last case stays loaded.
class BenchSession {
 public:
  /// `alive` is called while work goes on: between frames, and between passes of references.
  BenchSession(const BackendOptions& backend, const std::filesystem::path& out, std::function<void()> alive);
  ~BenchSession();

  const std::string& rendererName() const { return context_->info().renderer; }
  const TechniqueRegistry& registry() const { return registry_; }
  /// The next case starts from nothing: a failure may have left scene and renderer half changed.
  void forgetScene();
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
  render::Playback playback(const Loaded& loaded, const bench::Case& c) const;
  static void configureTimed(Loaded& loaded, const bench::Case& c, render::Settings settings);
  reference::Request request(const bench::Case& c, reference::Term term, int light);
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

}  // namespace limn::app
