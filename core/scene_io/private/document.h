// Declares the JSON of a scene between its checks and tinygltf. Internal to the loader.
#pragma once

#include <nlohmann/json.hpp>

#include "core/scene_io/private/loader.h"

namespace limn::scene {

struct Loader::Document {
  nlohmann::json root;
};

}  // namespace limn::scene
