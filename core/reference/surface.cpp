#include "core/reference/private/surface.h"

#include <algorithm>

#include "core/scene/texture_lookup.h"
#include "glsl/relief/height_normal.glsl"
#include "glsl/surface/normal_map.glsl"

namespace limn::reference {
namespace {

/// A triangle's vertices and how to blend what they carry.
struct Corner {
  uint32_t index[3];
  float weight[3];

  template <class T>
  T blend(const T* values) const {
    return weight[0] * values[index[0]] + weight[1] * values[index[1]] + weight[2] * values[index[2]];
  }
};

/// Material textures at the footprint's level; white without image or coordinates.
struct TextureLookup {
  const RayScene& rays;
  bool hasUv;
  glm::vec2 uv;
  std::optional<TextureFootprint> footprint;  ///< nullopt: full size

  bool has(const scene::TextureRef& texture) const { return hasUv && texture.image != scene::kNone; }
  glm::vec4 operator()(const scene::TextureRef& texture) const {
    if (!has(texture)) return glm::vec4(1);
    return scene::sampleTexture(rays.scene(), texture, uv,
                                footprint ? levelOfDetail(rays.scene(), texture, *footprint) : 0.f);
  }
  /// The slopes of a height map of the scene.
  glm::vec2 slope(int height) const {
    const relief::HeightField& field = rays.scene().heights[static_cast<size_t>(height)];
    return scene::sampleSlopes(rays.slopes(height), scene::wrapOf(field), uv,
                               footprint ? levelOfDetail(glm::vec2(field.size()), *footprint) : 0.f);
  }
};

/// The tangent in world space, with the sign of the bitangent there.
glm::vec4 worldTangent(const Draw& draw, const Corner& corner) {
  const glm::vec4 tangent = corner.blend(draw.tangents);
  return {draw.tangentToWorld * glm::vec3(tangent), tangent.w * draw.orientation};
}

/// The normal that the material's normal map or else height map makes of an interpolated one, all in world
/// space.
glm::vec3 mappedNormal(const scene::Material& material, const TextureLookup& lookup, const glm::vec3& normal,
                       const glm::vec4& tangent) {
  if (lookup.has(material.normalTexture))
    return glsl::mapped_normal(normal, tangent, glm::vec3(lookup(material.normalTexture)),
                               material.normalScale);
  if (material.height == scene::kNone) return normal;
  return glsl::height_normal(normal, tangent, lookup.slope(material.height));
}

glm::vec3 shadingNormal(const Draw& draw, const Corner& corner, const TextureLookup& lookup,
                        const glm::vec3& geometricNormal) {
  const glm::vec3 interpolated = draw.normalToWorld * corner.blend(draw.normals);
  const float size = glm::length(interpolated);
  if (!(size > 0.f)) return geometricNormal;
  const glm::vec3 normal = interpolated / size;
  if (!lookup.hasUv || !draw.tangents) return normal;
  return mappedNormal(*draw.material, lookup, normal, worldTangent(draw, corner));
}

/// Sets what the material says of the surface, whose normals and vertex colour are known. `tangent` (world,
/// any length; 0: none) turns the frame in which a model is evaluated.
void fillMaterial(const RayScene& rays, const TextureLookup& lookup, const glm::vec3& tangent,
                  Surface& surface) {
  const scene::Material& material = *rays.draws()[surface.draw].material;
  glsl::GBufferSurface& values = surface.values;
  const glm::vec4 base = material.baseColour * lookup(material.baseColourTexture) * surface.vertexColour;
  const glm::vec4 metalRough = lookup(material.metalRoughTexture);
  // The G-buffer's ranges.
  // Vertices and textures decide on a model's coverage alone.
  values.base_colour = glm::clamp(glm::vec3(material.model ? material.baseColour : base), 0.f, 1.f);
  values.metallic = glm::clamp(material.metallic * metalRough.b, 0.f, 1.f);
  values.roughness = glm::clamp(material.roughness * metalRough.g, 0.f, 1.f);
  values.specular_factor = glm::clamp(material.specularFactor, 0.f, 1.f);
  values.specular_colour = glm::clamp(material.specularColour, 0.f, 1.f);
  values.ior = glm::clamp(material.ior, 1.f, 1000.f);
  values.emission = material.emission * glm::vec3(lookup(material.emissiveTexture));
  if (material.unlit) values.emission *= glm::vec3(surface.vertexColour);
  values.flags = material.specularSurface() ? glsl::gbuffer_flag_specular
                 : material.subsurface      ? glsl::gbuffer_flag_translucent
                                            : 0u;
  surface.brdf = glsl::surface_brdf(values.base_colour, values.metallic, values.roughness,
                                    values.specular_factor, values.specular_colour, values.ior);
  if (material.subsurface)
    surface.below = {.boundary = glsl::diffusion_boundary(values.ior), .albedo = values.base_colour};
  if (!material.model) return;
  surface.model = &*material.model;
  surface.measured = &rays.scene().measured;
  surface.frame = glsl::frame_along(values.normal, tangent);
}

/// The corners' positions in world space.
struct Triangle {
  glm::dvec3 p[3];

