// Surface elements at the vertices of meshes as passes read them.
#ifndef LIMN_SURFACE_LEAF_GLSL
#define LIMN_SURFACE_LEAF_GLSL

// limn::radiosity::Leaf, metres.
struct Leaf {
  vec3 vertex;
  float used;  // 0 where the slot is not in use
  vec4 position;
  vec4 normal;
  vec3 albedo;
  float unused;
};

#endif  // LIMN_SURFACE_LEAF_GLSL
