#include "apps/view/folder_listing.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/text.h"
#include "core/scene_io/load.h"

namespace limn::app {
namespace {

namespace fs = std::filesystem;

/// Other systems write MODEL.GLB, which is read by what it holds.
bool isScene(const fs::path& file) {
  const std::string extension = lowerCase(file.extension().string());
  return extension == ".gltf" || extension == ".glb";
}

}  // namespace

FolderListing listFolder(const fs::path& folder) {
  FolderListing listing;
  std::error_code error;
  listing.folder = fs::weakly_canonical(folder.empty() ? fs::path(".") : folder, error);
  if (!error && fs::is_regular_file(listing.folder, error)) listing.folder = listing.folder.parent_path();
  fs::directory_iterator entry(listing.folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path name = entry->path().filename();
    std::error_code unknown;  // a link that leads nowhere is neither
    if (name.native().front() == '.') continue;
    if (entry->is_directory(unknown))
      listing.folders.push_back(name);
    else if (entry->is_regular_file(unknown) && (isScene(name) || scene::isEnvironmentFile(name)))
      listing.files.push_back(name);
  }
  if (error) listing.problem = fmt::format("{}: {}", listing.folder.string(), error.message());
  std::ranges::sort(listing.folders);
  std::ranges::sort(listing.files);
  return listing;
}

}  // namespace limn::app
