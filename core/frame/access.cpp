#include "core/frame/private/access.h"

namespace limn::frame {

std::string_view name(Access access) {
  switch (access) {
    case Access::sampled:
      return "sampled";
    case Access::imageLoad:
      return "imageLoad";
    case Access::uniformBuffer:
      return "uniformBuffer";
    case Access::storageLoad:
      return "storageLoad";
    case Access::vertexBuffer:
      return "vertexBuffer";
    case Access::indexBuffer:
      return "indexBuffer";
    case Access::indirectBuffer:
      return "indirectBuffer";
    case Access::copySource:
      return "copySource";
    case Access::imageStore:
      return "imageStore";
    case Access::storageStore:
      return "storageStore";
    case Access::colourAttachment:
      return "colourAttachment";
    case Access::depthAttachment:
      return "depthAttachment";
    case Access::copyTarget:
      return "copyTarget";
    case Access::imageLoadStore:
      return "imageLoadStore";
    case Access::storageLoadStore:
      return "storageLoadStore";
    case Access::colourBlend:
      return "colourBlend";
    case Access::depthTest:
      return "depthTest";
  }
  return "unknown";
}

bool isWrite(Access access) {
  return access >= Access::imageStore;
}

bool isReadModifyWrite(Access access) {
  return access >= Access::imageLoadStore;
}

bool isShaderWrite(Access access) {
  return access == Access::imageStore || access == Access::storageStore || access == Access::imageLoadStore ||
         access == Access::storageLoadStore;
}

bool isShaderAccess(Access access) {
  switch (access) {
    case Access::sampled:
    case Access::imageLoad:
    case Access::uniformBuffer:
    case Access::storageLoad:
      return true;
    default:
      return isShaderWrite(access);
  }
}

bool fitsTexture(Access access) {
  switch (access) {
    case Access::sampled:
    case Access::imageLoad:
    case Access::imageStore:
    case Access::imageLoadStore:
    case Access::colourAttachment:
    case Access::depthAttachment:
    case Access::colourBlend:
    case Access::depthTest:
    case Access::copySource:
    case Access::copyTarget:
      return true;
    default:
      return false;
  }
}

bool fitsBuffer(Access access) {
  return !fitsTexture(access) || access == Access::copySource || access == Access::copyTarget;
}

GLbitfield barrierBit(Access access, bool texture) {
  switch (access) {
    case Access::sampled:
      return GL_TEXTURE_FETCH_BARRIER_BIT;
    case Access::imageLoad:
    case Access::imageStore:
    case Access::imageLoadStore:
      return GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
    case Access::uniformBuffer:
      return GL_UNIFORM_BARRIER_BIT;
    case Access::storageLoad:
    case Access::storageStore:
    case Access::storageLoadStore:
      return GL_SHADER_STORAGE_BARRIER_BIT;
    case Access::vertexBuffer:
      return GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT;
    case Access::indexBuffer:
      return GL_ELEMENT_ARRAY_BARRIER_BIT;
    case Access::indirectBuffer:
      return GL_COMMAND_BARRIER_BIT;
    case Access::copySource:
    case Access::copyTarget:
      return texture ? GL_TEXTURE_UPDATE_BARRIER_BIT : GL_BUFFER_UPDATE_BARRIER_BIT;
    case Access::colourAttachment:
    case Access::depthAttachment:
    case Access::colourBlend:
    case Access::depthTest:
      return GL_FRAMEBUFFER_BARRIER_BIT;
  }
  return GL_ALL_BARRIER_BITS;
}

}  // namespace limn::frame
