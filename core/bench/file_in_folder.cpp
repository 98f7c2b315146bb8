#include "core/bench/private/file_in_folder.h"

#include <algorithm>

namespace limn::bench {
namespace fs = std::filesystem;

fs::path fileInFolder(const fs::path& folder, const std::string& file) {
  std::error_code error;
  const fs::path root = fs::weakly_canonical(folder, error);
  const fs::path path = fs::weakly_canonical(folder / file, error);
  if (file.empty() || error || !fs::is_regular_file(path, error)) return {};
  const auto [end, ignored] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end() ? path : fs::path();
}

}  // namespace limn::bench
