#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/base/file_lock.h"
#include "core/reference/private/film.h"
#include "core/reference/reference.h"

namespace limn::reference {
namespace {

template <class Number>
std::optional<Number> numberOf(const Image& image, const std::string& key) {
  const auto found = image.metadata().find(key);
  if (found == image.metadata().end()) return std::nullopt;
  Number value{};
  const char* end = found->second.data() + found->second.size();
  const auto parsed = std::from_chars(found->second.data(), end, value);
  if (parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return value;
}

}  // namespace

std::filesystem::path Cache::pathOf(const std::string& contentHash) const {
  return folder_ / (contentHash + ".exr");
}

std::optional<Result> Cache::get(const std::string& contentHash) const {
  const std::filesystem::path file = pathOf(contentHash);
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
  try {
    Result result;
    result.image = readImage(file);
    const auto& metadata = result.image.metadata();
    const auto hash = metadata.find("content_hash");
    const auto noise = numberOf<double>(result.image, "noise_rms");
    const auto spp = numberOf<int>(result.image, "spp");
    const auto term = metadata.find("term");
    if (hash == metadata.end() || hash->second != contentHash || !noise || !spp || term == metadata.end())
      return std::nullopt;
    const auto kept = metadata;
    result.image = result.image.select(channelNames(parseTerm(term->second)));  // files order them by name
    result.image.metadata() = kept;
    result.noiseRms = *noise;
    result.spp = *spp;
    const auto machine = metadata.find("machine");
    const bool elsewhere = machine != metadata.end() && !machine_.empty() && machine->second != machine_;
    if (!elsewhere) result.seconds = numberOf<double>(result.image, "seconds");
    for (const char* ofFile : {"seconds", "machine"}) result.image.metadata().erase(ofFile);
    return result;
  } catch (const Error&) {
    return std::nullopt;  // a broken file is rendered again
  }
}

void Cache::put(const std::string& contentHash, const Result& result) const {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (failure)
    throw Error("reference cache: cannot create the folder " + folder_.string() + " (" + failure.message() +
                ")");
  Image image = result.image;
  image.metadata()["content_hash"] = contentHash;
  if (result.seconds) image.metadata()["seconds"] = fmt::format("{}", *result.seconds);
  if (result.seconds && !machine_.empty()) image.metadata()["machine"] = machine_;
  writeExr(pathOf(contentHash), image);
}

void Cache::keepInMemory(const std::string& contentHash, const Result& result) {
  constexpr size_t most = size_t{1} << 30;  // bytes
  const auto bytes = [](const auto& kept) { return kept.second.image.data().size() * sizeof(float); };
  kept_.emplace_back(contentHash, result);
  size_t sum = 0;
  for (const auto& kept : kept_) sum += bytes(kept);
  for (; sum > most && kept_.size() > 1; kept_.pop_front()) sum -= bytes(kept_.front());
}

Result Cache::render(Request request) {
  const std::string hash = contentHash(request);
  if (auto cached = get(hash)) return *std::move(cached);
  for (const auto& [name, kept] : kept_)
    if (name == hash) return kept;
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  const FileLock lock(folder_ / (hash + ".lock"), pathOf(hash).string());
  if (request.checkpoint.empty() && !failure) request.checkpoint = folder_ / (hash + ".partial");
  Result result = reference::render(request);
  result.image.metadata()["content_hash"] = hash;
  try {
    put(hash, result);
  } catch (const Error& error) {
    keepInMemory(hash, result);
    if (warn_ && !std::exchange(warned_, true))
      warn_(fmt::format("{}; references are kept in memory until the end of this run", error.what()));
  }
  return result;
}

}  // namespace limn::reference
