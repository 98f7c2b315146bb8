// Names the ways in which a reference follows light below translucent surfaces.
#pragma once

#include <cstdint>
#include <string_view>

namespace limn {

/// Says which light that entered a translucent surface leaves at a point of it.
enum class SubsurfaceModel : std::uint8_t {
  bssrdf,  ///< the dipole's profile over the distance, for all light that enters the body
  walk,    ///< a random walk inside the body
  local    ///< the share that a half space reflects, of the light that enters there
};

/// Holds the names, in the order of the enumerators.
constexpr const char* kSubsurfaceModels[] = {"bssrdf", "walk", "local"};

constexpr const char* name(SubsurfaceModel model) {
  return kSubsurfaceModels[static_cast<int>(model)];
}

/// Returns the model of that name; bssrdf for any other text.
constexpr SubsurfaceModel subsurfaceModelOf(std::string_view text) {
  for (const SubsurfaceModel model : {SubsurfaceModel::walk, SubsurfaceModel::local})
    if (text == name(model)) return model;
  return SubsurfaceModel::bssrdf;
}

}  // namespace limn
