// What draws the photons of each layer of the caustic maps: for each layer, path and view of the light's point a command for the
// run of rays that the view has of the path, which lie together in the list. Each thread takes a run, and writes it for all layers
// of its light's map.
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/caustics/listed_ray.glsl"
#include "glsl/numeric/work_items.glsl"
#include "glsl/shadow/shadow_view.glsl"

layout(local_size_x = 64) in;
layout(std430) readonly buffer Layers { CausticLayer layers[]; };
layout(std430) readonly buffer SceneLights { ShadowLight scene_lights[]; };
layout(std430) writeonly buffer MapDraws { RayDraw map_draws[]; };
uniform uint layer_count;   // of the rays
uniform uint path_count;
uniform uint layer_rays;    // rays of a layer and path
uniform uint point_layers;  // most layers of the rays of one point: commands of a path and layer of the maps

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
  uint run = work_item_index();
  if (run >= layer_count * path_count) return;
  uint path = run / layer_count;
  uint layer = run % layer_count;
  CausticLayer own = layers[layer];
  uint view = layer - own.first;
  uint first = photons_before(run * layer_rays);
  RayDraw draw = RayDraw(3u * (photons_before((run + 1u) * layer_rays) - first), 1u, 3u * first, 0u);
  ShadowLight maps = scene_lights[uint(own.light)];
  for (uint face = 0u; face < shadow_face_count(maps.faces); ++face) {
    uint commands = ((maps.first_layer + face) * path_count + path) * point_layers;
    map_draws[commands + view] = draw;
    // Points with fewer views than others have commands left.
    for (uint left = shadow_face_count(own.faces); view == 0u && left < point_layers; ++left)
      map_draws[commands + left] = RayDraw(0u, 1u, 0u, 0u);
  }
}
