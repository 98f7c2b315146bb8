#include "core/scene/private/animate.h"

#include <algorithm>

namespace limn::scene {
namespace {

using Interpolation = AnimationChannel::Interpolation;

/// The two keys around a time and the position between them.
struct Segment {
  std::size_t key = 0, next = 0;
  float t = 0;      ///< 0 at key, 1 at next
  float width = 0;  ///< seconds
};

Segment findSegment(const std::vector<float>& times, double time) {
  const auto after = std::upper_bound(times.begin(), times.end(), time, [](double value, float key) {
    return value < static_cast<double>(key);
  });
  if (after == times.begin()) return {};
  const std::size_t next = static_cast<std::size_t>(after - times.begin());
  if (next == times.size()) return {next - 1, next - 1, 0, 0};
  const double width = static_cast<double>(times[next]) - times[next - 1];
  return {next - 1, next, static_cast<float>((time - times[next - 1]) / width), static_cast<float>(width)};
}

/// Key k holds in-tangent, value and out-tangent; cubic Hermite as in glTF 2.0, appendix C.5.
float hermite(const AnimationChannel& channel, const Segment& s, std::size_t components, std::size_t c) {
  const auto at = [&](std::size_t key, std::size_t part) {
    return channel.values[(3 * key + part) * components + c];
  };
  if (s.key == s.next) return at(s.key, 1);
  const float t = s.t, t2 = t * t, t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * at(s.key, 1) + s.width * (t3 - 2 * t2 + t) * at(s.key, 2) +
         (3 * t2 - 2 * t3) * at(s.next, 1) + s.width * (t3 - t2) * at(s.next, 0);
}

glm::quat toQuat(const float* v) {
  return {v[3], v[0], v[1], v[2]};
}

glm::quat unit(const glm::quat& q) {
  const float length = glm::length(q);
  return length > 0 && std::isfinite(length) ? q / length : glm::quat(1, 0, 0, 0);
}

}  // namespace

void sampleChannel(const AnimationChannel& channel, double time, std::span<float> out) {
  const std::size_t n = out.size();
  const Segment s = findSegment(channel.times, time);
  const bool isRotation = channel.path == AnimationChannel::Path::rotation;
  if (channel.interpolation == Interpolation::cubic) {
    for (std::size_t c = 0; c < n; ++c) out[c] = hermite(channel, s, n, c);
  } else {
    const float* from = &channel.values[s.key * n];
    const float* to = &channel.values[s.next * n];
    const float t = channel.interpolation == Interpolation::step ? 0.f : s.t;
    if (isRotation) {
      const glm::quat q = glm::slerp(unit(toQuat(from)), unit(toQuat(to)), t);
      out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
    } else {
      for (std::size_t c = 0; c < n; ++c) out[c] = from[c] + t * (to[c] - from[c]);
    }
  }
  if (isRotation) {
    const glm::quat q = unit(toQuat(out.data()));
    out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w;
  }
}

}  // namespace limn::scene
