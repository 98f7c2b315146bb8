// The library of picture files as a part of the program.
#include "core/image/private/image_files.h"

namespace limn::image_files {

const Library& library() {
  return *limnImageFiles();
}

}  // namespace limn::image_files
