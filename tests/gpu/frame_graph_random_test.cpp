// Random graphs of small compute passes, run for several frames with random changes of their imports, against
// the values that the declarations mean. A wrong order, a shared memory too many or a result kept too long
// shows as a wrong number.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <random>

#include "core/base/error.h"
#include "core/frame/frame_graph.h"
#include "tests/gpu/gl_test.h"

namespace limn::frame {
namespace {

constexpr int kRandomSide = 8;
const gpu::TextureDesc kDesc{.format = GL_R32F, .width = kRandomSide, .height = kRandomSide};

constexpr gpu::EmbeddedSource kRandomSources[] = {
    {"sum.comp.glsl",
     "layout(local_size_x = 8, local_size_y = 8) in;\n"
     "layout(r32f) uniform image2D target;\n"
     "uniform sampler2D a;\n"
     "uniform sampler2D b;\n"
     "uniform vec4 weight;\n"  // of a, b, the old contents, 1
     "void main() {\n"
     "  ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n"
     "  float sum = weight.w;\n"
     "#if SOURCES > 0\n"
     "  if (weight.x != 0.0) sum += weight.x * texelFetch(a, p, 0).r;\n"
     "#endif\n#if SOURCES > 1\n"
     "  if (weight.y != 0.0) sum += weight.y * texelFetch(b, p, 0).r;\n"
     "#endif\n"
     "  if (weight.z != 0.0) sum += weight.z * imageLoad(target, p).r;\n"
     "  imageStore(target, p, vec4(sum));\n"
     "}\n"},
};

using Key = std::pair<uint32_t, uint32_t>;  // resource, version
Key keyOf(TextureHandle handle) {
  return {handle.resource, handle.version};
}

/// One pass: target = a + b + old + constant, those that are declared.
struct Step {
  std::string name;
  std::vector<TextureHandle> sources;
  TextureHandle before, after;
  bool keepsOld = false;
  float constant = 0;
};

class FrameGraphRandom : public GlTest {
 protected:
  static constexpr int imports = 2;

  struct Scene {
    std::vector<gpu::Texture> textures;
    std::vector<float> values;  ///< what the imported textures hold
    std::vector<TextureHandle> handles;
    FrameGraph graph;
    std::vector<Step> steps;
    std::vector<TextureHandle> outputs;
  };

  void declare(Scene& scene, std::mt19937& engine) {
    const auto pick = [&](size_t n) { return engine() % n; };
    std::vector<TextureHandle> live;  // every version made so far
    for (int i = 0; i < imports; ++i) {
      scene.textures.emplace_back(device(), "import", kDesc);
      scene.values.push_back(static_cast<float>(i + 1));
    }
    for (int i = 0; i < imports; ++i) {
      const float value[4] = {scene.values[static_cast<size_t>(i)]};
      scene.textures[static_cast<size_t>(i)].clear(value);
      scene.handles.push_back(scene.graph.importTexture("import", scene.textures[static_cast<size_t>(i)]));
      live.push_back(scene.handles.back());
    }
    std::map<Key, bool> overwritten;
    const size_t passes = 3 + pick(10);
    const bool caching = pick(2) == 0;
    // Mostly what was made recently, so that lifetimes end.
    const auto recent = [&] { return live[live.size() - 1 - pick(pick(4) == 0 ? live.size() : size_t{2})]; };
    for (size_t p = 0; p < passes; ++p) {
      Step step;
      PassBuilder pass = scene.graph.addPass("step");
      if (caching && pick(4) != 0) pass.cacheable();
      for (size_t i = pick(3); i > 0; --i) {
        step.sources.push_back(recent());
        pass.read(step.sources.back(), Access::sampled, step.sources.size() == 1 ? "a" : "b", "");
      }
      step.before = pick(3) == 0 ? live[pick(live.size())] : scene.graph.createTexture("t", kDesc);
      if (overwritten[keyOf(step.before)]) step.before = scene.graph.createTexture("t", kDesc);
      for (const TextureHandle& source :
           step.sources)  // sampling what the pass stores to is no case of its own
        if (source.resource == step.before.resource) step.before = scene.graph.createTexture("t", kDesc);
      overwritten[keyOf(step.before)] = true;
      const bool defined = step.before.version > 0 || step.before.resource < imports;
      step.keepsOld = defined && pick(2) == 0;
      step.constant = static_cast<float>(p + 1);
      step.after =
          pass.write(step.before, step.keepsOld ? Access::imageLoadStore : Access::imageStore, "target", "");
      live.push_back(step.after);
      const ProgramHandle program = pass.program(
          {{"techniques/test/sum.comp.glsl"}, {{"SOURCES", std::to_string(step.sources.size())}}});
      pass.execute([step, program](PassContext& context) { run(context, program, step); });
      scene.steps.push_back(step);
    }
    scene.outputs = {scene.steps.back().after, scene.steps[pick(scene.steps.size())].after};
    for (const TextureHandle& output : scene.outputs) scene.graph.output(output);
    for (size_t i = 0; i < scene.steps.size(); ++i)
      scene.steps[i].name = i == 0 ? "step" : "step " + std::to_string(i + 1);
  }

