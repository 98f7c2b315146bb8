// Declares the question that a picture answers: the scene, how it is lit, the viewpoint and time, and the
// term of its light. The command line, bench suites, rows of results and the viewer all hold such questions.
// core/question/question_fields.h declares each field once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/question/relief_paths.h"
#include "core/question/subsurface_model.h"
#include "core/question/term.h"

namespace limn {

/// Holds a question; the initial values are the defaults: the first camera, all lights, nothing changed.
/// question_fields.h documents each field. Every member has an initializer, so that some of them can be named
/// alone without a warning.
struct SceneQuestion {
  std::string scene = {};
  std::string camera = {}, eye = {}, target = {};
  double fov = 0;
  std::string light = {};
  int width = 1280, height = 720;
  int aa = 1;
  std::string term = name(Term::final);
  double time = 0;
  std::string animation = {};
  double lightSize = 0;
  std::vector<std::string> lightSettings = {};
  std::string defaultLights = "auto";
  std::string environment = {};
  double environmentRotation = 0, environmentScale = 1;
  std::string unshadowed = "off";
  std::string reliefPaths = name(ReliefPaths::both);
  std::string subsurface = name(SubsurfaceModel::bssrdf);
  std::string displaced = "off", floor = "off";
  double environmentLights = 0;
  int environmentResolution = 48;
  std::string environmentShape = "squares", environmentReflection = "area", environmentCombine = "add";
  std::string sigmaA = {}, sigmaS = {};
  std::optional<double> g = {};
  std::string grid = {};
  bool operator==(const SceneQuestion&) const = default;
};

}  // namespace limn
