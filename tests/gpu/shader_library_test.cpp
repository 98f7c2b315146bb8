#include "core/gpu/shader_library.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

#include "core/base/error.h"
#include "tests/gpu/bind_by_name.h"
#include "tests/gpu/gl_test.h"

namespace limn::gpu {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Writes the number a test asks for, so that it can see which source ran.
constexpr EmbeddedSource kSources[] = {
    {"answer.comp.glsl",
     "#include \"value.glsl\"\n"
     "layout(local_size_x = 1) in;\n"
     "layout(std430) buffer Result { uint result; };\n"
     "void main() { result = value() + LIMN_OFFSET; }\n"},
    {"value.glsl", "uint value() { return 1u; }\n"},
    {"broken.comp.glsl", "#include \"broken.glsl\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n"},
    {"broken.glsl", "// a comment\nint fine;\nint f() { return undeclared; }\n"},
    {"tested.comp.glsl", "layout(local_size_x = 1) in;\n#if LIMN_MODE == 2\n#endif\nvoid main() {}\n"},
    {"ladder.comp.glsl",
     "layout(local_size_x = 1) in;\n#ifdef __cplusplus\n#include <cmath>\n#include \"core/none.h\"\n#endif\n"
     "void main() {}\n"},
    {"behind.comp.glsl",
     "layout(local_size_x = 1) in;\n#ifdef LIMN_MORE\n#include \"value.glsl\"\n#include "
     "\"broken.glsl\"\n#endif\n"
     "void main() { undeclared = 1; }\n"},
    {"optional.comp.glsl",
     "layout(local_size_x = 1) in;\n#if LIMN_MODE\n#include \"value.glsl\"\n#endif\nvoid main() {}\n"},
    {"warns.comp.glsl",
     "layout(local_size_x = 1) in;\nlayout(std430) buffer Result { float result; };\n"
     "void main() { float x; result = x; }\n"},
    {"unlinkable.vert.glsl", "out vec2 a;\nvoid main() { a = vec2(0); gl_Position = vec4(0); }\n"},
    {"unlinkable.frag.glsl",
     "in vec3 a;\nlayout(location = 0) out vec4 colour;\nvoid main() { colour = vec4(a, 1); }\n"},
};

class ShaderLibraryTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    folder_ = fs::temp_directory_path() / fs::path("limn-shaders-" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }

  void TearDown() override {
    fs::remove_all(folder_);
    GlTest::TearDown();
  }

  ProgramDesc answer(const std::string& offset) {
    return {{"techniques/test/answer.comp.glsl"}, {{"LIMN_OFFSET", offset}}};
  }

  /// Writes a file of the override folder, with a time of its own however fast the test runs.
  void write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    std::ofstream(path) << text;
    fs::last_write_time(path, fs::file_time_type::clock::now() + std::chrono::seconds(++writes_));
  }

  uint32_t run(Program& program) {
    Buffer result(device(), "result", sizeof(uint32_t));
    test::bindByName(gl(), program, "Result", result);
    program.use();
    gl().DispatchCompute(1, 1, 1);
    uint32_t value = 0;
    result.read(0, &value, sizeof value);
    gl().UseProgram(0);
    return value;
  }

  std::string errorOf(const ProgramDesc& desc) {
    try {
      shaders().program(desc);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
      return error.what();
    }
    return "";
  }

  fs::path folder_;
  int writes_ = 0;
};

TEST_F(ShaderLibraryTest, permutationsAreCompiledOnce) {
  shaders().mount("techniques/test/", kSources);
  const int before = device().counters().programsCompiled;
  Program& ten = shaders().program(answer("10u"));
  Program& twenty = shaders().program(answer("20u"));
  EXPECT_EQ(&shaders().program(answer("10u")), &ten);
  EXPECT_EQ(device().counters().programsCompiled, before + 2);
  EXPECT_EQ(run(ten), 11u);
  EXPECT_EQ(run(twenty), 21u);
}

