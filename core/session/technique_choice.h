// Declares techniques and their parameters as people write them, and their translation for a renderer.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/base/export.h"
#include "core/render/renderer.h"
#include "core/technique/registry.h"

namespace limn::session {

/// Returns the set of these terms, by name. Throws UsageError for what is no term, an empty name, a term that
/// the technique does not answer, and one that is named twice.
LIMN_API TermSet askedFor(const TechniqueInfo& info, std::span<const std::string_view> terms);

/// Says which techniques are used, and with which parameters.
struct TechniqueChoice {
  std::string techniques;             ///< comma-separated; NAME:TERM+TERM: asked for these terms alone
  std::vector<std::string> settings;  ///< TECHNIQUE.PARAMETER=VALUE

  /// Returns the modules with their parameters. Throws UsageError for what is unknown, named twice, out of
  /// range or not answered, and Error for a module that is refused.
  LIMN_API std::vector<render::TechniqueUse> resolve(const TechniqueRegistry& registry) const;
};

/// Returns the choice of techniques with parameters as rows hold them: TECHNIQUE.PARAMETER, and its value.
LIMN_API TechniqueChoice choiceOf(const std::string& techniques,
                                  std::span<const std::pair<std::string, std::string>> parameters);

/// Throws UsageError where pictures would depend on how long frames take: an error measured in one frame and
/// the time of others would be those of different pictures.
LIMN_API void checkMeasurable(std::span<const render::TechniqueUse> uses);

}  // namespace limn::session
