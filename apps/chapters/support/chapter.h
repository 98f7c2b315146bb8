// Declares the demo program of a chapter. Without a display it writes the chapter's pictures and its table of
// frames per second; with one it opens the viewer, with a guide through the chapter's settings.
#pragma once

#include <span>
#include <string>

namespace limn::app {

/// Declares one step of the guide through the chapter that the window offers.
struct ChapterSetting {
  const char* title;
  const char* techniques;     ///< as --technique
  const char* parameters;     ///< as --set, separated by spaces; may be empty
  const char* sentence = "";  ///< what the setting shows
};

struct Chapter {
  const char* name;                     ///< of the program
  const char* title;                    ///< for people
  const char* scene;                    ///< shown in the window
  std::span<const char* const> suites;  ///< names of bench suites, in benchmarks/
  std::span<const ChapterSetting> settings;
};

/// Runs main() of a chapter's program and returns the exit status.
int runChapter(const Chapter& chapter, int argc, char** argv);

}  // namespace limn::app
