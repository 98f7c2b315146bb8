#include "assets/generator/image.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/base/file.h"

namespace limn::assets {
namespace {

std::uint32_t hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
  std::uint32_t h = x * 0x9e3779b1u ^ y * 0x85ebca77u ^ seed * 0xc2b2ae3du;
  h ^= h >> 15;
  h *= 0x2c1b3c6du;
  h ^= h >> 12;
  h *= 0x297a2d39u;
  return h ^ (h >> 15);
}

float unit(std::uint32_t h) {
  return static_cast<float>(h >> 8) * 0x1p-24f;
}

float encodeSrgb(float x) {
  x = glm::clamp(x, 0.0f, 1.0f);
  return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

template <class T>
void write(const std::filesystem::path& file, int width, int height, int channels, OIIO::TypeDesc type,
           const std::vector<T>& data) {
  TemporaryFile whole(file);
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(width, height, channels, type);
  if (type == OIIO::TypeDesc::FLOAT) spec.attribute("compression", "zip");
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // EXR files carry a date: the same bytes every time
  if (!out || !out->open(whole.path().string(), spec) ||
      !out->write_image(OIIO::BaseTypeFromC<T>::value, data.data()) || !out->close()) {
    throw std::runtime_error(
        fmt::format("cannot write {}: {}", file.string(), out ? out->geterror() : OIIO::geterror()));
  }
  whole.keep();
}

/// The tile under `uv`: its number and the distance to its edge in tiles.
struct Tile {
  glm::ivec2 cell;
  glm::vec2 local;
  float edge;
};

Tile tileAt(glm::vec2 uv, int tiles) {
  const glm::vec2 p = uv * static_cast<float>(tiles), cell = glm::floor(p), local = p - cell;
  const glm::vec2 d = glm::min(local, 1.0f - local);
  return {glm::ivec2(cell), local, std::min(d.x, d.y)};
}

constexpr float kJoint = 0.018f;  ///< half the width of a joint in tiles

float tileHeight(glm::vec2 uv, int tiles) {
  const Tile tile = tileAt(glm::fract(uv), tiles);
  const float bevel = glm::smoothstep(kJoint * 0.6f, kJoint * 2.6f, tile.edge);
  return 0.012f * bevel + 0.0022f * bevel * periodicFractal(uv * 48.0f, 48, 3, 17);
}

}  // namespace

Image makeImage(int width, int height, const std::function<glm::vec4(glm::vec2)>& pixel) {
  Image image{width, height, {}};
  image.pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.pixels.push_back(pixel((glm::vec2(x, y) + 0.5f) / glm::vec2(width, height)));
    }
  }
  return image;
}

void writePng(const Image& image, bool linear, const std::filesystem::path& file) {
  const bool opaque =
      std::all_of(image.pixels.begin(), image.pixels.end(), [](glm::vec4 p) { return p.a >= 1; });
  const int channels = opaque ? 3 : 4;
  std::vector<std::uint8_t> bytes;
  for (const glm::vec4& p : image.pixels) {
    for (int c = 0; c < channels; ++c) {
      const float value = linear || c == 3 ? glm::clamp(p[c], 0.0f, 1.0f) : encodeSrgb(p[c]);
      bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * value)));
    }
  }
  write(file, image.width, image.height, channels, OIIO::TypeDesc::UINT8, bytes);
}

void writeHeights(const Image& image, const std::filesystem::path& file) {
  std::vector<std::uint16_t> values;
  for (const glm::vec4& p : image.pixels)
    values.push_back(static_cast<std::uint16_t>(std::lround(65535 * glm::clamp(p.r, 0.0f, 1.0f))));
  write(file, image.width, image.height, 1, OIIO::TypeDesc::UINT16, values);
}

void writeExr(const Image& image, const std::filesystem::path& file) {
  std::vector<float> values;
  for (const glm::vec4& p : image.pixels) values.insert(values.end(), {p.r, p.g, p.b});
  write(file, image.width, image.height, 3, OIIO::TypeDesc::FLOAT, values);
}

float periodicNoise(glm::vec2 at, int period, std::uint32_t seed) {
  const glm::vec2 cell = glm::floor(at), f = at - cell, s = f * f * (3.0f - 2.0f * f);
  const auto corner = [&](int dx, int dy) {
    const int x = ((static_cast<int>(cell.x) + dx) % period + period) % period;
    const int y = ((static_cast<int>(cell.y) + dy) % period + period) % period;
    return unit(hash(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), seed));
  };
  return glm::mix(glm::mix(corner(0, 0), corner(1, 0), s.x), glm::mix(corner(0, 1), corner(1, 1), s.x), s.y);
}

