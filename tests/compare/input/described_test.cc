// SPDX-License-Identifier: LGPL-2.1-or-later
// Every described key: what is set is got, what is written is read back, and what is out of its
// range is refused.
#include "compare/input/described.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>

#include "compare/input/case_syntax.h"
#include "compare/input/external/external.h"
#include "compare/input/sweep/signal.h"
#include "problem/description/cilium.h"
#include "problem/description/environment.h"
#include "problem/description/surface.h"
#include "tests/support/case_texts.h"

namespace ciliaval::compare {
namespace {

using description::Key;
using description::Value;

std::mt19937 toy_random(20261128);

double number_in(const Range& range) {
  if (range.lower == range.upper) return 0;
  double value = 0;
  do {
    value = std::uniform_real_distribution(range.lower, range.upper)(toy_random);
  } while (!range.contains(value));
  return value;
}

/// A value of the kind of the key's, in its range.
Value random_value(const Key& key) {
  const auto pick = [](std::size_t count) { return toy_random() % count; };
  if (!key.choices.empty()) return std::string(key.choices[pick(key.choices.size())]);
  switch (key.initial.index()) {
    case 0:
      return pick(2) == 1;
    case 1:
      return static_cast<unsigned int>(number_in(key.range));
    case 2:
      return number_in(key.range);
    case 3:
      return "n\"a'm\\e " + std::to_string(toy_random());
    case 4:
      return std::array{number_in(key.range), number_in(key.range)};
    case 6: {
      std::array<double, 4> values{};
      for (double& value : values) value = number_in(key.range);
      return values;
    }
    default:
      if (key.may_be_axial && pick(2) == 0) return Vector3(0, 0, number_in(key.range));
      return Vector3(number_in(key.range), number_in(key.range), number_in(key.range));
  }
}

/// Value that is read from `NAME = TEXT`, or none with the faults.
std::optional<Value> text_read(const Key& key, const std::string& text, input::Faults& faults) {
  const toml::table table = input::parse_toml(fmt::format("{} = {}\n", key.name, text), "a.toml");
  return input::read_value(*table.get(key.name), key, faults);
}

/// Returns the number of the keys.
template <class Owner>
int check_fields(const description::Fields<Owner>& fields, const Owner& initial = {}) {
  for (const description::Field<Owner>& field : fields) {
    SCOPED_TRACE(field.name);
    EXPECT_EQ(field.get(initial), field.initial);
    EXPECT_FALSE(field.doc.empty());
    for (int i = 0; i < 20; ++i) {
      const Value value = random_value(field);
      Owner owner = initial;
      field.set(owner, value);
      EXPECT_TRUE(field.get(owner) == value || !field.in_place_of.empty());
      input::Faults faults;
      const std::string text = input::to_toml(field, value);
      const auto read = text_read(field, text, faults);
      EXPECT_TRUE(faults.empty()) << text;
      EXPECT_TRUE(read && *read == value) << text;
    }
    if (!std::holds_alternative<double>(field.initial)) continue;
    for (const double beyond : {field.range.lower - 1e-3 * (1 + std::abs(field.range.lower)),
                                field.range.upper + 1e-3 * (1 + std::abs(field.range.upper))}) {
      input::Faults faults;
      EXPECT_FALSE(text_read(field, input::to_toml(field, beyond), faults)) << beyond;
      EXPECT_EQ(faults.size(), 1U);
    }
  }
  return static_cast<int>(fields.size());
}

TEST(DescribedKey, IsReadAsItIsWritten) {
  int count = check_fields(description::fields<Segment>()) +
              check_fields(description::fields<CrossSection>()) +
              check_fields(description::fields<Cilium>()) +
              check_fields(description::fields<input::sweep::SignalOptions>()) +
              check_fields(description::fields<surroundings::Environment>()) +
              check_fields(description::fields<surroundings::magnets::Magnet>()) +
              check_fields(description::fields<surroundings::StatedSurface>()) +
              check_fields(description::fields<SweepWay>()) +
              check_fields(description::fields<input::external::ExternalModel>());
  for (const LoadType* type : load_types()) {
    count += check_fields(type->keys(), Load(*type));
    if (!type->statement) continue;
    LoadStatement::Values values;
    for (const auto& parameter : type->statement->parameters)
      values.push_back(std::get<double>(parameter.initial));
    count += check_fields(type->statement->parameters, values);
  }
  models::known().for_each([&](const auto& entry) { count += check_fields(entry.options); });
  EXPECT_GT(count, 100);
}

/// A struct of the test's own, in one file: three keys, of which one goes with another's value.
struct Toy {
  enum class Kind { plain, fancy };
  Kind kind = Kind::plain;
  double size = 1e-3;
  bool shines = false;
};

const description::Fields<Toy>& toy_fields() {
  static const description::Fields<Toy> all{
      required(description::choice(&Toy::kind, "kind",
                                   {{"plain", Toy::Kind::plain}, {"fancy", Toy::Kind::fancy}},
                                   "What it is.")),
      optional(description::field(&Toy::size, "size", quantity::length, {1e-6, 1, false, "toys"},
                                  "How large it is."),
               "1 mm"),
      only_with(&Toy::kind, Toy::Kind::fancy, R"(kind = "fancy")",
                description::field(&Toy::shines, "shines", "Whether it shines."))};
  return all;
}

/// The toy, or what is wrong.
std::string toy_faults(const std::string& text, Toy& toy) {
  const toml::table root = input::parse_toml(text, "toy.toml");
  input::Faults faults;
  input::Section table(&root, "the toy", "", {}, faults);
  input::read(table, toy_fields(), toy);
  table.finish();
  return faults.report("toy.toml");
}

TEST(DescribedStruct, IsReadAndWritten) {
  Toy toy;
  EXPECT_EQ(toy_faults("kind = \"fancy\"\nsize = \"3 mm\"\nshines = true\n", toy), "");
  EXPECT_EQ(toy.kind, Toy::Kind::fancy);
  EXPECT_EQ(toy.size, 3e-3);
  EXPECT_TRUE(toy.shines);
  EXPECT_EQ(input::lines(toy_fields(), toy),
            "kind = \"fancy\"\nsize = \"0.003 m\"\nshines = true\n");
  EXPECT_EQ(input::lines(toy_fields(), Toy{}), "kind = \"plain\"\n");
}

TEST(DescribedStruct, HasItsFaultsAtTheirPlaces) {
  Toy toy;
  EXPECT_EQ(toy_faults("size = \"3 mm\"\n", toy), "toy.toml:1:1: the toy needs 'kind'");
  EXPECT_EQ(toy_faults("kind = \"plain\"\nshines = true\n", toy),
            "toy.toml:2:10: 'shines' goes with kind = \"fancy\" only");
  EXPECT_EQ(toy_faults("kind = \"fancy\"\nshine = true\nsize = \"2 m\"\n", toy),
            "toy.toml:2:1: unknown key 'shine' in the toy (valid: kind, size, shines); did you "
            "mean 'shines'?\ntoy.toml:3:8: 'size' is 2 m ('2 m'), but must be from 1e-06 m to 1 "
            "m: toys");
  // Which keys belong is not known: 'shines' is not refused.
  EXPECT_EQ(toy_faults("kind = \"fancyy\"\nshines = true\n", toy),
            "toy.toml:1:8: 'kind' cannot be 'fancyy' (valid: plain, fancy); did you mean "
            "'fancy'?");
}

}  // namespace
}  // namespace ciliaval::compare
