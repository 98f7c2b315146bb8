// Plug-ins that are broken, foreign or dangerous: each is named in one line when it is asked for, and harms
// nobody else.
#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {
namespace fs = std::filesystem;

const fs::path kBuiltIn = fs::path(kBinaryDir) / "lib/limn/techniques";
const fs::path kMisfit = fs::path(kBinaryDir) / "tests/misfit/misfit.so";

/// What `limn list` and `limn render` must say of a module, besides its file.
struct Broken {
  std::string name, reason;
};

/// tests/cli/misfit.cpp under each of its names.
const std::vector<Broken>& misfits() {
  static const std::vector<Broken> all = {
      {"aborts_in_load", "it crashes when it is loaded (Aborted)"},
      {"crashes_at_exit", "it crashes when the program ends (Segmentation fault)"},
      {"answers_final", "it answers final, which is not for techniques to answer"},
      {"answers_unknown", "it answers the terms 0x40000001, which are none or not known"},
      {"entry_aborts", "it crashes when it is loaded (Aborted)"},
      {"entry_crashes", "it crashes when it is loaded (Segmentation fault)"},
      {"entry_exits", "it ends its process when it is loaded (exit status 0)"},
      {"entry_exits_113", "it ends its process when it is loaded (exit status 113)"},
      {"entry_hangs", "it does not come back within"},
      {"entry_throws", "its entry point failed: no licence"},
      {"entry_throws_42", "its entry point failed: it threw something that is no std::exception"},
      {"exits_at_exit", "it ends its process when the program ends (exit status 0)"},
      {"nan_default", "its parameter size has the default nan outside of 0..2"},
      {"no_choices", "its parameter size has no choices"},
      {"no_terms", "it answers the terms 0x0, which are none or not known"},
      {"null_create", "it gives no function for its shaders or none that makes it"},
      {"null_info", "it gives no TechniqueInfo"},
      {"null_name", "it gives no name"},
      {"null_parameter", "its parameter 0 has no name"},
      {"null_plugin", "its entry point gives no plug-in"},
      {"null_title", "it gives no title or source"},
      {"null_unit", "its parameter size has no unit or description"},
      {"other_compiler", "it was built with compiler x"},
      {"other_headers", "it was built from headers x"},
      {"other_interface", "it was built for interface 99, limn has interface"},
      {"stays_and_crashes_at_exit", "it crashes when the program ends (Segmentation fault)"},
      {"unterminated", "it was built from headers xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx, limn from headers"},
      {"wrong_name", "it calls itself pcss"},
  };
  return all;
}

void cutShort(const fs::path& whole, const fs::path& part, uintmax_t bytes) {
  fs::copy_file(whole, part);
  fs::resize_file(part, bytes);
}

/// Returns what a rendering said beside its progress, which it shows where it takes long.
std::string withoutProgress(const std::string& err) {
  std::istringstream lines(err);
  std::string rest;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("rendering: ")) rest += line + "\n";
  return rest;
}

class Plugins : public testing::Test {
 protected:
  Outcome list(const std::string& path) { return limn({"list", "--json"}, {{"LIMN_TECHNIQUE_PATH", path}}); }
  Outcome render(const std::string& technique, const std::string& path,
                 const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {
        "render", kCornellBox, "--technique", technique,
        "--size", "16x16",     "--out",       (folder_ / "picture.png").string()};
    command.insert(command.end(), more.begin(), more.end());
    Outcome outcome = limn(command, {{"LIMN_TECHNIQUE_PATH", path}});
    const std::string wrote = "wrote " + (folder_ / "picture.png").string() + "\n";
    if (const size_t at = outcome.err.find(wrote); at != std::string::npos)
      outcome.err.erase(at, wrote.size());  // what is left is about techniques
    return outcome;
  }
  /// The technique is refused when it is asked for, in one line that names its file and says why; the others
  /// are listed and render as if it was not there.
  void expectAllRefused(const std::vector<Broken>& broken) {
    const std::string path = folder_.path().string();
    const Outcome listed = list(path);
    ASSERT_EQ(listed.status, 0) << listed.err;
    EXPECT_EQ(listed.err, "");
    const auto answer = nlohmann::json::parse(listed.out);
    EXPECT_EQ(answer["techniques"].size(), techniques_);
    std::map<std::string, std::string> refused;
    for (const auto& refusal : answer["refused"]) refused[refusal["name"]] = refusal["reason"];
    EXPECT_EQ(refused.size(), broken.size());
    for (const auto& [name, reason] : broken) {
      const std::string file = (folder_ / (name + ".so")).string();
      EXPECT_THAT(refused[name], testing::AllOf(testing::HasSubstr(file), testing::HasSubstr(reason)))
          << name;
      if (name == "entry_hangs") continue;  // takes its time; nothing differs from the others
      expectRefused(render(name, path), 1, {"technique " + name + " was refused: ", file, reason});
    }
    const Outcome whole = render("pcss", path);
    EXPECT_EQ(whole.status, 0);
    EXPECT_EQ(withoutProgress(whole.err), "");
  }