TEST_F(ShaderLibraryTest, errorsNameTheIncludedFileAndLine) {
  shaders().mount("techniques/test/", kSources);
  const std::string error = errorOf({{"techniques/test/broken.comp.glsl"}, {{"LIMN_A", "1"}}});
  EXPECT_THAT(error, HasSubstr("cannot compile techniques/test/broken.comp.glsl (LIMN_A=1): "));
  EXPECT_THAT(error, HasSubstr("techniques/test/broken.glsl:3: "));
  EXPECT_THAT(error, HasSubstr("undeclared"));
}

TEST_F(ShaderLibraryTest, errorsBehindASkippedIncludeNameTheirLine) {
  shaders().mount("techniques/test/", kSources);
  EXPECT_THAT(errorOf({{"techniques/test/behind.comp.glsl"}, {}}),
              HasSubstr("techniques/test/behind.comp.glsl:6: "));
}

TEST_F(ShaderLibraryTest, mentionsWhatItsDefinesKeepFromBeingIncluded) {
  shaders().mount("techniques/test/", kSources);
  const ProgramDesc desc{{"techniques/test/optional.comp.glsl"}, {{"LIMN_MODE", "0"}}};
  shaders().program(desc);
  EXPECT_THAT(shaders().expanded(desc, desc.files[0]), Not(HasSubstr("value")));
  EXPECT_TRUE(shaders().mentions(desc, "value"));
  EXPECT_FALSE(shaders().mentions(desc, "values"));
}

TEST_F(ShaderLibraryTest, macrosThatAreTestedMustBeDefined) {
  shaders().mount("techniques/test/", kSources);
  const std::string file = "techniques/test/tested.comp.glsl";
  EXPECT_THAT(errorOf({{file}, {}}), HasSubstr(file + ":2: "));
  EXPECT_THAT(errorOf({{file}, {}}), HasSubstr("LIMN_MODE is tested but not defined"));
  EXPECT_THAT(errorOf({{file}, {{"LIMN_MODE", "2"}}}), IsEmpty());
}

TEST_F(ShaderLibraryTest, partsForCppAreSkipped) {
  shaders().mount("techniques/test/", kSources);
  EXPECT_THAT(errorOf({{"techniques/test/ladder.comp.glsl"}, {}}), IsEmpty());
}

TEST_F(ShaderLibraryTest, warningsAreErrorsInADebugContext) {
  if (!device().software()) GTEST_SKIP() << "what a driver warns of is its own choice";
  shaders().mount("techniques/test/", kSources);
  // The driver gives no warnings of a text that its cache on disk holds, from an earlier run or another
  // backend.
  const auto run = std::chrono::system_clock::now().time_since_epoch().count();
  EXPECT_THAT(errorOf({{"techniques/test/warns.comp.glsl"}, {{"LIMN_RUN", std::to_string(run)}}}),
              HasSubstr("techniques/test/warns.comp.glsl:3: "));
}

TEST_F(ShaderLibraryTest, otherFailuresSayWhichProgram) {
  shaders().mount("techniques/test/", kSources);
  EXPECT_THAT(
      errorOf({{"techniques/test/unlinkable.vert.glsl", "techniques/test/unlinkable.frag.glsl"}, {}}),
      HasSubstr("cannot link techniques/test/unlinkable.vert.glsl + techniques/test/unlinkable.frag.glsl: "));
  EXPECT_THAT(errorOf({{"techniques/test/value.glsl"}, {}}), HasSubstr("is no stage"));
  EXPECT_THAT(errorOf({{"techniques/test/none.comp.glsl"}, {}}), HasSubstr("does not exist"));
  EXPECT_THAT(errorOf({}), HasSubstr("at least one shader file"));
}

