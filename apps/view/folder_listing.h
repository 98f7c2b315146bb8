// Says what a folder holds that the window can open.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace limn::app {

/// Holds the content of a folder: names, sorted.
struct FolderListing {
  std::filesystem::path folder;                ///< absolute
  std::vector<std::filesystem::path> folders;  ///< without hidden ones
  std::vector<std::filesystem::path> files;    ///< scenes (.gltf, .glb) and environments
  std::string problem;                         ///< why it could not be read; empty where it could
};

/// Returns what a folder holds; of a file, the folder that it lies in; of "", the working folder.
FolderListing listFolder(const std::filesystem::path& folder);

}  // namespace limn::app
