// Declares what the viewer shows, as values: everything that `limn render` can be told. The code needs no
// window and no OpenGL.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "apps/view/orbit.h"
#include "core/question/question_fields.h"
#include "core/question/scene_question.h"
#include "core/render/renderer.h"
#include "core/session/technique_choice.h"

namespace limn::app {

struct ViewState {
  SceneQuestion scene;  ///< width and height are those of the saved picture; the window shows its own
  std::vector<render::TechniqueUse> techniques;
  ToneMapping tone;
  bool automaticExposure = false;  ///< in place of tone.exposureEv, from the picture: --exposure auto
  std::filesystem::path shaders;   ///< folder that overrides the embedded ones; empty: none
};

/// Returns what limn accepts for the field, a number, next to `value`: what is typed into a slider may lie
/// beyond both.
double accepted(const QuestionField& field, double value);

/// Says whether both questions are asked from the same place: the same camera, or the same eye and target.
bool sameViewpoint(const SceneQuestion& a, const SceneQuestion& b);

/// Puts the orbit's camera into the options, so that whatever reads them gets it bit for bit.
void setCamera(SceneQuestion& options, const Orbit& orbit, const glm::dvec3& origin);

/// Removes the techniques that `added`, itself one of them, excludes (refusedBeside).
void dropRivals(std::vector<render::TechniqueUse>& techniques, const TechniquePlugin& added);

/// Replaces the technique that claims what only one may of direct light by the next one of the registry that
/// does, with its defaults.
void useNextTechnique(std::vector<render::TechniqueUse>& techniques, const TechniqueRegistry& registry);

/// Puts techniques that were measured for `term` in place of those that answer it, and keeps the others as
/// far as they may stand beside them.
void takeMeasured(std::vector<render::TechniqueUse>& techniques, std::vector<render::TechniqueUse> measured,
                  Term term);

/// Returns the command that renders the state to `out`: one line for a shell, with arguments quoted where
/// needed.
std::string renderCommand(const ViewState& state, const std::filesystem::path& out);

/// Returns the command that renders these frames of the animation to out.0000.png and so on.
std::string sequenceCommand(const ViewState& state, const std::filesystem::path& out,
                            const FrameRange& frames, double fps);

/// Returns `opened`, a question that was asked some time ago, with what is to stay of `now`, the present one:
/// of the same file all that needs no opening, of another one only the picture's size, samples and term.
SceneQuestion carriedOver(const SceneQuestion& now, const SceneQuestion& opened, bool sameFile);

/// Returns a suite for `limn bench` that measures the state's techniques in its scene: all of the state
/// except the tone mapping.
std::string benchSuite(const ViewState& state);

}  // namespace limn::app
