// What draws the photons of each layer of the caustic maps: for each layer a command for each run of rays, those of one path and
// one layer of the rays, which lie together in the list. Runs of other lights draw nothing.
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/caustics/listed_ray.glsl"
#include "glsl/numeric/work_items.glsl"
#include "glsl/shadow/shadow_view.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Layers { CausticLayer layers[]; };
layout(std430) readonly buffer SceneLights { ShadowLight scene_lights[]; };
layout(std430) writeonly buffer MapDraws { RayDraw map_draws[]; };
uniform uint map_layers;
uniform uint layer_count;  // of the rays
uniform uint path_count;
uniform uint layer_rays;   // rays of a layer and path

// How many photons are of rays before this one: the list is ascending.
uint photons_before(uint ray) {
  uint low = 0u;
  uint high = draws[0].vertices / 3u;
  while (low < high) {
    uint middle = (low + high) / 2u;
    if (uint(listed_ray(0u, int(middle))) < ray) {
      low = middle + 1u;
    } else {
      high = middle;
    }
  }
  return low;
}

void main() {
  uint command = work_item_index();
  uint runs = layer_count * path_count;
  if (command >= map_layers * runs) return;
  uint run = command % runs;
  ShadowLight maps = scene_lights[uint(layers[run % layer_count].light)];
  RayDraw draw = RayDraw(0u, 1u, 0u, 0u);
  if (command / runs - maps.first_layer < shadow_face_count(maps.faces)) {
    uint first = photons_before(run * layer_rays);
    draw.vertices = 3u * (photons_before((run + 1u) * layer_rays) - first);
    draw.first_vertex = 3u * first;
  }
  map_draws[command] = draw;
}
