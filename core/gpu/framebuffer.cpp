#include <fmt/format.h>

#include "core/base/error.h"
#include "core/gpu/format.h"
#include "core/gpu/objects.h"

namespace limn::gpu {
namespace {

constexpr ObjectKind kFramebufferKind{
    [](const gl::Functions& gl, GLuint id) { gl.DeleteFramebuffers(1, &id); }, &Counters::framebuffers};

std::string_view statusName(GLenum status) {
  switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
      return "GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
      return "GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT";
    case GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER:
      return "GL_FRAMEBUFFER_INCOMPLETE_DRAW_BUFFER";
    case GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER:
      return "GL_FRAMEBUFFER_INCOMPLETE_READ_BUFFER";
    case GL_FRAMEBUFFER_UNSUPPORTED:
      return "GL_FRAMEBUFFER_UNSUPPORTED";
    case GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE:
      return "GL_FRAMEBUFFER_INCOMPLETE_MULTISAMPLE";
    case GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS:
      return "GL_FRAMEBUFFER_INCOMPLETE_LAYER_TARGETS";
    default:
      return "GL_FRAMEBUFFER_UNDEFINED";
  }
}

void attach(const gl::Functions& gl, GLuint framebuffer, GLenum point, const Attachment& attachment) {
  const Texture& texture = *attachment.texture;
  if (attachment.layer < 0 || texture.desc().target == GL_TEXTURE_2D) {
    gl.NamedFramebufferTexture(framebuffer, point, texture.id(), attachment.level);
  } else {
    gl.NamedFramebufferTextureLayer(framebuffer, point, texture.id(), attachment.level, attachment.layer);
  }
}

GLenum depthPoint(const Texture& texture) {
  const FormatInfo info = formatInfo(texture.desc().format);
  return info.kind == FormatClass::depthStencil ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT;
}

void checkAttachment(std::string_view label, const Attachment& attachment) {
  const TextureDesc& desc = attachment.texture->desc();
  const bool flat = desc.target == GL_TEXTURE_2D && attachment.layer > 0;
  if (attachment.level < 0 || attachment.level >= desc.levels || flat ||
      attachment.layer >= attachment.texture->layersOf(attachment.level)) {
    throw Error(
        fmt::format("framebuffer '{}' names level {}, layer {} of a texture with {} levels of {} layers",
                    label, attachment.level, attachment.layer, desc.levels, desc.layers));
  }
}

}  // namespace

Framebuffer::Framebuffer(Device& device, std::string_view label, std::span<const Attachment> colours,
                         Attachment depth)
    : Object(device, kFramebufferKind) {
  if (colours.size() > static_cast<size_t>(device.limits().maxColourAttachments)) {
    throw Error(fmt::format("framebuffer '{}' has {} colours: this device takes {}", label, colours.size(),
                            device.limits().maxColourAttachments));
  }
  for (const Attachment& colour : colours) checkAttachment(label, colour);
  if (depth.texture != nullptr) checkAttachment(label, depth);

  const gl::Functions& gl = device.gl();
  gl.CreateFramebuffers(1, &id_);
  count();
  std::vector<GLenum> drawBuffers;
  for (const Attachment& colour : colours) {
    drawBuffers.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(drawBuffers.size()));
    attach(gl, id_, drawBuffers.back(), colour);
  }
  if (depth.texture != nullptr) attach(gl, id_, depthPoint(*depth.texture), depth);
  if (drawBuffers.empty()) {
    gl.NamedFramebufferDrawBuffer(id_, GL_NONE);
    gl.NamedFramebufferReadBuffer(id_, GL_NONE);
  } else {
    gl.NamedFramebufferDrawBuffers(id_, static_cast<GLsizei>(drawBuffers.size()), drawBuffers.data());
  }
  const GLenum status = gl.CheckNamedFramebufferStatus(id_, GL_DRAW_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    throw Error(fmt::format("framebuffer '{}' is incomplete: {}", label, statusName(status)));
  setLabel(GL_FRAMEBUFFER, label);
}

}  // namespace limn::gpu
