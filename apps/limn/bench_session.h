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

/// One context; the scene of the last case stays loaded.
class BenchSession {
 public:
  BenchSession(const BackendOptions& backend, const std::filesystem::path& out);
  ~BenchSession();

  const std::string& rendererName() const { return context_->info().renderer; }
  bench::Reference reference(const bench::Case& c);
  bench::Measurement measure(const bench::Case& c);

 private:
  struct Loaded;
  Loaded& load(const bench::Case& c);
  reference::Request request(const bench::Case& c, reference::Term term, int light);
  Image separationFloor(const bench::Case& c);
  Image unshadowed(const bench::Case& c, int light);

  reference::Cache cache_;
  std::unique_ptr<Context> context_;
  gpu::Device device_;
  TechniqueRegistry registry_;
  std::unique_ptr<Loaded> loaded_;
};

}  // namespace limn::app
