#include "core/radiosity/glossy_lobes.h"

#include <algorithm>

#include "core/radiosity/private/float4.h"
#include "glsl/indirect/sample_reflection.glsl"
#include "glsl/light/ltc.glsl"
#include "glsl/materials/material_model.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {
namespace {

float sumOf(Float4 v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

/// Whether light arrives from above the horizon.
bool arrives(const glsl::IncidentLight& light) {
  return light.direction.z > 0 && glsl::largest_channel(light.irradiance) > 0;
}

glm::vec3 mirrored(const glm::vec3& direction) {
  return {-direction.x, -direction.y, direction.z};
}

}  // namespace

void GlossyLobes::set(const glsl::SurfaceBrdf& surface, std::span<const glsl::IncidentLight> lights,
                      float widen) {
  count_ = 0;
  lobes_.clear();
  all_.clear();
  const auto lobes = static_cast<size_t>(std::count_if(lights.begin(), lights.end(), arrives));
  lobes_.reserve(lobes);
  rowLength_ = stride(lobes);
  flux_ = glm::vec3(0);
  if (glsl::brdf_is_lambertian(surface)) return;
  rows_.assign(kRows * rowLength_, 0);
  // Lanes of no lobe are lobes of no light.
  for (const size_t row : {2, 3, 4}) std::fill_n(rows_.begin() + long(row * rowLength_), rowLength_, 1.f);
  for (const glsl::IncidentLight& light : lights) {
    if (!arrives(light)) continue;
    const float cosine = light.direction.z;
    const float alpha = glsl::widened_alpha(surface.alpha, light.spread, cosine, widen), a2 = alpha * alpha;
    const glm::vec3 reflectance =
        glsl::ltc_specular_reflectance(surface, glsl::ltc_lookup(cosine, surface.alpha));
    const glm::vec3 arriving = cosine * light.irradiance;
    const glm::vec3 weight = arriving * glsl::widened_energy(surface, alpha, cosine);
    float* row = rows_.data() + count_;
    for (const float value :
         {light.direction.x, light.direction.y, cosine, a2, std::sqrt(cosine * cosine * (1 - a2) + a2),
          weight.x * surface.f0.x, weight.y * surface.f0.y, weight.z * surface.f0.z, weight.x * surface.f90,
          weight.y * surface.f90, weight.z * surface.f90}) {
      *row = value;
      row += rowLength_;
    }
    lobes_.push_back({mirrored(light.direction), alpha, glsl::luminance(arriving * reflectance)});
    flux_ += arriving * reflectance;
    all_.push_back(static_cast<uint32_t>(count_++));
  }
}

glm::vec3 GlossyLobes::radiance(const glm::vec3& w) const {
  return evaluate(w, all_, rows_.data(), nullptr);
}

void GlossyLobes::describe(std::span<const uint32_t> which, float* rows) const {
  const size_t length = stride(which.size());
  for (size_t r = 0; r < kRows; ++r, rows += length) {
    const float* row = rows_.data() + r * rowLength_;
    for (size_t i = 0; i < which.size(); ++i) rows[i] = row[which[i]];
    std::fill(rows + which.size(), rows + length, r < 2 || r > 4 ? 0.f : 1.f);
  }
}

glm::vec3 GlossyLobes::evaluate(const glm::vec3& w, std::span<const uint32_t> which, const float* rows,
                                float* values) const {
  const size_t length = stride(which.size());
  // glsl::brdf_parts for four lobes at once, multiplied out: one division.
  const Float4 wx = splat(w.x), wy = splat(w.y), wz = splat(w.z), one = splat(1), zero = splat(0);
  const Float4 wz2 = wz * wz, scale = splat(0.5f * glsl::inverse_pi), half = splat(0.5f);
  Float4 red = zero, green = zero, blue = zero;
  for (size_t i = 0; i < length; i += 4) {
    const auto row = [&](size_t r) { return load(rows + r * length + i); };
    const Float4 lz = row(2), a2 = row(3);
    const Float4 hx = wx + row(0), hy = wy + row(1), hz = wz + lz;
    const Float4 across = hx * hx + hy * hy, up = hz * hz, size2 = across + up;
    const Float4 q = a2 * up + across;
    const Float4 shadowing = lz * root(wz2 * (one - a2) + a2) + wz * row(4);
    const Float4 lobe = scale * a2 * size2 * size2 / (q * q * shadowing);
    const Float4 m = greater(one - half * root(size2), zero), m2 = m * m;
    const Float4 high = lobe * (m2 * m2 * m), low = lobe - high;
    const Float4 r = low * row(5) + high * row(8);
    const Float4 g = low * row(6) + high * row(9);
    const Float4 b = low * row(7) + high * row(10);
    red += r, green += g, blue += b;
    if (!values) continue;
    store(values + i, r);
    store(values + length + i, g);
    store(values + 2 * length + i, b);
  }
  return {sumOf(red), sumOf(green), sumOf(blue)};
}

}  // namespace limn::radiosity
