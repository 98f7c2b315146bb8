// What the viewer shows, as values: everything that `limn render` can be told. No window, no OpenGL.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/limn/options.h"
#include "apps/view/orbit.h"
#include "core/render/renderer.h"

namespace limn::app {

struct ViewState {
  SceneOptions scene;  ///< `size` is that of the saved picture; the window shows its own
  std::vector<render::TechniqueUse> techniques;
  render::Output output = render::Output::final;
  float exposure = 0;  ///< EV
};

/// Puts the orbit's camera into the options, so that what reads them gets it to the bit.
void setCamera(SceneOptions& options, const Orbit& orbit, const glm::dvec3& origin);

/// The techniques that answer one of the terms already are replaced by one that claims it too, if only one
/// may: visibility, direct and environment have one technique each. Called after `use` was added to
/// `techniques`.
void dropRivals(std::vector<render::TechniqueUse>& techniques, const TechniquePlugin& added);

/// The command that renders the state to `out`: one line for a shell, arguments quoted where they must be.
std::string renderCommand(const ViewState& state, const std::filesystem::path& out);

/// Of indirect light, in the truth that a picture is compared with: 1 where the picture has any, else 0.
int bouncesOf(render::Output output, const std::vector<render::TechniqueUse>& techniques);

/// A suite for `limn bench` that measures the state's techniques in its scene: all of the state but the
/// exposure.
std::string benchSuite(const ViewState& state);

}  // namespace limn::app
