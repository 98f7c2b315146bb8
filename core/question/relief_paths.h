// Names the paths of light that a reference with bounces follows where surfaces have height maps.
#pragma once

#include <cstdint>
#include <string_view>

namespace limn {

/// Says which paths count by their segments from bump to bump: those that end on the height map that they
/// start from.
enum class ReliefPaths : std::uint8_t {
  both,    ///< all paths
  relief,  ///< paths with at least one such segment
  others   ///< paths without any: what would be one is absorbed
};

/// Holds the names, in the order of the enumerators.
constexpr const char* kReliefPaths[] = {"both", "relief", "others"};

constexpr const char* name(ReliefPaths paths) {
  return kReliefPaths[static_cast<int>(paths)];
}

/// Returns the paths of that name; both for any other text.
constexpr ReliefPaths reliefPathsOf(std::string_view text) {
  for (const ReliefPaths paths : {ReliefPaths::relief, ReliefPaths::others})
    if (text == name(paths)) return paths;
  return ReliefPaths::both;
}

}  // namespace limn
