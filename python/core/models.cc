// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/described.h"
#include "compare/models/evaluator.h"
#include "compare/models/magnet_forces.h"
#include "compare/models/registry.h"
#include "compare/models/run.h"
#include "compare/output/results.h"
#include "problem/error.h"
#include "problem/error_estimate.h"
#include "problem/joints/companions.h"
#include "python/core/calls.h"
#include "python/core/convert.h"
#include "python/core/pickle.h"

namespace ciliaval::python::core {
namespace py = pybind11;
using namespace compare;
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Result of bend(): shared by the shapes of all loads, so that a long path needs no more memory
/// than its results.
struct BentPath {
  input::Case problem;  ///< cilium, the mechanics model's options
  models::MechanicsRun run;
};

/// One step of a bent cilium, with its companions, from which errors of fields follow.
struct BentShape {
  std::shared_ptr<const BentPath> path;
  std::size_t index = 0;  ///< of the step

  const std::string& model() const { return path->run.model; }
  const input::Case& problem() const { return path->problem; }
  const MechanicsStep& step() const { return path->run.result.steps.at(index); }
  const Deformation& deformation() const {
    if (!step().deformation)
      throw SolverError(fmt::format("{} has no equilibrium with this load ({}): {}", model(),
                                    output::to_string(step().status), step().message));
    return *step().deformation;
  }
  CentrelinePoint tip() const {
    const Centreline& centreline = deformation().centreline;
    return centreline.at(centreline.length());
  }
};

/// Step i of a result alone.
MechanicsResult step_of(const MechanicsResult& result, std::size_t i) {
  MechanicsResult one{.undeformed = result.undeformed,
                      .steps = {result.steps.at(i)},
                      .companions = {},
                      .error_parts = result.error_parts,
                      .algebraic_error = result.algebraic_error};
  for (const MechanicsResult& companion : result.companions)
    one.companions.push_back(step_of(companion, i));
  return one;
}

std::vector<BentShape> shapes_of(input::Case problem, models::MechanicsRun run) {
  const std::size_t count = run.result.steps.size();
  const auto bent = std::make_shared<const BentPath>(BentPath{std::move(problem), std::move(run)});
  std::vector<BentShape> shapes;
  for (std::size_t i = 0; i < count; ++i) shapes.push_back({bent, i});
  return shapes;
}

std::vector<BentShape> bend(const py::object& rod, const py::object& loads, const Text& model_name,
                            const py::object& callback, const py::kwargs& options) {
  const auto& cilium = one<Cilium>(rod, "cilium");
  const auto path = list_of<Load>(loads, "load");
  const std::string model = text(model_name, "model");
  const input::MechanicsEntry& entry = models::entry_of(models::mechanics_models(), model);
  input::Case problem;
  problem.cilium = cilium;
  problem.mechanics = {model};
  set_options(model, entry.options, options, problem.options);
  MechanicsResult result;
  const Call call;
  {
    const Progress told = progress(callback);
    const py::gil_scoped_release released;
    result = models::Evaluator(entry, problem, models::field_models()).solve(cilium, path, told);
  }
  return shapes_of(std::move(problem), {model, std::move(result)});
}

/// The case's cilium under loads of its kind, with the case's options of the model.
std::vector<BentShape> bend_case(const input::Case& of, const py::object& loads,
                                 const Text& model_name, const py::object& callback) {
  const auto path = list_of<Load>(loads, "load");
  const std::string model = text(model_name, "model");
  const input::MechanicsEntry& entry = models::entry_of(models::mechanics_models(), model);
  MechanicsResult result;
  const Call call;
  {
    const Progress told = progress(callback);
    const py::gil_scoped_release released;
    result = models::Evaluator(entry, of, models::field_models()).solve(of.cilium, path, told);
  }
  return shapes_of(of, {model, std::move(result)});
}

/// B at points of each shape, with the field model's options of the shapes' problem: (n, m, 3), T.
py::object fields_of_shapes(const py::object& shape_list, const Array& where,
                            const Text& model_name) {
  const auto shapes = list_of<BentShape>(shape_list, "shapes");
  const std::vector<Vector3> at = points(where);
  const input::FieldEntry& entry =
      models::entry_of(models::field_models(), text(model_name, "model"));
  std::vector<double> B(3 * shapes.size() * at.size());
  const Call call;
  {
    const py::gil_scoped_release released;
    const auto one = [&](std::size_t i) {
      const BentShape& shape = shapes[i];
      const auto source = entry.make(shape.problem().options);
      const Field field = source->field(shape.problem().cilium, shape.deformation(), at);
      for (std::size_t p = 0; p < at.size(); ++p)
        std::ranges::copy(field.B.at(p), B.begin() + 3 * static_cast<long>(i * at.size() + p));
    };
    if (entry.is_collective)
      for (std::size_t i = 0; i < shapes.size(); ++i) one(i);
    else
      tbb::parallel_for(std::size_t{0}, shapes.size(), one);
  }
  return array(std::move(B),
               {static_cast<py::ssize_t>(shapes.size()), static_cast<py::ssize_t>(at.size()), 3});
}

/// The straight cilium that a shape was bent from.
BentShape straight(const BentShape& shape) {
  MechanicsResult result;
  result.undeformed = shape.path->run.result.undeformed;
  MechanicsStep& step = result.steps.emplace_back();
  step.load = shape.step().load;
  step.status = Status::converged;
  step.deformation = result.undeformed;
  return shapes_of(shape.problem(), {shape.model(), std::move(result)}).front();
}

/// The shape by joints that are as much softer as their correction is uncertain by; none of a shape
/// whose joints are not corrected, or if that one has no equilibrium.
std::optional<BentShape> with_softer_joints(const BentShape& shape) {
  const MechanicsResult& result = shape.path->run.result;
  const auto part =
      std::ranges::find(result.error_parts, joints::error_direction, &ErrorPart::direction);
  if (part == result.error_parts.end()) return std::nullopt;
  MechanicsResult softer = step_of(solution(result, part->finer), shape.index);
  if (softer.steps.front().status != Status::converged) return std::nullopt;
  return shapes_of(shape.problem(), {shape.model(), std::move(softer)}).front();
}

/// Components at each point, (n, 3); NaN where there is none.
py::object vectors(const models::AtSensors& values) {
  std::vector<Vector3> all;
  for (const auto& value : values) all.push_back(value.value_or(Vector3::Constant(nan)));
  return array(all);
}

py::object with_mechanics(const models::AtSensors& own,
                          const std::vector<std::optional<double>>& from_mechanics) {
  std::vector<Vector3> all;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::optional<double> more = i < from_mechanics.size() ? from_mechanics[i] : std::nullopt;
    all.push_back(own[i] && more ? Vector3(own[i]->array() + *more) : Vector3::Constant(nan));
  }
  return array(all);
}

