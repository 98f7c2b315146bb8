// What C++ and GLSL share: every header of glsl/ compiles as GLSL, and every block means the same bytes to
// both.
#include <gmock/gmock.h>

#include <cstddef>
#include <cstring>

#include "core/base/error.h"
#include "glsl/caustics/caustic_ray.glsl"
#include "glsl/indirect/direction_bins.glsl"
#include "glsl/indirect/virtual_area_light.glsl"
#include "glsl/materials/material_model.glsl"
#include "glsl/media/smoke.glsl"
#include "glsl/relief/relief_field.glsl"
#include "glsl/scene/blocks.glsl"
#include "glsl/shadow/fourier_shadow.glsl"
#include "glsl/shadow/shadow_view.glsl"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"

namespace limn {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

class SharedGlslTest : public GlTest {
 protected:
  struct Member {
    const char* name;
    size_t offset;
  };

  /// Whether the header, or one that it includes, says `what`.
  static bool brings(const gpu::EmbeddedSource& header, const std::string& what) {
    const std::string text = header.text;
    if (text.find(what) != std::string::npos) return true;
    for (const gpu::EmbeddedSource& other : embeddedSources()) {  // a comment may show its own inclusion
      const std::string include = std::string("#include \"") + other.path + "\"";
      if (std::string_view(other.path) != header.path && text.find(include) != std::string::npos &&
          brings(other, what))
        return true;
    }
    return false;
  }

  gpu::Program& mounted(const std::string& body, const std::string& header = "glsl/scene/blocks.glsl") {
    text_ = "#include \"" + header + "\"\nlayout(local_size_x = 1) in;\n" + body;
    const gpu::EmbeddedSource source[] = {{"main.comp.glsl", text_.c_str()}};
    shaders().mount("test/", source);
    return shaders().program({{"test/main.comp.glsl"}, {}});
  }

  GLint property(const gpu::Program& program, GLenum interface, const std::string& name, GLenum what) {
    const GLuint index = gl().GetProgramResourceIndex(program.id(), interface, name.c_str());
    if (index == GL_INVALID_INDEX) {
      ADD_FAILURE() << "GLSL has no " << name;
      return -1;
    }
    GLint value = -1;
    gl().GetProgramResourceiv(program.id(), interface, index, 1, &what, 1, nullptr, &value);
    return value;
  }

  /// Compares an std430 array of `type` with the C++ struct.
  void expectElement(const std::string& type, const std::string& firstMember, size_t size,
                     std::initializer_list<Member> members,
                     const std::string& header = "glsl/scene/blocks.glsl") {
    SCOPED_TRACE(type);
    const gpu::Program& program =
        mounted("layout(std430) buffer Elements { " + type +
                    " elements[]; };\nlayout(std430) buffer Result { vec4 result; };\n" +
                    "void main() { result = vec4(elements[1]." + firstMember + "); }\n",
                header);
    EXPECT_EQ(size_t(property(program, GL_BUFFER_VARIABLE,
                              "elements[0]." + firstMember.substr(0, firstMember.find('[')),
                              GL_TOP_LEVEL_ARRAY_STRIDE)),
              size);
    for (const Member& member : members) {
      EXPECT_EQ(
          size_t(property(program, GL_BUFFER_VARIABLE, std::string("elements[0].") + member.name, GL_OFFSET)),
          member.offset)
          << member.name;
    }
  }

