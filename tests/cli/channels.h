// The channels of a picture that limn wrote, read without limn.
#pragma once

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace limn::test {

/// Values of a channel of an EXR, pixel after pixel.
class Channels {
 public:
  explicit Channels(const std::filesystem::path& file) {
    const auto input = OIIO::ImageInput::open(file.string());
    if (!input) return;
    names_ = input->spec().channelnames;
    values_.resize(input->spec().image_pixels() * names_.size());
    input->read_image(0, 0, 0, static_cast<int>(names_.size()), OIIO::TypeDesc::FLOAT, values_.data());
  }
  size_t size() const { return names_.empty() ? 0 : values_.size() / names_.size(); }
  bool has(const std::string& name) const { return std::ranges::find(names_, name) != names_.end(); }
  float at(size_t pixel, const std::string& name) const {
    const auto channel = static_cast<size_t>(std::ranges::find(names_, name) - names_.begin());
    return values_.at(pixel * names_.size() + channel);
  }

 private:
  std::vector<std::string> names_;
  std::vector<float> values_;
};

}  // namespace limn::test
