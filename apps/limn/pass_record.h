// Declares what limn passes writes about the passes of a frame.
#pragma once

#include <map>
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
  /// What one pass reads and leaves, by file name: before/NAME.LEVEL of textures, before/NAME of buffers,
  /// after/ of what it writes. Rows from the bottom, tightly packed.
  std::map<std::string, std::vector<std::byte>> contents;
};

/// Renders the first frame and returns what its passes did, with the contents of what the pass
/// "TECHNIQUE/PASS" binds;
/// "": of none. Waits for the GPU after each pass. Throws UsageError where the frame has no such pass.
FrameRecord recordFrame(render::Renderer& renderer, const std::string& contentsOf);

/// Returns the record as JSON, for programs.
std::string toJson(const FrameRecord& frame);
/// Returns the record as a Markdown page under `title`, for people.
std::string toMarkdown(const FrameRecord& frame, const std::string& title);

}  // namespace limn::app
