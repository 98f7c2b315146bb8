// Which directions a texel of a height field sees, as an ellipse in the disc that directions project to on the base plane:
// the moment ellipse, in closed form from the horizon, and the published fit (Heidrich, Daubert, Kautz and Seidel 2000,
// Illuminating Micro Geometry Based on Precomputed Visibility). A light whose direction l, a unit vector of the base's frame
// (T, B, N), projects to d = (l.T, l.B) is lit where d lies inside.
#ifndef LIMN_RELIEF_ELLIPSE_GLSL
#define LIMN_RELIEF_ELLIPSE_GLSL
#include "glsl/numeric/language.glsl"
LIMN_BEGIN

// The uniform ellipse that has the lit region's centre and covariance. Radii are twice the roots of the covariance's
// eigenvalues; no axis is stored, so that texels can be interpolated.
struct ReliefEllipse {
  vec2 centre;
  float xx;  // covariance
  float xy;
  float yy;
  float spread;  // deviation of edges among the texels that a mean was taken of; 0 of one texel
};

// The published fit: the larger axis as a unit vector, the radii along it and across it.
struct FittedEllipse {
  vec2 centre;
  vec2 axis;
  vec2 radii;
};

// The distance of a direction from the ellipse's edge, to first order, and which way it grows.
struct EdgeDistance {
  float inside;  // in the disc of radius 1; below 0 outside
  vec2 outwards;  // unit vector, or 0 at the centre
};

// Determinant of the covariance; 4 times its root is the ambient visibility, the cosine-weighted share of the hemisphere that
// is seen.
LIMN_FN float ellipse_determinant(ReliefEllipse e) { return max(e.xx * e.yy - e.xy * e.xy, 0.0f); }
LIMN_FN float ellipse_ambient(ReliefEllipse e) { return min(4.0f * sqrt(ellipse_determinant(e)), 1.0f); }

// Whether the texel sees the direction. Nothing is divided by: an ellipse of no area is dark.
LIMN_FN bool ellipse_lit(ReliefEllipse e, vec3 l) {
  vec2 d = vec2(l) - e.centre;
  float form = e.yy * d.x * d.x - 2.0f * e.xy * d.x * d.y + e.xx * d.y * d.y;
  return l.z > 0.0f && form < 4.0f * ellipse_determinant(e);
}

LIMN_FN bool fitted_lit(FittedEllipse e, vec3 l) {
  vec2 d = vec2(l) - e.centre;
  float along = dot(e.axis, d) * e.radii.y;
  float across = (e.axis.x * d.y - e.axis.y * d.x) * e.radii.x;
  float area = e.radii.x * e.radii.y;
  return l.z > 0.0f && along * along + across * across < area * area;
}

// (1 - sqrt q) / |grad sqrt q|, where q is 1 on the ellipse and grows with the square of the distance from its centre.
LIMN_FN EdgeDistance ellipse_edge(ReliefEllipse e, vec2 place) {
  EdgeDistance edge;
  vec2 d = place - e.centre;
  vec2 slope = vec2(e.yy * d.x - e.xy * d.y, e.xx * d.y - e.xy * d.x);
  float scale = 4.0f * ellipse_determinant(e);
  float steepness = length(slope);
  edge.outwards = slope / max(steepness, 1e-20f);
  edge.inside = scale > 0.0f ? 1.0f : -1.0f;
  if (scale > 0.0f && steepness > 1e-12f) {
    float root = sqrt(max(dot(d, slope), 0.0f) / scale);
    edge.inside = (1.0f - root) * root * scale / steepness;
  }
  return edge;
}

// Share of a disc of radius 1 on one side of a straight edge: the side of the centre where its distance, `inside`, is above 0.
LIMN_FN float disc_inside_edge(float inside) {
  float x = clamp(inside, -1.0f, 1.0f);
  return 0.5f + (asin(x) + x * sqrt(1.0f - x * x)) * inverse_pi;
}

// Share that the texel sees of a round light, whose angular radius has the given sine: of the part above the base's plane. That
// plane and the ellipse's edge cut the light as great circles do, at their angles from its centre. The angle of the edge is the
// difference of two from `outwards`, a direction in the plane: of the light's centre, and of the edge, which to first order lies
// at their cosine plus `inside`. For ellipses about the zenith that is no approximation, so that level fields hide nothing.
LIMN_FN float ellipse_visibility(ReliefEllipse e, vec3 l, float sine) {
  EdgeDistance edge = ellipse_edge(e, vec2(l));
  vec2 o = edge.outwards;
  float light_cosine = dot(o, vec2(l));
  float light_sine = length(vec2(l.z, o.x * l.y - o.y * l.x));
  float edge_cosine = clamp(light_cosine + edge.inside, -1.0f, 1.0f);
  float edge_sine = sqrt(1.0f - edge_cosine * edge_cosine);
  float radius = max(sine, 1e-6f);
  float inside = (light_sine * edge_cosine - light_cosine * edge_sine) / radius;
  bool near = light_cosine * edge_cosine + light_sine * edge_sine > 0.0f;  // by less than a right angle
  if (!near) inside = edge.inside > 0.0f ? 1.0f : -1.0f;
  return l.z > 0.0f ? min(disc_inside_edge(inside) / disc_inside_edge(l.z / radius), 1.0f) : 0.0f;
}

// Share of the texels of a mean that see the direction: edges are spread over 3.4 deviations.
LIMN_FN float ellipse_mean_visibility(ReliefEllipse e, vec3 l) {
  float part = clamp(0.5f + ellipse_edge(e, vec2(l)).inside / max(3.4f * e.spread, 1e-6f), 0.0f, 1.0f);
  return l.z > 0.0f ? part : 0.0f;
}

LIMN_END
#endif  // LIMN_RELIEF_ELLIPSE_GLSL
