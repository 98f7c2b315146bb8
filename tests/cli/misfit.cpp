// A plug-in that is wrong in the way its file is named after. The tests copy it under these names.
#include <dlfcn.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include "core/technique/technique.h"

namespace {

const std::string& wrong() {
  static const std::string name = [] {
    Dl_info self{};
    return dladdr(reinterpret_cast<const void*>(&wrong), &self) ? std::filesystem::path(self.dli_fname).stem()
                                                                : "";
  }();
  return name;
}

class Misfit : public limn::Technique {
  limn::frame::TextureHandle addPasses(limn::frame::FrameGraph& graph, const limn::TechniqueInputs&,
                                       const limn::TermRequest& request) override {
    if (wrong() == "throws_42") throw 42;
    if (wrong() == "returns_nothing") return {};
    if (wrong() == "throws_exception") throw std::runtime_error("no\nluck");
    limn::frame::PassBuilder pass = graph.addPass("clear", "misfit");
    const auto target = pass.write(request.target, limn::frame::Access::copyTarget, "nothing");
    pass.execute([](limn::frame::PassContext&) {
      if (wrong() == "pass_throws_42") throw 42;
    });
    return target;
  }
  bool update(const limn::scene::Pose&) override {
    if (wrong() == "update_throws_42") throw 42;
    return false;
  }
};

/// Signals that a sanitizer would answer for the program.
void die(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// From now on dlclose() does not unload the module.
void stay() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<const void*>(&wrong), &self))
    dlopen(self.dli_fname, RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
}

/// What happens when the module is unloaded or the program ends.
const struct kLast {
  const std::string way = wrong();
  ~kLast() {
    if (way == "crashes_at_exit" || way == "stays_and_crashes_at_exit") die(SIGSEGV);
    if (way == "exits_at_exit") _exit(0);
  }
} last;

/// What happens before anybody calls the module.
const bool kLoaded = [] {
  if (wrong() == "aborts_in_load") die(SIGABRT);
  if (wrong() == "stays_and_crashes_at_exit") stay();
  return true;
}();

}  // namespace

extern "C" __attribute__((visibility("default"))) const limn::TechniquePlugin* limnTechniquePlugin() {
  static limn::Parameter parameters[] = {limn::real("size", 1, {0, 2}, "", "The size")};
  static limn::TechniqueInfo info{.name = wrong().c_str(),
                                  .title = "A misfit",
                                  .source = "a test",
                                  .terms = limn::termSet(limn::Term::visibility),
                                  .parameters = parameters,
                                  .stress = {}};
  static limn::TechniquePlugin plugin{limn::handshake(limn::interfaceHash()), &info,
                                      [] { return std::span<const limn::gpu::EmbeddedSource>(); },
                                      []() -> std::unique_ptr<limn::Technique> {
                                        if (wrong() == "makes_nothing") return nullptr;
                                        return std::make_unique<Misfit>();
                                      }};
  const std::string& name = wrong();
  if (name == "null_plugin") return nullptr;
  if (name == "null_info") plugin.info = nullptr;
  if (name == "null_name") info.name = nullptr;
  if (name == "null_title") info.title = nullptr;
  if (name == "null_create") plugin.create = nullptr;
  if (name == "wrong_name") info.name = "pcss";
  if (name == "no_terms") info.terms = 0;
  if (name == "answers_final") info.terms |= limn::termSet(limn::Term::final);
  if (name == "answers_unknown") info.terms |= 0x40000000;
  if (name == "null_parameter") parameters[0].name = nullptr;
  if (name == "null_unit") parameters[0].unit = nullptr;
  if (name == "nan_default") parameters[0].defaultValue = std::numeric_limits<double>::quiet_NaN();
  if (name == "no_choices") parameters[0].type = limn::ParameterType::choice;
  if (name == "other_interface") plugin.handshake.interfaceNumber = 99;
  if (name == "other_compiler") plugin.handshake.compiler[0] = 'x';
  if (name == "other_headers") plugin.handshake.headers[0] = 'x';
  if (name == "unterminated")  // the handshake's texts fill their arrays
    for (char* text : {plugin.handshake.compiler, plugin.handshake.headers, plugin.handshake.abi})
      std::fill_n(text, sizeof plugin.handshake.headers, 'x');
  if (name == "entry_throws") throw std::runtime_error("no licence");
  if (name == "entry_throws_42") throw 42;
  if (name == "entry_aborts") die(SIGABRT);
  if (name == "entry_crashes") die(SIGSEGV);
  if (name == "entry_exits") _exit(0);
  if (name == "entry_exits_113") _exit(113);
  if (name == "entry_hangs") pause();
  return &plugin;
}