  Triangle(const Draw& draw, const Corner& corner) {
    for (int k = 0; k < 3; ++k)
      p[k] = glm::dvec3(glm::vec3(draw.toWorld * glm::vec4(draw.positions[corner.index[k]], 1.f)));
  }
  glm::vec3 at(float u, float v) const {
    return glm::vec3(p[0] + static_cast<double>(u) * (p[1] - p[0]) + static_cast<double>(v) * (p[2] - p[0]));
  }
  /// The way towards the centroid that takes the point of these weights as far as `clearance` from every
  /// edge, or as far as there is room; 0 where it is clear of them. A point on the edge where two walls meet
  /// lies in both of their planes, as far as floats can tell, and rays that leave it must not meet the other
  /// one.
  glm::vec3 inward(const Corner& corner, float clearance) const {
    if (isClear(corner, static_cast<double>(clearance))) return glm::vec3(0);
    const double twiceArea = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    double share = 0;
    for (int k = 0; k < 3; ++k) {
      const double height = twiceArea / glm::length(p[(k + 2) % 3] - p[(k + 1) % 3]);
      const double least = std::min(clearance / height, 1.0 / 3);
      if (corner.weight[k] < least)
        share = std::max(share, (least - corner.weight[k]) / (1.0 / 3 - corner.weight[k]));
    }
    if (!(share > 0)) return glm::vec3(0);
    const glm::dvec3 point = static_cast<double>(corner.weight[0]) * p[0] +
                             static_cast<double>(corner.weight[1]) * p[1] +
                             static_cast<double>(corner.weight[2]) * p[2];
    return glm::vec3(share * ((p[0] + p[1] + p[2]) / 3.0 - point));
  }
  /// Whether the point is clearly farther than `clearance` from every edge: what most points are is found so
  /// without a root. The height over an edge is twice the area over its length.
  bool isClear(const Corner& corner, double clearance) const {
    const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double area2 = glm::dot(across, across), least = 1.001 * clearance * clearance;
    bool clear = true;
    for (int k = 0; k < 3; ++k) {
      const glm::dvec3 edge = p[(k + 2) % 3] - p[(k + 1) % 3];
      const double weight = static_cast<double>(corner.weight[k]);
      clear = clear && weight > 0 && weight * weight * area2 > least * glm::dot(edge, edge);
    }
    return clear;
  }
  /// Of the front face; `otherwise` where the triangle has no area.
  glm::vec3 normal(float orientation, const glm::vec3& otherwise) const {
    const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double size = glm::length(across);
    return size > 0 ? orientation * glm::vec3(across / size) : otherwise;
  }
};

/// The surface as seen from the direction `view`; 0: as its front is. Where it shows its back, both of its
/// normals turn round.
Surface seenFrom(const RayScene& rays, const Hit& hit, const glm::vec3& view,
                 const std::optional<TextureFootprint>& footprint, bool& back) {
  const Draw& draw = rays.draws()[hit.draw];
  const scene::Primitive& primitive = *draw.primitive;
  const uint32_t* indices = &primitive.indices[3 * static_cast<size_t>(hit.triangle)];
  const Corner corner{{indices[0], indices[1], indices[2]}, {1.f - hit.u - hit.v, hit.u, hit.v}};
  const Triangle triangle(draw, corner);
  Surface surface;
  surface.position = triangle.at(hit.u, hit.v) + triangle.inward(corner, draw.rayOffset);
  surface.view = view;
  surface.rayOffset = draw.rayOffset;
  surface.draw = hit.draw;

  glm::vec3 geometricNormal = triangle.normal(draw.orientation, view);
  TextureLookup lookup{rays, !primitive.uvs.empty(), {}, footprint};
  if (lookup.hasUv) lookup.uv = corner.blend(primitive.uvs.data());
  glm::vec3 normal = shadingNormal(draw, corner, lookup, geometricNormal);
  back = glm::dot(geometricNormal, view) < 0.f;
  if (back) {
    geometricNormal = -geometricNormal;
    normal = -normal;
  }
  const glm::vec4 tangent = draw.tangents ? worldTangent(draw, corner) : glm::vec4(0);
  if (draw.heights && !back)
    surface.relief =
        reliefPlace(*draw.heights, lookup.uv, draw.normalToWorld * corner.blend(draw.normals), tangent);
  surface.values.normal = normal;
  surface.values.geometric_normal = geometricNormal;
  if (!primitive.colours.empty()) surface.vertexColour = corner.blend(primitive.colours.data());
  fillMaterial(rays, lookup, glm::vec3(tangent), surface);
  if (back && surface.specular()) surface.values.flags |= glsl::gbuffer_flag_back;
  return surface;
}

glm::vec3 boundaryReflection(const Surface& surface, const glm::vec3& towards, const glm::vec3& direction) {
  const glm::vec3& n = surface.values.normal;
  const float light = glm::dot(n, direction);
  if (!(light > 0.f)) return glm::vec3(0);
  glsl::SurfaceBrdf mirror = surface.brdf;
  mirror.diffuse = glm::vec3(0);
  return glsl::brdf(mirror, n, towards, direction) + surface.below->f(glm::dot(n, towards), light);
}

}  // namespace

Surface Surface::reflecting() const {
  Surface surface = *this;
  surface.brdf.diffuse = glm::vec3(0);
  surface.below.reset();
  return surface;
}

Surface Surface::entered() const {
  Surface surface = *this;
  surface.brdf = glsl::surface_brdf(glm::vec3(1), 0, 1, 0, glm::vec3(1), values.ior);
  surface.below->albedo = glm::vec3(1);
  surface.below->leaves = false;
  return surface;
}

glm::vec3 Surface::reflectance(const glm::vec3& direction) const {
  if (!(glm::dot(values.geometric_normal, direction) > 0.f)) return glm::vec3(0);
  return reflectanceFromBump(direction);
}

glm::vec3 Surface::reflectanceFromBump(const glm::vec3& direction) const {
  if (model)
    return glsl::model_response(*measured, *model, glsl::to_local(frame, view),
                                glsl::to_local(frame, direction));
  const float cosine = glm::dot(values.normal, direction);
  return cosine > 0.f ? cosine * f(view, direction) : glm::vec3(0);
}

glm::vec3 Surface::f(const glm::vec3& towards, const glm::vec3& direction) const {
  if (below) return boundaryReflection(*this, towards, direction);
  if (!model) return glsl::brdf(brdf, values.normal, towards, direction);
  const glm::vec3 local = glsl::to_local(frame, direction);
  if (!(local.z > 0.f)) return glm::vec3(0);
  return glsl::model_response(*measured, *model, glsl::to_local(frame, towards), local) / local.z;
}

glm::vec3 Surface::mirrored() const {
  if (!model || model->kind != glsl::model_coated) return glm::vec3(0);
  const float cosine = glm::dot(values.normal, view);
  if (!(cosine > 0.f) || !(glm::dot(values.geometric_normal, mirrorDirection()) > 0.f)) return glm::vec3(0);
  return glsl::coated_mirror(*model, cosine);
}

glm::vec3 Surface::sample(const glm::vec3& u) const {
  if (!model) return glsl::brdf_sample(brdf, values.normal, view, u);
  return glsl::from_local(frame, glsl::model_sample(*model, glsl::to_local(frame, view), u));
}

float Surface::pdf(const glm::vec3& direction) const {
  if (!model) return glsl::brdf_pdf(brdf, values.normal, view, direction);
  return glsl::model_pdf(*model, glsl::to_local(frame, view), glsl::to_local(frame, direction));
}

Surface surfaceAt(const RayScene& rays, const Hit& hit, const glsl::FrameBlock& frame,
                  const ViewPixel& pixel) {
  const Draw& draw = rays.draws()[hit.draw];
  const glm::vec3 direction = viewRay(frame, static_cast<float>(pixel.x), static_cast<float>(pixel.y));
  std::optional<TextureFootprint> footprint;
  if (!draw.primitive->uvs.empty()) footprint = textureFootprint(draw, hit.triangle, frame, pixel);
  bool back = false;
  Surface surface = seenFrom(rays, hit, -glm::normalize(direction), footprint, back);
  surface.depth = hit.depth;
  return surface;
}

std::optional<Surface> surfaceAlong(const RayScene& rays, const Hit& hit, const glm::vec3& direction) {
  bool back = false;
  const Surface surface = seenFrom(rays, hit, -direction, std::nullopt, back);
  if (back && !rays.draws()[hit.draw].material->doubleSided) return std::nullopt;
  return surface;
}

Surface frontAt(const RayScene& rays, const Hit& hit) {
  bool back = false;
  Surface surface = seenFrom(rays, hit, glm::vec3(0), std::nullopt, back);
  surface.view = surface.values.normal;
  return surface;
}

Surface surfaceAtBump(const RayScene& rays, const Surface& from, const glm::dvec2& place,
                      const glm::vec3& direction) {
  Surface surface = from;
  surface.view = -direction;
  surface.depth = 0;
  surface.relief.place = place;
  const TextureLookup lookup{rays, true, surface.relief.uv(), std::nullopt};
  surface.values.normal = mappedNormal(*rays.draws()[from.draw].material, lookup, surface.relief.frame.n,
                                       surface.relief.tangent());
  fillMaterial(rays, lookup, surface.relief.frame.t, surface);
  return surface;
}

Interface interfaceAt(const RayScene& rays, const Hit& hit, const glm::vec3& direction) {
  bool back = false;
  const Surface surface = seenFrom(rays, hit, -direction, std::nullopt, back);
  const glsl::GBufferSurface& values = surface.values;
  return {surface.position,   values.normal,   values.geometric_normal, back,
          values.base_colour, values.metallic, surface.rayOffset,       surface.draw};
}

}  // namespace limn::reference
