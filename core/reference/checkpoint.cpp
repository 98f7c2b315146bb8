#include "core/reference/private/checkpoint.h"

#include <xxhash.h>

#include <array>
#include <cstring>
#include <span>

#include "core/base/error.h"
#include "core/base/file.h"

namespace limn::reference {
namespace {

struct Header {
  std::array<char, 8> magic{'l', 'i', 'm', 'n', 'r', 'e', 'f', '3'};
  std::array<char, 32> hash{};
  uint64_t count = 0;     ///< of sums
  uint64_t samples = 0;   ///< per pixel and half
  uint64_t checksum = 0;  ///< of this header, with 0 here, and of the sums
};
static_assert(sizeof(Header) == 64);

uint64_t checksum(Header header, std::span<const std::byte> payload) {
  header.checksum = 0;
  return XXH3_64bits_withSeed(payload.data(), payload.size(), XXH3_64bits(&header, sizeof(Header)));
}

}  // namespace

void saveCheckpoint(const std::filesystem::path& file, const std::string& hash, const Accumulators& state) {
  const std::span<const std::byte> payload = std::as_bytes(std::span(state.sums));
  Header header;
  std::memcpy(header.hash.data(), hash.data(), std::min(hash.size(), header.hash.size()));
  header.count = state.sums.size();
  header.samples = state.samples;
  header.checksum = checksum(header, payload);
  std::vector<std::byte> bytes(sizeof(Header) + payload.size());
  std::memcpy(bytes.data(), &header, sizeof(Header));
  std::memcpy(bytes.data() + sizeof(Header), payload.data(), payload.size());
  writeFile(file, bytes);
}

bool loadCheckpoint(const std::filesystem::path& file, const std::string& hash, Accumulators& state) {
  std::error_code ignored;
  if (file.empty() || !std::filesystem::is_regular_file(file, ignored)) return false;
  const size_t payloadSize = state.sums.size() * sizeof(Sums);
  std::vector<std::byte> bytes;
  try {
    bytes = readFile(file, sizeof(Header) + payloadSize);
  } catch (const Error&) {
    return false;  // unreadable or of another size: the work starts from nothing
  }
  if (bytes.size() != sizeof(Header) + payloadSize) return false;
  Header header;
  std::memcpy(&header, bytes.data(), sizeof(Header));
  Header expected;
  std::memcpy(expected.hash.data(), hash.data(), std::min(hash.size(), expected.hash.size()));
  const std::span<const std::byte> payload = std::span<const std::byte>(bytes).subspan(sizeof(Header));
  if (header.magic != expected.magic || header.hash != expected.hash || header.count != state.sums.size() ||
      header.samples > UINT32_MAX || header.checksum != checksum(header, payload))
    return false;
  std::memcpy(state.sums.data(), payload.data(), payload.size());
  state.samples = static_cast<uint32_t>(header.samples);
  return true;
}

}  // namespace limn::reference