TEST_F(ShaderLibraryTest, unknownUniformsAreRefused) {
  if (!device().software()) GTEST_SKIP() << "compilers of GPUs may remove any uniform";
  shaders().mount("techniques/test/", kSources);
  Program& program = shaders().program(answer("1u"));
  EXPECT_THROW(program.set("radius", 1.0f), Error);
}

TEST_F(ShaderLibraryTest, filesOnDiskTakePrecedenceAndAreReloaded) {
  shaders().mount("techniques/test/", kSources, folder_);
  Program& program = shaders().program(answer("10u"));
  EXPECT_EQ(run(program), 11u) << "the embedded source, since the folder is empty";
  EXPECT_EQ(shaders().reload().reloaded, 0);

  write("value.glsl", "uint value() { return 5u; }\n");
  EXPECT_EQ(shaders().reload().reloaded, 1);
  EXPECT_EQ(run(program), 15u) << "a file that appeared in the folder, behind the same reference";

  write("value.glsl", "uint value() { return 6u }\n");
  ShaderLibrary::ReloadResult result = shaders().reload();
  EXPECT_EQ(result.reloaded, 0);
  ASSERT_EQ(result.errors.size(), 1u);
  EXPECT_THAT(result.errors[0], HasSubstr("techniques/test/value.glsl:1: "));
  EXPECT_EQ(run(program), 15u) << "the last good version";
  result = shaders().reload();
  EXPECT_FALSE(result.changed);
  EXPECT_EQ(result.errors.size(), 1u) << "it is still broken";

  write("value.glsl", "uint value() { return 5u; }\n");
  result = shaders().reload();
  EXPECT_TRUE(result.changed);
  EXPECT_EQ(result.reloaded, 0) << "the text of the last good version again";
  EXPECT_THAT(result.errors, IsEmpty());

  write("value.glsl", "#include \"none.glsl\"\n");
  EXPECT_THAT(shaders().reload().errors[0], HasSubstr("include 'none.glsl' not found"));
  EXPECT_EQ(run(program), 15u);

  write("none.glsl", "uint value() { return 7u; }\n");
  EXPECT_EQ(shaders().reload().reloaded, 1) << "the missing include was created";
  EXPECT_EQ(run(program), 17u);

  fs::remove(folder_ / "value.glsl");
  EXPECT_EQ(shaders().reload().reloaded, 1);
  EXPECT_EQ(run(program), 11u) << "the embedded source again";
}

TEST_F(ShaderLibraryTest, aTouchedFileWithTheSameTextIsNotCompiledAgain) {
  shaders().mount("techniques/test/", kSources, folder_);
  write("value.glsl", kSources[1].text);
  shaders().program(answer("10u"));
  const int before = device().counters().programsCompiled;
  write("value.glsl", kSources[1].text);
  EXPECT_EQ(shaders().reload().reloaded, 0);
  EXPECT_EQ(device().counters().programsCompiled, before);
}

TEST_F(ShaderLibraryTest, anIdleReloadTakesMicroseconds) {
  shaders().mount("techniques/test/", kSources, folder_);
  shaders().program(answer("10u"));
  shaders().reload();
  double fastest = 1;  // seconds; the minimum, because the machine may be busy
  for (int i = 0; i < 50; ++i) {
    const auto start = std::chrono::steady_clock::now();
    shaders().reload();
    fastest =
        std::min(fastest, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_LT(fastest, 200e-6);
}

TEST_F(ShaderLibraryTest, limnsOwnSourcesAreMounted) {
  constexpr EmbeddedSource user[] = {
      {"pi.comp.glsl",
       "#include \"glsl/numeric/language.glsl\"\nlayout(local_size_x = 1) in;\n"
       "layout(std430) buffer Result { uint result; };\n"
       "void main() { result = uint(pi * 1000.0); }\n"}};
  shaders().mount("techniques/test/", user);
  EXPECT_EQ(run(shaders().program({{"techniques/test/pi.comp.glsl"}, {}})), 3141u);
}

}  // namespace
}  // namespace limn::gpu
