// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/validation/computed.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "compare/models/errors.h"
#include "compare/output/results.h"
#include "compare/results/quantity.h"

namespace ciliaval::compare::validation {
namespace {

using input::measurement::Measurand;
using Kind = Measurand::Kind;

/// ξ of the point in the cell by Newton's method; none if it leads far away.
std::optional<Vector3> local_coordinates(const LagrangeBasis& nodes, const SolidCell& cell,
                                         const Vector3& reference) {
  Vector3 xi = Vector3::Constant(0.5);
  for (int i = 0; i < 20; ++i) {
    const SolidPoint at = evaluate(nodes, cell, xi);
    const Vector3 step = at.reference_gradient.partialPivLu().solve(reference - at.reference);
    xi += step;
    if (!xi.allFinite() || (xi - Vector3::Constant(0.5)).cwiseAbs().maxCoeff() > 2)
      return std::nullopt;
    if (step.cwiseAbs().maxCoeff() < 1e-12) return xi;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Vector3> material_point(const SolidBody& body, const Vector3& reference) {
  constexpr double outside = 0.01;
  double best = outside;
  std::optional<Vector3> result;
  for (const SolidCell& cell : body.cells) {
    Vector3 low = cell.reference.front();
    Vector3 high = low;
    for (const Vector3& node : cell.reference) {
      low = low.cwiseMin(node);
      high = high.cwiseMax(node);
    }
    const Vector3 margin = Vector3::Constant(0.1 * (high - low).maxCoeff());
    if ((reference - low + margin).minCoeff() < 0 || (high + margin - reference).minCoeff() < 0)
      continue;
    const auto xi = local_coordinates(body.nodes, cell, reference);
    if (!xi) continue;
    const double violation =
        std::max(0.0, ((*xi - Vector3::Constant(0.5)).cwiseAbs().maxCoeff()) - 0.5);
    if (violation > best || (result && violation == best)) continue;
    best = violation;
    result = evaluate(body.nodes, cell, *xi).current;
  }
  return result;
}

Computed computed(const Measurand& measurand, const models::MechanicsRun& run, std::size_t step,
                  const Vector3& direction) {
  const MechanicsStep& of = run.result.steps[step];
  if (measurand.kind == Kind::number) {
    const results::Quantity& quantity = results::quantities().at(measurand.index);
    const std::vector<double> values = quantity.values(of);
    if (values.empty() || !std::isfinite(values.front())) {
      if (of.status == Status::converged) return {{}, {}, "the model does not tell it"};
      return {{}, {}, of.message.empty() ? std::string(output::to_string(of.status)) : of.message};
    }
    return {values.front(), quantity.uncertainty ? quantity.uncertainty(of) : std::nullopt, {}};
  }
  if (of.status != Status::converged || !of.deformation)
    return {{}, {}, of.message.empty() ? std::string(output::to_string(of.status)) : of.message};
  const Centreline& line = of.deformation->centreline;
  const CentrelinePoint tip = line.at(line.length());
  const std::optional<double> angle = results::tip_angle_uncertainty(of);
  if (measurand.kind == Kind::angle) return {tip.theta(), angle, {}};
  const Vector3 offset(measurand.point[0], measurand.point[1], 0);
  const bool is_centre = offset.isZero(0);
  Vector3 place = tip.position + tip.rotation * offset;
  std::optional<double> u = of.tip_uncertainty;
  if (!is_centre) u = u && angle ? std::optional(*u + *angle * offset.norm()) : std::nullopt;
  const Vector3 reference = offset + line.length() * Vector3::UnitZ();
  if (!is_centre && of.deformation->body) {
    const auto found = material_point(*of.deformation->body, reference);
    if (!found) return {{}, {}, "the point lies in no cell of the body that this process holds"};
    place = *found;
  }
  const double value = measurand.kind == Kind::deflection
                           ? (place - reference).dot(direction)
                           : place[static_cast<Eigen::Index>(measurand.axis)];
  return {value, u, {}};
}

Computed computed(const Measurand& measurand, const models::FieldRun& run,
                  const models::MechanicsRun& mechanics, std::size_t step) {
  const auto field =
      models::field_value(run, mechanics, step, measurand.sensor, measurand.kind == Kind::dB);
  const auto axis = static_cast<Eigen::Index>(measurand.axis);
  if (!field) {
    const std::string failure = run.steps[step] ? run.steps[step]->failure : std::string{};
    return {{}, {}, failure.empty() ? "there is no field" : failure};
  }
  Computed result{field->value[axis], {}, {}};
  if (field->numerical && field->from_mechanics)
    result.numerical = (*field->numerical)[axis] + *field->from_mechanics + field->rounding;
  return result;
}

}  // namespace ciliaval::compare::validation
