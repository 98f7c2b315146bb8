#include "core/session/suite_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "core/base/error.h"
#include "core/session/bench_session.h"
#include "core/session/find.h"
#include "core/session/view.h"

namespace limn::session {
namespace fs = std::filesystem;
namespace {

/// Lines, each once, in the order in which they are found.
class Lines {
 public:
  /// Runs `look`; what it throws becomes a line.
  template <class Look>
  bool find(const std::string& where, Look look) {
    try {
      look();
      return true;
    } catch (const Error& error) {
      const std::string line = where + error.what();
      if (std::ranges::find(lines_, line) == lines_.end()) lines_.push_back(line);
      return false;
    }
  }
  std::vector<std::string> take() { return std::move(lines_); }

 private:
  std::vector<std::string> lines_;
};

bool filesAreThere(const bench::Case& c, Lines& lines) {
  return lines.find("", [&] {
    findScene(c.scene);
    if (!c.environment.empty()) findEnvironment(c.environment);
    const std::string& grid = c.grid;
    std::error_code ignored;
    if (!grid.empty() && grid != "smoke" && grid != "none" && !fs::exists(grid, ignored))
      throw Error(fmt::format("grid '{}' does not exist; expected an OpenVDB file, smoke or none", grid));
  });
}

/// Cameras, lights and their sizes of all cases that see one scene.
void checkViews(const std::vector<const bench::Case*>& cases, Lines& lines, const Warn& warn) {
  const std::string where = cases.front()->scene + ": ";
  SceneQuestion shown = openedScene(*cases.front());
  View view;
  bool opened = false;
  lines.find(where, [&] {
    try {
      view = open(shown, warn);
      opened = true;
    } catch (const UsageError&) {
      throw;
    } catch (const std::exception&) {
      // broken: the rows will say so
    }
  });
  if (!opened) return;
  for (const bench::Case* c : cases) {
    if (std::exchange(shown.lightSize, c->lightSize) != c->lightSize)
      lines.find(where, [&] { relight(view, shown); });
    lines.find(where, [&] { chooseCamera(*c, view.pose, view.framing); });
    if (!c->light.empty()) lines.find(where, [&] { findNamed("light", c->light, view.pose.lightNames); });
  }
}

}  // namespace

std::vector<std::string> missingThings(const std::vector<bench::Case>& cases,
                                       const TechniqueRegistry& registry, const std::function<void()>& alive,
                                       const Warn& warn) {
  Lines lines;
  std::vector<std::vector<const bench::Case*>> scenes;
  std::vector<SceneQuestion> known;
  for (const bench::Case& c : cases) {
    if (c.technique != bench::kSeparationFloor)
      lines.find("", [&] { checkMeasurable(techniqueChoice(c).resolve(registry)); });
    if (!filesAreThere(c, lines)) continue;
    const auto place = std::ranges::find(known, openedScene(c));
    const auto index = static_cast<std::size_t>(place - known.begin());
    if (place == known.end()) {
      known.push_back(openedScene(c));
      scenes.emplace_back();
    }
    scenes[index].push_back(&c);
  }
  for (const auto& views : scenes) {
    alive();
    checkViews(views, lines, warn);
  }
  return lines.take();
}

}  // namespace limn::session
