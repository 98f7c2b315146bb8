#include "core/gpu/shader_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <iterator>
#include <optional>
#include <set>

#include "core/base/error.h"
#include "core/gpu/private/glsl_preprocessor.h"
#include "core/gpu/private/program_build.h"

namespace limn::gpu {
namespace {

namespace fs = std::filesystem;

/// Enough of a file's state to see that it was written to, created or removed.
struct Stamp {
  bool exists = false;
  fs::file_time_type time{};
  uintmax_t bytes = 0;
  bool operator==(const Stamp&) const = default;
};

Stamp stampOf(const fs::path& path) {
  std::error_code error;
  const fs::directory_entry entry(path, error);
  if (error || !entry.is_regular_file(error)) return {};
  Stamp stamp{true, entry.last_write_time(error), 0};
  stamp.bytes = entry.file_size(error);
  return stamp;
}

struct Mount {
  std::string prefix;
  std::map<std::string, std::string_view> sources;  // by path below the prefix
  fs::path overrideFolder;
};

std::string labelOf(const ProgramDesc& desc) {
  std::string label = fmt::format("{}", fmt::join(desc.files, " + "));
  if (desc.defines.empty()) return label;
  std::vector<std::string> defines;
  for (const auto& [name, value] : desc.defines) defines.push_back(name + "=" + value);
  return fmt::format("{} ({})", label, fmt::join(defines, ", "));
}

bool hasWord(const std::string& text, std::string_view word) {
  const auto inWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    const size_t end = at + word.size();
    if ((at == 0 || !inWord(text[at - 1])) && (end == text.size() || !inWord(text[end]))) return true;
  }
  return false;
}

}  // namespace

struct ShaderLibrary::Implementation {
  struct Entry {
    Program program;
    std::vector<std::string> texts;  // what the program was compiled from, one per stage
    std::set<fs::path> files;        // on disk, whether or not they exist
    std::string problem;             // why they do not make a program any more; empty: they do
  };

  explicit Implementation(Device& libraryDevice) : device(libraryDevice) {}

  /// The text of a file; every place on disk where it is or might appear is added to `visited`, with its
  /// state before it was read, so that a change in between is seen by the next reload().
  std::optional<std::string> find(const std::string& path, std::map<fs::path, Stamp>& visited) const {
    for (const Mount& mount : mounts) {
      if (!path.starts_with(mount.prefix)) continue;
      const std::string inside = path.substr(mount.prefix.size());
      if (!mount.overrideFolder.empty()) {
        const fs::path file = mount.overrideFolder / inside;
        visited.emplace(file, stampOf(file));
        std::error_code error;
        if (fs::is_regular_file(file, error)) {
          std::ifstream stream(file, std::ios::binary);
          return std::string(std::istreambuf_iterator<char>(stream), {});
        }
      }
      const auto embedded = mount.sources.find(inside);
      if (embedded != mount.sources.end()) return std::string(embedded->second);
    }
    return std::nullopt;
  }

  ExpandedSource expand(const ProgramDesc& desc, const std::string& file, std::map<fs::path, Stamp>& visited,
                        UnreadIncludes unread = UnreadIncludes::leftOut) const {
    const auto lookup = [&](const std::string& path) { return find(path, visited); };
    return expandGlsl(file, desc.defines, lookup, unread);
  }

  /// Expands every stage and builds the program, unless the text is that of `entry` already; true when it was
  /// built. The files looked at are in entry.files whether this succeeds or throws.
  bool build(const ProgramDesc& desc, Entry& entry) {
    std::vector<ShaderStage> stages;
    std::map<fs::path, Stamp> visited;
    const auto expandAll = [&] {
      for (const std::string& file : desc.files) stages.push_back({file, expand(desc, file, visited)});
    };
    try {
      expandAll();
    } catch (...) {
      watch(entry, visited);
      throw;
    }
    watch(entry, visited);
    std::vector<std::string> texts;
    texts.reserve(stages.size());
    for (const ShaderStage& stage : stages) texts.push_back(stage.source.text);
    if (entry.program && texts == entry.texts) return false;
    entry.program = Program(device, linkProgram(device, labelOf(desc), stages), labelOf(desc));
    entry.texts = std::move(texts);
    return true;
  }

