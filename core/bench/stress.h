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
#include "core/bench/provenance.h"
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

/// From the best to the worst.
enum class StressVerdict {
  pass,
  degraded,  ///< the error is above what the case allows
  refused,   ///< ended with a message
  failed,    ///< a value that is not finite, a visibility outside [0, 1] or a negative radiance
};
LIMN_API const char* name(StressVerdict verdict);

/// Says how a technique did in one term that it answers.
struct StressAnswer {
  std::string term;  ///< as StressRun::terms() names it
  StressVerdict verdict = StressVerdict::pass;
  double error = 0;  ///< RMSE of V; of radiance, relative to the reference's mean
  /// Of the unchanged scene with default parameters, or with the case's own where it is a technique's form of
  /// a common one.
  double benign = 0;
  double factor = 0;         ///< error / max(benign, 0.01); degraded above what the case allows
  std::string message = {};  ///< why it was refused or has failed
};

struct StressResult {
  std::string technique, name, scene, settings;
  std::string beside = {};  ///< the technique that ran along; empty: none
  bool own = false;         ///< declared by the technique; else one that all techniques meet
  double allowed = 0;
  /// Holds one for each term that was asked for. The first is the one that counts: of the worst verdict and,
  /// among these, of the largest factor.
  std::vector<StressAnswer> answers = {};
  Provenance provenance = {};  ///< empty in results of earlier versions

  /// Returns the answer that counts; an empty one where nothing was asked.
  LIMN_API const StressAnswer& worst() const;
};

/// Returns the extreme cases that every technique has to handle.
LIMN_API std::span<const StressCase> commonStressCases();

/// Returns the case as a technique meets it. In place of balls, which a case has that names no scene, one
/// that answers for translucent bodies or height maps meets a scene that has them. One that answers for
/// materials or light below surfaces has ray_traced_area_light beside it, where nothing else is: the
/// reference's light has shadows, and a picture without them errs by those more than by anything else.
LIMN_API StressCase stressCaseFor(const TechniqueInfo& technique, StressCase stressCase);

struct StressOptions {
  int width = 128, height = 96;
  int spp = 64;  ///< of the references
  /// How many scenes are kept with their renderers. Cases that ask of several by turns take less time by
  /// more, and more memory.
  int scenes = 1;
};

/// Runs cases of one technique after the other; references are shared.
class LIMN_API StressRun {
 public:
  /// Takes `registry`, which finds techniques that run beside others and must outlive the object, and
  /// `scene`, which loads an asset by name.
  StressRun(gpu::Device& device, const TechniqueRegistry& registry,
            std::function<scene::Scene(const std::string&)> scene, StressOptions options = {});
  ~StressRun();

  /// Asks for every term that the technique answers.
  StressResult run(const TechniquePlugin& technique, const StressCase& stressCase, bool own);

  /// Returns what run() asks such a technique for: every term that it answers, by its picture. Direct light
  /// stands for V where the case changes light or surfaces, of which V knows nothing; the environment's term
  /// has no picture of its own and is direct light under a sky alone; without any light all of these are one
  /// question, `final`.
  static std::vector<std::string> terms(TermSet answered, StressChange change);

 private:
  struct Asked;
  struct Question;
  static std::vector<Asked> askedOf(TermSet answered, StressChange change);
  Question& question(const Asked& asked, const StressCase& stressCase);
  StressAnswer answer(const TechniquePlugin& technique, const StressCase& stressCase, const Asked& asked);
  double error(const TechniquePlugin& technique, const StressCase& stressCase, const Asked& asked);
  double benign(const TechniquePlugin& technique, const StressCase& stressCase, const Asked& asked);

  gpu::Device& device_;
  const TechniqueRegistry& registry_;
  std::function<scene::Scene(const std::string&)> scene_;
  StressOptions options_;
  std::vector<std::unique_ptr<Question>> questions_;  ///< the last ones, the newest behind
  std::map<std::string, Image> references_;           ///< by question
  std::map<std::string, double> benign_;              ///< by technique and question
};

/// Returns a table with a line for each result, in the order in which they were measured; those that did not
/// pass are explained. Results of another version of the program, of a technique or of a scene than the last
/// ones have a mark that a line below explains.
LIMN_API std::string toMarkdown(std::span<const StressResult> results);
/// Returns {"renderer": ..., "results": [{"technique", "case", "scene", "settings", "beside", "own",
/// "allowed", "answers": [{"term", "verdict", "error", "benign", "factor", "message"}], "provenance":
/// {...}}]}, the worst answer first.
LIMN_API std::string toJson(std::span<const StressResult> results, const std::string& renderer);
/// Returns the results in a text of toJson(). Results of earlier versions, which asked for one term alone,
/// are left out. Throws Error for text that is not such a table, or that of another renderer.
LIMN_API std::vector<StressResult> stressFromJson(const std::string& text, const std::string& renderer);

}  // namespace limn::bench
