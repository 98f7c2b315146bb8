#include "core/gpu/format.h"

#include <fmt/format.h>

#include <array>

#include "core/base/error.h"

namespace limn::gpu {
namespace {

#define LIMN_FORMAT(NAME, BYTES, COMPONENTS, KIND, CLIENT_FORMAT, CLIENT_TYPE)                   \
  FormatInfo {                                                                                   \
    GL_##NAME, #NAME, BYTES, COMPONENTS, FormatClass::KIND, GL_##CLIENT_FORMAT, GL_##CLIENT_TYPE \
  }

constexpr std::array kFormats = {
    LIMN_FORMAT(R8, 1, 1, colour, RED, UNSIGNED_BYTE),
    LIMN_FORMAT(R8_SNORM, 1, 1, colour, RED, BYTE),
    LIMN_FORMAT(R16, 2, 1, colour, RED, UNSIGNED_SHORT),
    LIMN_FORMAT(R16_SNORM, 2, 1, colour, RED, SHORT),
    LIMN_FORMAT(R16F, 2, 1, colour, RED, HALF_FLOAT),
    LIMN_FORMAT(R32F, 4, 1, colour, RED, FLOAT),
    LIMN_FORMAT(RG8, 2, 2, colour, RG, UNSIGNED_BYTE),
    LIMN_FORMAT(RG8_SNORM, 2, 2, colour, RG, BYTE),
    LIMN_FORMAT(RG16, 4, 2, colour, RG, UNSIGNED_SHORT),
    LIMN_FORMAT(RG16_SNORM, 4, 2, colour, RG, SHORT),
    LIMN_FORMAT(RG16F, 4, 2, colour, RG, HALF_FLOAT),
    LIMN_FORMAT(RG32F, 8, 2, colour, RG, FLOAT),
    LIMN_FORMAT(RGB32F, 12, 3, colour, RGB, FLOAT),
    LIMN_FORMAT(RGBA8, 4, 4, colour, RGBA, UNSIGNED_BYTE),
    LIMN_FORMAT(RGBA8_SNORM, 4, 4, colour, RGBA, BYTE),
    LIMN_FORMAT(SRGB8_ALPHA8, 4, 4, colour, RGBA, UNSIGNED_BYTE),
    LIMN_FORMAT(RGBA16, 8, 4, colour, RGBA, UNSIGNED_SHORT),
    LIMN_FORMAT(RGBA16_SNORM, 8, 4, colour, RGBA, SHORT),
    LIMN_FORMAT(RGBA16F, 8, 4, colour, RGBA, HALF_FLOAT),
    LIMN_FORMAT(RGBA32F, 16, 4, colour, RGBA, FLOAT),
    LIMN_FORMAT(RGB10_A2, 4, 4, colour, RGBA, UNSIGNED_INT_2_10_10_10_REV),
    LIMN_FORMAT(R11F_G11F_B10F, 4, 3, colour, RGB, UNSIGNED_INT_10F_11F_11F_REV),
    LIMN_FORMAT(RGB9_E5, 4, 3, colour, RGB, UNSIGNED_INT_5_9_9_9_REV),
    LIMN_FORMAT(R8UI, 1, 1, unsignedInteger, RED_INTEGER, UNSIGNED_BYTE),
    LIMN_FORMAT(R16UI, 2, 1, unsignedInteger, RED_INTEGER, UNSIGNED_SHORT),
    LIMN_FORMAT(R32UI, 4, 1, unsignedInteger, RED_INTEGER, UNSIGNED_INT),
    LIMN_FORMAT(RG8UI, 2, 2, unsignedInteger, RG_INTEGER, UNSIGNED_BYTE),
    LIMN_FORMAT(RG16UI, 4, 2, unsignedInteger, RG_INTEGER, UNSIGNED_SHORT),
    LIMN_FORMAT(RG32UI, 8, 2, unsignedInteger, RG_INTEGER, UNSIGNED_INT),
    LIMN_FORMAT(RGBA8UI, 4, 4, unsignedInteger, RGBA_INTEGER, UNSIGNED_BYTE),
    LIMN_FORMAT(RGBA16UI, 8, 4, unsignedInteger, RGBA_INTEGER, UNSIGNED_SHORT),
    LIMN_FORMAT(RGBA32UI, 16, 4, unsignedInteger, RGBA_INTEGER, UNSIGNED_INT),
    LIMN_FORMAT(R8I, 1, 1, signedInteger, RED_INTEGER, BYTE),
    LIMN_FORMAT(R16I, 2, 1, signedInteger, RED_INTEGER, SHORT),
    LIMN_FORMAT(R32I, 4, 1, signedInteger, RED_INTEGER, INT),
    LIMN_FORMAT(RG16I, 4, 2, signedInteger, RG_INTEGER, SHORT),
    LIMN_FORMAT(RG32I, 8, 2, signedInteger, RG_INTEGER, INT),
    LIMN_FORMAT(RGBA16I, 8, 4, signedInteger, RGBA_INTEGER, SHORT),
    LIMN_FORMAT(RGBA32I, 16, 4, signedInteger, RGBA_INTEGER, INT),
    LIMN_FORMAT(DEPTH_COMPONENT16, 2, 1, depth, DEPTH_COMPONENT, UNSIGNED_SHORT),
    LIMN_FORMAT(DEPTH_COMPONENT24, 4, 1, depth, DEPTH_COMPONENT, UNSIGNED_INT),
    LIMN_FORMAT(DEPTH_COMPONENT32F, 4, 1, depth, DEPTH_COMPONENT, FLOAT),
    LIMN_FORMAT(DEPTH24_STENCIL8, 4, 2, depthStencil, DEPTH_STENCIL, UNSIGNED_INT_24_8),
    LIMN_FORMAT(DEPTH32F_STENCIL8, 8, 2, depthStencil, DEPTH_STENCIL, FLOAT_32_UNSIGNED_INT_24_8_REV),
};
#undef LIMN_FORMAT

/// Components of a client format; 0 when unknown.
size_t clientComponents(GLenum format) {
  switch (format) {
    case GL_RED:
    case GL_GREEN:
    case GL_BLUE:
    case GL_ALPHA:
    case GL_RED_INTEGER:
    case GL_DEPTH_COMPONENT:
    case GL_STENCIL_INDEX:
      return 1;
    case GL_RG:
    case GL_RG_INTEGER:
      return 2;
    case GL_RGB:
    case GL_BGR:
    case GL_RGB_INTEGER:
      return 3;
    case GL_RGBA:
    case GL_BGRA:
    case GL_RGBA_INTEGER:
      return 4;
    default:
      return 0;
  }
}

/// Bytes of one component; 0 when unknown or when the type packs a whole pixel.
size_t componentBytes(GLenum type) {
  switch (type) {
    case GL_BYTE:
    case GL_UNSIGNED_BYTE:
      return 1;
    case GL_SHORT:
    case GL_UNSIGNED_SHORT:
    case GL_HALF_FLOAT:
      return 2;
    case GL_INT:
    case GL_UNSIGNED_INT:
    case GL_FLOAT:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

std::optional<FormatInfo> findFormat(GLenum format) {
  for (const FormatInfo& info : kFormats) {
    if (info.format == format) return info;
  }
  return std::nullopt;
}

FormatInfo formatInfo(GLenum format) {
  if (const auto info = findFormat(format)) return *info;
  throw Error(
      fmt::format("texture format 0x{:04X} is not one that limn uses: see core/gpu/format.cpp", format));
}

size_t clientPixelBytes(GLenum format, GLenum type) {
  switch (type) {
    case GL_UNSIGNED_INT_2_10_10_10_REV:
    case GL_UNSIGNED_INT_10F_11F_11F_REV:
    case GL_UNSIGNED_INT_5_9_9_9_REV:
    case GL_UNSIGNED_INT_24_8:
      return 4;
    case GL_FLOAT_32_UNSIGNED_INT_24_8_REV:
      return 8;
    default:
      break;
  }
  const size_t bytes = clientComponents(format) * componentBytes(type);
  if (bytes == 0) {
    throw Error(fmt::format("pixel format 0x{:04X} of type 0x{:04X} is not one that limn reads or writes",
                            format, type));
  }
  return bytes;
}

}  // namespace limn::gpu