  TemporaryFolder folder_;
  const size_t techniques_ = listing(kBuiltIn).size();
};

TEST_F(Plugins, AModuleThatMisbehavesIsRefusedAndHarmsNobodyElse) {
  for (const Broken& broken : misfits()) fs::copy_file(kMisfit, folder_ / (broken.name + ".so"));
  expectAllRefused(misfits());
}

TEST_F(Plugins, AFileThatIsNoWholeModuleIsRefusedAndHarmsNobodyElse) {
  const fs::path whole = kBuiltIn / "vssm.so";
  const uintmax_t size = fs::file_size(whole);
  cutShort(whole, folder_ / "empty.so", 0);
  cutShort(whole, folder_ / "header.so", 40);
  cutShort(whole, folder_ / "half.so", size / 2);
  cutShort(whole, folder_ / "all_but_a_byte.so", size - 1);
  std::ofstream(folder_ / "text.so") << "INPUT(libm.so.6)\n";
  fs::create_directory(folder_ / "directory.so");
  ASSERT_EQ(mkfifo((folder_ / "fifo.so").c_str(), 0600), 0);
  fs::create_symlink("nowhere", folder_ / "link.so");
  fs::copy_file(kLimnBinary, folder_ / "program.so");
  const std::string part = "it is cut short: it names what lies beyond its ";
  expectAllRefused({{"empty", "it is not a shared object"},
                    {"header", "it ends after 40 bytes"},
                    {"half", part},
                    {"all_but_a_byte", part},
                    {"text", "it is not a shared object"},
                    {"directory", ""},
                    {"fifo", ""},
                    {"link", ""},
                    {"program", ""}});
}

TEST_F(Plugins, WhatATechniqueThrowsAtWorkNamesTechniqueAndFile) {
  const std::map<std::string, std::string> expected = {
      {"makes_nothing", "it makes no instance of itself"},
      {"returns_nothing", "it answers visibility with nothing"},
      {"throws_42", "it threw something that is no std::exception"},
      {"throws_exception", "no luck"},
      {"update_throws_42", "it threw something that is no std::exception"},
  };
  for (const auto& [name, what] : expected) {
    const fs::path file = folder_ / (name + ".so");
    fs::copy_file(kMisfit, file);
    expectRefused(render(name, folder_.path().string(), {"--repeat", "2"}), 1,
                  {"technique " + name + " (" + file.string() + "): " + what});
  }
  fs::copy_file(kMisfit, folder_ / "pass_throws_42.so");
  expectRefused(render("pass_throws_42", folder_.path().string()), 1,
                {"pass", "misfit", "clear", "it threw something that is no std::exception"});
}

TEST_F(Plugins, OfTwoModulesOfOneNameTheOneThatIsUsedIsSaid) {
  fs::copy_file(kBuiltIn / "pcss.so", folder_ / "pcss.so");
  const std::string foreign = (folder_ / "pcss.so").string(), own = (kBuiltIn / "pcss.so").string();
  const std::string said = "limn: warning: technique pcss is " + foreign + ", not " + own + "\n";
  EXPECT_EQ(list(folder_.path().string()).err, said);
  const Outcome used = render("pcss", folder_.path().string());
  EXPECT_EQ(used.status, 0);
  EXPECT_EQ(withoutProgress(used.err), said);
  EXPECT_EQ(withoutProgress(render("pcf", folder_.path().string()).err), "");  // did not ask for it
  EXPECT_EQ(list(kBuiltIn.string()).err, "");                                  // the same file twice
}

