// Fills single empty bins, as radiosity::BinFiller::close: a thread for each leaf and face.
#include "techniques/implicit_visibility/elements.glsl"

layout(local_size_x = 64) in;
layout(std430) buffer Links { uint links[]; };
layout(std430) buffer Distances { float distances[]; };
uniform uint leaf_count;

const uint n = BINS;

void main() {
  uint index = work_item_index();
  uint row = index / 6u;
  if (row >= leaf_count) return;
  uint first = row * bin_count + index % 6u * n * n;
  for (uint sweep = 0u; sweep < 2u; ++sweep)
    for (uint bin = 0u; bin < n * n; ++bin) {
      if (links[first + bin] != no_link) continue;
      uint x = bin % n;
      uint y = bin / n;
      bool inside[4] = bool[](x > 0u, x + 1u < n, y > 0u, y + 1u < n);
      uint neighbours[4] = uint[](bin - 1u, bin + 1u, bin - n, bin + n);
      uint missing = 0u;
      float longest = -1.0;
      uint link = no_link;
      for (int k = 0; k < 4; ++k) {
        if (!inside[k]) continue;
        uint other = links[first + neighbours[k]];
        float distance2 = distances[first + neighbours[k]];
        if (other == no_link) {
          ++missing;
        } else if (distance2 > longest) {
          longest = distance2;
          link = other;
        }
      }
      if (missing <= 1u) {
        links[first + bin] = link;
        distances[first + bin] = longest;
      }
    }
}
