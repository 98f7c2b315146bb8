// Declares what is certain of the conditions in a GLSL file before a compiler reads it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/gpu/private/glsl_lines.h"

namespace limn::gpu {

/// Says whether a condition holds, in the order of their certainty that it does.
enum class Holds : uint8_t { no, unknown, yes };

/// Returns whether the condition of an #if or #elif holds where the macros in `known`, whose values may be
/// anything, are defined. Files may define all others, so what depends on these is unknown, as is what the
/// grammar of conditions lacks here.
LIMN_API Holds evaluate(std::string_view condition, const std::map<std::string, std::string>& known);

/// Follows the conditions of one file from line to line.
class LIMN_API OpenConditions {
 public:
  /// Goes on to the next line. Returns true if compilers that read on behind it may have skipped inserted()
  /// lines, and with them the marks that say how lines are counted.
  bool follow(const GlslLine& line, const std::map<std::string, std::string>& known);
  /// Notes that other lines than the file's are inserted here.
  void inserted();
  /// Returns whether a compiler reads what stands here.
  Holds here() const;

 private:
  struct Open {
    Holds now;      ///< whether the branch is read
    Holds before;   ///< whether this one or an earlier one of the chain is
    bool inserted;  ///< into a branch that may be skipped
  };
  std::vector<Open> open_;
};

}  // namespace limn::gpu