TEST_F(Plugins, ACrashSaysWhere) {
  const std::string path = std::string(kBinaryDir) + "/tests/misbehaver";
  for (const auto& [way, where] :
       {std::pair("crash", "technique misbehaver"), std::pair("crash_in_pass", "pass clear of misbehaver")}) {
    const Outcome outcome =
        limn({"render", kCornellBox, "--size", "16x16", "--technique", "misbehaver", "--set",
              std::string("misbehaver.way=") + way, "-o", folder_ / "a.exr", "-q"},
             {{"LIMN_TECHNIQUE_PATH", path}});
    EXPECT_EQ(outcome.status, -1);
    EXPECT_EQ(outcome.err, std::string("limn: crashed: Aborted, in ") + where + "\n");
    EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
  }
}

TEST_F(Plugins, InfoNamesEveryModuleAndWhyOneIsRefused) {
  for (const char* name : {"entry_crashes", "throws_42"})
    fs::copy_file(kMisfit, folder_ / (name + std::string(".so")));
  fs::copy_file(kBuiltIn / "pcss.so", folder_ / "pcss.so");
  const std::string folder = folder_.path().string();
  const Outcome outcome = limn({"info", "--json"}, {{"LIMN_TECHNIQUE_PATH", folder}});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::map<std::string, nlohmann::json> modules;
  const auto answer = nlohmann::json::parse(outcome.out);
  for (const auto& module : answer["techniques"]) {
    modules[module["name"]] = module;
    EXPECT_EQ(fs::path(module["file"]),
              fs::path(module["folder"]) / (module["name"].get<std::string>() + ".so"));
  }
  EXPECT_EQ(answer["techniques"].size(), techniques_ + 2);
  EXPECT_EQ(modules["pcss"]["folder"], folder) << "that of the earlier folder";
  EXPECT_TRUE(modules["pcss"]["refused"].is_null());
  EXPECT_EQ(modules["vssm"]["folder"], kBuiltIn.string());
  EXPECT_EQ(modules["throws_42"]["folder"], folder);
  EXPECT_TRUE(modules["throws_42"]["refused"].is_null());
  EXPECT_EQ(modules["entry_crashes"]["file"], (folder_ / "entry_crashes.so").string());
  EXPECT_THAT(modules["entry_crashes"]["refused"], testing::HasSubstr("it crashes when it is loaded"));
  const Outcome text = limn({"info"}, {{"LIMN_TECHNIQUE_PATH", folder}});
  EXPECT_THAT(text.out, testing::HasSubstr("  pcss: " + folder + "/pcss.so\n"));
  EXPECT_THAT(text.out,
              testing::HasSubstr("  entry_crashes: refused: " + folder + "/entry_crashes.so: it crashes"));
}

TEST_F(Plugins, AWrongTechniquePathIsSaid) {
  const std::string none = (folder_ / "none").string(), empty = folder_.path().string();
  EXPECT_EQ(list(none).err, "limn: warning: technique folder '" + none +
                                "' cannot be read: No such file or directory; see LIMN_TECHNIQUE_PATH\n");
  EXPECT_EQ(list(empty).err, "limn: warning: technique folder '" + empty +
                                 "' holds no technique (*.so); see LIMN_TECHNIQUE_PATH\n");
  EXPECT_EQ(list("").err, "");
}

TEST_F(Plugins, AnUnknownNameIsAnsweredWithCloseOnesAlsoAmongTheRefused) {
  std::ofstream(folder_ / "my_shadow.so") << "no module\n";
  expectRefused(render("my_shadows", folder_.path().string()), 2, {"did you mean my_shadow?", "known are"});
}

}  // namespace
}  // namespace limn::test
