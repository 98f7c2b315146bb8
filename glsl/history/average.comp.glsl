// The mean of this frame's light and of that which frames before it left at the same surfaces. A frame counts at a pixel as
// far as the bilinear neighbours of where it had the pixel's place show that place: the same draw instance, a like normal, and
// no farther from its tangent plane than a pixel is wide.
//
// The frame before the first of them had the samples of this one, so that what differs between the two is no noise: light that
// changed, for which older frames count less. Where a place comes to another pixel, as camera or surface move, a pixel that has a
// part of the samples of a frame has others of them there: what differs then says nothing of the light.
//
// What moves with an instance is found where that was. Where nothing moved, a camera that stands still sees the same surfaces.
//
// PARTS: layers of the light.
#include "glsl/history/history_frame.glsl"
#include "glsl/surface/gbuffer_input.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430) readonly buffer HistoryFrames { HistoryFrame frames[]; };
layout(std430) readonly buffer Instances { Instance instances[]; };
layout(std430) readonly buffer InstancesBefore { Instance instances_before[]; };  // of each slot
uniform int instance_count;
uniform sampler2DArray light;  // rgb / a is the value; a: 0 where there is none, of part 0 below 1 for a part of the samples
uniform sampler2DArray history_light;
uniform usampler2DArray history_surfaces;
layout(rgba32f) writeonly uniform image2DArray averaged;  // rgb: sum over frames; a: their number
uniform int frame_count;  // before this one, the oldest first
uniform int frames_kept;  // a picture is the mean of this many; the frame of that age had the samples of this one

const float least_cosine = 0.8;    // of the angle between normals
const float least_weight = 0.1;    // of neighbours that show the same place, for a frame to count
const float whole_share = 0.99;    // of a frame's samples, less rounding
const float fade_of_change = 8.0;  // of weights per relative change: what changes by all of itself has an eighth of the frames
const float whole_pixel = 1.0 / 64.0;  // pixels: nearer to a pixel's centre than that is at it

// A place as a frame before this one has it.
struct PlaceBefore {
  vec3 position;
  vec3 normal;
  uint instance;
  float reach;  // m, that its neighbours may lie off the tangent plane
};

// Where the frame of a slot had a place of this frame. What did not move stays where it is, flat instances too, whose matrices
// have no inverse.
PlaceBefore place_before(PlaceBefore place, uint slot) {
  mat4 now = instances[place.instance].object_to_world;
  mat4 before = instances_before[int(slot) * instance_count + int(place.instance)].object_to_world;
  if (now == before) return place;
  vec3 own_position = inverse(mat3(now)) * (place.position - now[3].xyz);
  vec3 own_normal = transpose(mat3(now)) * place.normal;
  place.position = mat3(before) * own_position + before[3].xyz;
  place.normal = normalize(transpose(inverse(mat3(before))) * own_normal);
  return place;
}

