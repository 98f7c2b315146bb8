// What C++ and GLSL share: every header of glsl/ compiles as GLSL, and every block means the same bytes to
// both.
#include <gmock/gmock.h>

#include <cstddef>
#include <cstring>

#include "core/base/error.h"
#include "glsl/blocks.glsl"
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

  gpu::Program& mounted(const std::string& body) {
    text_ = "#include \"glsl/blocks.glsl\"\nlayout(local_size_x = 1) in;\n" + body;
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
                     std::initializer_list<Member> members) {
    SCOPED_TRACE(type);
    const gpu::Program& program =
        mounted("layout(std430, binding = 0) buffer Elements { " + type +
                " elements[]; };\nlayout(std430, binding = 1) buffer Result { vec4 result; };\n" +
                "void main() { result = vec4(elements[1]." + firstMember + "[0]); }\n");
    EXPECT_EQ(size_t(property(program, GL_BUFFER_VARIABLE, "elements[0]." + firstMember,
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
    const bool fragment = brings(source, "gl_FragCoord") || brings(source, "gl_PrimitiveID");
    const std::string text =
        "#include \"" + path + "\"\n" +
        (fragment || brings(source, "local_size_x") ? "" : "layout(local_size_x = 1) in;\n") +
        (brings(source, "void main()") ? "" : "void main() {}\n");
    const gpu::EmbeddedSource user[] = {{fragment ? "main.frag.glsl" : "main.comp.glsl", text.c_str()},
                                        {"main.vert.glsl", "void main() { gl_Position = vec4(0); }\n"}};
    gpu::ShaderLibrary library(device());
    library.mount("", embeddedSources());
    library.mount("test/", user);
    try {
      if (fragment)
        library.program({{"test/main.vert.glsl", "test/main.frag.glsl"}, {}});
      else
        library.program({{"test/main.comp.glsl"}, {}});
    } catch (const Error& error) {
      // A header of a permutation lacks its macro, whose name is in capitals, a main program its function;
      // anything else is broken.
      EXPECT_THAT(error.what(),
                  AnyOf(HasSubstr("is tested but not defined"), HasSubstr("light_visibility"),
                        HasSubstr("no function with name 'ray_kind'"),
                        HasSubstr("has no matching output"),  // of the vertex shader it is used with
                        ::testing::ContainsRegex("main.[a-z]+.glsl:[0-9]+: `[A-Z][A-Z0-9_]+' undeclared")));
    }
  }
}

TEST_F(SharedGlslTest, frameBlockHasOneLayout) {
  const gpu::Program& program = mounted(
      "layout(std430, binding = 1) buffer Result { vec4 result; };\nvoid main() { result = "
      "frame.camera_position; }\n");
  EXPECT_EQ(size_t(property(program, GL_UNIFORM_BLOCK, "FrameBlock", GL_BUFFER_DATA_SIZE)),
            sizeof(glsl::FrameBlock));
  EXPECT_EQ(unsigned(property(program, GL_UNIFORM_BLOCK, "FrameBlock", GL_BUFFER_BINDING)),
            glsl::FrameBlock::binding);
  const Member members[] = {
      LIMN_MEMBER(FrameBlock, world_to_clip),     LIMN_MEMBER(FrameBlock, clip_to_world),
      LIMN_MEMBER(FrameBlock, world_to_view),     LIMN_MEMBER(FrameBlock, camera_position),
      LIMN_MEMBER(FrameBlock, view_ray_origin),   LIMN_MEMBER(FrameBlock, view_ray_dx),
      LIMN_MEMBER(FrameBlock, view_ray_dy),       LIMN_MEMBER(FrameBlock, environment),
      LIMN_MEMBER(FrameBlock, frame_size),        LIMN_MEMBER(FrameBlock, medium_extinction),
      LIMN_MEMBER(FrameBlock, medium_scattering), LIMN_MEMBER(FrameBlock, medium_ball),
      LIMN_MEMBER(FrameBlock, medium_to_box),
  };
  for (const Member& member : members) {
    EXPECT_EQ(size_t(property(program, GL_UNIFORM, std::string("FrameBlock.") + member.name, GL_OFFSET)),
              member.offset)
        << member.name;
  }
}

TEST_F(SharedGlslTest, lightsHaveOneLayout) {
  expectElement("Light", "position", sizeof(glsl::Light),
                {LIMN_MEMBER(Light, position), LIMN_MEMBER(Light, direction), LIMN_MEMBER(Light, axis_u),
                 LIMN_MEMBER(Light, axis_v), LIMN_MEMBER(Light, emission), LIMN_MEMBER(Light, cone),
                 LIMN_MEMBER(Light, info)});
}

TEST_F(SharedGlslTest, instancesHaveOneLayout) {
  expectElement("Instance", "object_to_world", sizeof(glsl::Instance),
                {LIMN_MEMBER(Instance, object_to_world), LIMN_MEMBER(Instance, normal_to_world),
                 LIMN_MEMBER(Instance, info)});
}

TEST_F(SharedGlslTest, materialsHaveOneLayout) {
  expectElement(
      "Material", "base_colour", sizeof(glsl::Material),
      {LIMN_MEMBER(Material, base_colour), LIMN_MEMBER(Material, emission),
       LIMN_MEMBER(Material, metal_rough), LIMN_MEMBER(Material, specular),
       LIMN_MEMBER(Material, transmission), LIMN_MEMBER(Material, attenuation), LIMN_MEMBER(Material, info)});
}

// A block filled in C++, read in GLSL and written back word by word.
TEST_F(SharedGlslTest, uniformBlocksRoundTrip) {
  glsl::FrameBlock block;
  const float base = 0.5f;
  auto* words = reinterpret_cast<float*>(&block);
  constexpr size_t floats = sizeof(glsl::FrameBlock) / sizeof(float);
  for (size_t i = 0; i < floats; ++i) words[i] = base + static_cast<float>(i);
  block.frame_size = glm::uvec4(640, 480, 3, 4000000000u);

  const gpu::Program& program = mounted(
      "layout(std430, binding = 1) buffer Result {\n"
      "  mat4 a; mat4 b; mat4 c; vec4 d; vec4 e; vec4 f; vec4 g; vec4 h; uvec4 i;\n  vec4 j; vec4 k; vec4 "
      "l; mat4 m;\n};\n"
      "void main() {\n"
      "  a = frame.world_to_clip; b = frame.clip_to_world; c = frame.world_to_view; d = "
      "frame.camera_position;\n"
      "  e = frame.view_ray_origin; f = frame.view_ray_dx; g = frame.view_ray_dy; h = frame.environment;\n"
      "  i = frame.frame_size; j = frame.medium_extinction;\n"
      "  k = frame.medium_scattering; l = frame.medium_ball; m = frame.medium_to_box;\n}\n");
  const gpu::Buffer uniforms(device(), "frame", sizeof block, gpu::BufferUse::fixed, &block);
  const gpu::Buffer result(device(), "result", sizeof block);
  gl().BindBufferBase(GL_UNIFORM_BUFFER, glsl::FrameBlock::binding, uniforms.id());
  gl().BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, result.id());
  program.use();
  gl().DispatchCompute(1, 1, 1);
  glsl::FrameBlock readBack;
  result.read(0, &readBack, sizeof readBack);
  EXPECT_EQ(std::memcmp(&readBack, &block, sizeof block), 0);
}

}  // namespace
}  // namespace limn
