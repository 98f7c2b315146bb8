// Links made on the GPU: each leaf goes down the hierarchy by itself, opens elements that are larger than its bins and keeps
// the shortest link of each bin, as radiosity::Links does for leaves; no links are shared between receivers. FILL is
// radiosity::Fill: an element fills the bin of its centre (0), or those whose centres its disc covers (1), or, of a leaf, its
// triangles (2). The bins are clear to begin with.
//
// One loop does everything, a step at a time: the threads of a GPU's or processor's vector then wait for the longest of their
// sums of steps, not for the sum of the longest. llvmpipe leaves all loops of a thread after 65,535 steps in all: the roots
// come in batches.
#include "techniques/implicit_visibility/elements.glsl"
#if FILL == 2
#include "glsl/indirect/seen_triangle.glsl"
#endif

layout(local_size_x = 64) in;
layout(std430) readonly buffer Groups { ElementGroup groups[]; };
layout(std430) readonly buffer Roots { uint roots[]; };
#if FILL == 2
layout(std430) readonly buffer Leaves { Leaf leaves[]; };
layout(std430) readonly buffer Triangles { uint corners[]; };  // three leaves each
layout(std430) readonly buffer FirstTriangle { uint first_triangle[]; };  // of each leaf
uniform float unit;  // metres
#endif
layout(std430) buffer Links { uint links[]; };
layout(std430) buffer Distances { float distances[]; };  // squared
uniform uint first_leaf;
uniform uint leaf_count;
uniform uint first_root;
uniform uint root_count;
uniform float opening;  // bins

const int n = int(BINS);
const float half_n = 0.5 * float(n);
const float overlap = 1e-3;   // as radiosity::BinFiller
const float coplanar = 1e-3;
const float grazing = 1e-4;   // as radiosity::LinkTest
const int most_waiting = 64;  // groups: three for each level above the leaves at most

// In the axes of a face: major, column, row.
vec3 turned(vec3 v, uint face) {
  vec3 t = face < 2u ? v : face < 4u ? v.yzx : v.zxy;
  if ((face & 1u) != 0u) t.x = -t.x;
  return t;
}

int below(float u) { return int(max((u + 1.0) * half_n + 0.5, 0.0)); }
float centre(int bin) { return (float(bin) + 0.5) / half_n - 1.0; }

// Bins of a face that a disc may cover: first columns and rows, and the last. Empty: last before first.
ivec4 box_on_face(vec3 d, vec3 normal, float radius) {
  ivec4 nothing = ivec4(1, 1, 0, 0);
  if (d.x <= -radius) return nothing;
  vec2 low = vec2(-1.0);
  vec2 high = vec2(1.0);
  if (d.x > radius) {
    vec2 place = d.yz / d.x;
    vec2 along = normal.yz - place * normal.x;
    vec2 size2 = max(1.0 + place * place - along * along, vec2(0.0));
    float closer = radius * sqrt(max(1.0 - normal.x * normal.x, 0.0));
    vec2 reach = radius / (d.x - closer) * sqrt(size2);
    low = max(place - reach, low);
    high = min(place + reach, high);
    if (low.x > high.x || low.y > high.y) return nothing;
  }
  return ivec4(below(low.x), below(low.y), min(n, below(high.x)) - 1, min(n, below(high.y)) - 1);
}

#if FILL == 2
// Rows (x, y), the last included, of a face that a triangle may cover; its corners are in the face's axes.
ivec2 rows_on_face(mat3 corners) {
  const float nearest = 1e-3;
  ivec2 nothing = ivec2(1, 0);
  vec3 majors = vec3(corners[0].x, corners[1].x, corners[2].x);
  vec3 across = vec3(corners[0].y, corners[1].y, corners[2].y);
  vec3 along = vec3(corners[0].z, corners[1].z, corners[2].z);
  if (all(lessThanEqual(majors, vec3(0.0))) || all(greaterThan(across, majors)) || all(greaterThan(-across, majors)) ||
      all(greaterThan(along, majors)) || all(greaterThan(-along, majors)))
    return nothing;
  if (any(lessThanEqual(majors, nearest * (abs(across) + abs(along))))) return ivec2(0, n - 1);
  vec3 places = along / majors;
  float low = min(places.x, min(places.y, places.z));
  float high = max(places.x, max(places.y, places.z));
  return ivec2(below(low), min(n, below(high)) - 1);
}

