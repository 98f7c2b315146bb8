#include "core/radiosity/glossy_lobes.h"

#include <algorithm>

#include "core/radiosity/private/float4.h"
#include "glsl/light/ltc.glsl"
#include "glsl/materials/model.glsl"
#include "glsl/numeric/srgb.glsl"

namespace limn::radiosity {
namespace {

Float4 gathered(const std::vector<float>& values, const uint32_t* which) {
  return Float4{values[which[0]], values[which[1]], values[which[2]], values[which[3]]};
}

float sumOf(Float4 v) {
  return (v[0] + v[2]) + (v[1] + v[3]);
}

}  // namespace

void GlossyLobes::clear() {
  count_ = 0;
  for (std::vector<float>* values : {&x_, &y_, &z_, &alpha_, &root_, &brightness_}) values->clear();
  for (int c = 0; c < 3; ++c) low_[c].clear(), high_[c].clear();
  irradiance_.clear();
  widened_.clear();
  model_ = nullptr;
  measured_ = nullptr;
  flux_ = glm::vec3(0);
}

void GlossyLobes::set(const glsl::SurfaceBrdf& surface, std::span<const glsl::IncidentLight> lights,
                      float widen) {
  clear();
  if (glsl::brdf_is_lambertian(surface)) return;
  for (const glsl::IncidentLight& light : lights) {
    const float cosine = light.direction.z;
    const glm::vec3 arriving = cosine * light.irradiance;
    if (!(cosine > 0) || !(glsl::largest_channel(arriving) > 0)) continue;
    const float alpha = glsl::widened_alpha(surface.alpha, light.spread, cosine, widen);
    const glm::vec3 reflectance =
        glsl::ltc_specular_reflectance(surface, glsl::ltc_lookup(cosine, surface.alpha));
    glsl::SurfaceBrdf wider = surface;
    wider.alpha = alpha;
    const glm::vec3 kept =
        reflectance /
        glm::max(glsl::ltc_specular_reflectance(wider, glsl::ltc_lookup(cosine, alpha)), 1e-20f);
    x_.push_back(light.direction.x);
    y_.push_back(light.direction.y);
    z_.push_back(cosine);
    alpha_.push_back(alpha);
    root_.push_back(std::sqrt(cosine * cosine * (1 - alpha * alpha) + alpha * alpha));
    for (int c = 0; c < 3; ++c) {
      low_[c].push_back(arriving[c] * kept[c] * surface.f0[c]);
      high_[c].push_back(arriving[c] * kept[c] * surface.f90);
    }
    brightness_.push_back(glsl::luminance(arriving * reflectance));
    flux_ += arriving * reflectance;
    ++count_;
  }
  // Lanes that stand for no lobe still divide.
  const size_t padded = (count_ + 3) / 4 * 4;
  x_.resize(padded), y_.resize(padded), z_.resize(padded, 1), alpha_.resize(padded, 1),
      root_.resize(padded, 1);
  for (int c = 0; c < 3; ++c) low_[c].resize(padded), high_[c].resize(padded);
}

void GlossyLobes::set(const glsl::MaterialModel& model, const std::vector<glm::vec3>& measured,
                      std::span<const glsl::IncidentLight> lights, float widen) {
  clear();
  model_ = &model;
  measured_ = &measured;
  const bool rough = model.kind == glsl::model_torrance_sparrow || model.kind == glsl::model_ward;
  for (const glsl::IncidentLight& light : lights) {
    const float cosine = light.direction.z;
    const glm::vec3 arriving = cosine * light.irradiance;
    if (!(cosine > 0) || !(glsl::largest_channel(arriving) > 0)) continue;
    glsl::MaterialModel wider = model;
    if (rough)
      for (int k = 0; k < 2; ++k)
        wider.roughness[k] = glsl::widened_alpha(model.roughness[k], light.spread, cosine, widen);
    x_.push_back(light.direction.x);
    y_.push_back(light.direction.y);
    z_.push_back(cosine);
    alpha_.push_back(rough ? std::min(wider.roughness.x, wider.roughness.y) : 0.1f);
    irradiance_.push_back(light.irradiance);
    widened_.push_back(wider);
    brightness_.push_back(glsl::luminance(arriving));
    ++count_;
  }
}

glm::vec3 GlossyLobes::radiance(const glm::vec3& w) const {
  glm::vec3 sum(0);
  for (uint32_t k = 0; k < count_; ++k) {
    float values[12];
    sum += evaluate(w, {&k, 1}, values, 4);
  }
  return sum;
}

glm::vec3 GlossyLobes::evaluate(const glm::vec3& w, std::span<const uint32_t> which, float* values,
                                size_t stride) const {
  if (model_) {
    glm::vec3 sum(0);
    for (size_t i = 0; i < which.size(); ++i) {
      const uint32_t k = which[i];
      const glm::vec3 value =
          irradiance_[k] * glsl::model_response(*measured_, widened_[k], w, glm::vec3(x_[k], y_[k], z_[k]));
      for (int c = 0; c < 3; ++c) values[static_cast<size_t>(c) * stride + i] = value[c];
      sum += value;
    }
    return sum;
  }
  // glsl::brdf_parts for four lobes at once, multiplied out: one division.
  const Float4 wx = splat(w.x), wy = splat(w.y), wz = splat(w.z), one = splat(1), half = splat(0.5f);
  Float4 sums[3] = {};
  for (size_t i = 0; i < which.size(); i += 4) {
    const size_t lanes = std::min<size_t>(4, which.size() - i);
    uint32_t index[4];
    for (size_t k = 0; k < 4; ++k) index[k] = which[i + std::min(k, lanes - 1)];
    const Float4 lx = gathered(x_, index), ly = gathered(y_, index), lz = gathered(z_, index);
    const Float4 alpha = gathered(alpha_, index), root4 = gathered(root_, index);
    const Float4 a2 = alpha * alpha;
    const Float4 hx = wx + lx, hy = wy + ly, hz = wz + lz;
    const Float4 across = hx * hx + hy * hy, up = hz * hz, size2 = across + up;
    const Float4 q = a2 * up + across;
    const Float4 shadowing = lz * root(wz * wz * (one - a2) + a2) + wz * root4;
    const Float4 lobe = splat(0.5f * glsl::inverse_pi) * a2 * size2 * size2 / (q * q * shadowing);
    const Float4 vDotH = half * root(size2);
    const Float4 m = greater(one - vDotH, splat(0)), m2 = m * m;
    const Float4 toHigh = lobe * m2 * m2 * m, toLow = lobe - toHigh;
    for (int c = 0; c < 3; ++c) {
      Float4 value = toLow * gathered(low_[c], index) + toHigh * gathered(high_[c], index);
      for (size_t k = lanes; k < 4; ++k) value[k] = 0;
      store(values + static_cast<size_t>(c) * stride + i, value);
      sums[c] += value;
    }
  }
  return {sumOf(sums[0]), sumOf(sums[1]), sumOf(sums[2])};
}

}  // namespace limn::radiosity