/// State of a shape: its problem as the model's id, cilium, load and options, and its result.
py::tuple state(const BentShape& shape) {
  py::dict options;
  for (const auto& option : models::entry_of(models::mechanics_models(), shape.model()).options)
    options[py::str(std::string(option.name))] = option.get(shape.problem().options);
  return py::make_tuple(build(), shape.model(), packed(shape.problem().cilium), options,
                        packed(step_of(shape.path->run.result, shape.index)));
}

BentShape shape_of(const py::tuple& state) {
  require_own_build(state[0].cast<std::string>());
  BentPath path;
  path.run.model = state[1].cast<std::string>();
  path.problem.mechanics = {path.run.model};
  path.problem.cilium = unpacked<Cilium>(state[2].cast<py::bytes>());
  const auto& entry = models::entry_of(models::mechanics_models(), path.run.model);
  set_options(entry.id, entry.options, state[3].cast<py::dict>(), path.problem.options);
  path.run.result = unpacked<MechanicsResult>(state[4].cast<py::bytes>());
  return {std::make_shared<const BentPath>(std::move(path)), 0};
}

py::dict field(const BentShape& shape, const Array& where, const Text& model_name,
               const py::kwargs& options) {
  const std::string model = text(model_name, "model");
  const input::FieldEntry& entry = models::entry_of(models::field_models(), model);
  input::Case problem = shape.problem();
  problem.load_path = {shape.step().load};
  problem.sensors = points(where);
  problem.fields = {model};
  set_options(model, entry.options, options, problem.options);
  static_cast<void>(shape.deformation());  // throws if there is none
  models::FieldRun run;
  const Call call;
  {
    const Progress told = progress(py::none());
    const py::gil_scoped_release released;
    const models::MechanicsRun of_step{shape.model(), step_of(shape.path->run.result, shape.index)};
    run = models::run_field(model, *entry.make(problem.options), of_step, problem, told);
  }
  const bool is_missing = !run.steps.front() || !run.steps.front()->any();
  if (is_missing && !problem.sensors.empty())
    throw SolverError(run.steps.front() ? run.steps.front()->failure : "there is no field");
  const models::FieldStep& step = *run.steps.front();
  py::dict result;
  result["B"] = vectors(step.B);
  result["dB"] = vectors(step.dB);
  result["B_uncertainty"] = with_mechanics(step.uncertainty, step.from_mechanics);
  result["dB_uncertainty"] = with_mechanics(step.dB_uncertainty, step.dB_from_mechanics);
  result["message"] = step.failure.empty() ? step.remark : step.failure;
  return result;
}

