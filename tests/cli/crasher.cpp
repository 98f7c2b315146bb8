// A plug-in that brings the process down in the middle of a frame.
#include <csignal>

#include "core/technique/technique.h"

namespace {

constexpr limn::Parameter parameters[] = {
    limn::boolean("crash", true, "Whether it does so, or claims that every light is black"),
};

class Crasher : public limn::Technique {
  limn::frame::TextureHandle addPasses(limn::frame::FrameGraph& graph, const limn::TechniqueInputs& inputs,
                                       const limn::TermRequest& request) override {
    if (inputs.parameters.boolean("crash")) std::raise(SIGSEGV);
    limn::frame::PassBuilder pass = graph.addPass("clear", "crasher");
    const auto target = pass.write(request.target, limn::frame::Access::copyTarget, "black");
    pass.execute([target](limn::frame::PassContext& context) {
      context.gl().ClearTexImage(context.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
};

constexpr limn::TechniqueInfo info{.name = "crasher",
                                   .title = "Crash",
                                   .source = "a test",
                                   .terms = limn::termSet(limn::Term::visibility),
                                   .parameters = parameters,
                                   .stress = {}};

}  // namespace

extern "C" __attribute__((visibility("default"))) const limn::TechniquePlugin* limnTechniquePlugin() {
  static const limn::TechniquePlugin plugin{
      limn::handshake(limn::interfaceHash()), &info,
      [] { return std::span<const limn::gpu::EmbeddedSource>(); },
      []() -> std::unique_ptr<limn::Technique> { return std::make_unique<Crasher>(); }};
  return &plugin;
}
