// Declares what the commands `limn brdf ...` look at: a file of measured data, a model, or a scene's
// material.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "core/brdf/factor_tables.h"

namespace limn::app {

/// Says which BRDF is meant, as the command line does.
struct BrdfChoice {
  std::string source;           ///< a file, or a model: metal:ALPHA, plastic:ALPHA, groove
  std::filesystem::path scene;  ///< a scene's file or name, whose material is taken in place of a source
  std::string material;

  /// Gives the command its argument and --scene and --material.
  void addTo(CLI::App& command);
};

struct BrdfSource {
  std::string name;  ///< as it was asked for
  std::string kind;  ///< what it is, in words
  brdf::Brdf f;
  bool isotropic = true;
  std::vector<int> nodes;  ///< along each axis of a table; empty for models
  double largest = 0;      ///< value of the table's nodes, 1/sr
  std::size_t bytes = 0;   ///< of the table's nodes in memory
};

/// Reads the file, or finds the model. Throws Error or UsageError in one line where there is none.
BrdfSource openBrdf(const BrdfChoice& choice);

/// Returns a colour given as one number or red,green,blue, each 0 to 1. Throws UsageError that names `flag`
/// for any other text.
glm::vec3 parseAlbedo(const std::string& flag, const std::string& text);

}  // namespace limn::app