  void watch(Entry& entry, const std::map<fs::path, Stamp>& visited) {
    for (const auto& [file, stamp] : visited) {
      entry.files.insert(file);
      stamps.try_emplace(file, stamp);
    }
  }

  Device& device;
  std::vector<Mount> mounts;  // longest prefix first, the latest of equal ones first
  std::map<ProgramDesc, Entry> entries;
  std::map<fs::path, Stamp> stamps;
};

ShaderLibrary::ShaderLibrary(Device& device) : implementation_(std::make_unique<Implementation>(device)) {}

ShaderLibrary::~ShaderLibrary() = default;

void ShaderLibrary::mount(std::string prefix, std::span<const EmbeddedSource> sources,
                          fs::path overrideFolder) {
  Mount mount{std::move(prefix), {}, std::move(overrideFolder)};
  for (const EmbeddedSource& source : sources) mount.sources.emplace(source.path, source.text);
  auto& mounts = implementation_->mounts;
  const auto place = std::find_if(mounts.begin(), mounts.end(), [&](const Mount& other) {
    return other.prefix.size() <= mount.prefix.size();
  });
  mounts.insert(place, std::move(mount));
}

Program& ShaderLibrary::program(const ProgramDesc& desc) {
  auto& entries = implementation_->entries;
  const auto found = entries.find(desc);
  if (found != entries.end()) return found->second.program;
  Implementation::Entry entry;
  implementation_->build(desc, entry);
  return entries.emplace(desc, std::move(entry)).first->second.program;
}

bool ShaderLibrary::has(const ProgramDesc& desc) const {
  return implementation_->entries.contains(desc);
}

bool ShaderLibrary::mentions(const ProgramDesc& desc, std::string_view word) const {
  const auto found = implementation_->entries.find(desc);
  if (found == implementation_->entries.end()) return false;
  const auto has = [&](const std::string& text) { return hasWord(text, word); };
  if (std::ranges::any_of(found->second.texts, has)) return true;
  std::map<fs::path, Stamp> visited;
  return std::ranges::any_of(desc.files, [&](const std::string& file) {
    return has(implementation_->expand(desc, file, visited, UnreadIncludes::kept).text);
  });
}

ShaderLibrary::ReloadResult ShaderLibrary::reload() {
  std::set<fs::path> changed;
  for (auto& [file, stamp] : implementation_->stamps) {
    const Stamp now = stampOf(file);
    if (now == stamp) continue;
    stamp = now;
    changed.insert(file);
  }
  ReloadResult result{.changed = !changed.empty(), .reloaded = 0, .errors = {}};
  const auto isChanged = [&](const fs::path& file) { return changed.contains(file); };
  for (auto& [desc, entry] : implementation_->entries) {
    if (result.changed && std::any_of(entry.files.begin(), entry.files.end(), isChanged)) {
      entry.problem.clear();
      try {
        if (implementation_->build(desc, entry)) ++result.reloaded;
      } catch (const Error& error) {
        entry.problem = error.what();
      }
    }
    if (!entry.problem.empty()) result.errors.push_back(entry.problem);
  }
  return result;
}

std::string ShaderLibrary::expanded(const ProgramDesc& desc, std::string_view file) const {
  std::map<fs::path, Stamp> visited;
  return implementation_->expand(desc, std::string(file), visited).text;
}

std::string ShaderLibrary::standalone(const ProgramDesc& desc, std::string_view file) const {
  std::map<fs::path, Stamp> visited;
  return standaloneGlsl(implementation_->expand(desc, std::string(file), visited));
}

}  // namespace limn::gpu
