#include "apps/view/parameter_widgets.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <limits>

#include "apps/view/viewer_style.h"

namespace limn::app {
namespace {

/// As ImGui prints a slider's value, with the unit, which is text to the letter.
std::string format(const char* number, const Parameter& p) {
  std::string text = *p.unit ? fmt::format("{} ", number) : number;
  for (const char* c = p.unit; *c; ++c) text.append(*c == '%' ? size_t{2} : size_t{1}, *c);
  return text;
}

/// What the parameter does, and within which range.
std::string helpOf(const Parameter& p) {
  if (p.type == ParameterType::boolean || p.type == ParameterType::choice) return p.doc;
  return fmt::format("{}\n{:g} to {:g}{}{}", p.doc, p.range.low, p.range.high, *p.unit ? " " : "", p.unit);
}

/// ImGui's logarithmic sliders take 0 into a range by a dead zone of their own.
ImGuiSliderFlags sliderFlags(const Parameter& p) {
  return ImGuiSliderFlags_AlwaysClamp | (p.logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
}

/// The part of a range that sliders can show: ImGui ends the program at one over more than half of the
/// numbers.
template <class Number>
ParameterRange sliderRange(const Parameter& p) {
  constexpr double most = static_cast<double>(std::numeric_limits<Number>::max()) / 2;
  return {std::clamp(p.range.low, -most, most), std::clamp(p.range.high, -most, most)};
}

/// The shortest text that is the same float. At the ends of the slider it is that of the range, which may lie
/// between two floats, and beyond which ImGui rounds to the digits that are shown.
std::string realText(const ParameterRange& range, float value) {
  if (value <= static_cast<float>(range.low)) return fmt::format("{}", range.low);
  if (value >= static_cast<float>(range.high)) return fmt::format("{}", range.high);
  return fmt::format("{}", value);
}

/// The new value as the command line would say it; empty: unchanged.
std::string widget(const Parameter& p, const ParameterValues& values) {
  ImGui::SetNextItemWidth(-1);
  switch (p.type) {
    case ParameterType::boolean: {
      bool value = values.boolean(p.name);
      return ImGui::Checkbox("##value", &value) ? (value ? "true" : "false") : "";
    }
    case ParameterType::integer: {
      int value = values.integer(p.name);
      const ParameterRange range = sliderRange<int>(p);
      const int low = static_cast<int>(range.low), high = static_cast<int>(range.high);
      return ImGui::SliderInt("##value", &value, low, high, format("%d", p).c_str(), sliderFlags(p))
                 ? std::to_string(value)
                 : "";
    }
    case ParameterType::real: {
      float value = values.real(p.name);
      const ParameterRange range = sliderRange<float>(p);
      const auto low = static_cast<float>(range.low), high = static_cast<float>(range.high);
      return ImGui::SliderFloat("##value", &value, low, high, format("%.4g", p).c_str(), sliderFlags(p))
                 ? realText(range, value)
                 : "";
    }
    case ParameterType::choice: {
      int value = values.choice(p.name);
      return ImGui::Combo("##value", &value, p.choices, p.choiceCount) ? p.choices[value] : "";
    }
  }
  return "";
}

}  // namespace

bool parameterWidgets(ParameterValues& values, const ParameterValues& defaults) {
  const auto now = values.printed(), standard = defaults.printed();
  bool changed = false;
  if (!ImGui::BeginTable("parameters", 3, ImGuiTableFlags_SizingStretchProp)) return false;
  ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 0.45f);
  ImGui::TableSetupColumn("value", ImGuiTableColumnFlags_WidthStretch, 0.55f);
  ImGui::TableSetupColumn("reset", ImGuiTableColumnFlags_WidthFixed, ImGui::GetFrameHeight());
  for (size_t i = 0; i < now.size(); ++i) {
    const Parameter& p = values.declared()[i];
    ImGui::PushID(p.name);
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(p.name);
    tip(helpOf(p));
    ImGui::TableNextColumn();
    std::string text = widget(p, values);
    tip(helpOf(p));
    ImGui::TableNextColumn();
    if (now[i].second != standard[i].second) {
      if (ImGui::Button("x", {-1, 0})) text = standard[i].second;
      tip("back to " + standard[i].second);
    }
    if (!text.empty()) {
      values.set(p.name, text);
      changed = true;
    }
    ImGui::PopID();
  }
  ImGui::EndTable();
  return changed;
}

}  // namespace limn::app
