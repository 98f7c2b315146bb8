// Declares budgets of frame time: a technique that can do with less work names its levels, and is told which
// one keeps the time that a frame may take. On the way from one level to the next it stands between them, for
// techniques that can fade.
#pragma once

#include <array>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"
#include "core/technique/frame_service.h"

namespace limn {

/// Chooses a level by the times of frames. It starts at the dearest one. Times are taken to be a + b work,
/// with a part a that no level changes: b follows from what a dearer level took, in proportion to what the
/// level of now has taken since.
class LIMN_API FrameBudget {
 public:
  /// Takes the time that a frame may take, ms, and the work of each level, from the cheapest to the dearest,
  /// in any unit: at least one, each positive and none below the one before.
  FrameBudget(double milliseconds, std::vector<double> work);

  /// Notes the time between the last two frames, ms, and moves position() on.
  void addFrame(double milliseconds);
  /// Returns the level that is gone to.
  int target() const { return target_; }
  /// Returns the level of the next frame, a whole number or on the way between two.
  double position() const { return position_; }
  /// Returns the dearest level that the next frames need: those that position() lies between, and target().
  int dearest() const;

 private:
  void choose(double median);
  void note(double median);
  double expected(int level, double median) const;
  double work(int level) const { return work_[static_cast<size_t>(level)]; }
  void goTo(int level);

  static constexpr int kMedianOf = 5;           ///< frames at a level before it is judged
  static constexpr int kFramesOfLevel = 8;      ///< from one level to the next
  static constexpr int kFramesOfCaution = 256;  ///< before a level that was too dear is tried again

  double budget_;
  std::vector<double> work_;
  int target_;
  double position_, step_ = 0;
  std::array<double, kMedianOf> times_{};
  int timeCount_ = 0;
  std::vector<double> seen_;  ///< median time of each level, ms; 0: not known
  bool tried_ = true;         ///< target() was risen to, or begun with, and is not judged yet
  int tooDear_;               ///< the cheapest level that is not tried for now
  int caution_ = 0;
};

/// Holds the budgets of a renderer's techniques, from one graph to the next, and measures frames by the clock
/// between their starts: on the frame path nothing waits for the GPU. Where a program waits for the end of a
/// frame itself, what it does afterwards does not count. Frames that are given up have no time, and frames of
/// a graph in which nobody requested a budget say nothing about it.
class LIMN_API FrameBudgetService : public FrameService {
 public:
  static constexpr const char* serviceName = "frame budgets";

  /// Returns the budget of a technique; another time or other levels start another one.
  const FrameBudget& request(std::string_view technique, double milliseconds,
                             const std::vector<double>& work);

 private:
  struct Entry {
    double milliseconds;
    std::vector<double> work;
    FrameBudget budget;
    bool requested = true;  ///< in the graph that was built last
  };
  void begin() override;
  bool update(frame::FrameGraph& graph, const scene::Pose& pose) override;
  void waited() override;
  void givenUp() override;

  using Clock = std::chrono::steady_clock;
  std::map<std::string, Entry, std::less<>> entries_;
  std::optional<Clock::time_point> start_;  ///< of the last frame; none: it does not count
  std::optional<Clock::time_point> end_;    ///< of the last frame; none: the start of the next one
};

}  // namespace limn
