// Materials that several translucent scenes share.
#pragma once

#include <string>

#include "assets/generator/scene.h"

namespace limn::assets {

/// Materials with the coefficients that Jensen, Marschner, Levoy and Hanrahan measured (2001, A Practical
/// Model for Subsurface Light Transport): skin1, marble and whole milk.
Material skin(std::string name, float roughness);
Material marble(std::string name);
Material wholeMilk(std::string name);

}  // namespace limn::assets
