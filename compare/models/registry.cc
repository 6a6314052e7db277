// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/models/registry.h"

#include <fmt/format.h>

#include <pthread.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <span>
#include <utility>

#include "compare/input/case.h"

// Every model, one line each, the more detailed ones later. CalculiX stands before the solid, which
// is the reference: it takes every load, and on a mesh of the same size its error is a tenth
// (docs/measurements.md).
#define CILIAVAL_MODELS(MECHANICS, FIELD) \
  MECHANICS(elastica)                     \
  MECHANICS(beam)                         \
  MECHANICS(calculix)                     \
  MECHANICS(solid)                        \
  FIELD(dipole)                           \
  FIELD(line)                             \
  FIELD(volume)                           \
  FIELD(mesh)                             \
  FIELD(potential)

namespace ciliaval::compare::models {

namespace entries {
#define CILIAVAL_DECLARE_MECHANICS(model) MechanicsEntry model();
#define CILIAVAL_DECLARE_FIELD(model) FieldEntry model();
CILIAVAL_MODELS(CILIAVAL_DECLARE_MECHANICS, CILIAVAL_DECLARE_FIELD)
}  // namespace entries

namespace {

/// Held while a collective model works: MPI is one for the process and takes one thread at a time,
/// and so do MUMPS and p4est. A thread that has it may take it again, as in a function that is told
/// of the progress.
std::recursive_mutex collective_work;

/// A forked process has the forking thread alone: the lock is free there.
void free_in_forked_processes() {
  static const int registered =
      pthread_atfork(nullptr, nullptr, [] { std::construct_at(&collective_work); });
  static_cast<void>(registered);
}

class ExclusiveMechanics : public MechanicsModel {
 public:
  explicit ExclusiveMechanics(std::unique_ptr<MechanicsModel> model) : model_(std::move(model)) {}
  MechanicsResult solve(const Cilium& cilium, const LoadPath& path,
                        const Progress& progress) const override {
    const std::lock_guard lock(collective_work);
    return model_->solve(cilium, path, progress);
  }
  MechanicsResult solve_from(const Cilium& cilium, const LoadPath& path,
                             const Checkpoint& checkpoint,
                             const Progress& progress) const override {
    const std::lock_guard lock(collective_work);
    return model_->solve_from(cilium, path, checkpoint, progress);
  }

 private:
  std::unique_ptr<MechanicsModel> model_;
};

class ExclusiveField : public FieldModel {
 public:
  explicit ExclusiveField(std::unique_ptr<FieldModel> model) : model_(std::move(model)) {}
  bool pointwise() const override { return model_->pointwise(); }
  const FieldModel& for_differences() const override {
    const FieldModel& other = model_->for_differences();
    return &other == model_.get() ? *this : other;
  }
  Field field(const Cilium& cilium, const Deformation& deformation,
              std::span<const Vector3> points) const override {
    const std::lock_guard lock(collective_work);
    return model_->field(cilium, deformation, points);
  }
  std::vector<Vector3> magnetization(const Cilium& cilium, const Deformation& deformation,
                                     std::span<const Vector3> points) const override {
    return model_->magnetization(cilium, deformation, points);
  }

 private:
  std::unique_ptr<FieldModel> model_;
};

/// The entry, whose models take the lock if they are collective: whoever runs them, in however many
/// threads, need not know.
template <class Exclusive, class Model>
input::Entry<Model> exclusive(input::Entry<Model> entry) {
  if (entry.is_collective)
    entry.make = [make = std::move(entry.make)](const input::ModelOptions& options) {
      free_in_forked_processes();
      return std::make_unique<Exclusive>(make(options));
    };
  return entry;
}

bool has_environment(const Load& load) {
  return !surroundings::is_empty(load.environment());
}

void add(input::Models& models, MechanicsEntry entry) {
  models.mechanics.push_back(exclusive<ExclusiveMechanics>(std::move(entry)));
}
void add(input::Models& models, FieldEntry entry) {
  models.fields.push_back(exclusive<ExclusiveField>(std::move(entry)));
}

input::Models& all() {
  static input::Models models = [] {
    input::Models list;
#define CILIAVAL_ADD_MECHANICS(model) add(list, entries::model());
#define CILIAVAL_ADD_FIELD(model) add(list, entries::model());
    CILIAVAL_MODELS(CILIAVAL_ADD_MECHANICS, CILIAVAL_ADD_FIELD)
    return list;
  }();
  return models;
}

}  // namespace

const input::Models& known() {
  return all();
}

std::string fault_of(const MechanicsEntry& entry, const input::Case& problem) {
  const LoadPath& path = problem.load_path;
  if (!entry.takes_environment && std::ranges::any_of(path, has_environment))
    return fmt::format("{} takes no environment", entry.id);
  const auto is_plain = [](const Load& load) { return load.touch().is_plain(); };
  if (!entry.takes_touch && !std::ranges::all_of(path, is_plain))
    return fmt::format("{} takes no 'touch'", entry.id);
  const auto takes = [&](const Load& load) {
    return entry.loads.empty() || std::ranges::find(entry.loads, &load.type()) != entry.loads.end();
  };
  if (const auto refused = std::ranges::find_if_not(path, takes); refused != path.end())
    return fmt::format("{} takes no load of the type '{}'", entry.id, type(*refused));
  if (!entry.takes_sections && problem.cilium.section.shape != CrossSection::Shape::circle)
    return fmt::format("{} takes a full circular section", entry.id);
  std::string first;
  const input::Report report = [&](const std::string& /*where*/, const std::string& fault) {
    if (first.empty()) first = fmt::format("{}: {}", entry.id, fault);
  };
  if (!path.empty() && entry.check) entry.check({problem, true, true, true, report});
  return first;
}

void add_model(MechanicsEntry entry) {
  add(all(), std::move(entry));
}

void add_model(FieldEntry entry) {
  add(all(), std::move(entry));
}

}  // namespace ciliaval::compare::models
