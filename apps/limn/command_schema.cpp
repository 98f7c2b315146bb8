// limn schema: describes the JSON that limn writes.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "apps/limn/commands.h"
#include "core/bench/schema.h"

namespace limn::app {

Action addSchemaCommand(CLI::App& command) {
  const auto kind = std::make_shared<std::string>();
  command.add_option("kind", *kind, "row: a line of results.jsonl; stats: what `limn render --stats` writes")
      ->required()
      ->check(CLI::IsMember({"row", "stats"}));
  return [kind] {
    fmt::print("{}", *kind == "row" ? bench::rowSchema() : bench::statsSchema());
    return 0;
  };
}

}  // namespace limn::app
