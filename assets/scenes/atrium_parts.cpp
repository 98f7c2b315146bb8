#include "assets/scenes/atrium_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "assets/generator/shapes.h"

namespace limn::assets::atrium {
namespace {

/// An acanthus-like leaf that hugs a bell and curls outwards at its tip; root at the origin, outwards is +Z.
Mesh capitalLeaf(float width, float height) {
  return surface(6, 9, [=](glm::vec2 uv) {
    const float t = uv.y, x = 2 * uv.x - 1;
    const float half = 0.5f * width * (0.75f + 0.5f * std::sin(glm::pi<float>() * t)) *
                       (1 - 0.75f * t * t * t) * (1 + 0.1f * std::cos(14 * t));
    const float curl = 0.22f * height * t * t * t + 0.05f * height * t;
    const float y = height * (t - 0.22f * t * t * t * t);
    return glm::vec3(x * half, y, curl + 0.1f * width * (1 - x * x) + 0.02f * width * std::cos(9 * x));
  });
}

void addCapital(Mesh& mesh, float y, float height, float radius) {
  const glm::vec2 bell[] = {{radius, y},
                            {1.1f * radius, y + 0.01f},
                            {1.1f * radius, y + 0.035f},
                            {0.98f * radius, y + 0.045f},
                            {1.0f * radius, y + 0.5f * height},
                            {1.2f * radius, y + 0.8f * height},
                            {1.42f * radius, y + 0.88f * height}};
  append(mesh, lathe(bell, 40));
  for (int row = 0; row < 2; ++row) {
    for (int i = 0; i < 8; ++i) {
      const float degrees = 45.0f * (static_cast<float>(i) + 0.5f * static_cast<float>(row));
      const Mesh leaf = capitalLeaf(0.78f * radius, (row == 0 ? 0.5f : 0.78f) * height);
      append(mesh, leaf,
             translation({0, y + 0.04f, 0}) * rotation(degrees, {0, 1, 0}) *
                 translation({0, 0, (row == 0 ? 1.0f : 0.97f) * radius}));
    }
  }
  append(mesh, transformed(roundedBox({1.5f * radius, 0.06f * height, 1.5f * radius}, 0.012f, 2),
                           translation({0, y + 0.94f * height, 0})));
}

void addBase(Mesh& mesh, float radius) {
  append(mesh, box({0, 0.05f, 0}, {1.45f * radius, 0.05f, 1.45f * radius}));
  std::vector<glm::vec2> profile;
  const auto roll = [&](float y, float r, float half) {
    for (int i = 0; i <= 6; ++i) {
      const float a = glm::pi<float>() * (static_cast<float>(i) / 6 - 0.5f);
      profile.emplace_back(r + half * std::cos(a), y + half * std::sin(a));
    }
  };
  roll(0.14f, 1.26f * radius, 0.04f);
  profile.emplace_back(1.2f * radius, 0.19f);
  profile.emplace_back(1.13f * radius, 0.22f);
  roll(0.25f, 1.1f * radius, 0.025f);
  profile.emplace_back(1.0f * radius, 0.285f);
  append(mesh, lathe(profile, 40));
}

}  // namespace

Mesh flutedColumn(float height, float radius) {
  Mesh mesh;
  addBase(mesh, radius);
  const float capital = 1.7f * radius, bottom = 0.28f, top = height - capital;
  append(mesh, surface(120, 8, [=](glm::vec2 uv) {
           const float a = 2 * glm::pi<float>() * uv.x, t = uv.y;
           const float taper = 1 - 0.14f * t * t + 0.02f * std::sin(glm::pi<float>() * t);
           const float flute =
               std::pow(0.5f - 0.5f * std::cos(20 * a), 0.7f) * (t < 0.01f || t > 0.99f ? 0.0f : 1.0f);
           const float r = radius * taper * (1 - 0.085f * flute);
           return glm::vec3(r * std::cos(a), glm::mix(bottom, top, t), -r * std::sin(a));
         }));
  addCapital(mesh, top, capital, 0.87f * radius);
  return mesh;
}

Mesh plainColumn(float height, float radius) {
  Mesh mesh;
  append(mesh, box({0, 0.03f, 0}, {1.4f * radius, 0.03f, 1.4f * radius}));
  const glm::vec2 profile[] = {{1.3f * radius, 0.06f},           {1.35f * radius, 0.09f},
                               {1.3f * radius, 0.12f},           {1.08f * radius, 0.14f},
                               {1.0f * radius, 0.18f},           {1.0f * radius, 0.5f * height},
                               {0.86f * radius, height - 0.24f}, {0.98f * radius, height - 0.235f},
                               {0.98f * radius, height - 0.21f}, {0.88f * radius, height - 0.2f},
                               {0.9f * radius, height - 0.14f},  {1.3f * radius, height - 0.08f},
                               {1.35f * radius, height - 0.06f}};
  append(mesh, lathe(profile, 36));
  append(mesh, box({0, height - 0.03f, 0}, {1.4f * radius, 0.03f, 1.4f * radius}));
  return mesh;
}

Mesh archedWall(float width, float height, float depth, float radius) {
  constexpr int steps = 28;
  const float half = width / 2, corner = std::atan2(height, half);
  std::vector<float> angles = {corner, glm::pi<float>() - corner};
  for (int i = 0; i <= steps; ++i) angles.push_back(glm::pi<float>() * static_cast<float>(i) / steps);
  std::sort(angles.begin(), angles.end());
  const auto rim = [&](float a) {  // where the ray at angle a leaves the rectangle
    const float c = std::abs(std::cos(a)), s = std::sin(a);
    const float reach = std::min(c > 1e-6f ? half / c : 1e9f, s > 1e-6f ? height / s : 1e9f);
    return glm::vec2(std::cos(a), s) * reach;
  };
  Mesh mesh;
  const auto strip = [&](const auto& first, const auto& second, const auto& normal) {
    const auto base = static_cast<std::uint32_t>(mesh.positions.size());
    for (const float a : angles) {
      for (const glm::vec3& p : {glm::vec3(first(a)), glm::vec3(second(a))}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(normal(a));
        mesh.uvs.emplace_back(p.x + p.z, p.y);
      }
    }
    for (std::uint32_t i = base; i + 3 < mesh.positions.size(); i += 2) {
      mesh.indices.insert(mesh.indices.end(), {i, i + 1, i + 3, i, i + 3, i + 2});
    }
  };
  const auto inner = [&](float a) { return radius * glm::vec2(std::cos(a), std::sin(a)); };
  const float z = depth / 2;
  strip([&](float a) { return glm::vec3(inner(a), z); }, [&](float a) { return glm::vec3(rim(a), z); },
        [](float) { return glm::vec3(0, 0, 1); });
  strip([&](float a) { return glm::vec3(rim(a), -z); }, [&](float a) { return glm::vec3(inner(a), -z); },
        [](float) { return glm::vec3(0, 0, -1); });
  strip([&](float a) { return glm::vec3(inner(a), -z); }, [&](float a) { return glm::vec3(inner(a), z); },
        [](float a) { return glm::vec3(-std::cos(a), -std::sin(a), 0); });
  for (const float side : {-1.0f, 1.0f}) {  // the strips on which the wall rests
    append(mesh, quad({side * (half + radius) / 2, 0, 0}, {(half - radius) / 2, 0, 0}, {0, 0, depth / 2}));
  }
  for (const float face : {-1.0f, 1.0f}) {
    for (const auto& [at, thick] : {std::pair{radius + 0.03f, 0.035f}, {radius + 0.13f, 0.022f}}) {
      std::vector<glm::vec3> path;
      for (int i = 0; i <= steps; ++i) {
        const float a = glm::pi<float>() * static_cast<float>(i) / steps;
        path.emplace_back(at * std::cos(a), at * std::sin(a), face * z);
      }
      append(mesh, tube(path, std::vector<float>(path.size(), thick), 8, false));
    }
  }
  append(mesh,
         transformed(roundedBox({0.085f, 0.15f, z + 0.05f}, 0.012f, 1), translation({0, radius + 0.1f, 0})));
  return mesh;
}

Mesh balustrade(float width, float height, int balusters) {
  Mesh mesh;
  append(mesh, transformed(roundedBox({width / 2, 0.06f, 0.11f}, 0.015f, 2), translation({0, 0.06f, 0})));
  append(mesh,
         transformed(roundedBox({width / 2, 0.05f, 0.13f}, 0.03f, 3), translation({0, height - 0.05f, 0})));
  const float h = height - 0.2f;
  const glm::vec2 knots[] = {{0.05f, 0},     {0.05f, 0.06f}, {0.03f, 0.09f},  {0.062f, 0.22f},
                             {0.07f, 0.33f}, {0.04f, 0.55f}, {0.027f, 0.78f}, {0.04f, 0.86f},
                             {0.03f, 0.9f},  {0.05f, 0.94f}, {0.05f, 1}};
  std::vector<glm::vec2> profile;
  for (const glm::vec2& k : spline(std::span<const glm::vec2>(knots), 2))
    profile.emplace_back(k.x, 0.11f + h * k.y);
  const Mesh baluster = lathe(profile, 16, 50);
  for (int i = 0; i < balusters; ++i) {
    const float x = width * ((static_cast<float>(i) + 0.5f) / static_cast<float>(balusters) - 0.5f);
    append(mesh, baluster, translation({x, 0, 0}));
  }
  return mesh;
}

Mesh cornice(std::span<const glm::vec2> profile, float halfX, float halfZ) {
  Mesh mesh;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const glm::vec2 a = profile[i], b = profile[i + 1];
    const glm::vec2 n = glm::normalize(glm::vec2(b.y - a.y, a.x - b.x));  // (inwards, up)
    for (int side = 0; side < 4; ++side) {
      const bool alongX = side % 2 == 0;
      const float sign = side < 2 ? 1.0f : -1.0f;
      // Seen from the court, u runs to the right.
      const glm::vec3 inwards = alongX ? glm::vec3(0, 0, -sign) : glm::vec3(-sign, 0, 0),
                      right = glm::cross(glm::vec3(0, 1, 0), inwards);
      const float reach = alongX ? halfZ : halfX, length = alongX ? halfX : halfZ;
      const auto corner = [&](glm::vec2 p, float end) {
        return -inwards * (reach - p.x) + right * end * (length - p.x) + glm::vec3(0, p.y, 0);
      };
      const auto base = static_cast<std::uint32_t>(mesh.positions.size());
      for (const glm::vec3& p : {corner(a, -1), corner(a, 1), corner(b, 1), corner(b, -1)}) {
        mesh.positions.push_back(p);
        mesh.normals.push_back(n.x * inwards + glm::vec3(0, n.y, 0));
        mesh.uvs.emplace_back(glm::dot(p, right), p.y);
      }
      mesh.indices.insert(mesh.indices.end(), {base, base + 1, base + 2, base, base + 2, base + 3});
    }
  }
  return mesh;
}

