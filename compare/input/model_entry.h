// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/input/option.h"
#include "problem/field_model.h"
#include "problem/load.h"
#include "problem/mechanics_model.h"

namespace ciliaval::meshes {
struct PlainMesh;
}

namespace ciliaval::compare::input {

struct Case;
class Section;

/// Refinement of a model: the option that refines it, and its values.
struct Refinement {
  enum class Law {
    power,     ///< the error is α h^p, or nearly
    tolerance  ///< the model promises an error below h times the scale
  };
  std::string_view option;
  std::vector<double> values;          ///< of the option, coarsest first
  std::function<double(double)> size;  ///< h of a value
  std::string_view size_name;          ///< what h is, for people
  Law law = Law::power;
  std::optional<double> formal_order{};
  std::function<bool(const ModelOptions&)> applies{};  ///< empty: always
  std::function<void(ModelOptions&)> also{};           ///< what else is set on all levels
};

/// The largest error that the user allows in a mechanics model's results: it is refined until its
/// estimate is as small.
struct ErrorLimit {
  enum class Of {
    tip,   ///< of the tip's position, over its displacement, at each step
    field  ///< of ΔB, over the largest |ΔB| of the path, at each sensor and step
  };
  double percent = 0;  ///< 0: there is none, the options say how fine the model is
  Of of = Of::tip;
};

/// Takes a fault of a case; `path` says where it is, dotted: "models.solid.mesh", "load.height[2]".
using Report = std::function<void(const std::string& path, const std::string& fault)>;

/// A case whose tables are right by themselves, as a model checks it against its own options.
struct CaseCheck {
  const Case& problem;
  bool is_asked_for = false;  ///< the case names the model
  bool cilium_is_right = false;
  bool load_is_right = false;
  const Report& report;
};

/// Sub-tables of a model, [[models.<model>.<name>]].
struct SubTables {
  std::string name{};  ///< "models.<model>.<name>"
  std::vector<description::Key> keys{};
  std::function<void(Section& model, ModelOptions&)> read{};
  std::function<std::string(const ModelOptions&)> write{};
};

/// A stage that a model gives to the error budget (compare/budget/budget.h).
struct BudgetStage {
  std::string physics;                       ///< what it takes in that the stages before leave out
  std::string variant{};                     ///< tells it from the model's other stages
  std::function<void(ModelOptions&)> set{};  ///< the options that make it; empty: the case's
  bool is_beside = false;                    ///< a model of its own, not on the way
  bool bears_differences = true;  ///< its numerical error is small enough for derivatives
};

/// A model as all others know it. A part that is left out has the simplest meaning: no options, not
/// refined, every load, serial, quick, accurate to rounding.
template <class Model>
struct Entry {
  std::string id;           ///< in case files and results
  std::string description;  ///< one line for `ciliaval list`
  std::function<std::unique_ptr<Model>(const ModelOptions&)> make;
  std::vector<Option> options{};
  std::vector<Refinement> refinements{};
  /// Mechanics: the error limit, for which the first of the refinements is raised; empty: none.
  std::function<ErrorLimit(const ModelOptions&)> error_limit{};
  std::vector<const LoadType*> loads{};  ///< that a mechanics model takes; empty: it says so itself
  bool takes_environment = false;        ///< mechanics: weight and fields of [environment]
  bool takes_touch = false;              ///< mechanics: [load.touch] of a contact or a probe
  bool takes_sections = false;           ///< rectangles and tubes, too
  bool has_body = false;                 ///< mechanics: gives Deformation::body; field: needs it
  bool is_collective = false;            ///< all MPI ranks call it, and no two threads at a time
  bool is_slow = false;                  ///< `ciliaval check --quick` leaves it out
  /// The part of its scale to which a number is the same on any machine; on one machine a tenth.
  double accuracy = 1e-10;
  std::function<void(const CaseCheck&)> check{};
  /// Remarks on the files that the options name. Throws InputError.
  std::function<std::vector<std::string>(const Case&)> remarks{};
  SubTables tables{};
  /// Stages that the model adds to the models before it, one assumption each; empty: the budget
  /// leaves the model out.
  std::function<std::vector<BudgetStage>(const ModelOptions&)> budget_stages{};
  /// Sets the options by which it leaves out least; empty: no option of it tells what it leaves
  /// out.
  std::function<void(ModelOptions&)> correct{};
  /// Sets the options by which it takes least time: closed forms, no estimate of its error.
  std::function<void(ModelOptions&)> hasten{};
  /// Sets the options by which it does not look for the largest load where the load is borne.
  std::function<void(ModelOptions&)> skip_range{};
  /// The mesh on which it solves a case, or that of another refinement. Throws InputError.
  std::function<meshes::PlainMesh(const Case&, std::optional<unsigned int> refinement)> mesh{};
  /// Options that the model's checkpoint does not depend on; none: it keeps no checkpoint, because
  /// it takes but a moment.
  std::optional<std::vector<std::string_view>> checkpoint_without{};

  /// True if the model has a correct() and it would change nothing.
  bool is_corrected(const ModelOptions& given) const {
    if (!correct) return false;
    ModelOptions best = given;
    correct(best);
    return std::ranges::all_of(
        options, [&](const Option& option) { return option.get(given) == option.get(best); });
  }
  /// True if it takes a moment, in any thread, with rods.
  bool is_quick() const { return !is_slow && !is_collective && !has_body; }
};
using MechanicsEntry = Entry<MechanicsModel>;
using FieldEntry = Entry<FieldModel>;

/// Every model, the more detailed ones later.
struct Models {
  std::vector<MechanicsEntry> mechanics;
  std::vector<FieldEntry> fields;

  template <class F>
  void for_each(const F& f) const {
    for (const MechanicsEntry& entry : mechanics) f(entry);
    for (const FieldEntry& entry : fields) f(entry);
  }
};

template <class Entries>
std::vector<std::string_view> ids(const Entries& entries) {
  std::vector<std::string_view> result;
  result.reserve(entries.size());
  for (const auto& entry : entries) result.emplace_back(entry.id);
  return result;
}

/// Entry::make of a model that takes a struct of options.
template <class Model, class Options>
std::unique_ptr<Model> make(const ModelOptions& options) {
  return std::make_unique<Model>(options.of<Options>());
}

/// Changes the names of the files that the options state.
void change_files(const Models& models, ModelOptions& options,
                  const std::function<void(Option::File, std::filesystem::path&)>& change);

/// The meshes that the user made, by the option that names them, "models.solid.mesh".
std::map<std::string, std::filesystem::path> user_meshes(const Models& models,
                                                         const ModelOptions& options);

}  // namespace ciliaval::compare::input
