#include "assets/scenes/scenes.h"

namespace limn::assets {

const std::vector<SceneEntry>& allScenes() {
  static const std::vector<SceneEntry> scenes = {
      {"balls", makeBalls},
      {"cornell_box", makeCornellBox},
  };
  return scenes;
}

}  // namespace limn::assets
