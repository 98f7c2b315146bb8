// Light that left a specular object: the elements of the caustic-ray buffer, and the path of one light ray through the
// object it meets (thesis, section 8.3.2). The reference traces the same path with exact intersections.
#ifndef LIMN_CAUSTIC_RAY_GLSL
#define LIMN_CAUSTIC_RAY_GLSL
#include "glsl/numeric/language.glsl"
#include "glsl/scene/media.glsl"
LIMN_BEGIN

LIMN_CONST float caustic_ray_none = 0.0f;      // no light goes here
LIMN_CONST float caustic_ray_open = 1.0f;      // ends where the medium does
LIMN_CONST float caustic_ray_surface = 2.0f;   // ends on a surface of the scene

// Storage buffer element.
struct CausticRay {
  vec3 start;            // p1, where the light leaves the object
  float segment_length;  // of p1 p2, m
  vec3 direction;        // unit, of propagation
  float kind;            // caustic_ray_*
  vec3 power;            // flux at p1, W
  uint normal;           // of the surface that p2 lies on, against the ray: octahedral, snorm
};

// What all rays of one layer share: storage buffer element.
struct CausticLayer {
  float light;     // index in the list of shadow maps' lights
  float diameter;  // of the widest object, m: no way through one is longer
  uint first;      // layer of the first view from the same point
  uint faces;      // shadow_faces_*: how these views share its surroundings
};

LIMN_CONST uint caustic_reflection = 1u;
LIMN_CONST uint caustic_refraction = 2u;

// One event: light along `direction` (unit, of propagation) meets a surface of normal n (unit, either side). `inside`:
// within the body that the surface bounds.
struct SpecularEvent {
  vec3 reflected;     // unit, of propagation
  vec3 reflectance;
  vec3 refracted;     // 0: total internal reflection
  vec3 transmittance;
};

// The cosine of incidence must be positive: callers turn n against the direction, and drop light that a shading normal
// says comes from behind.
LIMN_FN SpecularEvent specular_event(Optics o, vec3 direction, vec3 n, bool inside) {
  SpecularEvent e;
  vec3 l = -direction;
  float cosine = dot(n, l);
  bool thin = !(o.thickness > 0.0f);
  bool leaves = inside && !thin;
  float n1 = leaves ? o.ior : 1.0f;
  float n2 = leaves ? 1.0f : o.ior;
  e.reflected = mirrored(l, n);
  e.reflectance = optics_reflectance(o, cosine, n1, n2);
  e.refracted = thin ? direction : refracted(l, n, n1 / n2);
  e.transmittance = optics_transmittance(o, cosine, n1, n2);
  return e;
}

// Square of the index of refraction on one side of an interface, `inside` or outside, as specular_event() takes it. Radiance over
// this square is what goes along a refracted ray, less what the interface reflects (Veach 1997, section 5.2); flux passes without
// it. Both sides of a thin wall have 1.
LIMN_FN float squared_index(Optics o, bool inside) {
  return inside && o.thickness > 0.0f ? o.ior * o.ior : 1.0f;
}

// What the flux of light along `direction` (unit, of propagation) is multiplied by where it leaves a surface along
// `leaving`, besides the reflectance or transmittance: 1 unless the shading normal n differs from the geometric normal ng
// (either side). A shading normal keeps radiance as it is (times the square of the indices' ratio), not the flux through the
// surface: the adjoint of a specular event, (n.l) (ng.o) / ((ng.l) (n.o)) (Veach 1997, section 5.3). 0 where one normal says
// that light is reflected and the other that it passes.
LIMN_FN float shading_flux(vec3 n, vec3 ng, vec3 direction, vec3 leaving) {
  float meets = dot(n, direction) * dot(ng, leaving);
  float below = dot(ng, direction) * dot(n, leaving);
  return below != 0.0f ? max(meets / below, 0.0f) : 0.0f;
}

LIMN_END
#endif  // LIMN_CAUSTIC_RAY_GLSL
