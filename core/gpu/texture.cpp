#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "core/base/error.h"
#include "core/gpu/format.h"
#include "core/gpu/objects.h"
#include "core/gpu/private/object_support.h"

namespace limn::gpu {
namespace {

constexpr ObjectKind kTextureKind{[](const gl::Functions& gl, GLuint id) { gl.DeleteTextures(1, &id); },
                                  &Counters::textures, &Counters::textureBytes};

int extent(int size, int level) {
  return std::max(1, size >> level);
}

bool isVolume(const TextureDesc& desc) {
  return desc.target == GL_TEXTURE_3D;
}

int layersAt(const TextureDesc& desc, int level) {
  return isVolume(desc) ? extent(desc.layers, level) : desc.layers;
}

int64_t levelTexels(const TextureDesc& desc, int level) {
  return int64_t{extent(desc.width, level)} * extent(desc.height, level) * layersAt(desc, level);
}

struct TargetRules {
  const char* name;
  int maxSize;
  int maxLayers;
};

TargetRules rulesOf(const Device& device, std::string_view label, GLenum target) {
  const Limits& limits = device.limits();
  switch (target) {
    case GL_TEXTURE_2D:
      return {"2D texture", limits.maxTextureSize, 1};
    case GL_TEXTURE_2D_ARRAY:
      return {"2D array texture", limits.maxTextureSize, limits.maxArrayLayers};
    case GL_TEXTURE_CUBE_MAP:
      return {"cube map", limits.maxCubeMapSize, 6};
    case GL_TEXTURE_CUBE_MAP_ARRAY:
      return {"cube map array", limits.maxCubeMapSize, limits.maxArrayLayers};
    case GL_TEXTURE_3D:
      return {"3D texture", limits.max3dTextureSize, limits.max3dTextureSize};
    default:
      throw Error(
          fmt::format("texture '{}' has target 0x{:04X}: accepted are 2D, 2D array, cube map, cube "
                      "map array and 3D",
                      label, target));
  }
}

void allocate(const gl::Functions& gl, GLuint id, const TextureDesc& desc) {
  if (desc.target == GL_TEXTURE_2D || desc.target == GL_TEXTURE_CUBE_MAP) {
    gl.TextureStorage2D(id, desc.levels, desc.format, desc.width, desc.height);
  } else {
    gl.TextureStorage3D(id, desc.levels, desc.format, desc.width, desc.height, desc.layers);
  }
}

}  // namespace

int fullMipLevels(int width, int height, int depth) {
  return static_cast<int>(std::bit_width(static_cast<unsigned>(std::max({width, height, depth, 1}))));
}

TextureDesc resolved(TextureDesc desc) {
  if (desc.levels == 0)
    desc.levels = fullMipLevels(desc.width, desc.height, isVolume(desc) ? desc.layers : 1);
  return desc;
}

int64_t textureBytes(const TextureDesc& desc) {
  const TextureDesc full = resolved(desc);
  int64_t texels = 0;
  for (int level = 0; level < full.levels; ++level) texels += levelTexels(full, level);
  return texels * formatInfo(full.format).bytes;
}

void checkTextureDesc(const Device& device, std::string_view label, const TextureDesc& desc) {
  const TargetRules rules = rulesOf(device, label, desc.target);
  const auto refuse = [&](const std::string& problem) {
    throw Error(fmt::format("{} '{}' of {} x {} x {} with {} levels: {}", rules.name, label, desc.width,
                            desc.height, desc.layers, desc.levels, problem));
  };
  if (!findFormat(desc.format)) refuse(fmt::format("format 0x{:04X} is not one that limn uses", desc.format));
  if (desc.width < 1 || desc.height < 1 || std::max(desc.width, desc.height) > rules.maxSize) {
    refuse(fmt::format("width and height may be 1 to {}", rules.maxSize));
  }
  if (desc.layers < 1 || desc.layers > rules.maxLayers)
    refuse(fmt::format("layers may be 1 to {}", rules.maxLayers));
  const int chain = resolved({.target = desc.target,
                              .width = desc.width,
                              .height = desc.height,
                              .layers = desc.layers,
                              .levels = 0})
                        .levels;
  if (desc.levels < 0 || desc.levels > chain) refuse(fmt::format("levels may be 0 (all) to {}", chain));
  const bool cube = desc.target == GL_TEXTURE_CUBE_MAP || desc.target == GL_TEXTURE_CUBE_MAP_ARRAY;
  if (cube && (desc.width != desc.height || desc.layers % 6 != 0))
    refuse("faces are square and come in sixes");
}

Texture::Texture(Device& device, std::string_view label, const TextureDesc& desc)
    : Object(device, kTextureKind), desc_(resolved(desc)) {
  checkTextureDesc(device, label, desc);
  const gl::Functions& gl = device.gl();
  gl.CreateTextures(desc_.target, 1, &id_);
  count(textureBytes(desc_));
  allocate(gl, id_, desc_);
  if (outOfMemory(gl)) {
    throw Error(fmt::format("out of GPU memory for texture '{}' of {} x {} x {} ({} bytes)", label,
                            desc_.width, desc_.height, desc_.layers, textureBytes(desc_)));
  }
  setLabel(GL_TEXTURE, label);
  setSampling(desc_.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST, GL_NEAREST);
}

int Texture::layersOf(int level) const {
  return layersAt(desc_, level);
}

void Texture::setSampling(GLenum minFilter, GLenum magFilter, GLenum wrapS, GLenum wrapT) {
  const gl::Functions& gl = device_->gl();
  gl.TextureParameteri(id_, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(minFilter));
  gl.TextureParameteri(id_, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(magFilter));
  gl.TextureParameteri(id_, GL_TEXTURE_WRAP_S, static_cast<GLint>(wrapS));
  gl.TextureParameteri(id_, GL_TEXTURE_WRAP_T, static_cast<GLint>(wrapT));
  gl.TextureParameteri(id_, GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

void Texture::upload(int level, int layer, GLenum format, GLenum type, const void* data) {
  if (level < 0 || level >= desc_.levels || layer < 0 || layer >= layersOf(level)) {
    throw Error(fmt::format("texture upload to level {}, layer {}: it has {} levels of {} layers", level,
                            layer, desc_.levels, desc_.layers));
  }
  const gl::Functions& gl = device_->gl();
  const int width = extent(desc_.width, level), height = extent(desc_.height, level);
  if (desc_.target == GL_TEXTURE_2D) {
    gl.TextureSubImage2D(id_, level, 0, 0, width, height, format, type, data);
  } else {
    gl.TextureSubImage3D(id_, level, 0, 0, layer, width, height, 1, format, type, data);
  }
}

void Texture::read(int level, GLenum format, GLenum type, void* data, size_t bytes) const {
  if (level < 0 || level >= desc_.levels) {
    throw Error(fmt::format("texture read of level {}: it has {} levels", level, desc_.levels));
  }
  const size_t needed = static_cast<size_t>(levelTexels(desc_, level)) * clientPixelBytes(format, type);
  if (bytes != needed) {
    throw Error(fmt::format("texture read of level {} into {} bytes: it has {} bytes", level, bytes, needed));
  }
  if (needed > static_cast<size_t>(std::numeric_limits<GLsizei>::max())) {
    throw Error(fmt::format("texture read of {} bytes: OpenGL reads at most 2 GiB at once", needed));
  }
  const gl::Functions& gl = device_->gl();
  // Image stores become visible to this read only behind this barrier.
  gl.MemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  gl.GetTextureImage(id_, level, format, type, static_cast<GLsizei>(bytes), data);
}

void Texture::clear(const float (&value)[4]) {
  const FormatInfo info = formatInfo(desc_.format);
  if (info.kind != FormatClass::colour && info.kind != FormatClass::depth) {
    throw Error(fmt::format("texture of format {} is not cleared with a colour or a depth", info.name));
  }
  const GLenum format = info.kind == FormatClass::depth ? GL_DEPTH_COMPONENT : GL_RGBA;
  for (int level = 0; level < desc_.levels; ++level) {
    device_->gl().ClearTexImage(id_, level, format, GL_FLOAT, value);
  }
}

void Texture::clearUint(const uint32_t (&value)[4]) {
  const FormatInfo info = formatInfo(desc_.format);
  if (info.kind != FormatClass::unsignedInteger && info.kind != FormatClass::signedInteger) {
    throw Error(fmt::format("texture of format {} is not cleared with integers", info.name));
  }
  for (int level = 0; level < desc_.levels; ++level) {
    device_->gl().ClearTexImage(id_, level, GL_RGBA_INTEGER, GL_UNSIGNED_INT, value);
  }
}

}  // namespace limn::gpu
