#include "core/gpu/private/glsl_preprocessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "core/base/error.h"
#include "core/gpu/private/glsl_conditions.h"
#include "core/gpu/private/glsl_lines.h"

namespace limn::gpu {
namespace {

std::string normalised(const std::filesystem::path& path) {
  return path.lexically_normal().generic_string();
}

bool isIdentifier(std::string_view text) {
  const auto isWord = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 &&
         std::all_of(text.begin(), text.end(), isWord);
}

class Expander {
 public:
  Expander(const SourceLookup& lookup, UnreadIncludes unread) : lookup_(lookup), unread_(unread) {}

  ExpandedSource run(const std::string& entry, const std::map<std::string, std::string>& defines) {
    result_.text = "#version 450 core\n";
    for (const auto& [name, value] : defines) define(name, value);
    defines_ = &defines;
    known_ = defines;
    const auto text = lookup_(entry);
    if (!text) throw Error(fmt::format("shader file '{}' does not exist", entry));
    appendFile(entry, *text, false);
    return std::move(result_);
  }

 private:
  void define(const std::string& name, const std::string& value) {
    if (!isIdentifier(name) || value.find_first_of("\n\r\\") != std::string::npos) {
      throw Error(fmt::format("shader define '{}' = '{}': accepted are an identifier and a value on one line",
                              name, value));
    }
    result_.text += fmt::format("#define {} {}\n", name, value);
  }

  /// Source string number of a file.
  size_t numberOf(const std::string& path) {
    const auto found = std::find(result_.files.begin(), result_.files.end(), path);
    if (found == result_.files.end()) {
      result_.files.push_back(path);
      return result_.files.size() - 1;
    }
    return static_cast<size_t>(found - result_.files.begin());
  }

  /// From here on the compiler counts from `line` (1 is the first) of `file`.
  void appendLineMark(size_t line, size_t file) { result_.text += fmt::format("#line {} {}\n", line, file); }

  void appendFile(const std::string& path, const std::string& text, bool conditional) {
    const GlslFile file(text);
    const size_t number = numberOf(path);
    stack_.push_back(path);
    appendLineMark(1, number);
    OpenConditions conditions;
    bool miscounted = false;  // by a compiler that reads on behind this line
    for (size_t i = 0; i < file.lines.size(); ++i) {
      const GlslLine& line = file.lines[i];
      if (line.directive == "version") {
        throw Error(fmt::format("{}:{}: #version is written by the library: remove it", path, i + 1));
      }
      for (const std::string& macro : line.requiredMacros) {
        appendRequirement(macro, i + 1, number);
        conditions.inserted();
      }
      miscounted = conditions.follow(line, known_) || miscounted;
      const Holds here = conditions.here();
      if (line.directive == "undef" && here != Holds::no) known_.erase(line.argument);
      if (line.directive == "include") {
        const bool unread = here == Holds::no && unread_ == UnreadIncludes::leftOut;
        if (!unread) {
          appendIncludeUnder(here, path, i + 1, line.argument, conditional);
          conditions.inserted();
        }
        appendLineMark(i + 2, number);  // one line for one where it is not read either
        miscounted = false;
      } else {
        result_.text.append(line.text).push_back('\n');
        const bool goesOn = line.text.find('\\') != std::string_view::npos;
        if (miscounted && !goesOn) {
          appendLineMark(i + 2, number);
          miscounted = false;
        }
      }
    }
    stack_.pop_back();
  }

  /// What an include brings under a condition of its file is there for certain as long as that lasts.
  void appendIncludeUnder(Holds condition, const std::string& from, size_t line, const std::string& argument,
                          bool conditional) {
    if (condition == Holds::yes) return appendInclude(from, line, argument, conditional);
    std::set<std::string> before = complete_;
    appendInclude(from, line, argument, true);
    complete_ = std::move(before);
  }

  void appendRequirement(const std::string& macro, size_t line, size_t file) {
    result_.text += fmt::format("#ifndef {}\n", macro);
    appendLineMark(line, file);
    result_.text += fmt::format("#error {} is tested but not defined\n#endif\n", macro);
    appendLineMark(line, file);
  }

