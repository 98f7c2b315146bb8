#include "apps/limn/options.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>
#include <utility>

#include "apps/limn/interruption.h"
#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/base/file.h"
#include "core/base/text.h"
#include "core/session/view.h"

namespace limn::app {
namespace fs = std::filesystem;
namespace {

std::atomic<int> errorFile = STDERR_FILENO;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler reads it");

/// Where a standard file is closed, the next file that is opened would take its number, and what is printed
/// would be written to it. Results are an error then, as before; messages are lost.
void holdStandardFiles() {
  for (int file = STDIN_FILENO; file <= STDERR_FILENO; ++file) {
    if (fcntl(file, F_GETFD) >= 0) continue;
    [[maybe_unused]] const int held = open("/dev/null", file == STDERR_FILENO ? O_WRONLY : O_RDONLY);
  }
}

/// One name of a file, whatever leads to it.
fs::path placeOf(const fs::path& file) {
  std::error_code unknown;
  return fs::weakly_canonical(fs::absolute(file, unknown), unknown);
}

[[noreturn]] void refuseSameFile(const fs::path& file) {
  throw UsageError(
      fmt::format("{}: cannot be written: another argument names the same file, or a scene that reads it",
                  file.string()));
}

/// How many columns the terminal behind stderr has.
std::size_t terminalColumns() {
  constexpr std::size_t usual = 80;
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual;
}

}  // namespace

fs::path programBeside(const std::string& name) {
  std::error_code unknown;
  return fs::read_symlink("/proc/self/exe", unknown).parent_path() / name;
}

void checkWritable(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw Error(fmt::format("{}: cannot be written: it is a folder", file.string()));
  if (isSpecialFile(file))
    throw Error(fmt::format("{}: cannot be written: it is not a regular file", file.string()));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
  removeAbandonedFiles(folder);
}

void checkApart(const std::vector<fs::path>& written, const std::vector<fs::path>& read) {
  std::set<fs::path> taken;
  const auto take = [&](const fs::path& file) { return file.empty() || taken.insert(placeOf(file)).second; };
  for (const fs::path& file : read) take(file);
  for (const fs::path& file : written)
    if (!take(file)) refuseSameFile(file);
}

std::vector<fs::path> filesRead(const SceneQuestion& question) {
  try {
    return session::inputFiles(question);
  } catch (const Error&) {
    return {};
  }
}

void checkExtension(const char* option, const fs::path& file, const std::vector<std::string>& extensions) {
  if (std::ranges::find(extensions, file.extension().string()) == extensions.end())
    throw UsageError(fmt::format("{} '{}' is not accepted; expected a name ending in {}", option,
                                 file.string(), joined(extensions, "or")));
}

void checkFinite(const Image& picture, const fs::path& file, const std::string& term,
                 const std::string& techniques) {
  std::size_t count = 0;
  int firstX = 0, firstY = 0;
  for (int y = 0; y < picture.height(); ++y)
    for (int x = 0; x < picture.width(); ++x) {
      const bool finite = std::ranges::all_of(picture.pixel(x, y), [](float v) { return std::isfinite(v); });
      if (!finite && count++ == 0) firstX = x, firstY = y;
    }
  if (count > 0)
    throw Error(
        fmt::format("{}: {} of {} pixels of term {} by {} are not finite, the first at {},{} from the upper "
                    "left; nothing is written",
                    file.string(), count, picture.pixelCount(), term,
                    techniques.empty() ? "no technique" : techniques, firstX, firstY));
}

void checkShaderFolder(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored))
    throw UsageError(fmt::format("--shaders '{}': no such folder", folder.string()));
  if (!fs::is_directory(folder / "glsl", ignored) && !fs::is_directory(folder / "techniques", ignored))
    warn(fmt::format("--shaders {}: the folder holds neither glsl/ nor techniques/ and replaces no shader",
                     folder.string()));
}

std::optional<FrameRange> parseFrames(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const size_t colon = text.find(':');
  const bool count = colon == std::string::npos;
  const auto first = count ? std::optional(0.0) : parseNumber(std::string_view(text).substr(0, colon));
  auto last = parseNumber(std::string_view(text).substr(count ? 0 : colon + 1));
  if (count && last) last = *last - 1;
  const auto whole = [](double v) { return v == std::floor(v) && v >= 0 && v <= 1e6; };
  if (!first || !last || !whole(*first) || !whole(*last) || *first > *last)
    throw UsageError(fmt::format(
        "--frames '{}' is not accepted; expected a:b with 0 <= a <= b <= 1000000, or a number of frames",
        text));
  return FrameRange{static_cast<int>(*first), static_cast<int>(*last)};
}

fs::path numbered(const fs::path& out, int frame) {
  return out.parent_path() / fmt::format("{}.{:04}{}", out.stem().string(), frame, out.extension().string());
}

void checkFramesApart(const fs::path& out, const FrameRange& frames, const std::vector<fs::path>& others) {
  for (const fs::path& other : others) {
    const fs::path place = placeOf(other);
    const std::string name = place.stem().string();  // picture.0007
    const std::size_t dot = name.rfind('.');
    const auto frame =
        dot == std::string::npos ? std::nullopt : parseWhole<int>(std::string_view(name).substr(dot + 1));
    if (!frame || *frame < frames.first || *frame > frames.last) continue;
    if (const fs::path file = numbered(out, *frame); placeOf(file) == place) refuseSameFile(file);
  }
}

