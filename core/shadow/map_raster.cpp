#include "core/shadow/private/map_raster.h"

#include <fmt/format.h>

#include <string>

namespace limn::shadow {
namespace {

using frame::Access;
using frame::TextureHandle;

constexpr GLfloat kNothing[4] = {1, 1, 1, 1}, kFarthest = 0;
constexpr GLuint kNobody[4] = {glsl::no_instance, 0, 0, 0};

TextureHandle createMaps(const MapRaster& raster, const ShadowMaps& maps, const char* name, GLenum format) {
  return raster.graph.createTexture(name, {.target = GL_TEXTURE_2D_ARRAY,
                                           .format = format,
                                           .width = maps.size,
                                           .height = maps.size,
                                           .layers = maps.layers});
}

bool layered(const gpu::Device& device) {
  return !device.software() && device.limits().layerFromVertexShader;
}

}  // namespace

void addDepthPass(const MapRaster& raster, ShadowMaps& maps) {
  frame::PassBuilder pass = raster.graph.addPass("shadow maps", "shadow");
  pass.role(frame::PassRole::map);
  const bool together = layered(raster.device);
  const scene::DrawPrograms programs =
      raster.scene.declareDepth(pass, raster.handles,
                                {.files = {"glsl/shadow/depth.vert.glsl", "glsl/shadow/depth.frag.glsl"},
                                 .defines = {{"LAYERED", together ? "1" : "0"}}});
  pass.read(maps.views, Access::storageLoad, "Views", "projections");
  maps.depth =
      pass.write(createMaps(raster, maps, "shadow maps", GL_R32F), Access::colourAttachment, "linear depth");
  const TextureHandle zbuffer = pass.write(createMaps(raster, maps, "shadow map z", GL_DEPTH_COMPONENT32F),
                                           Access::depthAttachment, "hidden-surface removal");
  if (raster.cacheable) pass.cacheable();
  pass.execute([raster, zbuffer, together, programs, depth = maps.depth](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    context.bindFramebuffer({{depth}}, {zbuffer});
    gl.ClearBufferfv(GL_COLOR, 0, kNothing);
    gl.ClearBufferfv(GL_DEPTH, 0, &kFarthest);
    raster.scene.drawDepth(context, programs, raster.views, raster.list, together,
                           [&](const scene::DepthView& view) {
                             context.bindFramebuffer({{depth, 0, view.layer}}, {zbuffer, 0, view.layer});
                           });
  });
}

void addReflectivePass(const MapRaster& raster, TextureHandle ltc, bool instances, ShadowMaps& maps) {
  frame::PassBuilder pass = raster.graph.addPass("reflective shadow maps", "shadow");
  pass.role(frame::PassRole::map);
  const bool together = layered(raster.device);
  const scene::SurfacePrograms programs = raster.scene.declareSurfaces(
      pass, raster.handles,
      {.files = {"glsl/shadow/reflective.vert.glsl", "glsl/shadow/reflective.frag.glsl"},
       .defines = {{"LAYERED", together ? "1" : "0"},
                   {"LAMBERTIAN", ltc ? "0" : "1"},
                   {"INSTANCES", instances ? "1" : "0"}}});
  pass.read(maps.views, Access::storageLoad, "Views", "projections");
  if (ltc) pass.read(ltc, Access::sampled, "ltc_table", "diffuse albedo below a specular layer");
  const auto write = [&](const char* name, GLenum format, const char* why) {
    return pass.write(createMaps(raster, maps, name, format), Access::colourAttachment, why);
  };
  maps.depth = write("reflective depth", GL_R32F, "linear depth");
  maps.normal = write("reflective normal", GL_RG16_SNORM, "normal of the triangle");
  const TextureHandle third = instances ? write("reflective instance", GL_R32UI, "draw instance")
                                        : write("reflective albedo", GL_RGB10_A2, "diffuse albedo");
  (instances ? maps.instance : maps.albedo) = third;
  const TextureHandle zbuffer = pass.write(createMaps(raster, maps, "reflective z", GL_DEPTH_COMPONENT32F),
                                           Access::depthAttachment, "hidden-surface removal");
  if (raster.cacheable) pass.cacheable();
  pass.execute([raster, zbuffer, together, programs, depth = maps.depth, normal = maps.normal, third,
                instances](frame::PassContext& context) {
    const gl::Functions& gl = context.gl();
    const auto bind = [&](int layer) {
      context.bindFramebuffer({{depth, 0, layer}, {normal, 0, layer}, {third, 0, layer}},
                              {zbuffer, 0, layer});
    };
    bind(-1);
    constexpr GLfloat black[4] = {0, 0, 0, 0};
    gl.ClearBufferfv(GL_COLOR, 0, kNothing);
    gl.ClearBufferfv(GL_COLOR, 1, black);
    if (instances)
      gl.ClearBufferuiv(GL_COLOR, 2, kNobody);
    else
      gl.ClearBufferfv(GL_COLOR, 2, black);
    gl.ClearBufferfv(GL_DEPTH, 0, &kFarthest);
    raster.scene.drawSurfaces(context, programs, raster.views, raster.list, together,
                              [&](const scene::DepthView& view) { bind(view.layer); });
  });
}

}  // namespace limn::shadow
