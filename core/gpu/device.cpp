#include "core/gpu/device.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "core/base/error.h"

namespace limn::gpu {
namespace {

template <class T>
T query(const gl::Functions& gl, GLenum what) {
  GLint64 value = 0;
  gl.GetInteger64v(what, &value);
  return static_cast<T>(value);
}

bool hasExtension(const gl::Functions& gl, std::string_view wanted) {
  const auto count = query<GLuint>(gl, GL_NUM_EXTENSIONS);
  for (GLuint i = 0; i < count; ++i) {
    if (wanted == reinterpret_cast<const char*>(gl.GetStringi(GL_EXTENSIONS, i))) return true;
  }
  return false;
}

Limits queryLimits(const gl::Functions& gl) {
  return {
      .maxTextureSize = query<int>(gl, GL_MAX_TEXTURE_SIZE),
      .max3dTextureSize = query<int>(gl, GL_MAX_3D_TEXTURE_SIZE),
      .maxCubeMapSize = query<int>(gl, GL_MAX_CUBE_MAP_TEXTURE_SIZE),
      .maxArrayLayers = query<int>(gl, GL_MAX_ARRAY_TEXTURE_LAYERS),
      .maxColourAttachments = query<int>(gl, GL_MAX_COLOR_ATTACHMENTS),
      .maxStorageBlockBytes = query<int64_t>(gl, GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
      .maxUniformBlockBytes = query<int>(gl, GL_MAX_UNIFORM_BLOCK_SIZE),
      .maxSharedMemoryBytes = query<int>(gl, GL_MAX_COMPUTE_SHARED_MEMORY_SIZE),
      .uniformAlignment = query<int>(gl, GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT),
      .layerFromVertexShader = hasExtension(gl, "GL_ARB_shader_viewport_layer_array") ||
                               hasExtension(gl, "GL_AMD_vertex_shader_layer"),
  };
}

/// OpenGL promises storage blocks to fragments and compute shaders alone.
void checkStages(const gl::Functions& gl, const std::string& renderer) {
  constexpr int vertex = 6, geometry = 1;  // what limn's shaders need
  const int vertexBlocks = query<int>(gl, GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
            geometryBlocks = query<int>(gl, GL_MAX_GEOMETRY_SHADER_STORAGE_BLOCKS);
  if (vertexBlocks < vertex || geometryBlocks < geometry)
    throw Error(
        fmt::format("{} offers {} storage blocks in vertex and {} in geometry shaders: limn needs {} and {}",
                    renderer, vertexBlocks, geometryBlocks, vertex, geometry));
}

}  // namespace

Device::Device(Context& context)
    : context_(context), software_(context.info().software && std::getenv("LIMN_HARDWARE_PATHS") == nullptr) {
  const ContextScope scope(&context);
  const gl::Functions& gl = context.gl();
  checkStages(gl, context.info().renderer);
  limits_ = queryLimits(gl);
  gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.Enable(GL_TEXTURE_CUBE_MAP_SEAMLESS);
  gl.Disable(GL_FRAMEBUFFER_SRGB);  // passes write linear values; tone mapping encodes by itself
  gl.Disable(GL_DITHER);            // on by default; it may alter what is written to narrow formats
}

Device::~Device() = default;

}  // namespace limn::gpu
