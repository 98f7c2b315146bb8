// tinygltf compiled with the sanitizers instead of the installed library, so that they see into it.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_INCLUDE_JSON
#include <nlohmann/json.hpp>
//
#include <tiny_gltf.h>

// The default callbacks of the class. limn's loader takes the images out before tinygltf sees them.
namespace tinygltf {

bool LoadImageData(Image*, int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
  return false;
}

bool WriteImageData(const std::string*, const std::string*, const Image*, bool, std::string*, void*) {
  return false;
}

}  // namespace tinygltf
