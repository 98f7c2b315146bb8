// A plug-in that fails in every way in which the code of others can fail.
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <thread>

#include "core/technique/technique.h"

namespace {

enum class Way { none, crash, crash_in_pass, foreign, number, memory, hang, once_there };
constexpr const char* kWays[] = {"none",   "crash",  "crash_in_pass", "foreign",
                                 "number", "memory", "hang",          "once_there"};

constexpr limn::Parameter kParameters[] = {
    limn::choice("way", 0, kWays,
                 "How it fails; once_there: it crashes when the file LIMN_TEST_TRIGGER has a content"),
};

void misbehave(Way way) {
  std::error_code ignored;
  switch (way) {
    case Way::none:
    case Way::crash_in_pass:
      return;
    case Way::crash:
      std::abort();
    case Way::foreign:
      throw std::runtime_error("no error\nof limn's own");
    case Way::number:
      throw 42;
    case Way::memory:
      throw std::bad_alloc();
    case Way::hang:
      for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
    case Way::once_there:
      if (const char* file = std::getenv("LIMN_TEST_TRIGGER"))
        if (std::filesystem::exists(file, ignored) && std::filesystem::file_size(file, ignored) > 0)
          std::abort();
  }
}

class Misbehaver : public limn::Technique {
  limn::frame::TextureHandle addPasses(limn::frame::FrameGraph& graph, const limn::TechniqueInputs& inputs,
                                       const limn::TermRequest& request) override {
    const auto way = static_cast<Way>(inputs.parameters.choice("way"));
    misbehave(way);
    limn::frame::PassBuilder pass = graph.addPass("clear", "misbehaver");
    const auto target = pass.write(request.target, limn::frame::Access::copyTarget, "black");
    pass.execute([target, way](limn::frame::PassContext& context) {
      misbehave(way == Way::crash_in_pass ? Way::crash : way);
      context.gl().ClearTexImage(context.texture(target).id(), 0, GL_RED, GL_FLOAT, nullptr);
    });
    return target;
  }
};

constexpr limn::TechniqueInfo kInfo{.name = "misbehaver",
                                    .title = "Misbehaviour",
                                    .source = "a test",
                                    .terms = limn::termSet(limn::Term::visibility),
                                    .parameters = kParameters,
                                    .stress = {}};

}  // namespace

extern "C" __attribute__((visibility("default"))) const limn::TechniquePlugin* limnTechniquePlugin() {
  static const limn::TechniquePlugin plugin{
      limn::handshake(limn::interfaceHash()), &kInfo,
      [] { return std::span<const limn::gpu::EmbeddedSource>(); },
      []() -> std::unique_ptr<limn::Technique> { return std::make_unique<Misbehaver>(); }};
  return &plugin;
}
