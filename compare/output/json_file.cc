// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/json_file.h"

#include <fmt/core.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "compare/input/case_syntax.h"
#include "problem/error.h"

namespace ciliaval::compare::output {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t largest_file = 256u << 20;  ///< bytes
constexpr std::size_t deepest = 100;

}  // namespace

Json read_json(const std::filesystem::path& file, std::string_view kind) {
  return parse_json(input::read_file(file, kind, largest_file), file.string());
}

Json parse_json(std::string_view text, std::string_view name) {
  std::vector<std::set<std::string>> keys(deepest + 1);  // of the objects around, by depth
  const auto look = [&](int depth, Json::parse_event_t event, const Json& parsed) {
    using Event = Json::parse_event_t;
    const auto level = static_cast<std::size_t>(depth);
    if (event == Event::object_start || event == Event::array_start) {
      if (level >= deepest)
        throw InputError(fmt::format("{}: nested more than {} deep", name, deepest));
      keys[level + 1].clear();
    }
    if (event != Event::key) return true;
    const auto& key = parsed.get_ref<const std::string&>();
    if (!keys[level].insert(key).second)
      throw InputError(fmt::format("{}: the key \"{}\" is there twice in one object", name, key));
    return true;
  };
  try {
    return Json::parse(text, look);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: not JSON: {}", name, error.what()));
  }
}

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}

std::optional<double> number_or_none(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(json.get<double>());
}

std::string to_text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace ciliaval::compare::output
