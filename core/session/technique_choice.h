// Declares techniques and their parameters as people write them, and their translation for a renderer.
#pragma once

#include <string>
#include <vector>

#include "core/base/export.h"
#include "core/render/renderer.h"
#include "core/technique/registry.h"

namespace limn::session {

/// Says which techniques are used, and with which parameters.
struct TechniqueChoice {
  std::string techniques;             ///< comma-separated
  std::vector<std::string> settings;  ///< TECHNIQUE.PARAMETER=VALUE

  /// Returns the modules with their parameters. Throws UsageError for what is unknown, named twice or out of
  /// range, and Error for a module that is refused.
  LIMN_API std::vector<render::TechniqueUse> resolve(const TechniqueRegistry& registry) const;
};

}  // namespace limn::session
