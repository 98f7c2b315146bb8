// A ray through the maps of one light: where each of its points lies in them. The views of a light share origin, scale and
// range, and the axes of one are those of the first in another order. So the ray is projected once onto the axes of the first
// view, and a point of it costs a few multiply-adds and, in a perspective view, one division. The same answers as
// shadow_project() of glsl/shadow/shadow_view.glsl gives in the view that shadow_face() chooses, for perspective and
// orthographic views.
#ifndef LIMN_MAP_PATH_GLSL
#define LIMN_MAP_PATH_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/shadow/shadow_view.glsl"
LIMN_BEGIN

struct MapPath {
  vec3 start;    // in the axes of the first view, m
  float texels;  // per metre across an orthographic view, and across a perspective one at 1 m depth
  vec3 step;     // per unit along the ray
  float size;    // texels per side
  vec2 middle;   // texel of the axis x = y = 0
  float near;    // depth of what the maps store as 0, m
  float range;   // depth of what they store as 1, less `near`, m
};

// The points origin + t direction.
LIMN_FN MapPath map_path(ShadowView first, vec3 origin, vec3 direction) {
  MapPath path;
  path.start = shadow_local(first, origin);
  path.step = shadow_view_axes(first, direction);
  path.size = float(first.size);
  path.texels = first.scale * path.size;
  path.middle = path.size * first.middle;
  path.near = first.near;
  path.range = first.far - first.near;
  return path;
}

// An offset in the axes of a light's first view, in those of its view `face`.
LIMN_FN vec3 shadow_face_axes(uint faces, uint face, vec3 r) {
  if (faces == shadow_faces_single) return r;
  bool back = face == (faces == shadow_faces_pair ? 1u : 5u);
  vec3 along_z = back ? vec3(r.y, r.x, -r.z) : r;
  if (faces == shadow_faces_pair) return along_z;
  vec3 along_x = face == 1u ? vec3(r.y, r.z, r.x) : vec3(r.z, r.y, -r.x);
  vec3 along_y = face == 3u ? vec3(r.z, r.x, r.y) : vec3(r.x, r.z, -r.y);
  return face == 0u || back ? along_z : (face <= 2u ? along_x : along_y);
}

// A point of the ray in the maps.
struct MapPlace {
  vec2 texel;   // its middle is at its number + 1/2
  float depth;  // m
  uint face;    // of the light's views
};

// projection, faces: the light's, constants where a program is compiled for lights that are alike.
LIMN_FN MapPlace map_path_place(MapPath path, uint projection, uint faces, float t) {
  vec3 local = path.start + t * path.step;
  MapPlace place;
  place.face = shadow_face_of_local(faces, local);
  vec3 r = shadow_face_axes(faces, place.face, local);
  float k = projection == shadow_orthographic ? path.texels : path.texels / max(r.z, 1e-30f);
  place.texel = vec2(path.middle.x + k * r.x, path.middle.y + k * r.y);
  place.depth = r.z;
  return place;
}

// Whether the view sees it: shadow_inside().
LIMN_FN bool map_path_inside(MapPath path, MapPlace place) {
  return place.depth > 0.0f && place.texel.x >= 0.0f && place.texel.y >= 0.0f && place.texel.x < path.size &&
         place.texel.y < path.size;
}

// The texel that holds it, or the nearest one.
LIMN_FN ivec2 map_path_texel(MapPath path, MapPlace place) {
  return ivec2(clamp(place.texel, vec2(0.0f), vec2(path.size - 1.0f)));
}

// Metres by which it lies behind what a map stores.
LIMN_FN float map_path_behind(MapPath path, MapPlace place, float stored) {
  return place.depth - (path.near + stored * path.range);
}

LIMN_END
#endif  // LIMN_MAP_PATH_GLSL
