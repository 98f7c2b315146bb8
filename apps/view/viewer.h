// Declares the viewer limn-view: a window on a scene, in which techniques, parameters, lights and cameras are
// changed interactively and compared with each other and with the ground truth.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/limn/tone_flags.h"
#include "core/question/scene_question.h"
#include "core/render/renderer.h"
#include "core/session/technique_choice.h"

namespace limn::app {

/// Declares a setting that a guide offers, with a sentence about what it shows.
struct ViewerStep {
  std::string title, sentence;
  session::TechniqueChoice techniques;
};

struct ViewerOptions {
  std::string title = "limn";
  SceneQuestion scene;  ///< its size is that of the picture; without a name, the window says how to open one
  session::TechniqueChoice techniques;
  ToneFlags tone;
  std::vector<ViewerStep> steps;                           ///< may be empty
  std::vector<std::string> panels{"scene", "techniques"};  ///< open at first
  std::string compareWith;                                 ///< at first: nothing (empty), techniques or truth
  int device = -1;                                         ///< of the pictures, as in ContextOptions
  bool debug = false;                                      ///< OpenGL errors end the program
  std::filesystem::path shaders;  ///< folder that overrides the embedded ones, watched for changes
  double scale = 0;               ///< of text and widgets; 0: the monitor's
  std::filesystem::path save = "out/view.png";     ///< where pictures are saved at first
  std::filesystem::path cache = "out/references";  ///< of reference pictures; empty: none are kept
  int frames = 0;                                  ///< with the whole picture, then it closes; 0: stays
  std::filesystem::path screenshot;                ///< of the window, written at its end (.png); empty: none
  std::filesystem::path stats;  ///< of the window's frames, written at its end (.json); empty: none
};

/// Runs until the window is closed. Throws Error if no window can be opened or the first scene cannot be
/// shown.
void runViewer(const ViewerOptions& options);

}  // namespace limn::app
