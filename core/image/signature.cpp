#include "core/image/signature.h"

#include "core/base/version.h"

namespace limn {

void sign(Image& picture, const std::string& command) {
  picture.metadata()["command"] = command;
  picture.metadata()["version"] = version();
}

}  // namespace limn
