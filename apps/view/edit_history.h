// Remembers what was chosen in the viewer, for undo and redo.
#pragma once

#include <cstddef>
#include <vector>

#include "apps/view/orbit.h"
#include "apps/view/view_state.h"

namespace limn::app {

/// Holds what undo brings back.
struct Edit {
  ViewState state;
  Orbit orbit;
  std::vector<render::TechniqueUse> others;  ///< that are compared with
  std::size_t step = 0;                      ///< of the guide
};
/// Says whether two edits differ in nothing but the size of the picture.
bool same(const Edit& a, const Edit& b);

/// Holds the edits since a scene was opened.
class EditHistory {
 public:
  /// Forgets everything; `present` is where undo ends.
  void restart(Edit present);
  /// Adds `present` where it differs from the edit before; what was undone is forgotten then.
  void note(const Edit& present);
  /// Forgets the edits whose scene is to be opened as `question` says, which turned out to be impossible. The
  /// edit before the present one takes its place if it is among them.
  void forget(const SceneQuestion& question);
  /// Gives the edits that have no techniques to compare with these, which nobody chose: undo does not take
  /// them back.
  void fillOthers(const std::vector<render::TechniqueUse>& others);
  /// Counts the edits' orbits from another origin, as Orbit::recount() does.
  void recount(const glm::dvec3& from, const glm::dvec3& to);
  /// Returns the edit before the present one, which it makes the present one; null where there is none.
  const Edit* undo();
  /// Returns the edit that was undone last, which it makes the present one; null where there is none.
  const Edit* redo();

 private:
  static constexpr std::size_t kMost = 500;
  std::vector<Edit> edits_;
  std::size_t present_ = 0;  ///< index of the present one
};

}  // namespace limn::app
