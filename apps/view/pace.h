// How often the window is drawn.
#pragma once

#include <algorithm>

namespace limn::app {

/// Holds how long the window waits for an event before it is drawn again.
class Pace {
 public:
  static constexpr double kFrameSeconds = 1. / 60;  ///< while something moves, or what happened settles
  static constexpr double kIdleSeconds = 0.25;      ///< while nothing happens, or nobody sees it
  static constexpr int kSettling = 3;               ///< frames that ImGui takes to answer an event

  /// Returns how many seconds to wait at most. `moving`: something changes without events.
  double patience(bool moving, bool minimised) {
    if (moving) lively_ = kSettling;
    return patience_ = lively_ > 0 && !minimised ? kFrameSeconds : kIdleSeconds;
  }
  /// Takes for how many seconds was waited: fewer than the patience where an event came.
  void waited(double seconds) { lively_ = seconds < patience_ ? kSettling : std::max(lively_ - 1, 0); }

 private:
  double patience_ = kFrameSeconds;
  int lively_ = kSettling;
};

}  // namespace limn::app