void add_neighbour(HistoryFrame f, ivec2 pixel, float weight, PlaceBefore place, inout vec4 sums[PARTS]) {
  if (weight <= 0.0 || any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  uvec2 surface = texelFetch(history_surfaces, ivec3(pixel, f.slot), 0).xy;
  vec3 ray = f.view_ray_origin.xyz + float(pixel.x) * f.view_ray_dx.xyz + float(pixel.y) * f.view_ray_dy.xyz;
  vec3 position = f.camera_position.xyz + history_depth(surface) * ray;
  bool same = history_depth(surface) > 0.0 && history_same_instance(surface, place.instance) &&
              dot(history_normal(surface), place.normal) >= least_cosine &&
              abs(dot(place.normal, position - place.position)) <= place.reach;
  if (!same) return;
  for (int part = 0; part < PARTS; ++part)
    sums[part] += weight * texelFetch(history_light, ivec3(pixel, int(f.slot) * PARTS + part), 0);
}

// What the frame holds of the place: values, a: 1, or 0 where it does not show it.
void find_place(HistoryFrame f, PlaceBefore place, inout vec4 values[PARTS]) {
  vec4 clip = f.world_to_clip * vec4(place.position, 1.0);
  if (!(clip.w > 0.0)) return;
  vec2 at = (clip.xy / clip.w * 0.5 + 0.5) * vec2(frame.frame_size) - 0.5;
  if (!(all(greaterThan(at, vec2(-1.0))) && all(lessThan(at, vec2(frame.frame_size))))) return;
  ivec2 pixel = ivec2(floor(at + whole_pixel));
  vec2 share = max(at - vec2(pixel), vec2(0.0));
  share = mix(share, vec2(0.0), lessThan(share, vec2(whole_pixel)));
  place.reach *= clip.w;
  vec4 sums[PARTS];
  for (int part = 0; part < PARTS; ++part) sums[part] = vec4(0.0);
  add_neighbour(f, pixel, (1.0 - share.x) * (1.0 - share.y), place, sums);
  add_neighbour(f, pixel + ivec2(1, 0), share.x * (1.0 - share.y), place, sums);
  add_neighbour(f, pixel + ivec2(0, 1), (1.0 - share.x) * share.y, place, sums);
  add_neighbour(f, pixel + ivec2(1, 1), share.x * share.y, place, sums);
  for (int part = 0; part < PARTS; ++part)
    if (sums[part].a >= least_weight) values[part] = vec4(sums[part].rgb / sums[part].a, 1.0);
}

// Relative change of the light between two frames with the same samples: of all parts together, 0 where the place was not seen.
float change(vec4 now[PARTS], vec4 before[PARTS]) {
  vec3 difference = vec3(0.0), most = vec3(0.0);
  for (int part = 0; part < PARTS; ++part) {
    if (now[part].a == 0.0 || before[part].a == 0.0) continue;
    difference += abs(now[part].rgb - before[part].rgb);
    most += max(now[part].rgb, before[part].rgb);
  }
  float all = most.r + most.g + most.b;
  return all > 0.0 ? (difference.r + difference.g + difference.b) / all : 0.0;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.frame_size)))) return;
  vec4 totals[PARTS];
  bool lit = false;
  bool whole = texelFetch(light, ivec3(pixel, 0), 0).a >= whole_share;
  for (int part = 0; part < PARTS; ++part) {
    vec4 sum = texelFetch(light, ivec3(pixel, part), 0);
    totals[part] = sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
    lit = lit || sum.a > 0.0;
  }
  float depth = pixel_depth(pixel);
  PlaceBefore place = PlaceBefore(pixel_position(pixel, depth), pixel_geometric_normal(pixel),
                                  min(pixel_instance(pixel), uint(instance_count - 1)), length(frame.view_ray_dx.xyz));
  float fade = 0.0;  // of a frame's weight, per frame that it is old
  for (int i = 0; lit && i < frame_count; ++i) {
    HistoryFrame f = frames[i];
    vec4 values[PARTS];
    for (int part = 0; part < PARTS; ++part) values[part] = vec4(0.0);
    PlaceBefore then = place;
    if (f.moved != 0u) then = place_before(place, f.slot);
    if (f.still == 0u || f.moved != 0u) {
      find_place(f, then, values);
    } else {
      for (int part = 0; part < PARTS; ++part)
        values[part] = texelFetch(history_light, ivec3(pixel, int(f.slot) * PARTS + part), 0);
    }
    if (int(f.age) == frames_kept) {
      bool here = f.still != 0u && then.position == place.position;  // at this pixel
      if (whole || here) fade = fade_of_change * change(totals, values) / float(frames_kept);
    } else {
      float weight = max(1.0 - fade * float(f.age), 0.0);
      for (int part = 0; part < PARTS; ++part) totals[part] += weight * values[part];
    }
  }
  for (int part = 0; part < PARTS; ++part) imageStore(averaged, ivec3(pixel, part), totals[part]);
}
