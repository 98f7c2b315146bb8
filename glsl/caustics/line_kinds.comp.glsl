// What each caustic ray is drawn as: a line, a point or a quad. BEAMS 0: no quads, lines stand for all.
#include "glsl/caustics/ray_shape.glsl"

#if BEAMS
layout(std430) writeonly buffer RayBeams { RayBeam beams[]; };  // of the rays that are quads, at their places in the ray buffer
#endif

uint ray_kind(int index) {
  CausticRay ray = rays[index];
  RayPiece piece = ray_piece(ray, ray_range(ray));
  if (!(piece.range.x < piece.range.y)) return ray_kind_none;
  if (!(piece.pixels >= 1.0)) return ray_kind_point;
#if BEAMS
  BeamSides sides = beam_sides(index, ray, piece);
  RayBeam beam = ray_beam(sides, piece);
  if (max(beam_width(beam, piece, 0.0), beam_width(beam, piece, 1.0)) > 1.0) {
    if (!beam_in_picture(sides, piece)) return ray_kind_none;
    beams[index] = beam;
    return ray_kind_quad;
  }
#endif
  return ray_kind_line;
}

#include "glsl/caustics/ray_kinds.glsl"
