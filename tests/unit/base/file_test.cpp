// Files written whole or not at all, locks, and what killed writers leave.
#include "core/base/file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "core/base/error.h"
#include "core/base/file_lock.h"

namespace limn {
namespace {

namespace fs = std::filesystem;

class FileTest : public testing::Test {
 protected:
  FileTest() {
    std::string name = (fs::temp_directory_path() / "limn-file-XXXXXX").string();
    if (mkdtemp(name.data())) folder_ = name;
  }
  ~FileTest() override { fs::remove_all(folder_); }

  std::vector<std::string> names() const {
    std::vector<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.push_back(entry.path().filename());
    return found;
  }

  fs::path folder_;
};

TEST_F(FileTest, EveryNameThatAFileMayHaveCanBeWritten) {
  for (const std::string& name :
       {std::string("a"), std::string(244, 'n'), std::string(255, 'n'), std::string("-rf"),
        std::string("it's \"odd\"\nhere"), std::string("\xff\xfe.exr")}) {
    writeTextFile(folder_ / name, "content");
    EXPECT_EQ(readTextFile(folder_ / name), "content");
    EXPECT_EQ(names(), std::vector<std::string>{name}) << "nothing is left beside it";
    const fs::path lock = beside(folder_ / name, ".checkpoint");
    EXPECT_LE(lock.filename().string().size(), 255u);
    EXPECT_TRUE(lock.string().ends_with(".checkpoint"));
    EXPECT_EQ(lock.parent_path(), folder_);
    fs::remove(folder_ / name);
  }
  EXPECT_EQ(beside("a/b.exr", ".lock"), "a/b.exr.lock");
  EXPECT_NE(beside(std::string(254, 'n') + "1", ".lock"), beside(std::string(254, 'n') + "2", ".lock"));
}

/// Lines are limited, the whole of them is not.
TEST_F(FileTest, LinesAreReadOneByOne) {
  const std::string longer(std::size_t{3} << 20, 'l');  // than what is read at once
  const std::string whole = "first\n\n" + longer + "\nlast\n";
  const auto lines = [&](const std::string& content, std::uint64_t maxBytes) {
    writeTextFile(folder_ / "a", content);
    std::vector<std::string> taken;
    EXPECT_EQ(readLines(
                  folder_ / "a", [&](const std::string& line) { taken.push_back(line); }, maxBytes),
              whole.size());
    return taken;
  };
  const std::vector<std::string> wanted = {"first", "", longer, "last"};
  EXPECT_EQ(lines(whole, longer.size()), wanted);
  EXPECT_EQ(lines(whole + "torn", longer.size()), wanted);
  const auto ignore = [](const std::string&) {};
  EXPECT_THROW(readLines(folder_ / "a", ignore, longer.size() - 1), Error);
  writeTextFile(folder_ / "a", "torn and too long");
  EXPECT_THROW(readLines(folder_ / "a", ignore, 4), Error);
  EXPECT_THROW(readLines(folder_ / "missing", ignore), Error);
  EXPECT_THROW(readLines(folder_, ignore), Error);
}

TEST_F(FileTest, WhyAFileCannotBeReadIsSaid) {
  const auto problem = [](const fs::path& path) -> std::string {
    try {
      readFile(path);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  fs::create_symlink("loop", folder_ / "loop");
  const fs::path loop = folder_ / "loop", longer = folder_ / std::string(300, 'n');
  EXPECT_EQ(problem(loop), loop.string() + ": cannot be read: " + std::strerror(ELOOP));
  EXPECT_EQ(problem(longer), longer.string() + ": cannot be read: " + std::strerror(ENAMETOOLONG));
  EXPECT_EQ(problem(folder_ / "missing"), (folder_ / "missing").string() + ": no such file");
  EXPECT_EQ(problem(folder_), folder_.string() + ": not a regular file");
}

TEST_F(FileTest, LeftoversOfAnotherProcessOfTheSameNumberDisturbNobody) {
  // What a writer that was killed left, in a container where process numbers start anew.
  for (int count = 0; count < 64; ++count)
    std::ofstream(folder_ / (".a." + std::to_string(getpid()) + "-" + std::to_string(count) + ".part"));
  writeTextFile(folder_ / "a", "content");
  EXPECT_EQ(readTextFile(folder_ / "a"), "content");
  removeAbandonedFiles(folder_);
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
}

TEST_F(FileTest, OnlyWhatNoLivingWriterHoldsIsRemoved) {
  const fs::path held = folder_ / ".held.0123456789abcdef.part",
                 dead = folder_ / ".dead.0123456789abcdef.part";
  std::ofstream(held) << "half";
  std::ofstream(dead) << "half";
  for (const char* other : {".mine.part", "a.0123456789abcdef.part", ".x.0123456789abcdeg.part", "b.exr"})
    std::ofstream(folder_ / other) << "other";
  const int file = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(file, LOCK_EX), 0);
  removeAbandonedFiles(folder_);
  EXPECT_TRUE(fs::exists(held));
  EXPECT_FALSE(fs::exists(dead));
  ::close(file);
  removeAbandonedFiles(folder_);
  EXPECT_FALSE(fs::exists(held));
  EXPECT_EQ(names().size(), 4u);
  removeAbandonedFiles(folder_ / "missing");
}

/// Another program may write to it; whoever cleans up leaves it alone.
TEST_F(FileTest, ATemporaryFileGetsItsNameOrIsGone) {
  {
    const TemporaryFile dropped(folder_ / "a");
    EXPECT_TRUE(fs::exists(dropped.path()));
  }
  EXPECT_TRUE(names().empty());
  TemporaryFile file(folder_ / "a");
  std::ofstream(file.path()) << "content of another program";
  removeAbandonedFiles(folder_);
  file.keep();
  EXPECT_EQ(names(), std::vector<std::string>{"a"});
  EXPECT_EQ(readTextFile(folder_ / "a"), "content of another program");
  EXPECT_THROW(TemporaryFile(folder_ / "missing" / "a"), Error);
}

/// As root one would otherwise replace /dev/null, and what /dev/stdout leads to.
TEST_F(FileTest, DevicesPipesAndWhatIsOpenStayWhatTheyAre) {
  const fs::path fifo = folder_ / "fifo", device = folder_ / "null", opened = folder_ / "stdout";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  fs::create_symlink("/dev/null", device);
  std::ofstream(folder_ / "log") << "log";
  const int log = ::open((folder_ / "log").c_str(), O_WRONLY | O_CLOEXEC);
  fs::create_symlink("/proc/self/fd/" + std::to_string(log), opened);
  ASSERT_TRUE(fs::is_regular_file(opened));
  const std::vector<std::string> before = names();
  for (const fs::path& path : {fifo, device, opened}) {
    EXPECT_TRUE(isSpecialFile(path));
    EXPECT_THROW(writeTextFile(path, "content"), Error) << path;
  }
  EXPECT_EQ(names(), before);
  EXPECT_TRUE(fs::is_fifo(fifo) && fs::is_symlink(device) && fs::is_symlink(opened));
  ::close(log);
  for (const char* name : {"log", "missing", "."}) EXPECT_FALSE(isSpecialFile(folder_ / name)) << name;
}

TEST_F(FileTest, WritersAndCleanersInManyThreadsLoseNothing) {
  std::vector<std::jthread> threads(4);
  for (int i = 0; i < 4; ++i)
    threads[static_cast<std::size_t>(i)] = std::jthread([this, i] {
      for (int n = 0; n < 50; ++n) {
        writeTextFile(folder_ / std::to_string(i), std::string(1000, static_cast<char>('a' + n % 26)));
        removeAbandonedFiles(folder_);
      }
    });
  threads.clear();
  EXPECT_EQ(names().size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(readTextFile(folder_ / std::to_string(i)).size(), 1000u);
}

TEST_F(FileTest, ALockNamesItsHolderAndDiesWithIt) {
  const fs::path path = folder_ / ".lock";
  {
    const FileLock lock(path, "folder out");
    try {
      const FileLock second(path, "folder out");
      ADD_FAILURE() << "two hold one lock";
    } catch (const Error& error) {
      const std::string message = error.what();
      EXPECT_TRUE(message.starts_with("folder out is in use by process " + std::to_string(getpid()) + " on "))
          << message;
      EXPECT_NE(message.find(" since 2"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos);
    }
  }
  EXPECT_TRUE(names().empty());
  const pid_t child = fork();
  if (child == 0) {
    const FileLock lock(path, "x");
    raise(SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(fs::exists(path)) << "what the killed one left";
  const FileLock lock(path, "x");
}

TEST_F(FileTest, NamesOfAFolderDoNotLeadOutOfIt) {
  const fs::path root = folder_ / "results";
  createFolder(root / "pictures");
  writeTextFile(root / "pictures" / "a.png", "a");
  writeTextFile(folder_ / "secret", "s");
  fs::create_symlink(folder_ / "secret", root / "out");
  fs::create_symlink("pictures/a.png", root / "in");
  EXPECT_EQ(fileInFolder(root, "pictures/a.png"), fs::canonical(root / "pictures" / "a.png"));
  EXPECT_EQ(fileInFolder(root, "in"), fs::canonical(root / "pictures" / "a.png"));
  for (const char* name : {"", ".", "pictures", "missing", "../secret", "pictures/../../secret", "out"})
    EXPECT_EQ(fileInFolder(root, name), fs::path()) << name;
  EXPECT_EQ(fileInFolder(root, (folder_ / "secret").string()), fs::path());
  EXPECT_EQ(fileInFolder("", (folder_ / "secret").string()), fs::path()) << "it is not in the current folder";
}

TEST_F(FileTest, WhereNoLockCanBeMadeNothingIsGuarded) {
  const FileLock lock(folder_ / "missing" / ".lock", "x");
  SUCCEED();
}

}  // namespace
}  // namespace limn
