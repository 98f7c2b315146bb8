// limn-fit-ltc: fits linearly transformed cosines to the glossy lobe of glsl/surface/brdf.glsl and writes the
// table that core/shading/ltc_table.cpp compiles in. Run it after changing that lobe:
//
//     limn-fit-ltc core/shading/ltc_table.inc
//
// For every (roughness, n.v) the directional reflectance is integrated by sampling visible normals; then m11,
// m22, m13 and the tilt minimise the difference between the lobe and the transformed cosine over samples of
// both (Heitz et al. 2016, section 3), by Nelder and Mead's simplex. Two things differ from the paper: the
// transformed cosine is cut at the horizon and normalised over what is left, which lets it follow the cut
// lobes of grazing views, and the difference counts to the power 3/2, not 3; together they halve the total
// variation between the two. Deterministic.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <vector>

#include "core/base/error.h"
#include "glsl/light/ltc.glsl"

namespace {

using namespace limn::glsl;

constexpr int kSize = ltc_size;
constexpr int kFitSide = 24;      // samples per axis and strategy while fitting
constexpr int kAlbedoSide = 128;  // samples per axis for reflectances
constexpr float kSmallestTheta = 0.02f;

struct Setting {
  float alpha;
  vec3 v;
  float theta;
};

Setting setting(int column, int row) {
  const float low = std::sqrt(brdf_min_alpha);
  const float root = low + (1 - low) * column / (kSize - 1);
  const float y = static_cast<float>(row) / (kSize - 1);
  const float cosine = std::clamp(y * y, brdf_min_cosine, std::cos(kSmallestTheta));
  return {root * root, vec3(std::sqrt(1 - cosine * cosine), 0, cosine), std::acos(cosine)};
}

/// The lobe with Fresnel term 1, times n.l, and the density of sampling it.
struct Lobe {
  float value = 0, pdf = 0, schlick = 0;
};

Lobe lobe(const Setting& s, const vec3& l) {
  if (!(l.z > 0)) return {};
  const HalfVector h = half_vector(vec3(0, 0, 1), s.v, l);
  const float d = ggx_distribution(h.n_dot_h, h.sine2, s.alpha);
  return {d * ggx_visibility(s.v.z, l.z, s.alpha) * l.z, ggx_masking(s.v.z, s.alpha) * d / (4 * s.v.z),
          schlick_weight(h.v_dot_h)};
}

vec3 sampleLobe(const Setting& s, vec2 u) {
  const vec3 h = sample_visible_normal(s.v, vec2(s.alpha), u);
  return normalize(2 * dot(s.v, h) * h - s.v);
}

vec2 stratum(int index, int side) {
  return {(index % side + 0.5f) / side, (index / side + 0.5f) / side};
}

struct Albedo {
  double a = 0, b = 0;
  dvec3 mean{0};
};

Albedo albedo(const Setting& s) {
  Albedo result;
  for (int i = 0; i < kAlbedoSide * kAlbedoSide; ++i) {
    const vec3 l = sampleLobe(s, stratum(i, kAlbedoSide));
    const Lobe f = lobe(s, l);
    if (f.pdf <= 0) continue;
    const double weight = f.value / f.pdf;
    result.a += weight * (1 - f.schlick);
    result.b += weight * f.schlick;
    result.mean += weight * dvec3(l);
  }
  const double n = double(kAlbedoSide) * kAlbedoSide;
  result.a /= n;
  result.b /= n;
  return result;
}

/// Mean of (1 - v.h)^5 over a cosine lobe.
double diffuseFresnel(const Setting& s) {
  double sum = 0;
  for (int i = 0; i < kAlbedoSide * kAlbedoSide; ++i) {
    const vec3 l = sample_cosine(stratum(i, kAlbedoSide));
    sum += schlick_weight(half_vector(vec3(0, 0, 1), s.v, l).v_dot_h);
  }
  return sum / (double(kAlbedoSide) * kAlbedoSide);
}

/// A transformed cosine in double precision.
struct Transformed {
  dmat3 m, inverse;
  double share;  // of the lobe, above the horizon
  double scale;  // |det M^-1| / (pi share)

