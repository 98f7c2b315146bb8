// Mutates a scene as what it is: the JSON by value, the binary chunk by byte, the container around them kept.
// Damage to the text and the container themselves is left to libFuzzer, one time in eight.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t maxSize);

namespace {

using json = nlohmann::json;
using Random = std::minstd_rand;

constexpr std::uint32_t kJson = 0x4e4f534a, kBinary = 0x004e4942;
constexpr std::size_t kChunk = 8, kHeader = 12;

struct Parts {
  json root;
  std::vector<std::uint8_t> binary;
};

std::uint32_t word(const std::uint8_t* at) {
  std::uint32_t value;
  std::memcpy(&value, at, sizeof value);
  return value;
}

void append(std::vector<std::uint8_t>& out, std::uint32_t value) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof value);
}

/// False where the bytes are no whole GLB with an object in it.
bool takeApart(const std::uint8_t* data, std::size_t size, Parts& parts) {
  if (size < kHeader + kChunk || std::memcmp(data, "glTF", 4) != 0) return false;
  const std::size_t length = word(data + kHeader), begin = kHeader + kChunk;
  if (length > size - begin) return false;
  // Nesting is bounded, or a text of brackets would take the parser's stack.
  if (std::count(data + begin, data + begin + length, '[') > 2000) return false;
  parts.root = json::parse(data + begin, data + begin + length, nullptr, false);
  if (!parts.root.is_object()) return false;
  const std::size_t rest = begin + length;
  if (size >= rest + kChunk) parts.binary.assign(data + rest + kChunk, data + size);
  return true;
}

std::vector<std::uint8_t> putTogether(const Parts& parts) {
  std::string text = parts.root.dump(-1, ' ', false, json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t padded = (parts.binary.size() + 3) / 4 * 4;
  std::vector<std::uint8_t> out = {'g', 'l', 'T', 'F'};
  append(out, 2);
  append(out, static_cast<std::uint32_t>(kHeader + kChunk + text.size() + (padded ? kChunk + padded : 0)));
  append(out, static_cast<std::uint32_t>(text.size()));
  append(out, kJson);
  out.insert(out.end(), text.begin(), text.end());
  if (padded == 0) return out;
  append(out, static_cast<std::uint32_t>(padded));
  append(out, kBinary);
  out.insert(out.end(), parts.binary.begin(), parts.binary.end());
  out.resize(out.size() + padded - parts.binary.size());
  return out;
}

std::size_t below(std::size_t count, Random& random) {
  return random() % std::max<std::size_t>(count, 1);
}

void collect(json& value, std::vector<json*>& all) {
  all.push_back(&value);
  if (value.is_structured())
    for (json& element : value) collect(element, all);
}

json boundaryNumber(Random& random) {
  static const std::array numbers = {
      json(0),          json(-1),         json(1),         json(2),     json(3),         json(127),
      json(255),        json(256),        json(65535),     json(65536), json(INT32_MAX), json(INT32_MIN),
      json(0.5),        json(-0.0),       json(1e-30),     json(1e30),  json(-1e30),     json(3.5e38),
      json(1e308),      json(5120),       json(5121),      json(5123),  json(5125),      json(5126),
      json(1e-320),     json(UINT32_MAX), json(4),         json(5),     json(1.5),       json(1u << 30),
      json(1ull << 53), json(INT64_MIN),  json(UINT64_MAX)};
  return numbers[below(numbers.size(), random)];
}

json otherType(Random& random) {
  static const std::array values = {json(),
                                    json(true),
                                    json(false),
                                    json(""),
                                    json("a"),
                                    json("0"),
                                    json::array(),
                                    json::object(),
                                    json::array({0}),
                                    json("a\nb\x1b"),
                                    json::array({0, 1, 2}),
                                    json::array({1e30, -1, "x"})};
  return values[below(values.size(), random)];
}

void changeNumber(json& value, Random& random) {
  if (below(3, random) == 0)
    value = boundaryNumber(random);
  else if (value.is_number_integer() && value > -1000000000 && value < 1000000000)
    value = value.get<int>() + static_cast<int>(below(5, random)) - 2;
  else
    value = value.get<double>() * (below(2, random) == 0 ? -1 : 1e3);
}

/// Removes, repeats or renames one of its members.
void changeMembers(json& value, const std::vector<json*>& all, Random& random) {
  if (value.empty()) return;
  auto member = value.begin();
  std::advance(member, below(value.size(), random));
  const json copy = *member;
  if (below(2, random) == 0) {
    value.erase(member);
  } else if (value.is_array()) {
    value.push_back(copy);
  } else {
    const json& other = *all[below(all.size(), random)];
    if (other.is_object() && !other.empty()) {
      auto named = other.begin();
      std::advance(named, below(other.size(), random));
      const std::string key = named.key();
      value[key] = copy;
    }
  }
}

void mutateJson(json& root, Random& random) {
  std::vector<json*> all;
  collect(root, all);
  json& value = *all[below(all.size(), random)];
  switch (below(6, random)) {
    case 0: {  // what stands elsewhere; first copied, since it may hold this value
      json copy = *all[below(all.size(), random)];
      value = std::move(copy);
      break;
    }
    case 1:
      value = below(2, random) == 0 ? otherType(random) : boundaryNumber(random);
      break;
    default:
      if (value.is_number())
        changeNumber(value, random);
      else if (value.is_structured())
        changeMembers(value, all, random);
      else
        value = otherType(random);
  }
  if (!root.is_object()) root = json::object();
}

void mutateBinary(std::vector<std::uint8_t>& binary, Random& random) {
  if (binary.size() >= 4 && below(2, random) == 0) {
    static constexpr std::array<std::uint32_t, 8> words = {0,          0x7f800000, 0x7fc00000, 0x7f7fffff,
                                                           0xff7fffff, 0x00000001, 0xffffffff, 0x3f800000};
    std::memcpy(binary.data() + below(binary.size() / 4, random) * 4, &words[below(words.size(), random)], 4);
    return;
  }
  const std::size_t before = binary.size();
  binary.resize(before + 16);
  binary.resize(LLVMFuzzerMutate(binary.data(), before, before + 16));
}

/// What takeApart() gives; the input that the last mutation made, which comes back for the next one, is not
/// parsed again.
struct Known {
  std::vector<std::uint8_t> bytes;
  Parts parts;

  bool holds(const std::uint8_t* data, std::size_t size) const {
    return size == bytes.size() && size > 0 && std::memcmp(data, bytes.data(), size) == 0;
  }
};

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t maxSize,
                                               unsigned seed) {
  static Known known;
  Random random(seed);
  if (below(8, random) == 0) return LLVMFuzzerMutate(data, size, maxSize);
  Parts parts;
  if (known.holds(data, size))
    parts = std::move(known.parts);
  else if (!takeApart(data, size, parts))
    return LLVMFuzzerMutate(data, size, maxSize);
  known = {};
  for (std::size_t i = 0, count = 1 + below(3, random); i < count; ++i) {
    if (!parts.binary.empty() && below(5, random) == 0)
      mutateBinary(parts.binary, random);
    else
      mutateJson(parts.root, random);
  }
  std::vector<std::uint8_t> whole = putTogether(parts);
  if (whole.size() > maxSize) return LLVMFuzzerMutate(data, size, maxSize);
  std::copy(whole.begin(), whole.end(), data);
  known = {std::move(whole), std::move(parts)};
  return known.bytes.size();
}
