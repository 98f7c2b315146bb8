#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "core/gpu/objects.h"
#include "core/gpu/private/object_support.h"

namespace limn::gpu {
namespace {

constexpr size_t kMinimumBytes = 16;

constexpr ObjectKind kBufferKind{[](const gl::Functions& gl, GLuint id) { gl.DeleteBuffers(1, &id); },
                                 &Counters::buffers, &Counters::bufferBytes};

size_t storageBytes(size_t bytes) {
  return bytes == 0 ? kMinimumBytes : blockRoom(bytes);
}

void checkRange(const char* what, size_t offset, size_t bytes, size_t size) {
  if (offset > size || bytes > size - offset) {
    throw Error(
        fmt::format("buffer {} of {} bytes at {} is outside its {} bytes", what, bytes, offset, size));
  }
}

}  // namespace

size_t blockRoom(size_t bytes) {
  constexpr size_t kLeast = 4096, kMost = 65536;  // a page; what most devices take in a uniform block
  return bytes > kMost ? bytes : std::bit_ceil(std::max(bytes, kLeast));
}

Buffer::Buffer(Device& device, std::string_view label, size_t bytes, BufferUse use, const void* data)
    : Object(device, kBufferKind), bytes_(bytes), use_(use) {
  if (bytes > static_cast<size_t>(std::numeric_limits<GLsizeiptr>::max())) {
    throw Error(fmt::format("buffer '{}' of {} bytes is larger than memory can be", label, bytes));
  }
  const gl::Functions& gl = device.gl();
  const size_t storage = storageBytes(bytes);
  std::vector<std::byte> padded;
  if (data != nullptr && storage != bytes) {
    padded.resize(storage);
    std::memcpy(padded.data(), data, bytes);
    data = padded.data();
  }
  gl.CreateBuffers(1, &id_);
  count(static_cast<int64_t>(bytes == 0 ? kMinimumBytes : bytes));
  gl.NamedBufferStorage(id_, static_cast<GLsizeiptr>(storage), data,
                        use == BufferUse::updated ? GL_DYNAMIC_STORAGE_BIT : 0);
  if (outOfMemory(gl))
    throw Error(fmt::format("out of GPU memory for buffer '{}' of {} bytes", label, bytes));
  setLabel(GL_BUFFER, label);
}

void Buffer::update(size_t offset, const void* data, size_t bytes) {
  checkRange("update", offset, bytes, bytes_);
  if (use_ != BufferUse::updated) throw Error("buffer update needs BufferUse::updated at creation");
  if (bytes == 0) return;
  device_->gl().NamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void Buffer::read(size_t offset, void* data, size_t bytes) const {
  checkRange("read", offset, bytes, bytes_);
  if (bytes == 0) return;
  // Shader writes become visible to this read only behind this barrier.
  device_->gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  device_->gl().GetNamedBufferSubData(id_, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes),
                                      data);
}

void Buffer::clear(uint32_t value) {
  if (bytes_ % sizeof value != 0)
    throw Error(fmt::format("buffer of {} bytes cannot be cleared by words of 4", bytes_));
  device_->gl().MemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);  // after shaders' writes
  device_->gl().ClearNamedBufferData(id_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
}

}  // namespace limn::gpu
