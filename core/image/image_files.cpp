#include "core/image/private/image_files.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstring>

#include "core/base/error.h"
#include "core/base/helper.h"
#include "core/base/version.h"
#include "core/image/image.h"

namespace limn::image_files {
namespace {

const Library& load() {
  const std::string file = (libraryFolder() / "limn/limn-image-files.so").string();
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) throw Error(fmt::format("pictures cannot be read or written: {}", dlerror()));
  const auto entry = reinterpret_cast<decltype(&limnImageFiles)>(dlsym(handle, "limnImageFiles"));
  const Library* found = entry != nullptr ? entry() : nullptr;
  if (found == nullptr || std::strcmp(found->version, version()) != 0)
    throw Error(fmt::format("{}: it is of another limn than liblimn, {}", file, version()));
  return *found;
}

}  // namespace

const Library& library() {
  static const Library& loaded = load();
  return loaded;
}

}  // namespace limn::image_files

void limn::loadPictureLibrary() {
  image_files::library();
}
