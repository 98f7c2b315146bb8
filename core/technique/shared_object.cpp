#include "core/technique/private/shared_object.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <link.h>

#include <cstdint>
#include <cstring>

namespace limn {
namespace {

/// The header of liblimn itself, which says what this machine loads.
const ElfW(Ehdr) * ownHeader() {
  Dl_info self{};
  if (dladdr(reinterpret_cast<void*>(&sharedObjectProblem), &self) == 0) return nullptr;
  return static_cast<const ElfW(Ehdr)*>(self.dli_fbase);
}

bool holds(std::span<const std::byte> file, uint64_t offset, uint64_t size) {
  return offset <= file.size() && size <= file.size() - offset;
}

/// Whether a table of headers and, for each of its entries, what `extent` says lies within the file.
template <class Entry, class Extent>
bool tableHolds(std::span<const std::byte> file, uint64_t offset, uint64_t count, uint64_t stride,
                Extent extent) {
  if (count == 0) return true;
  if (stride != sizeof(Entry) || !holds(file, offset, count * stride)) return false;
  for (uint64_t i = 0; i < count; ++i) {
    Entry entry;
    std::memcpy(&entry, file.data() + offset + i * stride, sizeof entry);
    const auto [begin, size] = extent(entry);
    if (!holds(file, begin, size)) return false;
  }
  return true;
}

}  // namespace

std::string sharedObjectProblem(std::span<const std::byte> file) {
  ElfW(Ehdr) header;
  if (file.size() < SELFMAG || std::memcmp(file.data(), ELFMAG, SELFMAG) != 0)
    return "it is not a shared object (ELF)";
  if (file.size() < sizeof header) return fmt::format("it ends after {} bytes", file.size());
  std::memcpy(&header, file.data(), sizeof header);
  const ElfW(Ehdr)* own = ownHeader();
  if (own && (header.e_ident[EI_CLASS] != own->e_ident[EI_CLASS] ||
              header.e_ident[EI_DATA] != own->e_ident[EI_DATA] || header.e_machine != own->e_machine))
    return fmt::format("it is for another machine (ELF machine {}, this one is {})", header.e_machine,
                       own->e_machine);
  if (header.e_type != ET_DYN) return fmt::format("it is not a shared object (ELF type {})", header.e_type);
  if (header.e_phnum == 0) return "it is not a shared object (no program headers)";
  using Extent = std::pair<uint64_t, uint64_t>;
  const bool whole =
      tableHolds<ElfW(Phdr)>(file, header.e_phoff, header.e_phnum, header.e_phentsize,
                             [](const ElfW(Phdr) & p) { return Extent(p.p_offset, p.p_filesz); }) &&
      tableHolds<ElfW(Shdr)>(file, header.e_shoff, header.e_shnum, header.e_shentsize,
                             [](const ElfW(Shdr) & s) {
                               return s.sh_type == SHT_NOBITS ? Extent(0, 0) : Extent(s.sh_offset, s.sh_size);
                             });
  if (!whole) return fmt::format("it is cut short: it names what lies beyond its {} bytes", file.size());
  return {};
}

}  // namespace limn