void addTechniqueFlags(CLI::App& command, session::TechniqueChoice& choice) {
  command.add_option("--technique,--techniques", choice.techniques,
                     "Techniques, comma-separated (see limn list); NAME:TERM+TERM asks one for these of its "
                     "terms alone; without this option: unshadowed");
  takeOneEach(command.add_option("--set", choice.settings, "TECHNIQUE.PARAMETER=VALUE, repeatable"));
}

void addDeviceFlags(CLI::App& command, int& device, bool& debug) {
  command
      .add_option(
          "--device", device,
          "EGL device, by its index in limn info; default: the first GPU with OpenGL 4.5, or else the "
          "processor")
      ->transform(wholeRange(0, 255));
  command.add_flag("--gl-debug", debug, "Use an OpenGL debug context: driver errors end the run");
}

void BackendOptions::addTo(CLI::App& command) {
  command
      .add_option(
          "--backend", backend,
          "Where OpenGL comes from; osmesa: always the processor; glfw: a hidden window, which needs a "
          "display")
      ->type_name("{egl,osmesa,glfw}")
      ->check([](const std::string& text) {
        parseBackend(text);
        return std::string();
      })
      ->capture_default_str();
  addDeviceFlags(command, device, debug);
}

ContextOptions BackendOptions::contextOptions() const {
  ContextOptions options;
  options.backend = parseBackend(backend);
  options.device = device;
  options.debug = debug;
  options.visible = false;
  options.warn = warn;
  return options;
}

std::vector<std::string> BackendOptions::arguments() const {
  const BackendOptions usual;
  std::vector<std::string> arguments;
  if (backend != usual.backend) arguments.insert(arguments.end(), {"--backend", backend});
  if (device != usual.device) arguments.insert(arguments.end(), {"--device", std::to_string(device)});
  if (debug) arguments.push_back("--gl-debug");
  return arguments;
}

void printAsJson(const nlohmann::ordered_json& json) {
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

const char* lineBeginning() {
  return isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
}

void sayNote(const std::string& line) {
  std::fputs((lineBeginning() + line + "\n").c_str(), stderr);
}

void warn(const std::string& message) {
  sayNote("limn: warning: " + message);
}

void sayError(const std::string& message) {
  dprintf(errorFile, "%slimn: %s\n", lineBeginning(), oneLine(message, 4000).c_str());
}

int errorDescriptor() {
  return errorFile;
}

SilentStderr::SilentStderr() {
  errorFile = dup(STDERR_FILENO);
  const int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nothing, STDERR_FILENO);
  close(nothing);
}

SilentStderr::~SilentStderr() {
  std::fflush(stderr);
  dup2(errorFile, STDERR_FILENO);
  close(errorFile.exchange(STDERR_FILENO));
}

int guarded(const std::function<int()>& work) {
  holdStandardFiles();
  std::signal(SIGXFSZ, SIG_IGN);
  std::signal(SIGCHLD, SIG_DFL);  // some parents ignore it, and how programs end would stay unknown
  try {
    return work();
  } catch (const Interrupted& interruption) {
    sayError(interruption.message);
    return 128 + interruption.signal;
  } catch (const UsageError& error) {
    sayError(error.what());
    return 2;
  } catch (const fs::filesystem_error& error) {
    sayError(error.what());
  } catch (const std::system_error& error) {  // of fmt::print: the buffer was full before the end
    sayError("standard output cannot be written: " + error.code().message());
  } catch (...) {
    sayError(currentFailure());
  }
  return 1;
}

void sayInTerminal(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

void sayWritten(const fs::path& file) {
  sayNote("wrote " + file.string());
}

Progress::Progress(std::string label, double patience)
    : label_(std::move(label)),
      terminal_(isatty(STDERR_FILENO) != 0),
      silentUntil_(std::chrono::steady_clock::now() +
                   std::chrono::milliseconds(static_cast<int>(1000 * patience))) {}

Progress::~Progress() {
  if (terminal_ && lastShown_ >= 0) std::fputs("\r\033[K", stderr);
}

void Progress::update(double fraction, const std::string& note) {
  const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  if (terminal_) {
    constexpr int width = 30;
    const std::string bar(static_cast<size_t>(percent * width / 100), '#');
    // A longer line would go on in the next one, where the bar after it could not take its place.
    constexpr std::size_t ellipsis = 3, least = 8;
    const std::size_t room = std::max(terminalColumns(), least) - 1 - ellipsis;
    const std::string line = fmt::format("{} [{:<{}}] {:3}% {}", label_, bar, width, percent, note);
    std::fputs(("\r" + oneLine(line, room) + "\033[K").c_str(), stderr);
  } else if ((percent / 10 > lastShown_ / 10 || lastShown_ < 0) &&
             std::chrono::steady_clock::now() >= silentUntil_) {
    std::fputs(fmt::format("{}: {}% {}\n", label_, percent, note).c_str(), stderr);
  } else {
    return;
  }
  lastShown_ = percent;
}

}  // namespace limn::app
