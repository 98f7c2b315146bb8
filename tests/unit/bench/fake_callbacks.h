// Callbacks of runs in tests: pictures of one colour instead of rendered ones.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/bench/runner.h"

namespace limn::bench::test {

/// Callbacks that count their calls; the picture of technique "bad" fails.
struct Fakes {
  int references = 0, measurements = 0, timings = 0;
  Callbacks callbacks() {
    Callbacks made;
    made.reference = [this](const Case& c) {
      ++references;
      Reference reference{Image::rgb(c.width, c.height), "reference.exr", 0.001, std::nullopt};
      std::ranges::fill(reference.image.data(), 0.5f);
      return reference;
    };
    made.keepPicture = [](const std::string& name, const Image&) { return "pictures/" + name + ".png"; };
    made.measure = [this](const Case& c) {
      ++measurements;
      if (c.technique == "bad") throw Error("shader does not compile");
      Measurement m{Image::rgb(c.width, c.height), {}};
      std::ranges::fill(m.image.data(), 0.6f);
      m.cost.frameMs = {1, 1, 1, c.frames, std::vector<double>(static_cast<std::size_t>(c.frames), 1)};
      return m;
    };
    made.time = [this](const Case& c) {
      if (c.technique == "lost") throw Error("out of memory");
      return std::vector<double>(static_cast<std::size_t>(c.frames), ++timings);
    };
    return made;
  }
};

}  // namespace limn::bench::test
