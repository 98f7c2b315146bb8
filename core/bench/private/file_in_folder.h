// Finds the files that rows name. Rows may come from elsewhere.
#pragma once

#include <filesystem>
#include <string>

namespace limn::bench {

/// Returns where the regular file lies that a row names `file`, or nothing where there is none or where it
/// lies outside of `folder`, links followed.
std::filesystem::path fileInFolder(const std::filesystem::path& folder, const std::string& file);

}  // namespace limn::bench
