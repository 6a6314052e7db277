// SPDX-License-Identifier: LGPL-2.1-or-later
// What the paper says of the flow (section 3.5, Fig. 5).
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "compare/claims/claim.h"
#include "compare/sensing/bench.h"
#include "problem/error.h"

namespace ciliaval::compare::claims {
namespace {

/// R² of |ΔB| = a v² + b over the case's velocities, as measured at one azimuth. The interpolation
/// of the response may change each |ΔB| and thus the misfit; errors in proportion to |ΔB| cancel.
Span linearity(const sensing::Response& response, const std::vector<double>& forces) {
  Eigen::MatrixX2d A(static_cast<Eigen::Index>(forces.size()), 2);
  Eigen::VectorXd y(A.rows());
  for (Eigen::Index i = 0; i < A.rows(); ++i) {
    const double q = forces[static_cast<std::size_t>(i)];
    A.row(i) << q, 1;  // q is v² but for a factor
    y[i] = response.change(sensing::Vector2(q, 0)).norm();
  }
  const Eigen::VectorXd residual = y - A * A.colPivHouseholderQr().solve(y);
  const double deviation = (y.array() - y.mean()).matrix().norm();
  const double misfit = residual.norm() / deviation;
  const double off =
      response.interpolation_error() * std::sqrt(static_cast<double>(y.size())) / deviation;
  const double r2 = 1 - misfit * misfit;
  return {r2, r2, off * (2 * misfit + off)};
}

Claim largest_force(const sensing::Bench& bench) {
  const sensing::FlowLaw flow = *sensing::flow_law(bench.problem);
  const double q = flow.force_per_height(input::stated_values(bench.problem, "velocity").back());
  return {"3.5, Eq. 11",
          "the largest force per length is 0.375 N/m at 0.5 m/s",
          {},
          {in_range("rho v2 C_d d/2", {q, q}, "N/m", 0.3745, 0.3755)}};
}

Claim linear_response(const sensing::Bench& bench, bool with_solid, const Progress& progress) {
  Claim claim{"3.5",
              "the field's change is approximately linear in v2",
              "R2 of a straight line through |dB| at the case's velocities; held to R2 > 0.99, as "
              "the paper's other comparisons are. The paper gives no figure.",
              {}};
  std::vector<double> forces;
  for (const Load& load : bench.problem.load_path) forces.push_back(magnitude(load));
  std::vector<models::ModelPair> pairs{
      {"elastica", "line"}, {"elastica", "volume"}, {"beam", "volume"}};
  if (with_solid) pairs.push_back({"solid", "mesh"});
  for (const models::ModelPair& pair : pairs) {
    const sensing::Response response(
        bench.problem, pair.field,
        sensing::shapes_up_to(bench.problem, pair.mechanics, forces.back(), progress),
        bench.problem.sensors);
    claim.evidence.push_back(
        in_range(pair.name() + ": R2", linearity(response, forces), "", 0.99, 1));
  }
  return claim;
}

Claim direction(sensing::Bench bench, bool with_solid, const Progress& progress) {
  Claim claim{
      "abstract, 3.5, Fig. 5e",
      "direction of the flow within 10 deg, 0 to 0.5 m/s",
      "Simulated from 0.1 m/s on, with the stated errors of cases/paper/fig5.sense.toml, without "
      "turbulence; +-: 95 %, from the scatter of the simulated sensors. Towards 0 the direction is "
      "lost in the noise. The paper's readings were not published.",
      {}};
  if (!with_solid) bench.truth = {"beam", "volume"};
  const sensing::BenchResult result = sensing::run_bench(bench, progress);
  const sensing::BenchRow& all = result.rows.back();
  const std::string pair = bench.truth.name() + " by " + bench.models.name();
  const auto degrees = [](double angle) { return angle * 180 / std::numbers::pi; };
  const auto add = [&](const std::string& what, const sensing::BenchErrors& errors) {
    const double rms = degrees(errors.azimuth_rms);
    claim.evidence.push_back(
        in_range(what + ", rms", {rms, rms, degrees(errors.azimuth_rms_interval)}, "deg", 0, 10));
    const double part = 100 * errors.below_ten_degrees;
    claim.evidence.push_back(in_range(what + ", within 10 deg", {part, part}, "%", 99, 100));
  };
  add(pair, all.inversion);
  add(pair + ", linear fit", all.linear_fit);
  add(pair + ", slowest flow", result.by_magnitude.front());
  return claim;
}

}  // namespace

std::vector<Claim> flow_claims(const std::filesystem::path& folder, bool with_solid,
                               const Progress& progress) {
  const sensing::Bench bench = sensing::read_bench(folder / "fig5.sense.toml");
  if (input::stated_values(bench.problem, "velocity").empty())
    throw InputError("fig5.sense.toml: its case is no flow of a velocity");
  return {largest_force(bench), linear_response(bench, with_solid, progress),
          direction(bench, with_solid, progress)};
}

}  // namespace ciliaval::compare::claims
