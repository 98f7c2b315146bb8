// Procedural pictures: textures that repeat in both directions, and environments.
#pragma once

#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace limn::assets {

/// Linear RGBA, row by row from the top.
struct Image {
  int width = 0, height = 0;
  std::vector<glm::vec4> pixels;
};

/// Evaluates `pixel` at the pixel centres; (0, 0) is the top left corner and (1, 1) the bottom right one.
Image makeImage(int width, int height, const std::function<glm::vec4(glm::vec2)>& pixel);

/// 8-bit PNG, sRGB-encoded unless `linear`. Throws std::runtime_error.
void writePng(const Image& image, bool linear, const std::filesystem::path& file);
/// 16-bit grey PNG of the red channel, as it is. Throws std::runtime_error.
void writeHeights(const Image& image, const std::filesystem::path& file);
/// 32-bit RGB EXR. Throws std::runtime_error.
void writeExr(const Image& image, const std::filesystem::path& file);

/// Smooth noise in [0, 1] that repeats every `period` units (at least 1) in each direction.
float periodicNoise(glm::vec2 at, int period, std::uint32_t seed);
/// Sum of `octaves` of it, each twice as fine and half as strong, in [0, 1].
float periodicFractal(glm::vec2 at, int period, int octaves, std::uint32_t seed);

/// The tangent-space normal map of heights that repeat, in units of the repeat; green points up the picture,
/// against v.
Image normalImage(int size, const std::function<float(glm::vec2)>& height);

/// Square stone tiles with joints, `tiles` a side, alternating between two colours.
Image tileImage(int size, int tiles, glm::vec3 even, glm::vec3 odd, glm::vec3 joint);
/// The tangent-space normal map of those tiles: bevelled edges, slightly rough faces.
Image tileNormalImage(int size, int tiles);
/// Wooden boards along u, `boards` a side.
Image woodImage(int size, int boards, glm::vec3 light, glm::vec3 dark);
/// Veined marble.
Image marbleImage(int size, glm::vec3 ground, glm::vec3 vein);
/// Even plaster with soft blotches.
Image plasterImage(int size, glm::vec3 colour, float contrast);

}  // namespace limn::assets
