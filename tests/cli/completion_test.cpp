// limn completion: what bash offers at the cursor.
#include "tests/cli/limn_program.h"

namespace limn::test {
namespace {

/// What bash completes the last of the words to, a line each.
std::vector<std::string> completed(const std::vector<std::string>& words,
                                   const std::string& source = "limn completion",
                                   const std::string& function = "_limn") {
  std::string script =
      "PATH=" + std::string(kBinaryDir) + "/bin:$PATH; source <(" + source + "); COMP_WORDS=(";
  for (const std::string& word : words) script += "'" + word + "' ";
  script += ") COMP_CWORD=" + std::to_string(words.size() - 1) + "; " + function +
            "; printf '%s\\n' \"${COMPREPLY[@]}\"";
  const Outcome outcome = run({"/bin/bash", "-c", script});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  std::vector<std::string> lines;
  std::istringstream text(outcome.out);
  for (std::string line; std::getline(text, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

TEST(Completion, KnowsCommandsOptionsAndChoices) {
  using testing::Contains;
  using testing::ElementsAre;
  EXPECT_THAT(completed({"limn", "ren"}), ElementsAre("render"));
  EXPECT_THAT(completed({"limn", ""}), testing::AllOf(Contains("bench"), Contains("--version")));
  EXPECT_THAT(completed({"limn", "render", "--tone"}), ElementsAre("--tonemap"));
  EXPECT_THAT(completed({"limn", "render", "--tonemap", ""}), ElementsAre("none", "neutral", "agx"));
  EXPECT_THAT(completed({"limn", "reference", "x.glb", "--term", "ind"}), ElementsAre("indirect"));
  EXPECT_THAT(completed({"limn", "bench", "quick", "--backend", ""}), ElementsAre("egl", "osmesa", "glfw"));
  EXPECT_THAT(completed({"limn", "bench", "quick", "--backend", "="}), ElementsAre("egl", "osmesa", "glfw"));
  EXPECT_THAT(completed({"limn", "bench", "quick", "--backend", "=", "o"}), ElementsAre("osmesa"));
  EXPECT_THAT(completed({"limn", "brdf", "fit", "metal:0.3", "--fit", "pq"}), ElementsAre("pqp", "pqp_disc"));
  EXPECT_THAT(completed({"limn", "brdf", "fit", "metal:0.3", "--format", "fl"}), ElementsAre("float32"));
  EXPECT_THAT(completed({"limn", "compare", "--tone"}), testing::IsEmpty());
  EXPECT_THAT(completed({"limn", "brdf", "simu"}), ElementsAre("simulate"));
}

// limn view hands its words to limn-view, and so does its completion.
TEST(Completion, ProgramsWithAWindowCompleteTheirOwn) {
  using testing::ElementsAre;
  EXPECT_THAT(completed({"limn", "view", "x.glb", "--screens"}), ElementsAre("--screenshot"));
  EXPECT_THAT(completed({"limn", "view", "--compare", "tr"}), ElementsAre("truth"));
  EXPECT_THAT(completed({"limn-view", "--tonemap", "a"}, "limn-view --completion", "_limn_view"),
              ElementsAre("agx"));
  const std::string chapter = "ch7-variance-soft-shadows";
  EXPECT_THAT(completed({chapter, "--headl"}, chapter + " --completion", "_ch7_variance_soft_shadows"),
              ElementsAre("--headless"));
  EXPECT_THAT(run({kBinaryDir + std::string("/bin/limn-view"), "--help"}).out,
              testing::Not(testing::HasSubstr("--completion")));
}

TEST(Completion, OffersFilesElsewhere) {
  TemporaryFolder folder;
  std::ofstream(folder / "scene.glb") << ' ';
  const std::string start = (folder / "sce").string();
  EXPECT_THAT(completed({"limn", "render", start}), testing::ElementsAre(start + "ne.glb"));
}

/// In an interactive zsh, at a tab: the line is completed as far as one answer goes.
TEST(Completion, ZshCompletesByTheSameScript) {
  if (run({"/bin/sh", "-c", "command -v zsh"}).status != 0) GTEST_SKIP() << "needs zsh";
  TemporaryFolder folder;
  std::ofstream(folder / "script.zsh") << R"(zmodload zsh/zpty
zpty z zsh -f -i
zpty -w z 'autoload -Uz compinit bashcompinit; compinit -u -d zcompdump; bashcompinit; source <(limn completion); print rea""dy'
zpty -r z seen '*ready*'
zpty -w -n z $'limn ren\t --tonem\t agx > words; print do""ne\n'
zpty -r z seen '*done*'
)";
  std::ofstream(folder / "limn") << "#!/bin/sh\n[ \"$1\" = completion ] && exec '" << kLimnBinary
                                 << "' completion\necho \"$@\"\n";
  const Outcome outcome = run({"/bin/sh", "-c",
                               "cd '" + folder.path().string() +
                                   "'; chmod +x limn; PATH=\"$PWD:$PATH\" timeout 60 zsh -f script.zsh"});
  EXPECT_EQ(contents(folder / "words"), "render --tonemap agx\n") << outcome.out << outcome.err;
}

}  // namespace
}  // namespace limn::test
