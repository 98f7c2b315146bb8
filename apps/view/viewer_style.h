// How the viewer's widgets look, and the few that it has beyond ImGui's.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "core/gpu/objects.h"

namespace limn::app {

/// Once, after ImGui's context was made.
void setStyle();

/// Text that breaks at the panel's edge.
void wrapped(const std::string& text);
/// The same, in the colour of things that went wrong.
void complaint(const std::string& text);
/// For the widget before.
void tip(const std::string& text);
/// A row of a two-column table: name with explanation, then the place for a widget as wide as the column.
void nameCell(const char* name, const std::string& explanation);
/// Begins and ends such a table.
bool beginRows(const char* name);
void endRows();

/// For ImGui's pictures.
void* textureId(const gpu::Texture& texture);

}  // namespace limn::app