  void appendInclude(const std::string& from, size_t line, const std::string& argument, bool conditional) {
    const auto refuse = [&](const std::string& problem) {
      if (!conditional) throw Error(fmt::format("{}:{}: {}", from, line, problem));
      appendLineMark(line, numberOf(from));
      result_.text += fmt::format("#error {}\n", problem);
    };
    const auto named = defines_->find(argument);
    const bool quoted = argument.size() >= 3 && argument.front() == '"' && argument.back() == '"';
    if (!quoted && named == defines_->end()) {
      return refuse(
          fmt::format("include {} is not of the form \"path\", nor a define of the program", argument));
    }
    const std::string wanted = quoted ? argument.substr(1, argument.size() - 2) : named->second;
    const std::string beside = normalised(std::filesystem::path(from).parent_path() / wanted);
    for (const std::string& path : {beside, normalised(wanted)}) {
      if (path.starts_with("../") || path.starts_with('/')) continue;
      if (const auto text = lookup_(path)) return appendGuarded(from, line, path, *text, conditional);
    }
    refuse(
        fmt::format("include '{}' not found (looked for '{}' and '{}')", wanted, beside, normalised(wanted)));
  }

  void appendGuarded(const std::string& from, size_t line, const std::string& path, const std::string& text,
                     bool conditional) {
    if (std::find(stack_.begin(), stack_.end(), path) != stack_.end()) {
      throw Error(fmt::format("{}:{}: '{}' includes itself: {} -> {}", from, line, path,
                              fmt::join(stack_, " -> "), path));
    }
    if (complete_.contains(path)) return;
    const size_t number = numberOf(path);
    result_.text += fmt::format("#ifndef LIMN_INCLUDED_{0}\n#define LIMN_INCLUDED_{0}\n", number);
    appendFile(path, text, conditional);
    result_.text += "#endif\n";
    complete_.insert(path);
  }

  const SourceLookup& lookup_;
  const UnreadIncludes unread_;
  const std::map<std::string, std::string>* defines_ = nullptr;
  std::map<std::string, std::string> known_;  // those that no file may have undefined
  ExpandedSource result_;
  std::vector<std::string> stack_;  // files being included, outermost first
  std::set<std::string> complete_;  // files that are certainly there already where the compiler reads on
};

}  // namespace

ExpandedSource expandGlsl(const std::string& entry, const std::map<std::string, std::string>& defines,
                          const SourceLookup& lookup, UnreadIncludes unread) {
  return Expander(lookup, unread).run(entry, defines);
}

std::string standaloneGlsl(const ExpandedSource& source) {
  enum class Branch {
    glsl,
    cpp,
    other
  };  // of an open #if: what GLSL reads, what C++ reads, a condition on anything else
  std::vector<Branch> open;
  const auto dropped = [&] { return std::ranges::find(open, Branch::cpp) != open.end(); };
  std::string text;
  size_t current = source.files.size(), shown = current;
  for (const GlslLine& line : GlslFile(source.text).lines) {
    if (line.directive == "line") {
      current = std::stoul(line.argument.substr(line.argument.find(' ')));
      continue;
    }
    bool keep = !dropped();
    if (line.directive.starts_with("if")) {
      const bool cpp = line.argument == "__cplusplus" && line.directive != "if";
      open.push_back(!cpp ? Branch::other : line.directive == "ifdef" ? Branch::cpp : Branch::glsl);
      keep = keep && !cpp;
    } else if (line.directive == "else" && !open.empty() && open.back() != Branch::other) {
      open.back() = open.back() == Branch::cpp ? Branch::glsl : Branch::cpp;
      keep = false;
    } else if (line.directive == "endif" && !open.empty()) {
      keep = keep && open.back() == Branch::other;
      open.pop_back();
    }
    if (!keep) continue;
    const bool content =
        line.directive.empty() && line.text.find_first_not_of(" \t") != std::string_view::npos;
    if (content && current != shown && current < source.files.size())
      text += fmt::format("// ---- {}\n", source.files[current]);
    if (content) shown = current;
    text.append(line.text).push_back('\n');
  }
  return text;
}

}  // namespace limn::gpu
