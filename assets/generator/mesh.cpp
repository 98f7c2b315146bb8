#include "assets/generator/mesh.h"

#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace limn::assets {

void append(Mesh& mesh, const Mesh& part, const glm::mat4& transform) {
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  const glm::mat3 linear(transform);
  const glm::mat3 forNormals = glm::inverseTranspose(linear);
  const bool mirrored = glm::determinant(linear) < 0;
  for (const glm::vec3& p : part.positions) mesh.positions.push_back(glm::vec3(transform * glm::vec4(p, 1)));
  for (const glm::vec3& n : part.normals) mesh.normals.push_back(glm::normalize(forNormals * n));
  for (const glm::vec4& t : part.tangents) {
    mesh.tangents.emplace_back(glm::normalize(linear * glm::vec3(t)), mirrored ? -t.w : t.w);
  }
  mesh.uvs.insert(mesh.uvs.end(), part.uvs.begin(), part.uvs.end());
  mesh.joints.insert(mesh.joints.end(), part.joints.begin(), part.joints.end());
  mesh.weights.insert(mesh.weights.end(), part.weights.begin(), part.weights.end());
  for (std::size_t i = 0; i + 2 < part.indices.size(); i += 3) {
    mesh.indices.push_back(base + part.indices[i]);
    mesh.indices.push_back(base + part.indices[i + (mirrored ? 2 : 1)]);
    mesh.indices.push_back(base + part.indices[i + (mirrored ? 1 : 2)]);
  }
}

Mesh transformed(const Mesh& mesh, const glm::mat4& transform) {
  Mesh result;
  append(result, mesh, transform);
  return result;
}

void scaleUv(Mesh& mesh, glm::vec2 factor) {
  for (glm::vec2& uv : mesh.uvs) uv *= factor;
}

void bindToJoint(Mesh& mesh, int joint) {
  mesh.joints.assign(mesh.positions.size(), {static_cast<std::uint8_t>(joint), 0, 0, 0});
  mesh.weights.assign(mesh.positions.size(), {1, 0, 0, 0});
}

void bindToJoints(Mesh& mesh, int first, int second, const std::function<float(glm::vec3)>& blend) {
  mesh.joints.assign(mesh.positions.size(),
                     {static_cast<std::uint8_t>(first), static_cast<std::uint8_t>(second), 0, 0});
  mesh.weights.clear();
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const float w = glm::clamp(blend(mesh.positions[i]), 0.0f, 1.0f);
    mesh.weights.emplace_back(1 - w, w, 0, 0);
    if (w == 0) mesh.joints[i].y = 0;  // glTF wants joint 0 where the weight is 0
    if (w == 1) {
      mesh.joints[i] = {static_cast<std::uint8_t>(second), 0, 0, 0};
      mesh.weights[i] = {1, 0, 0, 0};
    }
  }
}

void computeTangents(Mesh& mesh) {
  std::vector<glm::vec3> along(mesh.positions.size(), glm::vec3(0)), across(along);
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const glm::vec3 e1 = mesh.positions[b] - mesh.positions[a], e2 = mesh.positions[c] - mesh.positions[a];
    const glm::vec2 d1 = mesh.uvs[b] - mesh.uvs[a], d2 = mesh.uvs[c] - mesh.uvs[a];
    const float sign = d1.x * d2.y - d2.x * d1.y < 0 ? -1.0f : 1.0f;
    for (const std::uint32_t v : {a, b, c}) {
      along[v] += sign * (e1 * d2.y - e2 * d1.y);
      across[v] += sign * (e2 * d1.x - e1 * d2.x);
    }
  }
  mesh.tangents.clear();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 n = mesh.normals[v];
    glm::vec3 t = along[v] - n * glm::dot(n, along[v]);
    if (glm::dot(t, t) < 1e-20f)
      t = glm::cross(n, std::abs(n.x) < 0.9f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0));
    t = glm::normalize(t);
    // glTF's bitangent follows the texture's upward direction, that is falling v.
    mesh.tangents.emplace_back(t, glm::dot(glm::cross(n, t), -across[v]) < 0 ? -1.0f : 1.0f);
  }
}

void brushAlongCircles(Mesh& mesh) {
  mesh.tangents.clear();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const float angle = 2 * glm::pi<float>() * mesh.uvs[v].x;
    mesh.tangents.emplace_back(-std::sin(angle), 0, -std::cos(angle), 1);
  }
}

void brushAlongRadii(Mesh& mesh) {
  brushAlongCircles(mesh);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const glm::vec3 along = glm::normalize(glm::cross(mesh.normals[v], glm::vec3(mesh.tangents[v])));
    mesh.tangents[v] = glm::vec4(along, 1);
  }
}

void computeNormals(Mesh& mesh) {
  mesh.normals.assign(mesh.positions.size(), glm::vec3(0));
  for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
    const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
    const glm::vec3 n =
        glm::cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    for (const std::uint32_t v : {a, b, c}) mesh.normals[v] += n;
  }
  for (glm::vec3& n : mesh.normals) n = glm::dot(n, n) > 0 ? glm::normalize(n) : glm::vec3(0, 1, 0);
}

glm::mat4 translation(glm::vec3 offset) {
  return glm::translate(glm::mat4(1), offset);
}
glm::mat4 scaling(glm::vec3 factor) {
  return glm::scale(glm::mat4(1), factor);
}
glm::mat4 rotation(float degrees, glm::vec3 axis) {
  return glm::rotate(glm::mat4(1), glm::radians(degrees), glm::normalize(axis));
}

glm::quat facing(glm::vec3 direction, glm::vec3 up) {
  const glm::vec3 d = glm::normalize(direction);
  if (std::abs(glm::dot(d, glm::normalize(up))) > 0.999f) up = glm::vec3(0, 0, -1);
  return glm::quatLookAt(d, up);
}

}  // namespace limn::assets
