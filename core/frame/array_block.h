// Chooses the block from which the programs of a pass read an array.
#pragma once

#include <algorithm>
#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/gpu/device.h"
#include "core/gpu/objects.h"

namespace limn::frame {

/// Returns how programs read an array of `count` elements: from a uniform block, from which all invocations
/// load at once, where the device takes one of that size, and from a storage block elsewhere. For the former
/// it sets the definition `countName` to a length that the array's buffer has room for, which uniform blocks
/// must state; a program that lacks it declares a storage block. The length is rounded up, so that a light or
/// a face of a map more seldom needs another program.
template <class Element>
Access arrayBlock(const gpu::Limits& limits, int count, const char* countName,
                  std::map<std::string, std::string>& defines) {
  static_assert(sizeof(Element) % 16 == 0, "std140 pads other elements, std430 does not");
  const size_t bytes = static_cast<size_t>(count) * sizeof(Element);
  const auto most = static_cast<size_t>(limits.maxUniformBlockBytes);
  if (bytes > most) return Access::storageLoad;
  defines[countName] = std::to_string(std::min(gpu::blockRoom(bytes), most) / sizeof(Element));
  return Access::uniformBuffer;
}

}  // namespace limn::frame
