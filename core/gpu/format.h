// Declares what limn knows about sized internal formats and about pixels in client memory.
#pragma once

#include <cstddef>
#include <optional>

#include "core/base/export.h"
#include "core/context/gl_functions.h"

namespace limn::gpu {

enum class FormatClass { colour, unsignedInteger, signedInteger, depth, depthStencil };

struct FormatInfo {
  GLenum format;  ///< sized internal format
  const char* name;
  int bytes;  ///< of one texel
  int components;
  FormatClass kind;
  GLenum clientFormat;  ///< format and type that read or write a texel without conversion
  GLenum clientType;
};

/// Returns the description of a format that limn uses, or nothing for any other.
LIMN_API std::optional<FormatInfo> findFormat(GLenum format);
/// Returns the description of a format. Throws Error for a format that limn does not use.
LIMN_API FormatInfo formatInfo(GLenum format);
/// Returns the bytes of one pixel of `format`/`type` in client memory, tightly packed. Throws Error for an
/// unknown combination.
LIMN_API size_t clientPixelBytes(GLenum format, GLenum type);

}  // namespace limn::gpu
