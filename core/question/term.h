// Declares the terms of the rendering equation as data: the name of each, its light paths, which techniques
// may answer it and what can be requested of its reference. Names, help texts, menus, `limn list`, which
// techniques can be combined and which requests the reference accepts are derived from here. A new term is an
// enumerator and a row; core/render/build_graph.cpp and core/reference compute it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/export.h"

namespace limn {

/// Names a term of the rendering equation, or `final`, their sum. Each is a bit of a TermSet.
enum class Term : uint32_t {
  visibility = 1,
  direct = 2,
  indirect = 4,
  caustic = 8,
  media = 16,
  environment = 32,
  specular = 64,
  final = 128,
  surface = 256,
  relief = 512,
  subsurface = 1024
};
using TermSet = uint32_t;
constexpr TermSet operator|(Term a, Term b) {
  return static_cast<TermSet>(a) | static_cast<TermSet>(b);
}
constexpr TermSet operator|(TermSet a, Term b) {
  return a | static_cast<TermSet>(b);
}
constexpr TermSet termSet(Term term) {
  return static_cast<TermSet>(term);
}
constexpr bool contains(TermSet set, Term term) {
  return (set & static_cast<TermSet>(term)) != 0;
}

/// Says when a picture can show the term alone.
enum class TermPicture : uint8_t {
  none,      ///< never: it is part of another term's picture
  answered,  ///< when a technique answers it
  always     ///< even without a technique
};

/// Says which numbers of bounces the term's reference takes.
enum class TermBounces : uint8_t {
  none,      ///< only 0: no light comes over other surfaces
  fromZero,  ///< 0 or more; 0 by default
  fromOne    ///< 1 or more; 1 by default
};

/// Says which numbers of smooth interfaces the term's reference takes.
enum class TermInterfaces : uint8_t {
  none,   ///< only 0
  light,  ///< on the light's way: 0 (off one, or into an object and out of it, as techniques have it) or all
  fromZero,  ///< those between the camera and what it sees: 0 or more, or all; 0 by default
  fromOne    ///< the same, 1 or more, or all; those of image space by default
};

struct TermInfo {
  Term term;
  const char* name;        ///< in flags, suites, rows and pictures' metadata
  const char* paths;       ///< of light, as Heckbert writes it; S, M, B: a smooth surface, the medium, a body
  const char* help;        ///< a phrase that says what a picture of it shows
  const char* unanswered;  ///< its value when no technique answers it
  bool answerable;         ///< techniques may answer it
  TermPicture picture;
  /// Names what only one technique may answer; terms with equal words exclude each other. Null: answers of
  /// several techniques are added.
  const char* exclusive;
  TermBounces bounces;
  TermInterfaces interfaces;
  bool background;  ///< the term is also where no surface is seen: comparisons include these pixels
  /// Holds the value that hashes of references use for the term; -1 without a picture. It never changes,
  /// because cached references would not be found any more.
  int hashed;
};

// clang-format off
inline constexpr TermInfo kTerms[] = {
    {Term::final, "final", "all",
     "the whole picture: emission, background and the sum of the terms", "the sum of what stands for the terms",
     false, TermPicture::always, nullptr, TermBounces::fromZero, TermInterfaces::fromZero, false, 2},
    {Term::visibility, "visibility", "a factor of L D E",
     "V_l, the part of light l (--light) that a pixel sees, 0 to 1", "1",
     true, TermPicture::answered, "direct light", TermBounces::none, TermInterfaces::none, false, 1},
    {Term::relief, "relief", "a factor of L D E",
     "W_l, the part of light l (--light) that a height map's bumps leave to a pixel, 0 to 1", "1",
     true, TermPicture::answered, "shadows of bumps", TermBounces::none, TermInterfaces::none, false, 7},
    {Term::direct, "direct", "L D E",
     "reflected direct light, shadows included", "L_u V T_l, summed over the lights",
     true, TermPicture::always, "direct light", TermBounces::none, TermInterfaces::none, false, 0},
    {Term::environment, "environment", "L D E",
     "the environment map's part of direct light, shadows included, in place of lights that stand for it",
     "unshadowed, or decomposed into lights",
     true, TermPicture::none, "the environment's light", TermBounces::none, TermInterfaces::none, false, -1},
    {Term::indirect, "indirect", "L D+ D E",
     "light that comes over other surfaces", "0",
     true, TermPicture::answered, nullptr, TermBounces::fromOne, TermInterfaces::none, false, 3},
    {Term::subsurface, "subsurface", "L D* B E",
     "light that entered translucent surfaces and left them again", "the local limit: it leaves where it entered",
     true, TermPicture::always, "light below surfaces", TermBounces::fromZero, TermInterfaces::none, false, 8},
    {Term::caustic, "caustic", "L S+ D E",
     "light that comes off mirrors and through glass", "0",
     true, TermPicture::answered, nullptr, TermBounces::none, TermInterfaces::light, false, 4},
    {Term::media, "media", "L S* M E",
     "light that the medium scatters once", "0",
     true, TermPicture::answered, nullptr, TermBounces::none, TermInterfaces::light, true, 5},
    {Term::specular, "specular", "L D+ S+ E, L S+ E",
     "what the camera sees in mirrors and glass, without caustics and light in the medium",
     "the environment alone, mirrored and refracted once",
     true, TermPicture::answered, "specular surfaces", TermBounces::fromZero, TermInterfaces::fromOne, false, 6},
    {Term::surface, "surface", "a factor of every D",
     "how material models (extras.limn_material) reflect light: f cos", "the models' exact f cos",
     true, TermPicture::none, "how materials reflect", TermBounces::none, TermInterfaces::none, false, -1},
};
// clang-format on

/// Returns the terms for whose rows `holds` is true.
template <class Predicate>
constexpr TermSet termsWhere(Predicate holds) {
  TermSet terms = 0;
  for (const TermInfo& info : kTerms)
    if (holds(info)) terms = terms | info.term;
  return terms;
}

constexpr TermSet kAnswerableTerms = termsWhere([](const TermInfo& info) { return info.answerable; });
constexpr TermSet kPicturedTerms =
    termsWhere([](const TermInfo& info) { return info.picture != TermPicture::none; });

/// Returns every term that only the technique that answers `terms` may answer, including `terms` themselves
/// when they are exclusive.
constexpr TermSet exclusiveWith(TermSet terms) {
  return termsWhere([&](const TermInfo& other) {
    for (const TermInfo& own : kTerms)
      if (contains(terms, own.term) && own.exclusive && other.exclusive &&
          std::string_view(own.exclusive) == other.exclusive)
        return true;
    return false;
  });
}

/// Returns every term that no other technique may answer beside one that answers `terms`: those that exclude
/// each other, and relief beside direct light, which would have to hold that factor itself.
constexpr TermSet refusedBeside(TermSet terms) {
  TermSet refused = exclusiveWith(terms);
  if (contains(terms, Term::relief)) refused = refused | Term::direct;
  if (contains(terms, Term::direct)) refused = refused | Term::relief;
  return refused;
}

/// Returns whether the term is a factor of one light: its picture shows that of one, 0 to 1.
constexpr bool isFactor(Term term) {
  return term == Term::visibility || term == Term::relief;
}

/// Returns whether a picture of the term shows something where no surface is seen.
constexpr bool showsBackground(Term term, bool environment, bool medium) {
  return (term == Term::final && (environment || medium)) || (term == Term::media && medium);
}

/// Returns the row of one term. Throws std::logic_error for a value that is not a term.
LIMN_API const TermInfo& termInfo(Term term);
LIMN_API const char* name(Term term);
/// Returns the names of the terms, in the table's order.
LIMN_API std::vector<std::string> termNames(TermSet terms);
/// Returns TermInfo::background of the term of that name; false for a text that names no term.
LIMN_API bool hasBackground(std::string_view text);
/// Returns the term of that name, which a picture can show. Throws UsageError that lists the accepted names.
LIMN_API Term parseTerm(std::string_view text);

}  // namespace limn
