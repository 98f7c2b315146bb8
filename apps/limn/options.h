// Declares the command-line options that several commands share, each once.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/context/context.h"
#include "core/image/image.h"
#include "core/question/scene_question.h"
#include "core/session/technique_choice.h"

namespace limn::app {

/// Gives the command all flags of the question except that of the term, which not every command offers.
void addSceneFlags(CLI::App& command, SceneQuestion& question);
/// Gives the command one of these flags, under the field's own flag name or under another one.
CLI::Option* addSceneFlag(CLI::App& command, SceneQuestion& question, std::string_view key,
                          const std::string& flag = {});

/// Accepts the real numbers from `low` to `high`. CLI::Range accepts NaN as well, with which every comparison
/// is false.
CLI::Validator realRange(double low, double high);

/// Accepts the whole numbers from `low` to `high`, in decimal: 010 is ten, which CLI::Range and what follows
/// it read as 8, as C does. It is for CLI::Option::transform(), since it writes the number as both read it.
CLI::Validator wholeRange(int low, int high);

/// Returns the path of another of limn's programs, which lie in one folder.
std::filesystem::path programBeside(const std::string& name);

/// Throws Error unless files can be written beside `file`. It is called before long work, whose result would
/// be lost otherwise. Removes what killed commands have left there (removeAbandonedFiles()).
void checkWritable(const std::filesystem::path& file);

/// Throws UsageError where two of the files that are to be written are one, or one of them is a file that is
/// read: one of the two would be lost. Empty names stand for no file.
void checkApart(const std::vector<std::filesystem::path>& written,
                const std::vector<std::filesystem::path>& read = {});

/// Returns the files that the question's scene is read from, for checkApart(); none where the scene cannot be
/// opened, which then says why before anything is written.
std::vector<std::filesystem::path> filesRead(const SceneQuestion& question);

/// Throws UsageError unless the name ends in one of `extensions`, such as ".png". `option` is what gave it.
void checkExtension(const char* option, const std::filesystem::path& file,
                    const std::vector<std::string>& extensions);

/// Throws Error where a picture that is to become `file` has values that are not finite: nobody should take
/// such a file for a result. The line names the term and the `techniques`; "": none.
void checkFinite(const Image& picture, const std::filesystem::path& file, const std::string& term,
                 const std::string& techniques);

/// Throws UsageError unless the value of --shaders is empty or a folder. Warns of one without any shaders.
void checkShaderFolder(const std::filesystem::path& folder);

struct FrameRange {
  int first, last;  // inclusive
};
/// Parses "a:b", or "n" for the first n frames; returns nullopt for an empty text. Throws UsageError for any
/// other text.
std::optional<FrameRange> parseFrames(const std::string& text);
/// Returns the file name of one frame: picture.png, frame 7 -> picture.0007.png.
std::filesystem::path numbered(const std::filesystem::path& out, int frame);
/// Throws UsageError where one of these frames would take the place of one of `others`.
void checkFramesApart(const std::filesystem::path& out, const FrameRange& frames,
                      const std::vector<std::filesystem::path>& others);

/// Makes an option repeatable, with one value each time. CLI11 would take what follows for further values, a
/// scene as well.
void takeOneEach(CLI::Option* option);

/// Gives the command --technique and --set.
void addTechniqueFlags(CLI::App& command, session::TechniqueChoice& choice);

/// Gives the command --device and --gl-debug.
void addDeviceFlags(CLI::App& command, int& device, bool& debug);

struct BackendOptions {
  std::string backend = "egl";
  int device = -1;
  bool debug = false;

  void addTo(CLI::App& command);
  ContextOptions contextOptions() const;
  /// Returns the arguments that give these options; those that are the default are left out.
  std::vector<std::string> arguments() const;
};

/// Returns what a line on stderr begins with: on a terminal a progress bar may stand where it is written.
const char* lineBeginning();

/// Writes a line to stderr that is neither a result nor an error.
void sayNote(const std::string& line);

/// Writes a warning to stderr, in one line: something unusual that does not end the run.
void warn(const std::string& message);

/// Writes an error to stderr, in one line, also while a SilentStderr lives.
void sayError(const std::string& message);

/// Returns the file descriptor to which errors go, also while a SilentStderr lives. A signal handler may call
/// it.
int errorDescriptor();

/// While one lives, what anybody writes to stderr is lost, except what goes to errorDescriptor(): errors, and
/// the last words of an interrupted command. Only one object may live at a time.
class SilentStderr {
 public:
  SilentStderr();
  ~SilentStderr();
  SilentStderr(const SilentStderr&) = delete;
  SilentStderr& operator=(const SilentStderr&) = delete;
};

/// Runs `work`, reports what it throws (including Interrupted) in one line on stderr, and returns the exit
/// status. A file that grows beyond the limit of the process is that file's error, not the program's end. How
/// programs end that it starts is known even where whoever started this one ignores SIGCHLD, and no file is
/// opened in the place of a standard one that is closed.
int guarded(const std::function<int()>& work);

/// Prints what --json asks for on stdout. Bytes of names that are not UTF-8 are replaced.
void printAsJson(const nlohmann::ordered_json& json);

/// Says a line on stdout at once, for whoever started the program from a terminal.
void sayInTerminal(const std::string& line);

/// Says on stderr that the file has been written.
void sayWritten(const std::filesystem::path& file);

/// Holds the patience, in seconds, of Progress with work that is mostly short.
constexpr double kProgressPatience = 1;

/// Shows progress on stderr: a bar of at most a line on a terminal, elsewhere plain lines (at most one every
/// 10 %, none in the first `patience` seconds).
class Progress {
 public:
  explicit Progress(std::string label, double patience = 0);
  ~Progress();
  void update(double fraction, const std::string& note = {});

 private:
  std::string label_;
  bool terminal_;
  std::chrono::steady_clock::time_point silentUntil_;
  int lastShown_ = -1;
};

}  // namespace limn::app