// Columns of a row, the last included, where all of w + u * slope are at least 0: u of the columns' centres.
ivec2 columns_of_row(vec3 w, vec3 slope) {
  float low = -1.0;
  float high = 1.0;
  for (int k = 0; k < 3; ++k) {
    if (slope[k] == 0.0) {
      if (w[k] < 0.0) return ivec2(1, 0);
    } else if (slope[k] > 0.0) {
      low = max(low, -w[k] / slope[k]);
    } else {
      high = min(high, -w[k] / slope[k]);
    }
  }
  if (low > high) return ivec2(1, 0);
  return ivec2(below(low), min(n, below(high)) - 1);
}
#endif

void keep(uint bin, float distance2, uint link) {
  if (distance2 < distances[bin]) {
    distances[bin] = distance2;
    links[bin] = link;
  }
}

void main() {
  uint row = work_item_index();
  if (row >= leaf_count) return;
  ElementGroup own = groups[(first_leaf + row) / 4u];
  uint self = (first_leaf + row) % 4u;
  if (self >= own.lanes) return;
  vec3 position = vec3(own.x[self], own.y[self], own.z[self]);
  vec3 up = vec3(own.nx[self], own.ny[self], own.nz[self]);
  float angle = opening * 4.0 / float(n * n);
  uint first_bin = row * bin_count;

  uint waiting[most_waiting];
  int top = 0;
  uint root = first_root;
  uint group = 0u;
  uint lanes = 0u;  // of the group, still to be looked at
  // The disc in work: its faces to come, and on one of them the box of bins and the bin that comes next.
  uint faces = 0u;
  uint face = 0u;
  ivec4 box = ivec4(1, 1, 0, 0);
  ivec2 at = ivec2(1);
  vec3 offset = vec3(0.0);
  vec3 normal = vec3(0.0);
  float height = 0.0;
  float radius = 0.0;
  uint link = no_link;
#if FILL == 2
  // The triangles to come of the leaf in work, and the one in work: weights, as rows, and corners in the axes of the bins.
  uint triangle = 0u;
  uint last_triangle = 0u;
  bool sees_back = false;
  bool by_triangle = false;
  mat3 weights = mat3(0.0);
  mat3 offsets = mat3(0.0);
  uvec3 links_of_corners = uvec3(0u);
#endif

  bool busy = true;
  while (busy) {
#if FILL == 2
    if (by_triangle && at.y <= box.w) {
      mat3 w = mat3(turned(weights[0], face), turned(weights[1], face), turned(weights[2], face));
      vec3 major = vec3(w[0].x, w[1].x, w[2].x) + centre(at.y) * vec3(w[0].z, w[1].z, w[2].z);
      vec3 slope = vec3(w[0].y, w[1].y, w[2].y);
      if (at.x > box.z) {
        ++at.y;
        if (at.y <= box.w) {
          ivec2 span = columns_of_row(vec3(w[0].x, w[1].x, w[2].x) + centre(at.y) * vec3(w[0].z, w[1].z, w[2].z), slope);
          at.x = span.x;
          box.z = span.y;
        }
      } else {
        vec3 ray = vec3(1.0, centre(at.x), centre(at.y));
        vec3 at_corners = major + slope * ray.y;
        float t = height / dot(turned(normal, face), ray);
        uint nearest = at_corners.x >= max(at_corners.y, at_corners.z) ? links_of_corners.x
                       : at_corners.y >= at_corners.z                  ? links_of_corners.y
                                                                       : links_of_corners.z;
        if (t > 0.0) keep(first_bin + uint((int(face) * n + at.y) * n + at.x), t * t * dot(ray, ray), nearest);
        ++at.x;
      }
    } else
#endif
    if (at.y <= box.w) {
      vec3 d = turned(offset, face);
      vec3 ray = vec3(1.0, centre(at.x), centre(at.y));
      float t = height / dot(turned(normal, face), ray);
      vec3 miss = t * ray - d;
      float miss2 = dot(miss, miss);
      if (t > 0.0 && miss2 <= radius * radius)
        keep(first_bin + uint((int(face) * n + at.y) * n + at.x),
             t * t * dot(ray, ray) * (1.0 + overlap / (radius * radius) * miss2), link);
      ++at.x;
      if (at.x > box.z) at = ivec2(box.x, at.y + 1);
    } else if (faces != 0u) {
      face = uint(findLSB(faces));
      faces &= faces - 1u;
#if FILL == 2
      if (by_triangle) {
        ivec2 rows =
            rows_on_face(mat3(turned(offsets[0], face), turned(offsets[1], face), turned(offsets[2], face)));
        // Before the first row, at its end.
        box = ivec4(0, rows.x, -1, rows.y);
        at = ivec2(0, rows.x <= rows.y ? rows.x - 1 : n);
        continue;
      }
#endif
      box = box_on_face(turned(offset, face), turned(normal, face), radius);
      at = box.x <= box.z ? box.xy : ivec2(0, n);
#if FILL == 2
    } else if (triangle < last_triangle) {
      uvec3 slots = uvec3(corners[3u * triangle], corners[3u * triangle + 1u], corners[3u * triangle + 2u]);
      ++triangle;
      vec3 from = leaves[first_leaf + row].position.xyz;
      for (int k = 0; k < 3; ++k) offsets[k] = to_bins(leaves[slots[k]].vertex - from) / unit;
      SeenTriangle seen = seen_triangle(offsets[0], offsets[1], offsets[2]);
      bool below = below_horizon(offsets[0], up, 0.0, 0.0) && below_horizon(offsets[1], up, 0.0, 0.0) &&
                   below_horizon(offsets[2], up, 0.0, 0.0);
      if (seen.height > 0.0 && !below && (sees_back || !seen.back)) {
        weights = mat3(seen.weight_a, seen.weight_b, seen.weight_c);
        normal = seen.normal;
        height = seen.height;
        links_of_corners = slots | (seen.back ? link_back : 0u);
        by_triangle = true;
        faces = 63u;
      }
#endif
    } else if (lanes != 0u) {
      int k = findLSB(lanes);
      lanes &= lanes - 1u;
      ElementGroup g = groups[group];
      offset = vec3(g.x[k], g.y[k], g.z[k]) - position;
      normal = vec3(g.nx[k], g.ny[k], g.nz[k]);
      height = dot(offset, normal);
      float distance2 = dot(offset, offset);
      float distance = sqrt(distance2);
      float reach = g.radius[k];
      float rise = reach;
#if FILL == 2
      if (g.children == no_link) rise += 2.0 * g.disc[k];  // of its triangles above its centre, at most
#endif
      bool facing = dot(offset, up) + rise - grazing * distance > 0.0;
      if (g.backs == 0u) facing = facing && reach + (g.spread[k] - grazing) * distance > height;
      vec3 size = abs(offset);
      float major = max(size.x, max(size.y, size.z));
      float extent = max(g.area[k], reach * reach);
      float limit = angle * major * major * major;
      float shown = min(abs(height) + g.spread[k] * distance, distance);
      bool open = g.children != no_link && extent * shown >= limit;
      bool linked = facing && !open && distance2 > 1e-14;
      bool behind = g.backs != 0u && height > max(0.1 * distance, g.disc[k]);
#if FILL == 2
      if (linked && g.children == no_link) {
        triangle = first_triangle[4u * group + uint(k)];
        last_triangle = first_triangle[4u * group + uint(k) + 1u];
        sees_back = behind;
        linked = false;
      }
      by_triangle = false;
#endif
      if (g.backs != 0u) linked = linked && (height <= 0.0 || behind);
      radius = g.disc[k];
      link = (4u * group + uint(k)) | (g.backs != 0u && height > 0.0 ? link_back : 0u);
      if (facing && open && top < most_waiting) {
        waiting[top] = g.children + uint(k);
        ++top;
      }
#if FILL != 0
      vec2 place;
      uint towards = bin_face(offset, place);
      if (linked && abs(height) >= coplanar * radius) faces = radius < 0.5 * major ? 1u << towards : 63u;
      if (faces != 0u && faces != 63u) {
        // A disc that reaches over the edge of its face is looked for on all.
        ivec4 whole = box_on_face(turned(offset, towards), turned(normal, towards), radius);
        if (min(whole.x, whole.y) <= 0 || max(whole.z, whole.w) >= n - 1) {
          faces = 63u;
        } else if (whole.x > whole.z || whole.y > whole.w) {
          faces = 0u;
        }
      }
#else
      if (linked) keep(first_bin + bin_of(offset, uint(n)), distance2, link);
#endif
    } else if (top > 0) {
      --top;
      group = waiting[top];
      lanes = (1u << groups[group].lanes) - 1u;
    } else if (root < first_root + root_count) {
      group = roots[root];
      lanes = 1u;
      ++root;
    } else {
      busy = false;
    }
  }
}
