// Tests stability: every technique on every extreme case, as a table of pass, degraded (how much) or refused
// (why).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/image/image.h"
#include "core/technique/registry.h"
#include "core/technique/technique.h"

namespace limn::gpu {
class Device;
}
namespace limn::scene {
struct Scene;
}

namespace limn::bench {

enum class Verdict {
  pass,
  degraded,  ///< the error is above what the case allows
  refused,   ///< ended with a message
  failed,    ///< a value that is not finite, a visibility outside [0, 1] or a negative radiance
};
LIMN_API const char* name(Verdict verdict);

struct StressResult {
  std::string technique, name, scene, settings;
  bool own = false;  ///< declared by the technique; else one that all techniques meet
  Verdict verdict = Verdict::pass;
  double error = 0;   ///< RMSE of V; of radiance, relative to the reference's mean
  double benign = 0;  ///< of the unchanged scene with default parameters
  double factor = 0;  ///< error / max(benign, 0.01); degraded above `allowed`
  double allowed = 0;
  std::string message;  ///< why it was refused or has failed
};

/// Returns the extreme cases that every technique has to handle.
LIMN_API std::span<const StressCase> commonStressCases();

struct StressOptions {
  int width = 128, height = 96;
  int spp = 64;  ///< of the references
};

/// Runs cases of one technique after the other; references are shared.
class LIMN_API StressRun {
 public:
  /// Takes `scene`, which loads an asset by name.
  StressRun(gpu::Device& device, std::function<scene::Scene(const std::string&)> scene,
            StressOptions options = {});
  ~StressRun();

  StressResult run(const TechniquePlugin& technique, const StressCase& stressCase, bool own);

 private:
  struct Question;
  Question& question(const TechniquePlugin& technique, const StressCase& stressCase, Term term);
  double error(const TechniquePlugin& technique, const StressCase& stressCase, Term term);
  double benign(const TechniquePlugin& technique, const char* scene, Term term);

  gpu::Device& device_;
  std::function<scene::Scene(const std::string&)> scene_;
  StressOptions options_;
  std::unique_ptr<Question> question_;       ///< the last one
  std::map<std::string, Image> references_;  ///< by question
  std::map<std::string, double> benign_;     ///< by technique, scene and term
};

/// Returns a table with a line for each result; those that did not pass are explained.
LIMN_API std::string toMarkdown(std::span<const StressResult> results);
/// Returns {"renderer": ..., "results": [{"technique", "case", "scene", "settings", "own", "verdict",
/// "error", "benign", "factor", "allowed", "message"}]}.
LIMN_API std::string toJson(std::span<const StressResult> results, const std::string& renderer);
/// Returns the results in a text of toJson(); none if they come from another renderer. Throws Error for text
/// that is not such a table.
LIMN_API std::vector<StressResult> stressFromJson(const std::string& text, const std::string& renderer);

}  // namespace limn::bench
