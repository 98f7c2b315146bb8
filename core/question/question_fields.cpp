#include "core/question/question_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "core/base/text.h"
#include "core/question/term.h"

namespace limn {
namespace {

using Q = SceneQuestion;
using enum QuestionEffect;

constexpr QuestionField text(const char* key, const char* flag, std::string Q::*member, const char* doc) {
  return {key, flag, QuestionKind::text, member, doc};
}
constexpr QuestionField texts(const char* key, const char* flag, std::vector<std::string> Q::*member,
                              const char* doc) {
  return {key, flag, QuestionKind::texts, member, doc};
}
constexpr QuestionField choice(const char* key, const char* flag, std::string Q::*member,
                               std::span<const char* const> names, const char* doc) {
  return QuestionField{key, flag, QuestionKind::choice, member, doc}.oneOf(names);
}
constexpr QuestionField coefficient(const char* key, const char* flag, std::string Q::*member,
                                    const char* doc) {
  return QuestionField{key, flag, QuestionKind::coefficient, member, doc}.within({0, 1e9}, "");
}
constexpr QuestionField real(const char* key, const char* flag, double Q::*member, ParameterRange range,
                             const char* unit, const char* doc) {
  return QuestionField{key, flag, QuestionKind::real, member, doc}.within(range, unit);
}
constexpr QuestionField optionalReal(const char* key, const char* flag, std::optional<double> Q::*member,
                                     ParameterRange range, const char* doc) {
  return QuestionField{key, flag, QuestionKind::optionalReal, member, doc}.within(range, "");
}
constexpr QuestionField integer(const char* key, const char* flag, int Q::*member, ParameterRange range,
                                const char* unit, const char* doc) {
  return QuestionField{key, flag, QuestionKind::integer, member, doc}.within(range, unit);
}
constexpr QuestionField size(const char* key, const char* flag, QuestionSizeMember member, double largest,
                             const char* unit, const char* doc) {
  return QuestionField{key, flag, QuestionKind::size, member, doc}.within({1, largest}, unit);
}

/// Returns that member of the rows of all terms that a picture can show.
constexpr auto ofPicturedTerms(const char* TermInfo::*member) {
  std::array<const char*, std::popcount(kPicturedTerms)> texts{};
  size_t count = 0;
  for (const TermInfo& info : kTerms)
    if (contains(kPicturedTerms, info.term)) texts[count++] = info.*member;
  return texts;
}

constexpr auto kTermNames = ofPicturedTerms(&TermInfo::name), kTermDocs = ofPicturedTerms(&TermInfo::help);
constexpr const char* kWhenDefaultLights[] = {"auto", "on", "off"};
constexpr const char* kOffOn[] = {"off", "on"};
constexpr const char* kShapes[] = {"squares", "rectangles"};
constexpr const char* kReflections[] = {"area", "centre"};
constexpr const char* kCombines[] = {"add", "ratio"};

constexpr QuestionGroup kSubject = QuestionGroup::subject, kEnvironment = QuestionGroup::environment,
                        kMedium = QuestionGroup::medium;

constexpr QuestionField kFields[] = {
    text("scene", "scene", &Q::scene,
         "glTF 2.0 scene (.gltf, .glb), or the name of one of limn's own; limn import converts other\n"
         "formats")
        .in(kSubject)
        .placed(1),
    text("camera", "--camera", &Q::camera, "Camera by name or #index")
        .in(kSubject)
        .changing(view)
        .sweptAs("cameras")
        .placed(2, "", "first camera"),
    text("eye", "--eye", &Q::eye, "Camera position x,y,z in metres (with --target)").changing(view),
    text("target", "--target", &Q::target, "Point at which the camera looks, x,y,z in metres").changing(view),
    real("fov", "--fov", &Q::fov, {0.1, 179}, "degrees", "Vertical field of view").changing(view),
    text("light", "--light", &Q::light, "Only this light, by name or #index")
        .in(kSubject)
        .changing(view)
        .sweptAs("lights")
        .placed(3, "", "all lights"),
    size("size", "--size", {&Q::width, &Q::height}, 16384, "pixels", "Picture size WxH")
        .in(kSubject)
        .changing(view)
        .sweptAs("sizes")
        .placed(6),
    integer(
        "aa", "--aa", &Q::aa, {1, 16}, "",
        "N x N samples in each pixel, averaged in linear light, in pictures and references alike: a picture\n"
        "takes N x N frames")
        .changing(view),
    choice("term", "--output-term", &Q::term, kTermNames, "Which part of the light the picture shows")
        .alsoGivenBy("--term")
        .meaning(kTermDocs)
        .in(kSubject)
        .changing(view)
        .placed(5),
    real("time", "--time", &Q::time, {-1e6, 1e6}, "seconds", "Animation time")
        .in(kSubject)
        .changing(QuestionEffect::time)
        .placed(4, "t"),
    text("animation", "--animation", &Q::animation, "Animation by name or #index (default: the first)"),
    real("light_size", "--light-size", &Q::lightSize, {1e-9, 1e9}, "",
         "Side of every area light in metres, angular diameter of directional lights in radians;\n"
         "intensities do not change")
        .in(kSubject)
        .changing(lights)
        .sweptAs("light_sizes")
        .labelled("light size")
        .later(),
    texts("set_light", "--set-light", &Q::lightSettings,
          "NAME.PROPERTY=VALUE, repeatable; PROPERTY is position=x,y,z (metres), rotation=pitch,yaw,roll\n"
          "(degrees, of a light that shines along -z), size=u,v (metres; directional: radians),\n"
          "colour=r,g,b or intensity=I (W/sr; directional: W/m^2). Emissive quads are lights as well:\n"
          "they have the name of their node, and the node moves with them")
        .changing(lights)
        .labelled(""),
    choice(
        "default_lights", "--default-lights", &Q::defaultLights, kWhenDefaultLights,
        "auto: a scene with neither lights nor --environment gets a key light from above the camera's left\n"
        "shoulder, a headlight in the camera (--light key, --light headlight) and the environment studio;\n"
        "on: every scene, which keeps its environment if it has one; off: none")
        .labelled("default lights"),
    text("environment", "--environment", &Q::environment,
         "Equirectangular .hdr or .exr, or the name of one of limn's own: sky, studio")
        .in(kEnvironment)
        .storedAs("map")
        .labelled("")
        .ofFile(),
    real("environment_rotation", "--environment-rotation", &Q::environmentRotation, {-1e6, 1e6}, "degrees",
         "Rotation of the environment about the vertical axis")
        .changing(lights)
        .labelled("environment rotation"),
    real("environment_scale", "--environment-scale", &Q::environmentScale, {0, 1e9}, "",
         "Factor on the environment's radiance")
        .changing(lights)
        .labelled("environment scale"),
    choice("unshadowed", "--unshadowed", &Q::unshadowed, kOffOn,
           "on: nothing keeps light from arriving in the reference (V = 1), so that the error of what is\n"
           "approximated without shadows can be told from their absence; techniques do not change")
        .changing(view),
    choice("relief_paths", "--relief-paths", &Q::reliefPaths, kReliefPaths,
           "Which paths the reference's indirect light takes: relief: those with light from bump to bump of\n"
           "one height map; others: those without; both; techniques do not change")
        .changing(view)
        .labelled("relief paths"),
    choice(
        "subsurface", "--subsurface", &Q::subsurface, kSubsurfaceModels,
        "How the reference follows light below translucent surfaces: bssrdf: by the dipole's profile over\n"
        "the distance; walk: a random walk inside closed bodies; local: light leaves where it enters;\n"
        "techniques do not change")
        .changing(view)
        .labelled("subsurface"),
    choice("displaced", "--displaced", &Q::displaced, kOffOn,
           "on: meshes take the place of height maps, in pictures and in the reference: what bump mapping\n"
           "leaves out is the difference, which is no error of a technique"),
    choice(
        "floor", "--floor", &Q::floor, kOffOn,
        "on: a diffuse square below the scene, 7 radii wide, that receives its shadows, in pictures and in\n"
        "the reference"),
    real(
        "environment_lights", "--environment-lights", &Q::environmentLights, {1e-4, 0.5}, "",
        "Replace the environment by area lights, which techniques can shadow. The value is the least share "
        "of\n"
        "a light's energy that a further row of texels must add for the light to grow; smaller: fewer lights")
        .in(kEnvironment)
        .storedAs("lights")
        .sweptAs("environment_lights")
        .orDefault()
        .approximating(),
    integer("environment_resolution", "--environment-resolution", &Q::environmentResolution, {1, 512}, "",
            "Texels per side of the cube map's faces on which the environment's area lights are found")
        .in(kEnvironment)
        .storedAs("resolution")
        .approximating(),
    choice("environment_shape", "--environment-shape", &Q::environmentShape, kShapes,
           "Shape of the environment's area lights: squares or rectangles")
        .in(kEnvironment)
        .storedAs("shape")
        .approximating(),
    choice(
        "environment_reflection", "--environment-reflection", &Q::environmentReflection, kReflections,
        "How surfaces reflect the environment's area lights: area: as areas; centre: as if all light came\n"
        "from the centre")
        .in(kEnvironment)
        .storedAs("reflection")
        .approximating(),
    choice(
        "environment_combine", "--environment-combine", &Q::environmentCombine, kCombines,
        "What surfaces reflect of the environment's area lights: add: the sum of them; ratio: the map "
        "itself,\n"
        "as far as the lights are seen, so that highlights show the map. It takes a technique that answers\n"
        "visibility; where one answers environment or direct, or of one light alone, nothing changes")
        .in(kEnvironment)
        .storedAs("combine")
        .later()
        .approximating(),
    coefficient("sigma_a", "--sigma-a", &Q::sigmaA,
                "Absorption coefficient of the medium per metre: one number or red,green,blue.\n"
                "With /scene behind it per diameter of the scene: 0.5/scene is an optical depth\n"
                "of 0.5 across it")
        .in(kMedium),
    coefficient("sigma_s", "--sigma-s", &Q::sigmaS,
                "Scattering coefficient of the medium, likewise; 0: no scattering")
        .in(kMedium),
    optionalReal("g", "--g", &Q::g, {-0.999, 0.999},
                 "Mean cosine of the medium's phase function (Henyey-Greenstein); > 0: forward")
        .in(kMedium)
        .sweptAs("g"),
    text("grid", "--grid", &Q::grid,
         "Density of the medium: an OpenVDB file with a grid 'density' (factors on the coefficients), smoke\n"
         "(procedural, animated) or none (homogeneous)"),
};

std::vector<std::string> asTexts(const std::string& value) {
  if (value.empty()) return {};
  return {value};
}
std::vector<std::string> asTexts(const std::vector<std::string>& values) {
  return values;
}
std::vector<std::string> asTexts(double value) {
  return {fmt::format("{}", value + 0.0)};  // -0 asks for the same as 0
}
std::vector<std::string> asTexts(int value) {
  return {fmt::format("{}", value)};
}
std::vector<std::string> asTexts(const std::optional<double>& value) {
  if (!value) return {};
  return asTexts(*value);
}
std::vector<std::string> asTexts(const std::pair<int, int>& value) {
  return {fmt::format("{}x{}", value.first, value.second)};
}

}  // namespace

const char* name(QuestionGroup group) {
  switch (group) {
    case QuestionGroup::subject:
      return "";
    case QuestionGroup::environment:
      return "environment";
    case QuestionGroup::medium:
      return "medium";
    case QuestionGroup::changes:
      return "changes";
  }
  return "";
}

std::span<const QuestionField> questionFields() {
  return kFields;
}

const QuestionField& questionField(std::string_view key) {
  const auto* found =
      std::ranges::find(kFields, key, [](const QuestionField& f) { return std::string_view(f.key); });
  if (found == std::end(kFields)) throw std::logic_error(fmt::format("a question has no field {}", key));
  return *found;
}

std::string unknownChoice(const QuestionField& field, std::string_view text) {
  const std::vector<std::string> known(field.choices.begin(), field.choices.end());
  return fmt::format("unknown {} '{}'{}; known are {}", field.key, text, didYouMean(text, known),
                     fmt::join(known, ", "));
}

const char* keyInSuite(const QuestionField& field) {
  return field.suiteKey ? field.suiteKey : field.key;
}

const char* keyInRow(const QuestionField& field) {
  return field.rowKey ? field.rowKey : field.key;
}

bool isDefault(const QuestionField& field, const SceneQuestion& question) {
  return visitField(field, question,
                    [](const auto& value, const auto& standard) { return value == standard; });
}

void copyField(const QuestionField& field, SceneQuestion& to, const SceneQuestion& from) {
  std::visit(
      [&](auto member) {
        if constexpr (std::is_same_v<decltype(member), QuestionSizeMember>) {
          to.*member.width = from.*member.width;
          to.*member.height = from.*member.height;
        } else {
          to.*member = from.*member;
        }
      },
      field.member);
}

void copyFields(QuestionEffect effect, SceneQuestion& to, const SceneQuestion& from) {
  for (const QuestionField& field : kFields)
    if (field.effect == effect) copyField(field, to, from);
}

bool sameFields(QuestionEffect effect, const SceneQuestion& a, const SceneQuestion& b) {
  SceneQuestion merged = a;
  copyFields(effect, merged, b);
  return merged == a;
}

std::vector<std::string> printed(const QuestionField& field, const SceneQuestion& question) {
  return visitField(field, question, [](const auto& value, const auto&) { return asTexts(value); });
}

std::optional<std::pair<int, int>> parsePictureSize(std::string_view text) {
  static const ParameterRange range = questionField("size").range;
  const std::size_t x = text.find('x');
  const auto side = [](std::string_view digits) -> std::optional<int> {
    const std::optional<int> value = parseWhole<int>(digits);
    return value && *value >= range.low && *value <= range.high ? value : std::nullopt;
  };
  if (x == std::string_view::npos) return std::nullopt;
  const std::optional<int> width = side(text.substr(0, x)), height = side(text.substr(x + 1));
  if (!width || !height) return std::nullopt;
  return std::pair(*width, *height);
}

std::string subjectText(const SceneQuestion& question, QuestionWording wording) {
  std::map<int, std::string> parts;
  for (const QuestionField& field : kFields) {
    const bool label = wording == QuestionWording::label;
    if (field.place == 0 || (label && field.effect == QuestionEffect::time)) continue;
    const std::vector<std::string> values = printed(field, question);
    parts[field.place] = values.empty() ? (label ? field.unset : "") : field.label + values.front();
  }
  std::vector<std::string> inOrder;
  for (const auto& [place, part] : parts) inOrder.push_back(part);
  return fmt::format("{}", fmt::join(inOrder, "/"));
}

std::string describe(const SceneQuestion& question, QuestionGroup group, QuestionWording wording) {
  std::vector<std::string> words;
  for (const QuestionField& field : kFields) {
    if (field.group != group || field.place != 0 || field.approximates || isDefault(field, question))
      continue;
    const std::string label = field.label ? field.label : field.key;
    for (std::string& value : printed(field, question)) {
      if (field.file && wording == QuestionWording::label)
        value = std::filesystem::path(value).filename().string();
      words.push_back(label.empty() ? value : label + " " + value);
    }
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string describeEnvironmentLights(const SceneQuestion& question) {
  if (!(question.environmentLights > 0)) return {};
  std::vector<std::string> words;
  for (const QuestionField& field : kFields)
    if (field.approximates && !(field.addedLater && isDefault(field, question)))
      for (std::string& value : printed(field, question)) words.push_back(std::move(value));
  return fmt::format("{}", fmt::join(words, " "));
}

std::string questionText(const SceneQuestion& question) {
  std::string text;
  for (const QuestionField& field : kFields) {
    if (isDefault(field, question)) continue;
    // Separators that no value contains keep different questions different.
    text += fmt::format("\x1e{}", field.key);
    for (const std::string& value : printed(field, question)) text += "\x1f" + value;
  }
  return text;
}

}  // namespace limn
