#include "core/technique/frame_budget.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace limn {

namespace {

/// A level is left for a cheaper one above this share of the budget, and for a dearer one that is expected
/// below the other.
constexpr double kTooDear = 1.1, kCheapEnough = 0.9;

}  // namespace

FrameBudget::FrameBudget(double milliseconds, std::vector<double> work)
    : budget_(milliseconds),
      work_(std::move(work)),
      target_(static_cast<int>(work_.size()) - 1),
      position_(target_),
      seen_(work_.size()),
      tooDear_(static_cast<int>(work_.size())) {}

int FrameBudget::dearest() const {
  return std::max(target_, static_cast<int>(std::ceil(position_)));
}

void FrameBudget::addFrame(double milliseconds) {
  if (caution_ > 0 && --caution_ == 0) tooDear_ = static_cast<int>(work_.size());
  if (position_ != target_) {
    position_ += step_;
    const bool arrived = step_ > 0 ? position_ >= target_ : position_ <= target_;
    if (arrived) position_ = target_;
    return;
  }
  times_[static_cast<size_t>(timeCount_++)] = milliseconds;
  if (timeCount_ < kMedianOf) return;
  timeCount_ = 0;
  std::ranges::nth_element(times_, times_.begin() + kMedianOf / 2);
  choose(times_[kMedianOf / 2]);
}

/// A level that was kept and becomes too dear has its time from before, and one that is fallen to and is
/// still too dear has none: that may be a stall, which says nothing about levels. Of a level that was tried
/// it does, and what was known of those above it is out of date.
void FrameBudget::note(double median) {
  const bool tooDear = median > kTooDear * budget_;
  if (tooDear && !tried_) return;
  double& known = seen_[static_cast<size_t>(target_)];
  if (known > 0 && !tooDear) {
    const double change = median / known;
    for (double& time : seen_) time *= change;
  }
  known = median;
  if (tooDear) std::fill(seen_.begin() + target_ + 1, seen_.end(), 0.0);
  tried_ = false;
}

/// Returns the time of a dearer level than target(), which takes `median`: at least as much, and at most as
/// much more as its work is.
double FrameBudget::expected(int level, double median) const {
  double slope = median / work(target_);
  for (int other = target_ + 1; other < static_cast<int>(work_.size()); ++other) {
    const double time = seen_[static_cast<size_t>(other)];
    if (!(time > 0) || !(work(other) > work(target_))) continue;
    slope = std::clamp((time - median) / (work(other) - work(target_)), 0.0, slope);
    break;
  }
  return median + slope * (work(level) - work(target_));
}

void FrameBudget::choose(double median) {
  note(median);
  if (median > kTooDear * budget_ && target_ > 0) {
    tooDear_ = target_;
    caution_ = kFramesOfCaution;
    int level = target_ - 1;
    while (level > 0 && work(level) > work(target_) * budget_ / median) --level;
    goTo(level);
  } else if (target_ + 1 < std::min(tooDear_, static_cast<int>(work_.size())) &&
             expected(target_ + 1, median) < kCheapEnough * budget_) {
    goTo(target_ + 1);
  }
}

void FrameBudget::goTo(int level) {
  tried_ = level > target_;
  target_ = level;
  step_ = (level > position_ ? 1.0 : -1.0) / kFramesOfLevel;
}

const FrameBudget& FrameBudgetService::request(std::string_view technique, double milliseconds,
                                               const std::vector<double>& work) {
  auto found = entries_.find(technique);
  if (found != entries_.end() && found->second.milliseconds == milliseconds && found->second.work == work) {
    found->second.requested = true;
    return found->second.budget;
  }
  if (found != entries_.end()) entries_.erase(found);
  return entries_.emplace(std::string(technique), Entry{milliseconds, work, FrameBudget(milliseconds, work)})
      .first->second.budget;
}

/// The first frame of a graph compiles and allocates.
void FrameBudgetService::begin() {
  start_.reset();
  for (auto& [technique, entry] : entries_) entry.requested = false;
}

bool FrameBudgetService::update(frame::FrameGraph&, const scene::Pose&) {
  const Clock::time_point now = Clock::now();
  if (start_) {
    const std::chrono::duration<double, std::milli> time = end_.value_or(now) - *start_;
    for (auto& [technique, entry] : entries_)
      if (entry.requested) entry.budget.addFrame(time.count());
  }
  start_ = now;
  end_.reset();
  return false;
}

/// The last time counts: who shows progress waits before each pass as well.
void FrameBudgetService::waited() {
  end_ = Clock::now();
}

void FrameBudgetService::givenUp() {
  start_.reset();
}

}  // namespace limn
