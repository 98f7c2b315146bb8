// Declares how a material gets a model in place of metallic-roughness.
#pragma once

#include "core/scene/scene.h"

namespace limn::scene {

/// Gives the material a model, and in baseColour, metallic and roughness the metal that is about as wide and
/// reflects as much diffuse light (glsl::hemispherical_reflectance). Its textures of metallic-roughness are
/// taken away, except the base colour's where it decides on coverage, and it transmits nothing.
LIMN_API void setModel(Material& material, const glsl::MaterialModel& model);

}  // namespace limn::scene