float periodicFractal(glm::vec2 at, int period, int octaves, std::uint32_t seed) {
  float sum = 0, weight = 1, total = 0;
  for (int i = 0; i < octaves; ++i) {
    sum += weight * periodicNoise(at, period, seed + static_cast<std::uint32_t>(i));
    total += weight;
    at *= 2.0f;
    period *= 2;
    weight *= 0.5f;
  }
  return sum / total;
}

Image tileImage(int size, int tiles, glm::vec3 even, glm::vec3 odd, glm::vec3 joint) {
  return makeImage(size, size, [&](glm::vec2 uv) {
    const Tile tile = tileAt(uv, tiles);
    const std::uint32_t h =
        hash(static_cast<std::uint32_t>(tile.cell.x), static_cast<std::uint32_t>(tile.cell.y), 5);
    const float cloud = periodicFractal(uv * 8.0f, 8, 4, h % 97);
    const glm::vec3 stone =
        ((tile.cell.x + tile.cell.y) % 2 ? odd : even) * (0.82f + 0.24f * cloud + 0.12f * unit(h));
    return glm::vec4(glm::mix(joint, stone, glm::smoothstep(kJoint * 0.7f, kJoint * 1.3f, tile.edge)), 1);
  });
}

Image normalImage(int size, const std::function<float(glm::vec2)>& height) {
  const float h = 1 / static_cast<float>(size);
  return makeImage(size, size, [&](glm::vec2 uv) {
    const float du = height(uv + glm::vec2(h, 0)) - height(uv - glm::vec2(h, 0));
    const float dv = height(uv + glm::vec2(0, h)) - height(uv - glm::vec2(0, h));
    const glm::vec3 n = glm::normalize(glm::vec3(-du / (2 * h), dv / (2 * h), 1));
    return glm::vec4(0.5f * n + 0.5f, 1);
  });
}

Image tileNormalImage(int size, int tiles) {
  return normalImage(size, [tiles](glm::vec2 uv) { return tileHeight(uv, tiles); });
}

Image woodImage(int size, int boards, glm::vec3 light, glm::vec3 dark) {
  return makeImage(size, size, [&](glm::vec2 uv) {
    const float row = std::floor(uv.y * static_cast<float>(boards)),
                across = uv.y * static_cast<float>(boards) - row;
    const auto id = static_cast<std::uint32_t>(row);
    const float shift = unit(hash(id, 3, 11));
    const float along = glm::fract(uv.x + shift);
    const float bend = periodicFractal({along * 4, across * 2 + 7 * row}, 4 * boards, 3, 40 + id);
    const float grain = 0.5f + 0.5f * std::sin(28 * (across + 0.5f * bend) + 9 * unit(hash(id, 1, 2)));
    const float fibre = periodicFractal({along * 16, uv.y * 256}, 256, 2, 77);
    const float shade = 0.15f + 0.45f * grain * bend + 0.25f * fibre + 0.3f * unit(hash(id, 9, 4));
    const float gap = glm::smoothstep(0.0f, 0.03f, std::min(across, 1 - across)) *
                      glm::smoothstep(0.0f, 0.003f, std::min(along, 1 - along));
    return glm::vec4(glm::mix(light, dark, glm::clamp(shade, 0.0f, 1.0f)) * (0.35f + 0.65f * gap), 1);
  });
}

Image marbleImage(int size, glm::vec3 ground, glm::vec3 vein) {
  return makeImage(size, size, [&](glm::vec2 uv) {
    const glm::vec2 warp(periodicFractal(uv * 4.0f, 4, 4, 21), periodicFractal(uv * 4.0f, 4, 4, 31));
    const float ridge = 1 - std::abs(2 * periodicFractal(uv * 3.0f + 2.0f * warp, 3, 5, 8) - 1);
    const float cloud = periodicFractal(uv * 6.0f + warp, 6, 4, 55);
    return glm::vec4(
        glm::mix(ground * (0.9f + 0.15f * cloud), vein, 0.8f * glm::smoothstep(0.9f, 1.0f, ridge)), 1);
  });
}

Image plasterImage(int size, glm::vec3 colour, float contrast) {
  return makeImage(size, size, [&](glm::vec2 uv) {
    const float blotch = periodicFractal(uv * 5.0f, 5, 6, 91) - 0.5f;
    return glm::vec4(colour * (1 + contrast * blotch), 1);
  });
}

}  // namespace limn::assets
