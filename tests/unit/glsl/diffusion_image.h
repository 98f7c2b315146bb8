// What a camera sees of an analytic body, and the light below its surface by points drawn in the image, for
// tests.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "glsl/diffusion/drawn_points.glsl"
#include "glsl/diffusion/entry_sums.glsl"
#include "glsl/diffusion/eye_plane.glsl"
#include "glsl/numeric/geometry.glsl"

namespace limn::glsl {

/// What scatters: of sigma_s' and sigma_a, per mm.
struct Matter {
  vec3 extinction, absorption;
  DipoleColours dipole;
  NormalisedColours normalised;
  Matter(const vec3& scattering, const vec3& absorbing, float eta = 1.3f)
      : extinction(scattering + absorbing),
        absorption(absorbing / extinction),
        dipole(dipole_colours(extinction, absorption, diffusion_boundary(eta))),
        normalised(normalised_colours(extinction, absorption, diffusion_boundary(eta))) {}
  vec3 reach() const {
    return diffusion_reach(extinction, absorption, walk_reflectance(diffusion_boundary(1.3f)));
  }
};
/// skin1 and ketchup (Jensen et al. 2001), and what absorbs nothing.
inline const Matter kSkin({0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f});
inline const Matter kKetchup({0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f});
inline const Matter kWhite(vec3(1), vec3(0));

/// A surface point, from the eye, and the light that enters there.
struct SeenPlace {
  vec3 place{0}, normal{0}, entering{0};
};

/// Returns what a ray from the eye meets.
using SeenBody = std::function<std::optional<SeenPlace>(const vec3& ray)>;

/// The light that enters at a place, by its position from the eye.
using EnteringLight = std::function<vec3(const vec3& place)>;

inline SeenBody planeBody(const vec3& place, const vec3& normal, EnteringLight light) {
  return [=](const vec3& ray) -> std::optional<SeenPlace> {
    const float t = dot(place, normal) / dot(ray, normal);
    if (!(t > 0)) return std::nullopt;
    return SeenPlace{t * ray, normal, light(t * ray)};
  };
}

inline SeenBody sphereBody(const vec3& centre, float radius, EnteringLight light) {
  return [=](const vec3& ray) -> std::optional<SeenPlace> {
    const dvec3 d = normalize(dvec3(ray)), c(centre);
    const double along = dot(c, d), rest = dot(c, c) - along * along, r = double(radius);
    if (rest > r * r) return std::nullopt;
    const dvec3 p = (along - std::sqrt(r * r - rest)) * d;
    return SeenPlace{vec3(p), vec3((p - c) / r), light(vec3(p))};
  };
}

/// An image: the directions of pixels, and what their centres see. Without pixels (`exact`), every ray sees
/// what is there.
class SeenImage {
 public:
  /// The camera looks along +z; pixels are `pixel` wide at distance 1, and the middle of pixel size / 2 looks
  /// along (aim, 1).
  SeenImage(SeenBody body, ivec2 size, float pixel, vec2 aim = vec2(0), bool exact = false)
      : size_(size), pixel_(pixel), aim_(aim), exact_(exact), body_(std::move(body)) {
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) seen_.push_back(body_(ray(vec2(x, y))));
  }
  vec3 ray(vec2 at) const { return vec3(aim_ + pixel_ * (at - vec2(size_ / 2)), 1); }
  vec2 pixelOf(const vec3& towards) const {
    return (vec2(towards) / towards.z - aim_) / pixel_ + vec2(size_ / 2);
  }
  const std::optional<SeenPlace>& at(ivec2 p) const {
    static const std::optional<SeenPlace> nothing;
    const bool inside = p.x >= 0 && p.y >= 0 && p.x < size_.x && p.y < size_.y;
    return inside ? seen_[size_t(p.y) * size_t(size_.x) + size_t(p.x)] : nothing;
  }
  /// What the ray through a point sees.
  std::optional<SeenPlace> along(const vec3& towards) const {
    if (towards.z <= 0) return std::nullopt;
    if (exact_) return body_(towards);
    return at(ivec2(floor(pixelOf(towards) + vec2(0.5f))));
  }
  bool sameTexel(const vec3& towards, ivec2 pixel) const {
    return !exact_ && towards.z > 0 && ivec2(floor(pixelOf(towards) + vec2(0.5f))) == pixel;
  }

 private:
  ivec2 size_;
  float pixel_;
  vec2 aim_;
  bool exact_;
  SeenBody body_;
  std::vector<std::optional<SeenPlace>> seen_;
};

struct ImageQuestion {
  int samples = 64;
  int first = 0, stride = 1;  ///< of the sequence
  int normalise = entry_normalise_weights;
  bool bothPlanes = false;
  bool texelPlaces = false;  ///< p is the texel's own position
};

/// The mean of entering light over the profile at a pixel, as the technique's pass gathers it.
template <class Colours>
vec3 gatheredLight(const SeenImage& image, const SeenPlace& here, ivec2 pixel, const Colours& colours,
                   const PointSource& source, const ImageQuestion& q) {
  const vec3 own = eye_plane(here.place, here.normal), facing = eye_plane(here.place, -normalize(here.place));
  const vec3 planes[2] = {own, facing};
  const Frame frames[2] = {frame_around(here.normal), frame_around(-normalize(here.place))};
  const int fromDisc = int(std::lround(source.uniform_share * float(q.samples)));
  vec3 light(0), weights(0);
  float hits = 0;
  for (int i = 0; i < q.samples; ++i) {
    const PointDraw draw = point_draw(uint(q.first + i * q.stride), i >= q.samples - fromDisc);
    const float drawn = drawn_radius(colours, source, draw);
    const int plane = q.bothPlanes ? i % 2 : 0;
    const vec3 offset = drawn * (draw.direction.x * frames[plane].t + draw.direction.y * frames[plane].b);
    const vec3 towards = here.place + offset;
    const auto seen = image.along(towards);
    if (!seen) continue;
    vec3 met = eye_plane(seen->place, seen->normal);
    float inverse = dot(met, towards);
    if (image.sameTexel(towards, pixel)) inverse = 1 + dot(own, offset);
    float stretch = inverse > 1 / eye_plane_most_stretch ? 1 / inverse : 0;
    if (stretch == 0) continue;
    float distance = eye_plane_distance(offset, towards, stretch);
    if (q.texelPlaces) distance = length(seen->place - here.place);
    const float area = eye_plane_area(met, stretch);
    float density = 0;
    for (int a = 0; a < (q.bothPlanes ? 2 : 1); ++a) {
      const float to = a == plane ? 1 : eye_plane_stretch(planes[a], towards);
      if (to == 0) continue;
      const float r = a == plane ? drawn : eye_plane_distance(offset, towards, to);
      const float share = q.bothPlanes ? 0.5f : 1.0f;
      density += share * drawn_density(diffusion_density(colours, r), source, r) *
                 (q.normalise == entry_normalise_count ? 1 : eye_plane_area(planes[a], to) / area);
    }
    const vec3 weight = diffusion_density(colours, distance) / density;
    light += weight * seen->entering;
    weights += weight;
    hits += 1;
  }
  return entry_mean(light, weights, hits, float(q.samples), q.normalise, here.entering);
}

}  // namespace limn::glsl
