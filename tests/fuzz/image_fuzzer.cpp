// libFuzzer target of pictures: any bytes are read as a picture and as a texture, or end in limn::Error of
// one line. OpenImageIO and the libraries below it are not instrumented: crashes in them are found, reads
// beyond their buffers are not.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/base/error.h"
#include "core/image/image.h"
#include "core/image/private/exr_header.h"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

template <class Read>
void attempt(Read read) {
  try {
    const auto image = read();
    require(image.data().size() > 0);
  } catch (const limn::Error& error) {
    require(std::string_view(error.what()).find('\n') == std::string_view::npos);
    require(std::string_view(error.what()).starts_with("picture: "));
  }
}

struct Texture {
  limn::Image8 image;
  const std::vector<std::uint8_t>& data() const { return image.data; }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data, size));
  const std::string problem = limn::exrHeaderProblem(bytes);
  require(problem.find('\n') == std::string::npos);
  attempt([&] { return limn::readImageMemory(bytes, "picture"); });
  attempt([&] { return Texture{limn::readImage8Memory(bytes, "picture")}; });
  return 0;
}