  Transformed(double m11, double m22, double m13, double tilt) {
    const dvec3 z(-std::sin(tilt), 0, std::cos(tilt)), x(std::cos(tilt), 0, std::sin(tilt));
    m = dmat3(x, dvec3(0, 1, 0), z) * dmat3(dvec3(m11, 0, m13), dvec3(0, m22, 0), dvec3(0, 0, 1));
    inverse = glm::inverse(m);
    // The horizon maps to a plane through the origin; a cosine lobe leaves (1 + cos) / 2 above such a plane.
    const dvec3 horizon(m[0].z, m[1].z, m[2].z);
    share = 0.5 * (1 + horizon.z / length(horizon));
    scale = std::abs(glm::determinant(inverse)) / (M_PI * share);
  }
  double density(const vec3& l) const {
    if (!(l.z > 0)) return 0;
    const dvec3 p = inverse * dvec3(l);
    const double r2 = dot(p, p);
    return std::max(0.0, p.z) * scale / (r2 * r2);
  }
  vec3 sample(vec2 u) const { return vec3(normalize(m * dvec3(sample_cosine(u)))); }
};

constexpr int kFree = 4;
using Point = std::array<double, kFree>;  // log m11, log m22, m13, tilt

Transformed transformed(const Point& p) {
  return {std::exp(p[0]), std::exp(p[1]), p[2], p[3]};
}

/// What the fit minimises: the mean of |difference|^(3/2), sampled from both distributions (balance
/// heuristic).
double misfit(const Setting& s, double total, const std::vector<vec3>& fromLobe, const Point& p) {
  const Transformed t = transformed(p);
  double sum = 0;
  const auto add = [&](const vec3& l) {
    const Lobe f = lobe(s, l);
    const double density = t.density(l);
    const double difference = std::abs(f.value / total - density);
    if (f.pdf + density > 0) sum += difference * std::sqrt(difference) / (f.pdf + density);
  };
  for (const vec3& l : fromLobe) add(l);
  for (int i = 0; i < kFitSide * kFitSide; ++i) add(t.sample(stratum(i, kFitSide)));
  return sum;
}

/// Nelder and Mead 1965.
Point minimise(const std::function<double(const Point&)>& f, const Point& start, const Point& step) {
  struct Vertex {
    Point p;
    double value;
  };
  std::array<Vertex, kFree + 1> simplex;
  for (int i = 0; i <= kFree; ++i) {
    simplex[i].p = start;
    if (i > 0) simplex[i].p[i - 1] += step[i - 1];
    simplex[i].value = f(simplex[i].p);
  }
  const auto better = [](const Vertex& a, const Vertex& b) { return a.value < b.value; };
  for (int iteration = 0; iteration < 120; ++iteration) {
    std::sort(simplex.begin(), simplex.end(), better);
    if (simplex[kFree].value - simplex[0].value < 1e-5 * simplex[0].value) break;
    Point centre{};
    for (int i = 0; i < kFree; ++i) {
      for (int k = 0; k < kFree; ++k) centre[k] += simplex[i].p[k] / kFree;
    }
    const auto towards = [&](double factor) {
      Vertex v;
      for (int k = 0; k < kFree; ++k) v.p[k] = centre[k] + factor * (simplex[kFree].p[k] - centre[k]);
      v.value = f(v.p);
      return v;
    };
    const Vertex reflected = towards(-1);
    if (reflected.value < simplex[0].value) {
      const Vertex expanded = towards(-2);
      simplex[kFree] = expanded.value < reflected.value ? expanded : reflected;
    } else if (reflected.value < simplex[kFree - 1].value) {
      simplex[kFree] = reflected;
    } else {
      const Vertex contracted = towards(reflected.value < simplex[kFree].value ? -0.5 : 0.5);
      if (contracted.value < std::min(reflected.value, simplex[kFree].value)) {
        simplex[kFree] = contracted;
        continue;
      }
      for (int i = 1; i <= kFree; ++i) {
        for (int k = 0; k < kFree; ++k) simplex[i].p[k] = 0.5 * (simplex[i].p[k] + simplex[0].p[k]);
        simplex[i].value = f(simplex[i].p);
      }
    }
  }
  return std::min_element(simplex.begin(), simplex.end(), better)->p;
}

struct Texels {
  vec4 shape, reflectance;
};

Texels fit(const Setting& s, Point& state) {
  const Albedo total = albedo(s);
  std::vector<vec3> fromLobe;
  fromLobe.reserve(size_t{kFitSide} * kFitSide);
  for (int i = 0; i < kFitSide * kFitSide; ++i) fromLobe.push_back(sampleLobe(s, stratum(i, kFitSide)));
  const auto error = [&](const Point& p) { return misfit(s, total.a + total.b, fromLobe, p); };
  // Two starts: the rougher neighbour's lobe, and the lobe of a very smooth surface.
  const double narrow = 2 * s.alpha;
  const Point smooth{std::log(narrow), std::log(narrow * s.v.z), 0, s.theta};
  std::array<Point, 2> found{state, smooth};
  for (Point& p : found) {
    const double width = std::exp(p[1]);
    p = minimise(error, p, {0.2, 0.2, 0.2 * width, 0.2 * width});
    p = minimise(error, p, {0.02, 0.02, 0.02 * width, 0.02 * width});
  }
  state = error(found[1]) < error(found[0]) ? found[1] : found[0];
  Texels texels;
  texels.shape =
      vec4(std::exp(state[0]) / s.alpha, std::exp(state[1]) / s.alpha, state[2] / s.v.x, state[3] / s.theta);
  texels.reflectance = vec4(total.a, total.b, diffuseFresnel(s), transformed(state).share);
  return texels;
}

void write(const char* path, const std::vector<Texels>& table) {
  std::ofstream out(path);
  out << "// Written by limn-fit-ltc; see glsl/light/ltc.glsl. Rows of n.v, columns of roughness, two texels "
         "each.\n";
  for (const Texels& t : table) {
    for (const vec4& v : {t.shape, t.reflectance}) {
      out << fmt::format("{{{:.6g}, {:.6g}, {:.6g}, {:.6g}}},", v.x, v.y, v.z, v.w);
    }
    out << '\n';
  }
  out.flush();
  if (!out) throw limn::Error(fmt::format("{}: cannot be written", path));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: limn-fit-ltc FILE.inc\n";
    return 2;
  }
  try {
    std::vector<Texels> table(kSize * kSize);
    for (int row = kSize - 1; row >= 0; --row) {
      Point state{0, 0, 0};
      for (int column = kSize - 1; column >= 0; --column) {
        const Setting s = setting(column, row);
        if (column + 1 < kSize) {  // widths scale with alpha
          const double ratio = std::log(s.alpha / setting(column + 1, row).alpha);
          state[0] += ratio;
          state[1] += ratio;
        }
        table[row * kSize + column] = fit(s, state);
      }
      std::cout << fmt::format("n.v = {:.4f}\n", setting(0, row).v.z);
    }
    write(argv[1], table);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