py::object magnetization_at(const BentShape& shape, const Array& where, const Text& model_name,
                            const py::kwargs& options) {
  const std::string model = text(model_name, "model");
  const input::FieldEntry& entry = models::entry_of(models::field_models(), model);
  input::ModelOptions chosen = shape.problem().options;
  set_options(model, entry.options, options, chosen);
  const std::vector<Vector3> at = points(where);
  const Deformation& deformation = shape.deformation();
  std::vector<Vector3> M;
  const Call call;
  {
    const py::gil_scoped_release released;
    M = entry.make(chosen)->magnetization(shape.problem().cilium, deformation, at);
  }
  return array(M);
}

/// Results of a design that a batch keeps.
struct Design {
  bool converged = false;
  Vector3 tip = Vector3::Constant(nan);
  double tip_angle = nan;
  double applied_force = nan;
  double slip_off = nan;
  std::vector<Vector3> B;
  std::vector<Vector3> dB;
  std::string message;
};

Design solve(const MechanicsModel& mechanics, const FieldModel& field, const Cilium& cilium,
             const Load& load, const std::vector<Vector3>& where) {
  Design design;
  support::check_interruption();
  try {
    const MechanicsResult result = mechanics.solve(cilium, {load});
    const MechanicsStep& step = result.steps.front();
    design.converged = step.status == Status::converged;
    design.message = step.message;
    design.slip_off = slip_off_limit(step).value_or(nan);
    if (!step.deformation) return design;
    const Centreline& centreline = step.deformation->centreline;
    const CentrelinePoint tip = centreline.at(centreline.length());
    design.tip = tip.position;
    design.tip_angle = tip.theta();
    design.applied_force = step.applied_force;
    if (where.empty()) return design;
    design.B = field.field(cilium, *step.deformation, where).B;
    const std::vector<Vector3> straight = field.field(cilium, result.undeformed, where).B;
    for (std::size_t p = 0; p < where.size(); ++p) design.dB.push_back(design.B[p] - straight[p]);
  } catch (const Error& error) {
    design.message = error.what();
  }
  return design;
}

/// Points for all designs, (m, 3), or for each of them, (n, m, 3).
std::vector<std::vector<Vector3>> points_of_designs(const Array& where, std::size_t designs) {
  if (where.is_none()) return {{}};
  const py::object array = py::module_::import("numpy").attr("asarray")(where);
  if (array.attr("ndim").cast<int>() != 3) return {points(where)};
  std::vector<std::vector<Vector3>> all;
  for (const py::handle each : array)
    all.push_back(points(py::reinterpret_borrow<py::object>(each)));
  if (all.size() != designs)
    throw InputError(
        fmt::format("`points` are those of {} designs, and there are {}: give (m, 3) for all or "
                    "(n, m, 3), m for each",
                    all.size(), designs));
  return all;
}

