// Declares what limn passes writes about the passes of a frame.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame/program_report.h"
#include "core/gpu/program_uniforms.h"
#include "core/render/renderer.h"

namespace limn::app {

struct ProgramRecord {
  frame::ProgramReport report;
  std::vector<std::string> shaders;         ///< file names, one for each of report.desc.files
  std::vector<gpu::UniformValue> uniforms;  ///< at the end of the pass
};

struct PassRecord {
  frame::PassReport report;
  std::vector<ProgramRecord> programs;  ///< none of passes that are left out
};

struct FrameRecord {
  std::vector<PassRecord> passes;              ///< in execution order, those that are left out last
  std::map<std::string, std::string> shaders;  ///< texts by file name; equal programs share one
  /// What the shaders of one pass read and leave, by file name: before/NAME.LEVEL of textures, before/NAME of
  /// buffers, after/ of what it writes. Rows from the bottom, tightly packed.
  std::map<std::string, std::vector<std::byte>> contents;
};

/// Renders two frames and returns what the passes of the second did, with the contents of what the pass
/// "TECHNIQUE/PASS" binds by name; "": of none. Throws UsageError where the frame has no such pass, or it
/// binds nothing.
FrameRecord recordFrame(render::Renderer& renderer, const std::string& contentsOf);

/// Returns the record as JSON, for programs. `files`: of the folder that it is written to; `complete`: they
/// are there.
std::string toJson(const FrameRecord& frame, const std::vector<std::string>& files, bool complete);
/// Returns the record as a Markdown page under `title`, for people.
std::string toMarkdown(const FrameRecord& frame, const std::string& title);

/// Returns the files that a record lists which toJson() wrote; nothing for any other text.
std::optional<std::vector<std::string>> filesOf(const std::string& json);

}  // namespace limn::app
