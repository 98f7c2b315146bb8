// Internal to core/brdf: values of a grid that nothing is known of, from those around them.
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace limn::brdf {

/// Holds the places beside one of a grid of up to three axes.
class GridNeighbours {
 public:
  void add(std::size_t place) { places_[count_++] = place; }
  const std::size_t* begin() const { return places_.data(); }
  const std::size_t* end() const { return places_.data() + count_; }

 private:
  std::array<std::size_t, 6> places_{};
  std::size_t count_ = 0;
};

/// Gives each of `values` that is not `known` the mean of those beside it that are, and so on outwards from
/// the known ones. `known` has an entry for each value, and becomes 1 where this gives one; what no known
/// value leads to stays as it is. neighbours(place) returns the GridNeighbours of a place.
template <class Neighbours>
void fillUnknown(std::vector<glm::vec3>& values, std::vector<char>& known, const Neighbours& neighbours) {
  std::vector<char> queued(values.size());
  std::vector<std::size_t> front, next;
  const auto queueAround = [&](std::size_t place) {
    for (const std::size_t other : neighbours(place)) {
      if (known[other] || queued[other]) continue;
      queued[other] = 1;
      next.push_back(other);
    }
  };
  for (std::size_t place = 0; place < values.size(); ++place)
    if (known[place]) queueAround(place);
  std::vector<glm::vec3> means;
  while (!next.empty()) {
    front.swap(next);
    next.clear();
    means.clear();
    for (const std::size_t place : front) {
      glm::vec3 sum(0);
      int count = 0;
      for (const std::size_t other : neighbours(place)) {
        if (!known[other]) continue;
        sum += values[other];
        ++count;
      }
      means.push_back(sum / static_cast<float>(count));
    }
    for (std::size_t i = 0; i < front.size(); ++i) {
      values[front[i]] = means[i];
      known[front[i]] = 1;
    }
    for (const std::size_t place : front) queueAround(place);
  }
}

}  // namespace limn::brdf