py::dict batch(const py::object& cilium_list, const py::object& load_list, const Array& where,
               const Text& model_name, const Text& field_name, bool with_slip_off,
               const py::kwargs& chosen) {
  const auto cilia = list_of<Cilium>(cilium_list, "cilia");
  const auto loads = list_of<Load>(load_list, "loads");
  const std::string model = text(model_name, "model");
  if (cilia.size() != loads.size())
    throw InputError(fmt::format("there are {} cilia and {} loads: give one load for each cilium",
                                 cilia.size(), loads.size()));
  const input::MechanicsEntry& mechanics = models::entry_of(models::mechanics_models(), model);
  const input::FieldEntry& field =
      models::entry_of(models::field_models(), text(field_name, "field"));
  const std::vector<std::vector<Vector3>> of_designs = points_of_designs(where, cilia.size());
  const std::vector<Vector3>& at = of_designs.front();
  const auto points_at = [&](std::size_t i) -> const std::vector<Vector3>& {
    return of_designs[of_designs.size() == 1 ? 0 : i];
  };
  std::vector<Design> designs(cilia.size());
  input::Case problem;
  problem.sensors = at;
  set_options(model, mechanics.options, chosen, problem.options);
  if (mechanics.hasten) mechanics.hasten(problem.options);
  if (mechanics.skip_range && !with_slip_off) mechanics.skip_range(problem.options);
  const Call call;
  {
    const py::gil_scoped_release released;
    const models::Evaluator solver(mechanics, problem, models::field_models());
    const auto source = field.make(problem.options);
    const auto one = [&](std::size_t i) {
      designs[i] = solve(solver, *source, cilia[i], loads[i], points_at(i));
    };
    if (mechanics.is_collective || (!at.empty() && field.is_collective))
      for (std::size_t i = 0; i < designs.size(); ++i) one(i);
    else
      tbb::parallel_for(std::size_t{0}, designs.size(), one);
  }
  const auto n = static_cast<py::ssize_t>(designs.size());
  const auto numbers = [&](double Design::*member) {
    std::vector<double> values(designs.size());
    std::ranges::transform(designs, values.begin(), member);
    return array(std::move(values), {n});
  };
  std::vector<Vector3> tips;
  std::vector<double> B;
  std::vector<double> dB;
  py::list converged;
  py::list messages;
  for (const Design& design : designs) {
    tips.push_back(design.tip);
    converged.append(design.converged);
    messages.append(design.message);
    for (std::size_t p = 0; p < at.size(); ++p)
      for (int c = 0; c < 3; ++c) {
        B.push_back(design.B.empty() ? nan : design.B[p][c]);
        dB.push_back(design.dB.empty() ? nan : design.dB[p][c]);
      }
  }
  py::dict result;
  result["converged"] =
      py::module_::import("numpy").attr("array")(converged, py::arg("dtype") = "bool");
  result["tip"] = array(tips);
  result["tip_angle"] = numbers(&Design::tip_angle);
  result["applied_force"] = numbers(&Design::applied_force);
  result["slip_off"] = numbers(&Design::slip_off);
  if (!where.is_none()) {
    result["B"] = array(std::move(B), {n, static_cast<py::ssize_t>(at.size()), 3});
    result["dB"] = array(std::move(dB), {n, static_cast<py::ssize_t>(at.size()), 3});
  }
  result["message"] = messages;
  return result;
}

/// One number for each material point at which a centreline is written.
template <class Number>
py::object along(const BentShape& shape, const Number& number) {
  const Centreline& centreline = shape.deformation().centreline;
  std::vector<double> values;
  for (const double S : output::output_points(centreline))
    values.push_back(number(S, centreline.at(S)));
  const auto n = static_cast<py::ssize_t>(values.size());
  return array(std::move(values), {n});
}

py::object positions(const BentShape& shape) {
  const Centreline& centreline = shape.deformation().centreline;
  std::vector<Vector3> all;
  for (const double S : output::output_points(centreline)) all.push_back(centreline.at(S).position);
  return array(all);
}

py::object pull_in(const BentShape& shape) {
  const std::optional<continuation::PullIn>& found = shape.step().pull_in;
  if (!found) return py::none();
  std::vector<double> approach;
  for (const continuation::ApproachToFold& at : found->approach)
    approach.insert(approach.end(), {at.fraction, at.smallest_eigenvalue});
  const auto n = static_cast<py::ssize_t>(found->approach.size());
  return py::dict(py::arg("fraction") = found->fraction, py::arg("load") = found->load,
                  py::arg("magnet") = found->magnet, py::arg("tip") = array(found->tip),
                  py::arg("tip_angle") = found->tip_angle,
                  py::arg("approach") = array(std::move(approach), {n, 2}));
}

template <class Entries>
py::dict described(const Entries& entries) {
  py::dict result;
  for (const auto& entry : entries) {
    py::dict options;
    for (const input::Option& option : entry.options)
      options[py::str(std::string(option.name))] =
          fmt::format("{} (default {})", option.doc, input::to_toml(option, option.initial));
    result[py::str(entry.id)] =
        py::dict(py::arg("description") = entry.description, py::arg("options") = options);
  }
  return result;
}

}  // namespace

