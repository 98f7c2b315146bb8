// limn-read-draco: decodes the Draco meshes of a scene, in a process of its own with limits of its own, and
// answers as core/scene_io/private/draco_message.h says. liblimn starts it.
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <cstdio>
#include <new>
#include <string_view>

#include "core/base/error.h"
#include "core/scene_io/readers/confine.h"
#include "core/scene_io/readers/draco_mesh.h"

namespace {

using namespace limn::scene;

/// Returns what standard input, a file, holds.
std::span<const std::byte> input() {
  struct stat file {};
  if (fstat(STDIN_FILENO, &file) != 0 || file.st_size <= 0) return {};
  const auto size = static_cast<std::size_t>(file.st_size);
  const void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, STDIN_FILENO, 0);
  if (bytes == MAP_FAILED) return {};
  return {static_cast<const std::byte*>(bytes), size};
}

std::vector<std::byte> answer(std::span<const DracoMesh> meshes, std::uint64_t memory) {
  std::vector<std::byte> arrays;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    try {
      decodeDracoMesh(meshes[i], arrays);
    } catch (const limn::Error& error) {
      return encodeDracoRefusal(i, error.what());
    } catch (const std::bad_alloc&) {
      return encodeDracoRefusal(
          i, fmt::format("decoding asks for more memory than the {} MiB allowed", memory >> 20));
    } catch (const std::exception& exception) {
      return encodeDracoRefusal(i, fmt::format("not a mesh that Draco decodes ({})", exception.what()));
    }
  }
  return encodeDracoAnswer(arrays);
}

}  // namespace

int main(int count, char** arguments) {
  std::uint64_t memory = 0;
  unsigned seconds = 0;
  const auto understood = [&](int argument, auto& number) {
    if (argument >= count) return false;
    const std::string_view text = arguments[argument];
    return std::from_chars(text.data(), text.data() + text.size(), number).ec == std::errc();
  };
  if (count != 3 || !understood(1, memory) || !understood(2, seconds)) {
    std::fprintf(stderr, "usage: limn-read-draco MEMORY SECONDS < REQUEST\n");
    return 2;
  }
  if (!limn::confine(memory, seconds)) return 3;
  try {
    // What the library made of a damaged mesh is not taken down.
    _exit(limn::writeAnswer(answer(decodeDracoRequest(input()), memory)) ? 0 : 1);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "limn-read-draco: %s\n", error.what());
    return 1;
  }
}
