#include "core/technique/handshake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstring>

#include "core/base/file.h"
#include "core/technique/module.h"
#include "core/technique/private/shared_object.h"

namespace limn {
namespace {

using testing::HasSubstr;

/// A side with settings of its own.
Handshake with(std::string_view abi) {
  Handshake side = handshake("0123456789abcdef0123456789abcdef");
  std::memset(side.abi, 0, sizeof side.abi);
  copyText(side.abi, abi);
  return side;
}

TEST(Handshake, SidesThatAreTheSameFit) {
  EXPECT_EQ(mismatch(handshake(interfaceHash()), handshake(interfaceHash())), "");
}

TEST(Handshake, TheHashIsThatOfAllHeaders) {
  EXPECT_EQ(std::strlen(interfaceHash()), 32u);
  EXPECT_EQ(std::strspn(interfaceHash(), "0123456789abcdef"), 32u);
}

TEST(Handshake, OnlyTheNumberIsReadWhereItDiffers) {
  Handshake other = handshake(interfaceHash());
  other.interfaceNumber = 7;
  std::memset(other.compiler, 'x', sizeof other - offsetof(Handshake, compiler));
  EXPECT_EQ(mismatch(other, handshake(interfaceHash())),
            "it was built for interface 7, limn has interface " + std::to_string(kTechniqueInterfaceNumber));
}

TEST(Handshake, EveryDifferenceIsSaid) {
  Handshake other = with("A=1;B=B;");
  other.compiler[0] = 'x';
  other.headers[0] = 'f';
  EXPECT_EQ(mismatch(other, with("A=2;B=1;C=3;")),
            std::string("it was built with compiler x") + (__VERSION__ + 1) +
                ", limn with compiler " __VERSION__
                "; A is 1 in it and 2 in limn; B is undefined in it and 1 in limn; C is undefined in it and "
                "3 in limn; "
                "it was built from headers f123456789abcdef0123456789abcdef, limn from headers "
                "0123456789abcdef0123456789abcdef");
}

TEST(Handshake, SettingsOfTheLayoutAreCompared) {
  const std::string abi = kTechniqueAbi;
  for (const char* setting : {"__cplusplus=2020", "__SIZEOF_POINTER__=8;", "_GLIBCXX_USE_CXX11_ABI=1;",
                              "_GLIBCXX_DEBUG=_GLIBCXX_DEBUG;", "GLM_VERSION_MINOR=", "FMT_VERSION="})
    EXPECT_THAT(abi, HasSubstr(setting));
}

TEST(Handshake, TextsWithoutAnEndAreReadToTheEndOfTheirRoom) {
  Handshake other = handshake(interfaceHash());
  std::memset(other.compiler, 'x', sizeof other - offsetof(Handshake, compiler));
  EXPECT_THAT(mismatch(other, handshake(interfaceHash())), HasSubstr(std::string(64, 'x') + ","));
}

TEST(SharedObject, IsTakenWholeAndNoPartOfIt) {
  const std::vector<std::byte> whole = readFile(limnFile());
  EXPECT_EQ(sharedObjectProblem(whole), "");
  const std::span<const std::byte> all = whole;
  for (size_t i = 0; i <= 1000; ++i) {
    const size_t size = i < 300 ? i : (whole.size() - 1) * (i - 300) / 700;
    EXPECT_NE(sharedObjectProblem(all.first(size)), "") << size;
  }
}

TEST(SharedObject, OfAnotherMachineOrKindIsRefused) {
  std::vector<std::byte> file = readFile(limnFile());
  const auto with = [&](size_t offset, int value) {
    std::vector<std::byte> changed = file;
    changed[offset] = static_cast<std::byte>(value);
    return sharedObjectProblem(changed);
  };
  EXPECT_THAT(with(0, 0), HasSubstr("not a shared object"));
  EXPECT_THAT(with(4, 1), HasSubstr("another machine"));     // EI_CLASS: 32 bits
  EXPECT_THAT(with(5, 2), HasSubstr("another machine"));     // EI_DATA: big-endian
  EXPECT_THAT(with(18, 243), HasSubstr("another machine"));  // e_machine: RISC-V
  EXPECT_THAT(with(16, 2), HasSubstr("ELF type 2"));         // e_type: program
  EXPECT_THAT(with(56, 0) + with(57, 0), HasSubstr("program headers"));
  EXPECT_THAT(with(39, 0x7f), HasSubstr("cut short"));  // e_phoff
  EXPECT_THAT(with(47, 0x7f), HasSubstr("cut short"));  // e_shoff
}

/// What is wrong with a file is said when it is loaded.
TEST(ModuleTrial, EndsWhereChildrenAreNotWaitedFor) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  EXPECT_NO_THROW(tryModule("/dev/null", "none"));
  std::signal(SIGCHLD, before);
}

}  // namespace
}  // namespace limn
