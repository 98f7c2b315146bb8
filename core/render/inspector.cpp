#include "core/render/inspector.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace limn::render {
namespace {

using frame::Access;

const char* samplerFor(gpu::FormatClass kind) {
  switch (kind) {
    case gpu::FormatClass::unsignedInteger:
      return "usampler2D";
    case gpu::FormatClass::signedInteger:
      return "isampler2D";
    default:
      return "sampler2D";
  }
}

bool isInteger(gpu::FormatClass kind) {
  return kind == gpu::FormatClass::unsignedInteger || kind == gpu::FormatClass::signedInteger;
}

bool isDepth(gpu::FormatClass kind) {
  return kind == gpu::FormatClass::depth || kind == gpu::FormatClass::depthStencil;
}

/// The lower left corner of the texels.
template <class T>
std::vector<T> cropped(const std::vector<T>& all, int width, glm::ivec2 size, size_t components) {
  std::vector<T> part(components * static_cast<size_t>(size.x) * static_cast<size_t>(size.y));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const auto from = static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      const auto to = static_cast<size_t>(y) * static_cast<size_t>(size.x) + static_cast<size_t>(x);
      std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(components * from), components,
                  part.begin() + static_cast<std::ptrdiff_t>(components * to));
    }
  }
  return part;
}

}  // namespace

double InspectedValues::at(int x, int y, int component) const {
  if (component >= components) return 0;
  const auto texel = static_cast<size_t>(y) * static_cast<size_t>(size.x) + static_cast<size_t>(x);
  const size_t i = static_cast<size_t>(components) * texel + static_cast<size_t>(component);
  if (kind == gpu::FormatClass::unsignedInteger) return integers[i];
  if (kind == gpu::FormatClass::signedInteger) return static_cast<int32_t>(integers[i]);
  return static_cast<double>(reals[i]);
}

InspectedValues::Range InspectedValues::range(int component) const {
  Range range{std::numeric_limits<double>::max(), std::numeric_limits<double>::lowest(), 0, 0};
  size_t count = 0;
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const double value = at(x, y, component);
      if (!std::isfinite(value)) {
        ++range.notFinite;
        continue;
      }
      range.low = std::min(range.low, value);
      range.high = std::max(range.high, value);
      range.mean += value;
      ++count;
    }
  }
  if (count == 0) return {.low = 0, .high = 0, .mean = 0, .notFinite = range.notFinite};
  range.mean /= static_cast<double>(count);
  return range;
}

TextureInspector::TextureInspector(frame::FrameGraph& graph, frame::TextureHandle texture,
                                   const InspectionView& view)
    : graph_(graph), desc_(gpu::resolved(graph.desc(texture))), view_(view) {
  const gpu::TextureDesc flat{.format = desc_.format, .width = desc_.width, .height = desc_.height};
  frame::PassBuilder copying = graph.addPass("copy", passOwner);
  copying.role(frame::PassRole::core).read(texture, Access::copySource, "the texture looked at");
  copy_ = copying.write(graph.createTexture("values", flat), Access::copyTarget, "one level of one layer");
  copying.execute(
      [this, handles = Copy{texture, copy_}](frame::PassContext& context) { copy(context, handles); });
  graph.output(copy_);

  frame::PassBuilder showing = graph.addPass("show", passOwner);
  showing.role(frame::PassRole::core).read(copy_, Access::sampled, "values", "values");
  display_ = showing.write(
      graph.createTexture("colours", {.format = GL_RGBA8, .width = desc_.width, .height = desc_.height}),
      Access::imageStore, "display", "what people see of them");
  const auto program =
      showing.program({.files = {"glsl/inspect/show.comp.glsl"},
                       .defines = {{"SAMPLER", samplerFor(gpu::formatInfo(desc_.format).kind)}}});
  showing.execute([this, program](frame::PassContext& context) {
    gpu::Program& kernel = context.use(program);
    kernel.set("channel", view_.channel);
    kernel.set("low", view_.low);
    kernel.set("high", view_.high);
    context.dispatch(desc_.width, desc_.height, 1, 8, 8);
  });
  graph.output(display_);
}

void TextureInspector::copy(const frame::PassContext& context, const Copy& handles) const {
  const gpu::Texture& source = context.texture(handles.source);
  const int level = std::clamp(view_.level, 0, desc_.levels - 1);
  const int layer = std::clamp(view_.layer, 0, layersOf(level) - 1);
  const glm::ivec2 size = sizeOf(level);
  context.gl().CopyImageSubData(source.id(), desc_.target, level, 0, 0, layer,
                                context.texture(handles.copy).id(), GL_TEXTURE_2D, 0, 0, 0, 0, size.x, size.y,
                                1);
}

glm::ivec2 TextureInspector::sizeOf(int level) const {
  return {std::max(1, desc_.width >> level), std::max(1, desc_.height >> level)};
}

int TextureInspector::layersOf(int level) const {
  return desc_.target == GL_TEXTURE_3D ? std::max(1, desc_.layers >> level) : desc_.layers;
}

const gpu::Texture& TextureInspector::display() const {
  return graph_.texture(display_);
}

InspectedValues TextureInspector::read() const {
  const gpu::FormatInfo info = gpu::formatInfo(desc_.format);
  InspectedValues values{.size = sizeOf(std::clamp(view_.level, 0, desc_.levels - 1)),
                         .components = isDepth(info.kind) ? 1 : info.components,
                         .kind = info.kind,
                         .reals = {},
                         .integers = {}};
  // No more than the texture has: OpenGL reads at most 2 GiB at once.
  const GLenum format = isDepth(info.kind) ? GL_DEPTH_COMPONENT : info.clientFormat;
  const auto components = static_cast<size_t>(values.components);
  const size_t count = components * static_cast<size_t>(desc_.width) * static_cast<size_t>(desc_.height);
  const gpu::Texture& texture = graph_.texture(copy_);
  if (isInteger(info.kind)) {
    std::vector<uint32_t> all(count);
    texture.read(0, format, info.kind == gpu::FormatClass::signedInteger ? GL_INT : GL_UNSIGNED_INT,
                 all.data(), count * sizeof(uint32_t));
    values.integers = cropped(all, desc_.width, values.size, components);
  } else {
    std::vector<float> all(count);
    texture.read(0, format, GL_FLOAT, all.data(), count * sizeof(float));
    values.reals = cropped(all, desc_.width, values.size, components);
  }
  return values;
}

}  // namespace limn::render
