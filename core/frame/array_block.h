// Chooses the block from which the programs of a pass read an array.
#pragma once

#include <map>
#include <string>

#include "core/frame/frame_graph.h"
#include "core/gpu/device.h"

namespace limn::frame {

/// Returns how programs read an array of `count` elements: from a uniform block, from which all invocations
/// load at once, where the device takes one of that size, and from a storage block elsewhere. For the former
/// it sets the definition `countName` to the array's length, which uniform blocks must state; a program that
/// lacks it declares a storage block.
template <class Element>
Access arrayBlock(const gpu::Limits& limits, int count, const char* countName,
                  std::map<std::string, std::string>& defines) {
  static_assert(sizeof(Element) % 16 == 0, "std140 pads other elements, std430 does not");
  const size_t bytes = static_cast<size_t>(count) * sizeof(Element);
  if (bytes > static_cast<size_t>(limits.maxUniformBlockBytes)) return Access::storageLoad;
  defines[countName] = std::to_string(count);
  return Access::uniformBuffer;
}

}  // namespace limn::frame
