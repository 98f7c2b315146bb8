// Declares how a material gets a model in place of metallic-roughness.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Returns glsl::model_excess(): by what kd and ks must be divided, where it is above 1, for the model to
/// reflect no more light than there is.
LIMN_API float modelExcess(const glsl::MaterialModel& model);

/// Gives the material a model, and in baseColour, metallic and roughness the metal that is about as wide and
/// reflects as much diffuse light (glsl::hemispherical_reflectance). Its textures of metallic-roughness are
/// taken away, except the base colour's where it decides on coverage, and it transmits nothing.
LIMN_API void setModel(Material& material, const glsl::MaterialModel& model);

}  // namespace limn::scene