void bind_models(py::module_& module) {
  const std::string& field_model = models::quick_one(models::field_models()).id;
  using ShapeClass = py::class_<BentShape>;
  ShapeClass(module, "Shape", "A bent cilium: one model's answer to one load. SI units.")
      .def_property_readonly("model", [](const BentShape& s) { return s.model(); })
      .def_property_readonly("cilium", [](const BentShape& s) { return s.problem().cilium; })
      .def_property_readonly("load", [](const BentShape& s) { return s.step().load; })
      .def_property_readonly(
          "status",
          [](const BentShape& s) { return std::string(output::to_string(s.step().status)); },
          "'converged', 'slipped_off' (the load is larger than any equilibrium bears), "
          "'pulled_in'\n"
          "(a magnet pulls the cilium in: see pull_in) or 'failed'.")
      .def_property_readonly("message", [](const BentShape& s) { return s.step().message; })
      .def_property_readonly(
          "tip", [](const BentShape& s) { return array(s.tip().position); }, "(3,), m.")
      .def_property_readonly(
          "tip_angle", [](const BentShape& s) { return s.tip().theta(); },
          "Angle of the tip's section from the upright one, rad.")
      .def_property_readonly(
          "tip_uncertainty", [](const BentShape& s) { return s.step().tip_uncertainty; },
          "Estimate of the numerical error of the tip's position, m; None: not known.")
      .def_property_readonly("tip_angle_uncertainty",
                             [](const BentShape& s) { return s.step().tip_angle_uncertainty; })
      .def_property_readonly(
          "applied_force", [](const BentShape& s) { return s.step().applied_force; },
          "Horizontal force that the model really applied, N.")
      .def_property_readonly(
          "slip_off", [](const BentShape& s) { return slip_off_limit(s.step()); },
          "Largest load that an equilibrium bears (a contact's force, N, a "
          "probe's displacement, m); None: not known.")
      .def_property_readonly(
          "slip_off_uncertainty", [](const BentShape& s) { return s.step().slip_off_uncertainty; },
          "Estimate of the numerical error of slip_off; None: not known.")
      .def_property_readonly(
          "has_shape", [](const BentShape& s) { return s.step().deformation.has_value(); },
          "Whether there is an equilibrium to be asked for.")
      .def_property_readonly("straight", &straight, "The straight cilium that it was bent from.")
      .def_property_readonly(
          "with_softer_joints", &with_softer_joints,
          "The shape by corrected joints that are as much softer as the\n"
          "correction is uncertain by; None of one whose joints are not corrected.")
      .def_property_readonly(
          "unstable_modes", [](const BentShape& s) { return s.step().unstable_modes; },
          "Ways in which the energy decreases, 0: stable; None: not known.")
      .def_property_readonly(
          "smallest_eigenvalue", [](const BentShape& s) { return s.step().smallest_eigenvalue; },
          "Smallest eigenvalue of the second variation over that of the straight cilium without "
          "loads; None: not known.")
      .def_property_readonly(
          "pull_in", &pull_in,
          "Where a magnet pulls the cilium in: a dict of fraction (of this load and its\n"
          "environment), load, magnet, tip (3,), m, tip_angle, rad, of the last equilibrium, and\n"
          "approach (n, 2): fractions, and the smallest eigenvalue over that of the straight\n"
          "cilium there. None: it is not pulled in.")
      .def_property_readonly(
          "magnet_forces",
          [](const BentShape& s) {
            std::vector<models::MagnetForce> forces;
            const Call call;
            {
              const py::gil_scoped_release released;
              forces = models::forces_on_magnets(s.problem().cilium, s.step());
            }
            py::dict result;
            for (const models::MagnetForce& on : forces)
              result[py::str(on.name)] = py::dict(py::arg("force") = array(on.force),
                                                  py::arg("torque") = array(on.torque));
            return result;
          },
          "Of each magnet of the environment, by its name: force (3,), N, and torque about its\n"
          "centre (3,), N m, that the cilium exerts on it.")
      .def_property_readonly("seconds", [](const BentShape& s) { return s.step().seconds; })
      .def_property_readonly(
          "S", [](const BentShape& s) { return along(s, [](double S, const auto&) { return S; }); },
          "Arc length of material points from the base, (n,), m.")
      .def_property_readonly("centreline", &positions, "Their positions, (n, 3), m.")
      .def_property_readonly(
          "theta",
          [](const BentShape& s) {
            return along(s, [](double, const auto& p) { return p.theta(); });
          },
          "Angle of the sections from the upright one, (n,), rad.")
      .def_property_readonly(
          "curvature",
          [](const BentShape& s) {
            return along(s, [](double, const auto& p) { return p.bending_curvature(); });
          },
          "Bending curvature, (n,), 1/m.")
      .def(
          "field", &field, py::arg("points"), py::arg("model") = field_model,
          "Field at points, (3,) or (n, 3), m, by a field model and its options: a dict of\n"
          "B, dB = B - B(straight), B_uncertainty, dB_uncertainty, each (n, 3), T, with NaN where\n"
          "there is none or it is not known, and message, which says why. Raises InputError,\n"
          "SolverError.")
      .def(
          "B",
          [](const BentShape& s, const Array& where, const Text& model, const py::kwargs& options) {
            return py::object(field(s, where, model, options)["B"]);
          },
          py::arg("points"), py::arg("model") = field_model, "B alone: (n, 3), T.")
      .def(
          "dB",
          [](const BentShape& s, const Array& where, const Text& model, const py::kwargs& options) {
            return py::object(field(s, where, model, options)["dB"]);
          },
          py::arg("points"), py::arg("model") = field_model, "B - B(straight): (n, 3), T.")
      .def("M", &magnetization_at, py::arg("points"), py::arg("model") = field_model,
           "Magnetisation of the bent magnet at points, as the field model has it: (n, 3), A/m, 0\n"
           "outside of the magnet. H = B / mu_0 - M.")
      .def(py::pickle(&state, &shape_of))
      .def("__repr__", [](const BentShape& s) {
        return s.step().deformation
                   ? fmt::format("<Shape by {}: tip ({:.4g}, {:.4g}, {:.4g}) mm>", s.model(),
                                 1e3 * s.tip().position.x(), 1e3 * s.tip().position.y(),
                                 1e3 * s.tip().position.z())
                   : fmt::format("<Shape by {}: {}>", s.model(),
                                 output::to_string(s.step().status));
      });

  module.def("bend_path", &bend, py::arg("cilium"), py::arg("loads"), py::arg("model"),
             py::arg("progress"));
  module.def(
      "best_field", [] { return models::quick_one(models::field_models()).id; },
      "The most detailed field model that takes but a moment.");
  module.def(
      "has_body",
      [](const Text& mechanics, const Text& field) {
        return std::pair(
            models::entry_of(models::mechanics_models(), text(mechanics, "mechanics")).has_body,
            models::entry_of(models::field_models(), text(field, "field")).has_body);
      },
      py::arg("mechanics"), py::arg("field"),
      "Whether the mechanics model gives the body of a solid, and whether the field model needs "
      "it.");
  module.def("bend_case", &bend_case, py::arg("case"), py::arg("loads"), py::arg("model"),
             py::arg("progress"));
  module.def("fields", &fields_of_shapes, py::arg("shapes"), py::arg("points"), py::arg("model"));
  module.def(
      "bend_batch", &batch, py::arg("cilia"), py::arg("loads"), py::arg("points") = py::none(),
      py::arg("model") = models::mechanics_models().front().id, py::arg("field") = field_model,
      py::arg("slip_off") = true,
      "Many designs at once, on all cores: a list of cilia and one load for each, points at which\n"
      "B is asked for, m, (m, 3) for all, (n, m, 3) for each (None: nowhere), and options of the\n"
      "mechanics model, such as joints='corrected'. Returns a dict of arrays, SI units: converged\n"
      "(n,), tip (n, 3), tip_angle (n,), applied_force (n,), slip_off (n,), B and\n"
      "dB = B - B(straight), (n, m, 3), with NaN where a design has no equilibrium, and a list\n"
      "message. slip_off, the largest contact force or probe's displacement, is NaN for loads "
      "that\n"
      "cannot slip off and for models that do not know it; slip_off=False does not look for it\n"
      "(NaN), which takes the elastica a third less time. One design's failure does not "
      "stop\n"
      "the others. Raises InputError.\n\n"
      ">>> import ciliaval as cv\n"
      ">>> rod = cv.Cilium(3e-3, [cv.Segment(20e-3, 1e6, magnetization=75e3)])\n"
      ">>> loads = [cv.Load('contact', force=f, height=16e-3) for f in (1e-3, 2e-3)]\n"
      ">>> cv.bend_batch([rod] * 2, loads, [[0, 0, -2e-3]])['dB'].shape\n"
      "(2, 1, 3)\n");
  module.def(
      "models",
      [] {
        return py::dict(py::arg("mechanics") = described(models::mechanics_models()),
                        py::arg("fields") = described(models::field_models()));
      },
      "The models: {'mechanics': {id: {'description', 'options'}}, 'fields': {...}}.");
}

}  // namespace ciliaval::python::core
