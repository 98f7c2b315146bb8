#pragma once

namespace limn::test {

/// Roots of the source tree and of the build tree. They are defined in one generated file, so that the other
/// objects of the tests do not depend on where the trees lie and a compiler cache serves every checkout.
extern const char* const kSourceDir;
extern const char* const kBinaryDir;

}  // namespace limn::test