  static void run(PassContext& context, ProgramHandle program, const Step& step) {
    float weight[4] = {0, 0, step.keepsOld ? 1.0f : 0.0f, step.constant};
    for (size_t i = 0; i < step.sources.size(); ++i) weight[i] = 1;
    context.use(program).set4("weight", weight);
    context.dispatch(kRandomSide, kRandomSide, 1, 8, 8);
  }

  /// What a version holds in this frame.
  static float meaning(const Scene& scene, TextureHandle version) {
    for (const Step& step : scene.steps) {
      if (step.after != version) continue;
      float sum = step.constant + (step.keepsOld ? meaning(scene, step.before) : 0.0f);
      for (const TextureHandle& source : step.sources) sum += meaning(scene, source);
      return sum;
    }
    return scene.values[version.resource];
  }

  /// What the imported textures hold after the frame: their last version that is made.
  static std::vector<float> importsAfter(const Scene& scene) {
    std::vector<float> values = scene.values;
    const std::vector<PassReport> rows = scene.graph.explain();
    for (uint32_t i = 0; i < imports; ++i) {
      uint32_t latest = 0;
      for (const Step& step : scene.steps) {
        const bool kept = std::any_of(rows.begin(), rows.end(), [&](const PassReport& row) {
          return row.name == step.name && row.state != PassState::leftOut;
        });
        if (kept && step.after.resource == i && step.after.version > latest) {
          latest = step.after.version;
          values[i] = meaning(scene, step.after);
        }
      }
    }
    return values;
  }

  static float texel(const gpu::Texture& texture) {
    std::vector<float> values(kRandomSide * kRandomSide);
    texture.read(0, GL_RED, GL_FLOAT, values.data(), values.size() * sizeof(float));
    EXPECT_THAT(values, ::testing::Each(values.front()));
    return values.front();
  }
};

TEST_F(FrameGraphRandom, framesHoldWhatTheirDeclarationsMean) {
  ResourcePool pool(device());
  shaders().mount("techniques/test/", kRandomSources);
  int graphs = 0, cached = 0, shared = 0, cancelled = 0;
  for (unsigned seed = 0; seed < 120; ++seed) {
    std::mt19937 engine(seed);
    Scene scene;
    declare(scene, engine);
    try {
      scene.graph.prepare(device(), shaders(), pool);
    } catch (const Error&) {
      continue;  // some have no order, or overwrite an output
    }
    ++graphs;
    shared += scene.graph.transientBytes() < scene.graph.transientBytesUnaliased();
    const auto changeImports = [&] {
      for (uint32_t i = 0; i < imports; ++i) {
        if (engine() % 3 != 0) continue;
        scene.values[i] = static_cast<float>(engine() % 100);
        const float value[4] = {scene.values[i]};
        scene.textures[i].clear(value);
        scene.graph.touch(scene.handles[i]);
      }
    };
    // What a frame adds to an import stays there when it is given up.
    const bool mayCancel = std::none_of(scene.steps.begin(), scene.steps.end(),
                                        [](const Step& step) { return step.after.resource < imports; });
    for (int frame = 0; frame < 6; ++frame) {
      changeImports();
      if (mayCancel && frame % 2 == 1) {
        size_t left = engine() % scene.steps.size();
        cancelled += !scene.graph.execute(Timing::off, [&] { return left-- == 0; });
        changeImports();
      }
      ASSERT_TRUE(scene.graph.execute());
      for (const PassReport& row : scene.graph.explain()) cached += row.state == PassState::cached;
      for (const TextureHandle& output : scene.outputs)
        ASSERT_EQ(texel(scene.graph.texture(output)), meaning(scene, output))
            << "seed " << seed << " frame " << frame;
      scene.values = importsAfter(scene);
      for (uint32_t i = 0; i < imports; ++i) {
        ASSERT_EQ(texel(scene.textures[i]), scene.values[i]) << "seed " << seed << " frame " << frame;
      }
      // Sums over history must stay exact in single precision.
      if (std::any_of(scene.values.begin(), scene.values.end(), [](float v) { return v > 1e5f; })) break;
    }
  }
  EXPECT_GT(graphs, 60);
  EXPECT_GT(cached, 100);
  EXPECT_GT(shared, 20);
  EXPECT_GT(cancelled, 20);
}

}  // namespace
}  // namespace limn::frame
