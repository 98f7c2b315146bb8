// Declares move-only owners of OpenGL objects. A default-constructed owner owns nothing and may be destroyed
// or assigned to. All use direct state access; none touches bindings except through explicit bind calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/gpu/device.h"

namespace limn::gpu {

/// Says how objects of one kind are deleted, and where the device counts them.
struct ObjectKind {
  void (*remove)(const gl::Functions& gl, GLuint id);
  int Counters::*count;
  int64_t Counters::*bytes = nullptr;  ///< null: of kinds whose memory is not counted
};

/// Holds what all owners share: the device, the object's name and its kind, which move together. Deletes the
/// object in its own context.
class LIMN_API Object {
 public:
  GLuint id() const { return id_; }
  explicit operator bool() const { return id_ != 0; }
  Device& device() const { return *device_; }

 protected:
  Object() = default;
  Object(Device& device, const ObjectKind& kind) : device_(&device), kind_(&kind) {}
  Object(Object&& other) noexcept;
  Object& operator=(Object&& other) noexcept;
  ~Object();
  /// Counts the object, which takes `bytes`. To be called as soon as id_ is set, so that a constructor that
  /// throws later deletes what is counted.
  void count(int64_t bytes = 0);
  void setLabel(GLenum kind, std::string_view label) const;

  Device* device_ = nullptr;
  GLuint id_ = 0;

 private:
  const ObjectKind* kind_ = nullptr;
  int64_t counted_ = 0;  ///< bytes
};

enum class BufferUse {
  fixed,    ///< written by the GPU or once at creation
  updated,  ///< rewritten from the CPU with update(), before the frames that read it
};

/// Returns how many bytes a buffer of `bytes`, more than 0, has room for: up to 64 KiB a power of two, 4 KiB
/// at least. Programs may therefore state a rounded length of the arrays in their uniform blocks, so that one
/// program serves arrays of several lengths.
LIMN_API size_t blockRoom(size_t bytes);

class LIMN_API Buffer : public Object {
 public:
  Buffer() = default;
  /// Creates a buffer with room for blockRoom(bytes). `bytes` may be 0 (then 16 bytes are allocated, so that
  /// the buffer can be bound, and size() is 0). Throws Error when out of memory.
  Buffer(Device& device, std::string_view label, size_t bytes, BufferUse use = BufferUse::fixed,
         const void* data = nullptr);

  size_t size() const { return bytes_; }
  /// Writes part of a buffer made with BufferUse::updated. Throws Error beyond the end, as read() does.
  void update(size_t offset, const void* data, size_t bytes);
  /// Reads part of the buffer; blocks until the GPU is done. Meant for tests, tools and saved results, never
  /// for the frame path.
  void read(size_t offset, void* data, size_t bytes) const;
  void clear(uint32_t value = 0);  ///< sets every 32-bit word; the size must be a multiple of 4

  template <class T>
  static Buffer of(Device& device, std::string_view label, std::span<const T> data,
                   BufferUse use = BufferUse::fixed) {
    return Buffer(device, label, data.size_bytes(), use, data.data());
  }

 private:
  size_t bytes_ = 0;
  BufferUse use_ = BufferUse::fixed;
};

/// Describes a texture. Textures with equal descriptions are interchangeable: the frame graph's pool uses the
/// description as its key.
struct TextureDesc {
  GLenum target = GL_TEXTURE_2D;  ///< GL_TEXTURE_2D, _2D_ARRAY, _CUBE_MAP, _CUBE_MAP_ARRAY or _3D
  GLenum format = GL_RGBA8;       ///< sized internal format
  int width = 1, height = 1;
  int layers = 1;  ///< array layers, depth of a 3D texture, 6 x cubes of a cube map array; 6 for a cube map
  int levels = 1;  ///< mip levels; 0: the full chain
  bool operator==(const TextureDesc&) const = default;
};

/// Returns the number of mip levels of a full chain.
LIMN_API int fullMipLevels(int width, int height, int depth = 1);
/// Returns the description with levels = 0 replaced by the length of the full chain.
LIMN_API TextureDesc resolved(TextureDesc desc);
/// Returns the bytes of all levels and layers as limn counts them (the driver's padding is not known).
LIMN_API int64_t textureBytes(const TextureDesc& desc);
/// Throws Error for an unknown target or format, a size that is not positive or exceeds the device's limits,
/// too many levels, and a cube map that is not square or lacks faces.
LIMN_API void checkTextureDesc(const Device& device, std::string_view label, const TextureDesc& desc);

class LIMN_API Texture : public Object {
 public:
  Texture() = default;
  /// Allocates immutable storage. Minification is nearest (or nearest mipmap), magnification nearest, edges
  /// are clamped, unless setSampling() changes that; passes that filter bind a Sampler or set this at
  /// creation.
  Texture(Device& device, std::string_view label, const TextureDesc& desc);

