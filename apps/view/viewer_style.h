// Declares the style of the viewer's widgets, and the few widgets that ImGui lacks.
#pragma once

#include <imgui.h>

#include <glm/vec2.hpp>
#include <string>

#include "core/gpu/objects.h"

namespace limn::app {

/// Sets the style with text and widgets of that size (1: at 96 dots per inch). Called once, after ImGui's
/// context has been created.
void setStyle(float scale);
/// Returns whole pixels for a length that is stated in those of a monitor with 96 dots per inch.
float scaled(float pixels);

/// Returns the place as ImGui has it, pixels.
inline ImVec2 im(glm::vec2 place) {
  return {place.x, place.y};
}

/// Hold the panel's width at first and the height of the line below the picture, before scaled().
inline constexpr float kPanelWidth = 400, kStatusHeight = 28;

/// Holds the colour of text that says what is wrong.
inline const ImVec4 kProblemColour(1, 0.55f, 0.45f, 1);

/// Shows text that wraps at the panel's edge.
void wrapped(const std::string& text);
/// Shows wrapped text that explains.
void remark(const std::string& text);
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
/// Returns into how many columns a table that wide divides, each at least `column` wide: 1 to as many as
/// ImGui has.
int tableColumns(float room, float column);

/// Returns the texture as ImGui identifies it.
void* textureId(const gpu::Texture& texture);

}  // namespace limn::app
