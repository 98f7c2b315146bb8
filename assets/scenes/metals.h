// Indices of refraction and absorption of metals at 650, 550 and 450 nm, interpolated in table 3 of H.-J.
// Hagemann, W. Gudat and C. Kunz, "Optical constants from the far infrared to the x-ray region", DESY
// SR-74/7, 1974.
#pragma once

#include <glm/glm.hpp>

namespace limn::assets {

constexpr glm::vec3 kCopperEta{0.22f, 0.94f, 1.17f}, kCopperK{3.64f, 2.59f, 2.39f};
constexpr glm::vec3 kAluminiumEta{1.48f, 1.0f, 0.65f}, kAluminiumK{7.58f, 6.51f, 5.4f};

}  // namespace limn::assets