 private:
  std::string text_;
};

#define LIMN_MEMBER(TYPE, NAME) \
  { #NAME, offsetof(glsl::TYPE, NAME) }

TEST_F(SharedGlslTest, everyHeaderCompilesAlone) {
  for (const gpu::EmbeddedSource& source : embeddedSources()) {
    const std::string path = source.path;
    const bool stage = path.ends_with(".comp.glsl") || path.ends_with(".vert.glsl") ||
                       path.ends_with(".frag.glsl") || path.ends_with(".geom.glsl");
    if (stage) continue;
    SCOPED_TRACE(path);
    const bool vertex = brings(source, "gl_Position");
    const bool fragment = brings(source, "gl_FragCoord") || brings(source, "gl_PrimitiveID");
    const bool compute = !vertex && !fragment;
    const std::string text =
        "#include \"" + path + "\"\n" +
        (!compute || brings(source, "local_size_x") ? "" : "layout(local_size_x = 1) in;\n") +
        (brings(source, "void main()") ? "" : "void main() {}\n");
    const gpu::EmbeddedSource user[] = {
        {"main.vert.glsl", vertex ? text.c_str() : "void main() { gl_Position = vec4(0); }\n"},
        {"main.frag.glsl", fragment ? text.c_str() : "void main() {}\n"},
        {"main.comp.glsl", text.c_str()}};
    gpu::ShaderLibrary library(device());
    library.mount("", embeddedSources());
    library.mount("test/", user);
    try {
      if (compute)
        library.program({{"test/main.comp.glsl"}, {}});
      else
        library.program({{"test/main.vert.glsl", "test/main.frag.glsl"}, {}});
    } catch (const Error& error) {
      // A header of a permutation lacks its macro, whose name is in capitals, a main program its function;
      // anything else is broken.
      EXPECT_THAT(
          error.what(),
          AnyOf(HasSubstr("is tested but not defined"), HasSubstr("light_visibility"),
                HasSubstr("kernel_blockers"), HasSubstr("scattered_at"),
                HasSubstr("group_scan.glsl:7: syntax error"),  // SUM_TYPE is a type
                HasSubstr("no function with name 'ray_kind'"), HasSubstr("undefined variable \"ray_kind\""),
                HasSubstr("has no matching output"),  // of the vertex shader it is used with
                ::testing::ContainsRegex("main.[a-z]+.glsl:[0-9]+: `[A-Z][A-Z0-9_]+' undeclared"),
                ::testing::ContainsRegex("undefined variable \"[A-Z][A-Z0-9_]+\"")));
    }
  }
}

TEST_F(SharedGlslTest, materialModelsHaveOneLayout) {
  using glsl::MaterialModel;
  expectElement(
      "MaterialModel", "exponent", sizeof(MaterialModel),
      {LIMN_MEMBER(MaterialModel, eta), LIMN_MEMBER(MaterialModel, kind), LIMN_MEMBER(MaterialModel, k),
       LIMN_MEMBER(MaterialModel, exponent), LIMN_MEMBER(MaterialModel, kd),
       LIMN_MEMBER(MaterialModel, options), LIMN_MEMBER(MaterialModel, ks),
       LIMN_MEMBER(MaterialModel, material), LIMN_MEMBER(MaterialModel, roughness)},
      "glsl/materials/material_model.glsl");
}

TEST_F(SharedGlslTest, frameBlockHasOneLayout) {
  gpu::Program& program = mounted(
      "layout(std430) buffer Result { vec4 result; };\nvoid main() { result = "
      "frame.camera_position; }\n");
  EXPECT_EQ(size_t(property(program, GL_UNIFORM_BLOCK, "FrameBlock", GL_BUFFER_DATA_SIZE)),
            sizeof(glsl::FrameBlock));
  const Member members[] = {
      LIMN_MEMBER(FrameBlock, world_to_clip),
      LIMN_MEMBER(FrameBlock, world_to_view),
      LIMN_MEMBER(FrameBlock, camera_position),
      LIMN_MEMBER(FrameBlock, view_ray_origin),
      LIMN_MEMBER(FrameBlock, view_ray_dx),
      LIMN_MEMBER(FrameBlock, view_ray_dy),
      LIMN_MEMBER(FrameBlock, environment_rotation),
      LIMN_MEMBER(FrameBlock, environment_scale),
      LIMN_MEMBER(FrameBlock, frame_size),
      LIMN_MEMBER(FrameBlock, scene_radius),
      LIMN_MEMBER(FrameBlock, frame_index),
      LIMN_MEMBER(FrameBlock, medium_extinction),
      LIMN_MEMBER(FrameBlock, medium_asymmetry),
      LIMN_MEMBER(FrameBlock, medium_scattering),
      LIMN_MEMBER(FrameBlock, medium_to_box),
      {"medium_ball.centre", offsetof(glsl::FrameBlock, medium_ball)},
      {"medium_ball.radius", offsetof(glsl::FrameBlock, medium_ball) + offsetof(glsl::Ball, radius)},
  };
  for (const Member& member : members) {
    EXPECT_EQ(size_t(property(program, GL_UNIFORM, std::string("FrameBlock.") + member.name, GL_OFFSET)),
              member.offset)
        << member.name;
  }
}

TEST_F(SharedGlslTest, lightsHaveOneLayout) {
  expectElement(
      "Light", "position[0]", sizeof(glsl::Light),
      {LIMN_MEMBER(Light, position), LIMN_MEMBER(Light, direction), LIMN_MEMBER(Light, texture_number),
       LIMN_MEMBER(Light, axis_u), LIMN_MEMBER(Light, length_u), LIMN_MEMBER(Light, axis_v),
       LIMN_MEMBER(Light, length_v), LIMN_MEMBER(Light, emission), LIMN_MEMBER(Light, solid_angle),
       LIMN_MEMBER(Light, cos_inner), LIMN_MEMBER(Light, cos_outer), LIMN_MEMBER(Light, range),
       LIMN_MEMBER(Light, angular_diameter), LIMN_MEMBER(Light, type), LIMN_MEMBER(Light, flags),
       LIMN_MEMBER(Light, own_instance), LIMN_MEMBER(Light, index)});
}

TEST_F(SharedGlslTest, instancesHaveOneLayout) {
  expectElement("Instance", "object_to_world[0]", sizeof(glsl::Instance),
                {LIMN_MEMBER(Instance, object_to_world), LIMN_MEMBER(Instance, normal_to_world),
                 LIMN_MEMBER(Instance, material), LIMN_MEMBER(Instance, first_vertex),
                 LIMN_MEMBER(Instance, flags), LIMN_MEMBER(Instance, first_index)});
}

TEST_F(SharedGlslTest, materialsHaveOneLayout) {
  expectElement(
      "Material", "base_colour[0]", sizeof(glsl::Material),
      {LIMN_MEMBER(Material, base_colour), LIMN_MEMBER(Material, emission),
       LIMN_MEMBER(Material, alpha_cutoff), LIMN_MEMBER(Material, metallic), LIMN_MEMBER(Material, roughness),
       LIMN_MEMBER(Material, normal_scale), LIMN_MEMBER(Material, ior),
       LIMN_MEMBER(Material, specular_colour), LIMN_MEMBER(Material, specular_factor),
       LIMN_MEMBER(Material, transmission), LIMN_MEMBER(Material, thickness),
       LIMN_MEMBER(Material, attenuation_distance), LIMN_MEMBER(Material, attenuation),
       LIMN_MEMBER(Material, height), LIMN_MEMBER(Material, flags), LIMN_MEMBER(Material, height_size)});
}

TEST_F(SharedGlslTest, reliefFieldsHaveOneLayout) {
  expectElement("ReliefField", "first", sizeof(glsl::ReliefField),
                {LIMN_MEMBER(ReliefField, first), LIMN_MEMBER(ReliefField, clamped),
                 LIMN_MEMBER(ReliefField, size), LIMN_MEMBER(ReliefField, spacing),
                 LIMN_MEMBER(ReliefField, highest), LIMN_MEMBER(ReliefField, levels)},
                "glsl/relief/relief_field.glsl");
}

TEST_F(SharedGlslTest, shadowViewsHaveOneLayout) {
  expectElement(
      "ShadowView", "origin[0]", sizeof(glsl::ShadowView),
      {LIMN_MEMBER(ShadowView, origin), LIMN_MEMBER(ShadowView, near), LIMN_MEMBER(ShadowView, axis_x),
       LIMN_MEMBER(ShadowView, scale), LIMN_MEMBER(ShadowView, axis_y), LIMN_MEMBER(ShadowView, footprint),
       LIMN_MEMBER(ShadowView, axis_z), LIMN_MEMBER(ShadowView, far), LIMN_MEMBER(ShadowView, middle),
       LIMN_MEMBER(ShadowView, projection), LIMN_MEMBER(ShadowView, layer), LIMN_MEMBER(ShadowView, size),
       LIMN_MEMBER(ShadowView, light)},
      "glsl/shadow/shadow_view.glsl");
}

TEST_F(SharedGlslTest, shadowLightsHaveOneLayout) {
  expectElement("ShadowLight", "origin[0]", sizeof(glsl::ShadowLight),
                {LIMN_MEMBER(ShadowLight, origin), LIMN_MEMBER(ShadowLight, finite),
                 LIMN_MEMBER(ShadowLight, first_layer), LIMN_MEMBER(ShadowLight, faces),
                 LIMN_MEMBER(ShadowLight, light)},
                "glsl/shadow/shadow_view.glsl");
}

TEST_F(SharedGlslTest, fourierRangesHaveOneLayout) {
  expectElement("FourierRange", "zero", sizeof(glsl::FourierRange),
                {LIMN_MEMBER(FourierRange, zero), LIMN_MEMBER(FourierRange, change_u),
                 LIMN_MEMBER(FourierRange, change_v), LIMN_MEMBER(FourierRange, scale)},
                "glsl/shadow/fourier_shadow.glsl");
}

TEST_F(SharedGlslTest, virtualPointLightsHaveOneLayout) {
  expectElement("VirtualPointLight", "position[0]", sizeof(glsl::VirtualPointLight),
                {LIMN_MEMBER(VirtualPointLight, position), LIMN_MEMBER(VirtualPointLight, cluster),
                 LIMN_MEMBER(VirtualPointLight, normal), LIMN_MEMBER(VirtualPointLight, area),
                 LIMN_MEMBER(VirtualPointLight, flux)},
                "glsl/indirect/virtual_light.glsl");
}

TEST_F(SharedGlslTest, virtualAreaLightsHaveOneLayout) {
  expectElement("VirtualAreaLight", "position[0]", sizeof(glsl::VirtualAreaLight),
                {LIMN_MEMBER(VirtualAreaLight, position), LIMN_MEMBER(VirtualAreaLight, count),
                 LIMN_MEMBER(VirtualAreaLight, normal), LIMN_MEMBER(VirtualAreaLight, extent)},
                "glsl/indirect/virtual_area_light.glsl");
}

TEST_F(SharedGlslTest, causticRaysHaveOneLayout) {
  expectElement("CausticRay", "start[0]", sizeof(glsl::CausticRay),
                {LIMN_MEMBER(CausticRay, start), LIMN_MEMBER(CausticRay, segment_length),
                 LIMN_MEMBER(CausticRay, direction), LIMN_MEMBER(CausticRay, kind),
                 LIMN_MEMBER(CausticRay, power), LIMN_MEMBER(CausticRay, normal)},
                "glsl/caustics/caustic_ray.glsl");
}

TEST_F(SharedGlslTest, causticLayersHaveOneLayout) {
  expectElement("CausticLayer", "light", sizeof(glsl::CausticLayer),
                {LIMN_MEMBER(CausticLayer, light), LIMN_MEMBER(CausticLayer, diameter),
                 LIMN_MEMBER(CausticLayer, first), LIMN_MEMBER(CausticLayer, faces)},
                "glsl/caustics/caustic_ray.glsl");
}

TEST_F(SharedGlslTest, elementGroupsHaveOneLayout) {
  expectElement(
      "ElementGroup", "x[0]", sizeof(glsl::ElementGroup),
      {LIMN_MEMBER(ElementGroup, x), LIMN_MEMBER(ElementGroup, y), LIMN_MEMBER(ElementGroup, z),
       LIMN_MEMBER(ElementGroup, nx), LIMN_MEMBER(ElementGroup, ny), LIMN_MEMBER(ElementGroup, nz),
       LIMN_MEMBER(ElementGroup, area), LIMN_MEMBER(ElementGroup, radius), LIMN_MEMBER(ElementGroup, spread),
       LIMN_MEMBER(ElementGroup, disc), LIMN_MEMBER(ElementGroup, children), LIMN_MEMBER(ElementGroup, lanes),
       LIMN_MEMBER(ElementGroup, backs), LIMN_MEMBER(ElementGroup, object)},
      "glsl/indirect/direction_bins.glsl");
}

TEST_F(SharedGlslTest, smokeBlockHasOneLayout) {
  const gpu::Program& program =
      mounted("layout(std430) buffer Result { vec3 result; };\nvoid main() { result = smoke.low; }\n",
              "glsl/media/smoke.glsl");
  EXPECT_EQ(size_t(property(program, GL_UNIFORM_BLOCK, "SmokeBlock", GL_BUFFER_DATA_SIZE)),
            sizeof(glsl::SmokeBlock));
  const Member members[] = {LIMN_MEMBER(SmokeBlock, low),    LIMN_MEMBER(SmokeBlock, risen),
                            LIMN_MEMBER(SmokeBlock, high),   LIMN_MEMBER(SmokeBlock, whirl),
                            LIMN_MEMBER(SmokeBlock, voxels), LIMN_MEMBER(SmokeBlock, seed)};
  for (const Member& member : members) {
    EXPECT_EQ(size_t(property(program, GL_UNIFORM, std::string("SmokeBlock.") + member.name, GL_OFFSET)),
              member.offset)
        << member.name;
  }
}

// A block filled in C++, read in GLSL and written back word by word.
TEST_F(SharedGlslTest, uniformBlocksRoundTrip) {
  glsl::FrameBlock block;
  const float base = 0.5f;
  auto* words = reinterpret_cast<float*>(&block);
  constexpr size_t floats = sizeof(glsl::FrameBlock) / sizeof(float);
  for (size_t i = 0; i < floats; ++i) words[i] = base + static_cast<float>(i);
  block.frame_size = {640, 480};
  block.frame_index = 4000000000u;

  gpu::Program& program = mounted(
      "layout(std430) buffer Result {\n"
      "  mat4 a; mat4 b; vec4 c; vec4 d; vec4 e; vec4 f; vec2 g; uvec2 h; float i; uint j; uvec2 k;\n"
      "  vec4 l; vec4 m; vec4 n; mat4 o;\n};\n"
      "void main() {\n"
      "  a = frame.world_to_clip; b = frame.world_to_view; c = frame.camera_position;\n"
      "  d = frame.view_ray_origin; e = frame.view_ray_dx; f = frame.view_ray_dy;\n"
      "  g = vec2(frame.environment_rotation, frame.environment_scale); h = frame.frame_size;\n"
      "  i = frame.scene_radius; j = frame.frame_index; k = frame.unused_0;\n"
      "  l = vec4(frame.medium_extinction, frame.medium_asymmetry);\n"
      "  m = vec4(frame.medium_scattering, frame.unused_1);\n"
      "  n = vec4(frame.medium_ball.centre, frame.medium_ball.radius); o = frame.medium_to_box;\n}\n");
  const gpu::Buffer uniforms(device(), "frame", sizeof block, gpu::BufferUse::fixed, &block);
  const gpu::Buffer result(device(), "result", sizeof block);
  test::bindByName(gl(), program, "FrameBlock", uniforms);
  test::bindByName(gl(), program, "Result", result);
  program.use();
  gl().DispatchCompute(1, 1, 1);
  glsl::FrameBlock readBack;
  result.read(0, &readBack, sizeof readBack);
  EXPECT_EQ(std::memcmp(&readBack, &block, sizeof block), 0);
}

}  // namespace
}  // namespace limn
