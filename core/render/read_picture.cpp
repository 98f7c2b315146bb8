#include "core/render/private/read_picture.h"

#include "glsl/surface/gbuffer.glsl"

namespace limn::render {
namespace {

struct Reader {
  const frame::FrameGraph& graph;
  glm::ivec2 size;

  template <class T>
  std::vector<T> texture(frame::TextureHandle handle, GLenum format, GLenum type, int components) const {
    const gpu::Texture& texture = graph.texture(handle);
    std::vector<T> data(static_cast<size_t>(size.x) * size.y * components * texture.desc().layers);
    texture.read(0, format, type, data.data(), data.size() * sizeof(T));
    return data;
  }

  /// Calls f(pixel of the image, index of the texel): texture rows count from below.
  template <class F>
  void forEachPixel(Image& image, const F& f) const {
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) f(image.pixel(x, size.y - 1 - y), static_cast<size_t>(y) * size.x + x);
  }

  void channels(const GBuffer& gbuffer, bool background, Image& image) const {
    const auto depth = texture<float>(gbuffer.depth, GL_RED, GL_FLOAT, 1);
    const auto instance = texture<uint32_t>(gbuffer.instance, GL_RED_INTEGER, GL_UNSIGNED_INT, 1);
    const auto albedo = texture<float>(gbuffer.albedo, GL_RGBA, GL_FLOAT, 4);
    const auto normal = texture<float>(gbuffer.normal, GL_RG, GL_FLOAT, 2);
    forEachPixel(image, [&](std::span<float> pixel, size_t i) {
      const bool covered = depth[i] > 0;
      pixel[3] = depth[i];
      pixel[4] = covered ? 1.f : 0.f;
      pixel[5] = covered ? static_cast<float>(instance[i]) : -1.f;
      pixel[12] = covered || background ? 1.f : 0.f;
      if (!covered) return;
      const glm::vec3 colour =
          glsl::gbuffer_colour_decode(glm::vec3(albedo[4 * i], albedo[4 * i + 1], albedo[4 * i + 2]));
      const glm::vec3 n = glsl::octahedral_decode(glm::vec2(normal[2 * i], normal[2 * i + 1]));
      for (int c = 0; c < 3; ++c) {
        pixel[static_cast<size_t>(6 + c)] = colour[c];
        pixel[static_cast<size_t>(9 + c)] = n[c];
      }
    });
  }
};

}  // namespace

Image readPicture(const frame::FrameGraph& graph, const Settings& settings, frame::TextureHandle picture,
                  const GBuffer* gbuffer, bool background) {
  const Reader reader{graph, settings.size};
  std::vector<std::string> names{"R", "G", "B"};
  if (gbuffer)
    names.insert(names.end(),
                 {"Z", "coverage", "id", "albedo.R", "albedo.G", "albedo.B", "N.X", "N.Y", "N.Z", "A"});
  Image image(settings.size.x, settings.size.y, names);
  if (isFactor(settings.term)) {
    const auto v = reader.texture<float>(picture, GL_RED, GL_FLOAT, 1);
    reader.forEachPixel(image,
                        [&](std::span<float> pixel, size_t i) { pixel[0] = pixel[1] = pixel[2] = v[i]; });
  } else {
    const auto rgba = reader.texture<float>(picture, GL_RGBA, GL_FLOAT, 4);
    reader.forEachPixel(image, [&](std::span<float> pixel, size_t i) {
      for (size_t c = 0; c < 3; ++c) pixel[c] = rgba[4 * i + c];
    });
  }
  if (gbuffer) reader.channels(*gbuffer, background, image);
  return image;
}

}  // namespace limn::render
