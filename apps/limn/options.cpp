#include "apps/limn/options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <system_error>

#include "apps/limn/interruption.h"
#include "core/base/error.h"
#include "core/base/failure.h"
#include "core/base/text.h"

namespace limn::app {
namespace fs = std::filesystem;

fs::path findShared(const fs::path& folder, const fs::path& file) {
  std::error_code ignored;
  const fs::path prefix = fs::read_symlink("/proc/self/exe", ignored).parent_path().parent_path();
  for (const fs::path& share : {prefix, prefix / "share/limn"})
    if (fs::exists(share / folder / file, ignored)) return share / folder / file;
  return {};
}

fs::path findScene(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const std::string name = nameOrFile.string();
  if (name.find('/') == std::string::npos)
    if (const fs::path file = findShared("assets", fs::path(name) / (name + ".glb")); !file.empty())
      return file;
  throw Error(fmt::format(
      "scene '{}' does not exist; expected a .gltf or .glb file, or the name of one of limn's scenes", name));
}

fs::path findEnvironment(const fs::path& nameOrFile) {
  std::error_code ignored;
  if (fs::exists(nameOrFile, ignored)) return nameOrFile;
  const fs::path name = nameOrFile.filename();
  if (name == nameOrFile)
    if (const fs::path file = findShared("assets/environments", name.string() + ".exr"); !file.empty())
      return file;
  throw Error(fmt::format(
      "environment '{}' does not exist; expected an equirectangular .exr or .hdr file, or the name of one of "
      "limn's maps",
      nameOrFile.string()));
}

void createFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw Error(fmt::format("folder '{}' cannot be created: {}", folder.string(), error.message()));
}

void checkWritable(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_directory(file, ignored))
    throw Error(fmt::format("{}: cannot be written: it is a folder", file.string()));
  const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw Error(fmt::format("{}: cannot be written: {}", file.string(), std::strerror(errno)));
}

glm::ivec2 parseSize(const std::string& text) {
  const size_t x = text.find('x');
  const auto width = x == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(0, x));
  const auto height =
      x == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(x + 1));
  const auto fits = [](const std::optional<double>& v) {
    return v && *v >= 1 && *v <= 16384 && *v == std::floor(*v);
  };
  if (!fits(width) || !fits(height))
    throw UsageError(
        fmt::format("--size '{}' is not accepted; expected WxH, each from 1 to 16384 pixels", text));
  return {static_cast<int>(*width), static_cast<int>(*height)};
}

std::optional<FrameRange> parseFrames(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const size_t colon = text.find(':');
  const auto first =
      colon == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(0, colon));
  const auto last =
      colon == std::string::npos ? std::nullopt : parseNumber(std::string_view(text).substr(colon + 1));
  const auto whole = [](double v) { return v == std::floor(v) && v >= 0 && v <= 1e6; };
  if (!first || !last || !whole(*first) || !whole(*last) || *first > *last)
    throw UsageError(
        fmt::format("--frames '{}' is not accepted; expected a:b with 0 <= a <= b <= 1000000", text));
  return FrameRange{static_cast<int>(*first), static_cast<int>(*last)};
}

fs::path numbered(const fs::path& out, int frame) {
  return out.parent_path() / fmt::format("{}.{:04}{}", out.stem().string(), frame, out.extension().string());
}

int findNamed(const std::string& what, const std::string& text, const std::vector<std::string>& names) {
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return static_cast<int>(i);
  if (text.starts_with('#'))
    if (const auto index = parseNumber(std::string_view(text).substr(1));
        index && *index >= 0 && *index < static_cast<double>(names.size()) && *index == std::floor(*index))
      return static_cast<int>(*index);
  constexpr size_t listed = 20;
  std::vector<std::string> shown(names.begin(),
                                 names.begin() + static_cast<long>(std::min(names.size(), listed)));
  throw UsageError(
      fmt::format("{} '{}' is not in the scene{}; it has {}{}", what, text, didYouMean(text, names),
                  names.empty() ? "none" : joined(shown),
                  names.size() > listed ? fmt::format(" and {} more", names.size() - listed) : ""));
}

void TechniqueOptions::addTo(CLI::App& command) {
  command.add_option("--technique", techniques,
                     "Techniques, comma-separated (see limn list); none: unshadowed");
  command.add_option("--set", settings, "TECHNIQUE.PARAMETER=VALUE, repeatable")->take_all();
}

std::vector<render::TechniqueUse> TechniqueOptions::resolve(const TechniqueRegistry& registry) const {
  std::vector<render::TechniqueUse> uses;
  std::string_view rest = techniques;
  while (!rest.empty()) {
    const size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    const TechniquePlugin& plugin = registry.find(name);
    for (const auto& use : uses)
      if (use.plugin == &plugin)
        throw UsageError(fmt::format("technique {} is named twice; once is enough", name));
    uses.push_back({&plugin, ParameterValues(std::string(name), plugin.info->parameters)});
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  }
  for (const std::string& setting : settings) {
    const size_t dot = setting.find('.'), equals = setting.find('=');
    if (dot == std::string::npos || equals == std::string::npos || equals < dot)
      throw UsageError(
          fmt::format("--set '{}' is not accepted; expected TECHNIQUE.PARAMETER=VALUE", setting));
    const std::string technique = setting.substr(0, dot);
    bool found = false;
    for (auto& use : uses) {
      if (technique != use.plugin->info->name) continue;
      use.parameters.set(setting.substr(dot + 1, equals - dot - 1), setting.substr(equals + 1));
      found = true;
    }
    if (!found)
      throw UsageError(
          fmt::format("--set '{}' names technique {}, which --technique does not", setting, technique));
  }
  return uses;
}

void BackendOptions::addTo(CLI::App& command) {
  command.add_option("--backend", backend, "egl or osmesa")->capture_default_str();
  command.add_option("--device", device, "EGL device index, see limn info")->check(CLI::Range(0, 255));
  command.add_flag("--gl-debug", debug, "Debug context: driver errors end the run");
}

ContextOptions BackendOptions::contextOptions() const {
  ContextOptions options;
  options.backend = parseBackend(backend);
  options.device = device;
  options.debug = debug;
  options.visible = false;
  return options;
}

void warn(const std::string& message) {
  std::fputs(("limn: warning: " + message + "\n").c_str(), stderr);
}

int guarded(const std::function<int()>& work) {
  const auto say = [](const std::string& message) {
    std::fputs(("limn: " + oneLine(message, 4000) + "\n").c_str(), stderr);
  };
  try {
    return work();
  } catch (const Interrupted& interruption) {
    say(interruption.message);
    return 128 + interruption.signal;
  } catch (const UsageError& error) {
    say(error.what());
    return 2;
  } catch (const fs::filesystem_error& error) {
    say(error.what());
  } catch (const std::system_error& error) {  // of fmt::print: the buffer was full before the end
    say("standard output cannot be written: " + error.code().message());
  } catch (...) {
    say(currentFailure());
  }
  return 1;
}

void sayWritten(const fs::path& file) {
  std::fputs(fmt::format("wrote {}\n", file.string()).c_str(), stderr);
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
    std::fputs(fmt::format("\r{} [{:<{}}] {:3}% {}\033[K", label_, bar, width, percent, note).c_str(),
               stderr);
  } else if ((percent / 10 > lastShown_ / 10 || lastShown_ < 0) &&
             std::chrono::steady_clock::now() >= silentUntil_) {
    std::fputs(fmt::format("{}: {}% {}\n", label_, percent, note).c_str(), stderr);
  } else {
    return;
  }
  lastShown_ = percent;
}

}  // namespace limn::app
