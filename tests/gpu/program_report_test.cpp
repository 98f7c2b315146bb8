// What a frame graph says about the programs of its passes, for those who take them elsewhere.
#include "core/frame/program_report.h"

#include <gmock/gmock.h>

#include "core/gpu/program_uniforms.h"
#include "tests/gpu/frame_graph_harness.h"

namespace limn::frame {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr gpu::EmbeddedSource kReported[] = {
    {"report.comp.glsl",
     "#include \"half.glsl\"\n"
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(r32f) writeonly uniform image2D target;\n"
     "uniform sampler2D source;\n"
     "uniform float weights[2];\n"
     "uniform uvec2 place;\n"
     "void main() {\n"
     "  float sum = half_of(weights[place.x % 2u] + weights[place.y % 2u]);\n"
     "  imageStore(target, ivec2(place), vec4(sum) + texelFetch(source, ivec2(0), 0));\n"
     "}\n"},
    {"half.glsl", "float half_of(float x) { return 0.5 * x; }\n"},
    {"idle.comp.glsl", "layout(local_size_x = 1) in;\nvoid main() {}\n"}};

class ProgramReportTest : public FrameGraphGpu {
 protected:
  void SetUp() override {
    FrameGraphGpu::SetUp();
    shaders().mount("techniques/report/", kReported);
  }
  void TearDown() override {
    linear_ = {};
    FrameGraphGpu::TearDown();
  }

  void declare(FrameGraph& graph) {
    const TextureHandle start = set(graph, "start", 1);
    linear_ = gpu::Sampler(device(), GL_LINEAR, GL_LINEAR, GL_REPEAT);
    PassBuilder pass = graph.addPass("use", "test");
    pass.read(start, Access::sampled, ShaderName("source").sampledWith(&linear_), "what is read");
    graph.output(pass.write(graph.createTexture("sum", kValueDesc), Access::imageStore, "target", "the sum"));
    const ProgramHandle run = pass.program(desc_);
    pass.execute([=](PassContext& context) {
      gpu::Program& bound = context.use(run);
      bound.set("weights[0]", 0.25f);
      bound.set("weights[1]", 3.0f);
      for (int i = 0; i < 2; ++i) context.dispatch(kSize, 9, 1, 8, 8);
    });
    prepare(graph);
  }

  gpu::ProgramDesc desc_{{"techniques/report/report.comp.glsl"}, {{"LIMN_VALUE", "1"}}};
  gpu::Sampler linear_;
};

TEST_F(ProgramReportTest, SaysWhatIsBoundToEachName) {
  FrameGraph graph;
  declare(graph);
  graph.execute();
  const std::vector<ProgramReport> programs = graph.programs();
  ASSERT_EQ(programs.size(), 2u);
  const ProgramReport& use = programs[1];
  const PassReport pass = graph.explain()[use.pass];
  EXPECT_EQ(pass.name, "use");
  EXPECT_EQ(use.desc, desc_);
  ASSERT_EQ(use.names.size(), 2u);
  const NameReport &source = use.names[0], &target = use.names[1];
  EXPECT_EQ(source.name, "source");
  EXPECT_EQ(name(source.kind), "sampler");
  ASSERT_TRUE(source.access && source.sampling);
  EXPECT_EQ(pass.accesses[*source.access].resource, "start");
  EXPECT_EQ(source.sampling->minFilter, GLenum{GL_LINEAR});
  EXPECT_EQ(source.sampling->wrap[0], GLenum{GL_REPEAT});
  EXPECT_EQ(target.name, "target");
  EXPECT_EQ(name(target.kind), "image");
  EXPECT_TRUE(pass.accesses[*target.access].write);
  EXPECT_EQ(target.bytes, kSize * kSize * 4);
  EXPECT_EQ(target.texture->desc().format, GLenum{GL_R32F});
}

TEST_F(ProgramReportTest, CountsTheDispatchesOfTheLastFrame) {
  FrameGraph graph;
  declare(graph);
  EXPECT_EQ(graph.programs()[1].dispatches, 0);
  graph.execute();
  graph.execute();
  EXPECT_EQ(graph.programs()[1].dispatches, 2);
  EXPECT_THAT(graph.programs()[1].groups, ElementsAre(2u, 2u, 1u));
}

TEST_F(ProgramReportTest, RowsOfWorkGroupsHoldFewMoreThanAreAskedFor) {
  struct Case {
    int64_t groups;
    GLuint length, rows;
  };
  for (const Case& wanted :
       {Case{1, 1, 1}, Case{32768, 32768, 1}, Case{32769, 16385, 2}, Case{65537, 21846, 3}}) {
    FrameGraph graph;
    PassBuilder pass = graph.addPass("rows");
    const ProgramHandle run = pass.program({{"techniques/report/idle.comp.glsl"}, {}});
    pass.sideEffect().execute([=](PassContext& context) {
      context.use(run);
      context.dispatchRows(wanted.groups);
    });
    prepare(graph);
    graph.execute();
    EXPECT_THAT(graph.programs()[0].groups, ElementsAre(wanted.length, wanted.rows, 1u)) << wanted.groups;
  }
}

TEST_F(ProgramReportTest, ReadsPlainUniforms) {
  FrameGraph graph;
  declare(graph);
  graph.execute();
  std::vector<std::string> lines;
  for (const gpu::UniformValue& uniform : gpu::uniformValues(*graph.programs()[1].program))
    lines.push_back(uniform.type + " " + uniform.name + " " + uniform.value);
  EXPECT_THAT(lines, ElementsAre("uvec2 place 0, 0", "float weights[0] 0.25", "float weights[1] 3"));
}

TEST_F(ProgramReportTest, NeedsAPreparedGraph) {
  FrameGraph graph;
  EXPECT_EQ(errorOf([&] { std::ignore = graph.programs(); }), "frame graph: programs() before prepare()");
}

TEST_F(ProgramReportTest, StandaloneTextCompilesByItself) {
  const std::string text = shaders().standalone(desc_, desc_.files[0]);
  EXPECT_TRUE(text.starts_with("#version 450 core\n#define LIMN_VALUE 1\n")) << text;
  EXPECT_THAT(text, HasSubstr("// ---- techniques/report/half.glsl\nfloat half_of(float x)"));
  EXPECT_THAT(text, HasSubstr("// ---- techniques/report/report.comp.glsl\nlayout("));
  EXPECT_THAT(text, Not(HasSubstr("#line")));
  EXPECT_THAT(text, Not(HasSubstr("#include")));
  const gl::Functions& gl = device().gl();
  const char* source = text.c_str();
  const GLuint program = gl.CreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source);
  GLint linked = 0;
  gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
  gl.DeleteProgram(program);
  EXPECT_EQ(linked, GL_TRUE);
}

}  // namespace
}  // namespace limn::frame
