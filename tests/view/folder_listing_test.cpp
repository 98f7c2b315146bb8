// What the dialog that opens files shows of a folder.
#include "apps/view/folder_listing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/cli/process.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

TEST(FolderListing, HasWhatCanBeOpened) {
  const test::TemporaryFolder folder;
  for (const char* name :
       {"b.glb", "C.gltf", "D.GLB", "sky.hdr", "SKY.EXR", "a.exr", "notes.txt", ".hidden.glb"})
    std::ofstream(folder / name) << "a file";
  for (const char* name : {"sub", "another.glb", ".git"}) fs::create_directory(folder / name);
  fs::create_symlink("missing.glb", folder / "nowhere.glb");
  const FolderListing listing = listFolder(folder / "sub" / "..");
  EXPECT_EQ(listing.folder, fs::canonical(folder.path()));
  EXPECT_THAT(listing.folders, testing::ElementsAre("another.glb", "sub"));
  EXPECT_THAT(listing.files, testing::ElementsAre("C.gltf", "D.GLB", "SKY.EXR", "a.exr", "b.glb", "sky.hdr"));
  EXPECT_EQ(listing.problem, "");
  EXPECT_EQ(listFolder(folder / "b.glb").files, listing.files) << "a file's folder";
  EXPECT_EQ(listFolder("").folder, fs::current_path());
}

TEST(FolderListing, SaysWhatCannotBeRead) {
  const test::TemporaryFolder folder;
  const FolderListing listing = listFolder(folder / "missing");
  EXPECT_THAT(listing.problem, testing::HasSubstr("missing: No such file or directory"));
  EXPECT_THAT(listing.files, testing::IsEmpty());
}

}  // namespace
}  // namespace limn::app
