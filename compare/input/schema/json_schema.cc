// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/schema/json_schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "compare/input/case_sections.h"
#include "compare/input/environment/environment.h"
#include "compare/input/measurement/measurement.h"
#include "compare/input/schema/keys.h"

namespace ciliaval::compare::input::schema {
namespace {

using Json = nlohmann::ordered_json;

/// A number and what follows it.
constexpr const char* quantity_pattern =
    R"(^\s*[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][-+]?[0-9]+)?\s*[^\s0-9])";

Json list_of(Json element) {
  return {{"type", "array"}, {"items", std::move(element)}, {"minItems", 1}};
}

Json point_of(const Json& coordinate) {
  Json point = list_of(coordinate);
  point["minItems"] = 3;
  point["maxItems"] = 3;
  return point;
}

Json with_range(Json number, const Range& range) {
  if (range.lower == range.upper) return number;
  number[range.excludes_ends ? "exclusiveMinimum" : "minimum"] = range.lower;
  number[range.excludes_ends ? "exclusiveMaximum" : "maximum"] = range.upper;
  return number;
}

Json number_or_quantity(const Key& key) {
  if (key.quantity.unit.empty()) return with_range({{"type", "number"}}, key.range);
  return {{"type", "string"}, {"pattern", quantity_pattern}};
}

Json value_of(const Key& key) {
  switch (key.kind) {
    case Key::Kind::text:
    case Key::Kind::file:
      return {{"type", "string"}};
    case Key::Kind::files:
      return list_of({{"type", "string"}});
    case Key::Kind::choice:
      return {{"enum", key.choices}};
    case Key::Kind::choices: {
      Json list = list_of({{"enum", key.choices}});
      if (!key.fallback.empty()) list.erase("minItems");
      list["uniqueItems"] = true;
      return list;
    }
    case Key::Kind::flag:
      return {{"type", "boolean"}};
    case Key::Kind::whole_number:
      return with_range({{"type", "integer"}}, key.range);
    case Key::Kind::quantity:
      return number_or_quantity(key);
    case Key::Kind::quantities: {
      Json one = number_or_quantity(key);
      if (!key.word.empty()) one = {{"anyOf", {{{"const", key.word}}, one}}};
      return {{"anyOf", {one, list_of(one)}}};
    }
    case Key::Kind::point:
      return point_of(number_or_quantity(key));
    case Key::Kind::points: {
      const Json point = point_of(number_or_quantity(key));
      return {{"anyOf", {point, list_of(point)}}};
    }
    case Key::Kind::any:
      return {{"type", {"string", "number"}}};
    case Key::Kind::pair:
    case Key::Kind::any_pair:
      break;
  }
  Json pair = list_of(key.kind == Key::Kind::pair ? number_or_quantity(key)
                                                  : Json{{"type", {"string", "number"}}});
  pair["minItems"] = 2;
  pair["maxItems"] = 2;
  return pair;
}

Json described(const Key& key) {
  Json value = value_of(key);
  std::string text = key.text;
  if (key.range.lower != key.range.upper)
    text += fmt::format(" Range: {}.", describe(key.range, key.quantity));
  if (!key.fallback.empty()) text += fmt::format(" Default: {}.", key.fallback);
  value["description"] = text;
  return value;
}

/// A table without its sub-tables. Keys that go with some values of its choice are allowed and
/// required with these alone.
Json table_of(const std::vector<Key>& keys) {
  Json table{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  const Key* choice = nullptr;
  Json required = Json::array();
  bool depends = false;
  for (const Key& key : keys) {
    table["properties"][std::string(key.name)] = described(key);
    if (key.kind == Key::Kind::choice && choice == nullptr) choice = &key;
    depends = depends || !key.with.empty();
    if (key.fallback.empty() && key.with.empty()) required.push_back(key.name);
  }
  if (!required.empty()) table["required"] = required;
  if (!depends || choice == nullptr) return table;
  for (const std::string_view value : choice->choices) {
    Json names = Json::array();
    Json needed = Json::array();
    for (const Key& key : keys) {
      const bool is_there =
          key.with.empty() || std::ranges::find(key.with, value) != key.with.end();
      if (is_there) names.push_back(key.name);
      if (is_there && key.fallback.empty()) needed.push_back(key.name);
    }
    table["allOf"].push_back(
        {{"if",
          {{"properties", {{choice->name, {{"const", value}}}}}, {"required", {choice->name}}}},
         {"then", {{"propertyNames", {{"enum", names}}}, {"required", needed}}}});
  }
  return table;
}

/// [sensor] with a point or several, or [[sensor]] with a name and a point each.
Json sensors_of(const std::vector<Key>& keys) {
  Json one = table_of(keys);
  const std::string place(input::keys().sensor_position.name);
  const std::string name(input::keys().sensor_name.name);
  one["required"] = {name, place};
  Json all = one;
  const Json point = one["properties"][place];
  all["properties"].erase(name);
  all["required"] = {place};
  all["properties"][place] = {{"anyOf", {point, list_of(point)}},
                              {"description", point["description"]}};
  return {{"anyOf", {all, list_of(one)}}};
}

/// [load] may have the sub-tables of its type.
void allow_tables_of_loads(Json& load) {
  for (Json& one : load["allOf"]) {
    const Json& value = one["if"]["properties"][keys().load_type.name]["const"];
    for (const LoadType* type : load_types())
      if (type->name == value.get<std::string>())
        for (const LoadTable& table : type->tables)
          one["then"]["propertyNames"]["enum"].push_back(table.name);
  }
}

}  // namespace

std::string json_schema(const Models& models) {
  std::vector<std::pair<std::string, std::vector<Key>>> tables;  // in their order
  for (const Key& key : all_keys(models)) {
    const auto found = std::ranges::find(tables, key.table, [](const auto& t) { return t.first; });
    if (found == tables.end())
      tables.push_back({key.table, {key}});
    else
      found->second.push_back(key);
  }
  models.for_each([&](const auto& entry) {  // a table without a key may be there too
    const std::string name = "models." + entry.id;
    if (std::ranges::find(tables, name, [](const auto& t) { return t.first; }) == tables.end())
      tables.push_back({name, {}});
  });
  std::set<std::string> repeated{"cilium.segment", std::string(external::table_name),
                                 std::string(measurement::measurement_table),
                                 std::string(measurement::input_table),
                                 std::string(environment::magnet_table)};
  models.for_each([&](const auto& entry) {
    if (!entry.tables.keys.empty()) repeated.insert(entry.tables.name);
  });
  Json root{{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", "A case of CiliaVal"},
            {"description", "Every key: docs/guide/cases.md"},
            {"type", "object"},
            {"additionalProperties", false},
            {"required", {"case", "cilium", "models"}},
            {"anyOf", {{{"required", {"load"}}}, {{"required", {environment::table_name}}}}},
            {"properties", Json::object()}};
  for (const auto& [name, keys] : tables) {
    Json table = name == "sensor" ? sensors_of(keys) : table_of(keys);
    if (repeated.contains(name)) table = list_of(std::move(table));
    Json* parent = &root;
    std::string_view rest = name;
    for (auto dot = rest.find('.'); dot != std::string_view::npos; dot = rest.find('.')) {
      parent = &(*parent)["properties"][std::string(rest.substr(0, dot))];
      rest.remove_prefix(dot + 1);
    }
    (*parent)["properties"][std::string(rest)] = std::move(table);
  }
  root["properties"]["cilium"]["required"].push_back("segment");
  allow_tables_of_loads(root["properties"]["load"]);
  return root.dump(2) + '\n';
}

}  // namespace ciliaval::compare::input::schema
