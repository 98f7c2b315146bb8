// limn-view: a window on a scene, in which techniques, parameters, lights and cameras are changed while one
// looks, compared with each other and with the truth.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "core/render/renderer.h"

namespace limn::app {

/// A setting that a guide offers, with a sentence about what is to be seen.
struct ViewerStep {
  std::string title, sentence;
  TechniqueOptions techniques;
};

struct ViewerOptions {
  std::string title = "limn";
  SceneOptions scene;
  TechniqueOptions techniques;
  std::string outputTerm = "final";
  double exposure = 0;
  std::vector<ViewerStep> steps;                           ///< may be empty
  std::vector<std::string> panels{"scene", "techniques"};  ///< open at first
  std::string compareWith;                                 ///< at first: nothing (empty), techniques or truth
  bool debug = false;                                      ///< OpenGL errors end the program
  std::filesystem::path shaders;  ///< folder that overrides the embedded ones, watched for changes
  std::filesystem::path save = "out/view.png";     ///< where pictures are saved at first
  std::filesystem::path cache = "out/references";  ///< of the truth's pictures; empty: none are kept
  int frames = 0;                                  ///< ends after so many with the whole picture; 0: stays
  std::filesystem::path screenshot;                ///< of the window, written at its end (.png); empty: none
  std::filesystem::path stats;  ///< how the window fared, written at its end (.json); empty: not
};

/// Runs until the window is closed. Throws Error if no window can be opened or the first scene cannot be
/// shown.
void runViewer(const ViewerOptions& options);

}  // namespace limn::app