  const TextureDesc& desc() const { return desc_; }  ///< levels resolved
  /// Returns the layers (depth of a 3D texture) of one level.
  int layersOf(int level) const;
  void setSampling(GLenum minFilter, GLenum magFilter, GLenum wrapS = GL_CLAMP_TO_EDGE,
                   GLenum wrapT = GL_CLAMP_TO_EDGE);
  /// Uploads one level of one layer (of a cube map: one face). `format` and `type` describe `data`, tightly
  /// packed.
  void upload(int level, int layer, GLenum format, GLenum type, const void* data);
  /// Reads one whole level, all layers, tightly packed; `bytes` must be exactly that size. Blocks; never to
  /// be used on the frame path.
  void read(int level, GLenum format, GLenum type, void* data, size_t bytes) const;
  /// Sets all levels and layers to one value: clear() for colour and depth formats, clearUint() for integer
  /// ones. Throws Error for other formats.
  void clear(const float (&value)[4]);
  void clearUint(const uint32_t (&value)[4]);

 private:
  TextureDesc desc_;
};

/// Describes one image attached to a framebuffer. A layer of -1 attaches all layers (layered rendering).
struct Attachment {
  const Texture* texture = nullptr;
  int level = 0;
  int layer = -1;
};

class LIMN_API Framebuffer : public Object {
 public:
  Framebuffer() = default;
  /// Creates a framebuffer with any number of colour attachments and an optional depth attachment. Throws
  /// Error naming the status when incomplete, as without any.
  Framebuffer(Device& device, std::string_view label, std::span<const Attachment> colours,
              Attachment depth = {});
};

class LIMN_API Sampler : public Object {
 public:
  Sampler() = default;
  Sampler(Device& device, GLenum minFilter, GLenum magFilter, GLenum wrap = GL_CLAMP_TO_EDGE);
};

struct VertexAttribute {
  GLuint location;
  GLint components;
  GLenum type;
  bool normalised = false;
  bool integer = false;
  GLuint offset = 0;   ///< within one element, bytes
  GLuint binding = 0;  ///< vertex buffer binding it reads
};

/// Holds attribute formats; the buffers are bound per draw with glVertexArrayVertexBuffer.
class LIMN_API VertexArray : public Object {
 public:
  VertexArray() = default;
  VertexArray(Device& device, std::span<const VertexAttribute> attributes);
};

class LIMN_API Query : public Object {
 public:
  Query() = default;
  Query(Device& device, GLenum target);
  void begin();
  void end();
  uint64_t result() const;  ///< blocks until the GPU has it

 private:
  GLenum target_ = 0;
};

/// Describes what a program accesses by a name in its GLSL, and the unit that limn assigned to it.
struct ShaderResource {
  enum class Kind : uint8_t { sampler, image, uniformBlock, storageBlock };
  Kind kind = Kind::sampler;
  GLuint unit = 0;   ///< texture unit, image unit or binding of a block
  std::string name;  ///< of the variable, or of the block
};

class LIMN_API Program : public Object {
 public:
  Program() = default;
  /// Takes ownership of a linked program object (see ShaderLibrary).
  Program(Device& device, GLuint program, std::string label);
  void use() const;
  const std::string& label() const { return label_; }
  /// Returns the number of this linking, which no other program of the process has. id() may be that of a
  /// program that was deleted.
  uint64_t serial() const { return serial_; }
  /// Returns the samplers, images and blocks that the linked program uses. The first call gives each a unit
  /// of its own, counted from 0 for each kind, in the order of their names.
  const std::vector<ShaderResource>& resources();
  // The set functions write plain uniforms, which are allowed for a few scalars per dispatch. On software
  // renderers a name that is no active uniform is a bug and throws Error; on hardware, whose compilers remove
  // more, it is ignored.
  void set(const char* name, int value);
  void set(const char* name, unsigned value);
  void set(const char* name, float value);
  void set4(const char* name, const float* value);

 private:
  GLint location(const char* name);
  std::string label_;
  uint64_t serial_ = 0;
  std::optional<std::vector<ShaderResource>> resources_;
  std::vector<std::pair<std::string, GLint>>
      locations_;  ///< those queried so far: a query may wait for the driver
};

}  // namespace limn::gpu