Mesh fountain() {
  const glm::vec2 basin[] = {{1.25f, 0},    {1.25f, 0.08f}, {1.15f, 0.1f},  {1.12f, 0.16f}, {1.18f, 0.36f},
                             {1.26f, 0.4f}, {1.28f, 0.44f}, {1.24f, 0.48f}, {1.1f, 0.48f},  {1.05f, 0.45f},
                             {1.0f, 0.2f},  {0.3f, 0.16f},  {0.24f, 0.2f}};
  const glm::vec2 stem[] = {{0.26f, 0.15f}, {0.26f, 0.24f}, {0.2f, 0.3f},   {0.12f, 0.42f}, {0.1f, 0.6f},
                            {0.15f, 0.78f}, {0.12f, 0.86f}, {0.14f, 0.92f}, {0.3f, 0.98f},  {0.5f, 1.1f},
                            {0.55f, 1.16f}, {0.52f, 1.18f}, {0.46f, 1.14f}, {0.2f, 1.04f},  {0.08f, 1.06f},
                            {0.06f, 1.2f},  {0.1f, 1.3f},   {0.09f, 1.38f}, {0, 1.44f}};
  Mesh mesh = lathe(basin, 8, 20);
  append(mesh, lathe(spline(std::span<const glm::vec2>(stem), 3), 48, 60));
  return mesh;
}

Mesh banner(float width, float drop) {
  return surface(40, 24, [=](glm::vec2 uv) {
    const float down = 1 - uv.y, fold = 0.05f + 0.07f * down;
    const float x = (uv.x - 0.5f) * width * (1 - 0.05f * down);
    const float hem = 0.12f * drop * (uv.x < 0.5f ? uv.x : 1 - uv.x) * 2;
    return glm::vec3(x, -down * (drop - 0.12f * drop + hem),
                     fold * std::sin(2 * glm::pi<float>() * 2.5f * uv.x + 0.8f * std::sin(4 * down)) +
                         0.02f * std::sin(9 * uv.x + 6 * down));
  });
}

}  // namespace limn::assets::atrium
