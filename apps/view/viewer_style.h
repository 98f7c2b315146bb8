// Declares the style of the viewer's widgets, and the few widgets that ImGui lacks.
#pragma once

#include <glm/vec2.hpp>
#include <string>

#include "core/gpu/objects.h"

namespace limn::app {

/// Sets the style. Called once, after ImGui's context has been created.
void setStyle();

/// Shows text that wraps at the panel's edge.
void wrapped(const std::string& text);
/// Shows wrapped text in the colour of errors.
void complaint(const std::string& text);
/// Gives the previous widget a tooltip.
void tip(const std::string& text);
/// Begins a row of a two-column table: name with explanation, then the place for a widget as wide as the
/// column.
void nameCell(const char* name, const std::string& explanation);
/// Begins such a table and returns whether it is shown; endRows() ends one that is.
bool beginRows(const char* name);
void endRows();

/// Returns the texture as ImGui identifies it.
void* textureId(const gpu::Texture& texture);

}  // namespace limn::app
