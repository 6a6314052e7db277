// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/potential/adaptive.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>

#include "fem/parallel.h"
#include "fem/potential/cut_cells.h"
#include "fem/potential/functional.h"
#include "fem/potential/multipole.h"
#include "fem/potential/operator.h"
#include "problem/error.h"
#include "problem/field_model.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::potential {
namespace {

constexpr unsigned int degree = 2;         ///< of the solution that B is taken from
constexpr double solver_tolerance = 1e-8;  ///< residual of ψ
constexpr double dual_tolerance = 1e-4;    ///< of the duals, which only choose the leaves to cut
/// Uncertainty over estimate: on random cilia errors are up to 1.4 estimates
/// (docs/evidence/potential.md).
constexpr double safety = 2;
constexpr double ball_over_distance = 0.7;         ///< radius of a sensor's ball over its distance
constexpr double finest_over_extent = 1.0 / 4096;  ///< finest leaf over the radius of the bodies
constexpr double refined_fraction = 0.7;           ///< of the indicators' sum, whose leaves are cut

/// The sphere that holds all bodies and points, and the sensors' balls.
struct Layout {
  Vector3 centre = Vector3::Zero();
  double radius = 0;
  std::vector<SensorBall> balls;
};

std::string to_text(const Vector3& x) {
  std::ostringstream text;
  text << '(' << x[0] << ", " << x[1] << ", " << x[2] << ") m";
  return text.str();
}

std::span<const PermeableBox> plates_of(const PotentialProblem& problem) {
  if (!problem.plates) return {};
  return problem.plates->boxes();
}

void require_valid(const PotentialProblem& problem, const PotentialControl& control) {
  const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
  if (!positive(problem.relative_permeability))
    throw InputError("the relative permeability of the magnet must be finite and positive");
  for (const PermeableBox& plate : plates_of(problem)) {
    if (!positive(plate.relative_permeability))
      throw InputError("the relative permeability of a plate must be finite and positive");
    if (!plate.box.sizes().allFinite() || !(plate.box.sizes().minCoeff() > 0))
      throw InputError("a plate's upper corner must lie above its lower one in x, y and z");
    for (const PermeableBox& other : plates_of(problem))
      if (&other != &plate && other.box.intersection(plate.box).sizes().minCoeff() > 0)
        throw InputError("two permeable plates overlap");
  }
  for (const Vector3& point : problem.points)
    if (!point.allFinite()) throw InputError("a point of the potential is not finite");
  if (!positive(control.tolerance) || problem.points.empty())
    throw InputError("the potential needs points and a positive tolerance");
}

Layout lay_out(const PotentialProblem& problem) {
  Layout layout;
  Eigen::AlignedBox3d all;
  for (const Magnet::Block& block : problem.magnet.blocks())
    all.extend(problem.magnet.extent(block).box);
  const Eigen::AlignedBox3d bodies = all;
  for (const Vector3& point : problem.points) all.extend(point);
  layout.centre = all.center();
  layout.radius = all.sizes().norm() / 2;
  const double finest = finest_over_extent * bodies.sizes().norm() / 2;
  for (const PermeableBox& plate : plates_of(problem))
    if (problem.magnet.meets(plate.box))
      throw InputError("a permeable plate and the magnet overlap");
  for (const Vector3& point : problem.points) {
    support::check_interruption();
    double distance = problem.magnet.distance(point, finest);
    double from_plates = std::numeric_limits<double>::infinity();
    for (const PermeableBox& plate : plates_of(problem))
      from_plates = std::min(from_plates, plate.box.exteriorDistance(point));
    if (std::min(distance, from_plates) < 2 * finest)
      throw InputError("the point " + to_text(point) + " lies in the magnet or a plate, or in a " +
                       "leaf that one of them cuts on the finest octree (" +
                       std::to_string(finest) + " m): the potential gives B only outside of them");
    layout.balls.push_back({point, ball_over_distance * std::min(distance, layout.radius)});
  }
  return layout;
}

/// Moves all ranks' leaves to the first one. Collective.
void gather_leaves(MPI_Comm communicator, std::vector<FieldMesh::Leaf>& leaves) {
  if (rank_count(communicator) == 1) return;
  constexpr std::size_t doubles = sizeof(FieldMesh::Leaf) / sizeof(double);
  static_assert(sizeof(FieldMesh::Leaf) == doubles * sizeof(double));
  const auto* const own = reinterpret_cast<const double*>(leaves.data());
  const auto all = dealii::Utilities::MPI::gather(
      communicator, std::vector<double>(own, own + doubles * leaves.size()));
  leaves.clear();
  for (const std::vector<double>& part : all) {
    const std::size_t first = leaves.size();
    leaves.resize(first + part.size() / doubles);
    std::copy(part.begin(), part.end(), reinterpret_cast<double*>(leaves.data() + first));
  }
}

/// Dipole and quadrupole of the magnet, and the largest |ψ| that they leave out on a sphere.
struct Source {
  Multipole magnet;
  double rest = 0;  ///< A
};

Source source_of(const Magnet& magnet, const Vector3& centre, double distance) {
  Source source;
  source.magnet.centre = centre;
  std::vector<MagnetSample> samples;
  for (const Magnet::Block& block : magnet.blocks()) magnet.sample(block, 4, samples);
  for (const MagnetSample& s : samples) source.magnet.add(s.position, s.moment);
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      for (int k = -2; k <= 2; ++k) {
        if (std::max({std::abs(i), std::abs(j), std::abs(k)}) != 2) continue;
        const Vector3 x = centre + distance / 2 * Vector3(i, j, k);
        double exact = 0;
        for (const MagnetSample& s : samples) exact += dipole_potential(s.moment, x - s.position);
        source.rest = std::max(source.rest, std::abs(exact - source.magnet.potential(x)));
      }
    }
  }
  return source;
}

/// ψ in a space, with its operator and its solver.
struct Solution {
  PotentialSpace space;
  PotentialOperator matrix;
  PotentialMultigrid multigrid;
  PotentialVector psi;  ///< complete

  Solution(const Octree& octree, unsigned int p, const CutCells& bodies,
           const PotentialMultigrid::Coarse& coarse)
      : space(octree, p), matrix(space, bodies), multigrid(matrix, coarse), psi(space.vector()) {}

  void solve_for(const CutCells& bodies, const std::function<double(const Vector3&)>& boundary,
                 const PotentialVector* guess);
};

void Solution::solve_for(const CutCells& bodies,
                         const std::function<double(const Vector3&)>& boundary,
                         const PotentialVector* guess) {
  const PotentialVector lift = space.boundary_values(boundary);
  PotentialVector load = matrix.apply_complete(lift);
  load *= -1;
  for (const int cell : bodies.cells())
    if (const Eigen::VectorXd F = bodies.source(cell, space.basis()); F.size() != 0)
      space.add_free(cell, F, load);
  load.compress(dealii::VectorOperation::add);
  PotentialVector x = space.vector();
  if (guess != nullptr) x = *guess;
  space.constraints().set_zero(x);
  solve(matrix, multigrid, load, solver_tolerance, x);
  psi = lift;
  psi.zero_out_ghost_values();
  psi += x;
  space.complete(psi);
}

/// The values of a complete vector of one space at the nodes of another on the same octree.
PotentialVector interpolated(const PotentialSpace& from, const PotentialVector& complete,
                             const PotentialSpace& to) {
  PotentialVector result = to.vector();
  const Eigen::MatrixXd values = interpolation(from.basis(), to.basis());
  Eigen::VectorXd u(from.nodes());
  for (int c = 0; c < static_cast<int>(from.octree().cells().size()); ++c) {
    from.read(c, complete, u);
    to.write(c, values * u, result);
  }
  return result;
}

class Adaptive {
 public:
  Adaptive(const PotentialProblem& problem, const PotentialControl& control)
      : problem_(problem),
        control_(control),
        layout_(lay_out(problem)),
        half_width_(control.box * layout_.radius),
        source_(source_of(problem.magnet, layout_.centre, half_width_)),
        octree_(layout_.centre, half_width_, control.communicator) {
    induced_.centre = layout_.centre;
  }

  void make_first_mesh();
  PotentialCycle solve();
  std::shared_ptr<const FieldMesh> mesh() const;
  std::vector<plates::InducedMoment> induced_moments() const;
  void refine() { octree_.refine_largest(indicators_, refined_fraction); }

 private:
  double boundary_value(const Vector3& x) const;
  void update_induced();
  double truncation() const;
  void set_indicators();
  std::vector<Vector3> interface_error() const;
  std::vector<Vector3> B_at_points(const PotentialSpace& space, const PotentialVector& psi) const;
  std::vector<std::vector<Vector3>> dual_directions() const;

  const PotentialProblem& problem_;
  const PotentialControl& control_;
  Layout layout_;
  double half_width_;
  Source source_;
  Octree octree_;
  Multipole induced_;          ///< of the permeable bodies, as the last mesh gives it
  double induced_change_ = 0;  ///< of its dipole by the last mesh, A·m²
  std::optional<CutCells> bodies_;
  std::unique_ptr<PotentialMultigrid::Coarse> coarse_;
  std::unique_ptr<Solution> low_;
  std::unique_ptr<Solution> high_;
  std::vector<Vector3> B_;
  std::vector<double> indicators_;  ///< one for each own leaf
};

void Adaptive::make_first_mesh() {
  const auto too_coarse = [&](const Cube& cube) {
    if (cube.size > half_width_ / 3) return true;
    for (const SensorBall& ball : layout_.balls)
      if (cube.size > ball.radius && cube.box().exteriorDistance(ball.centre) < ball.radius)
        return true;
    // Leaves that a plate meets are not drawn.
    for (const PermeableBox& plate : plates_of(problem_))
      if (cube.size > plate.box.sizes().minCoeff() && cube.box().intersects(plate.box)) return true;
    return false;
  };
  while (octree_.refine(too_coarse)) {
  }
  // The magnet in leaves no larger than twice its largest block is wide.
  std::vector<Magnet::Extent> extents;
  double width = 0;
  for (const Magnet::Block& block : problem_.magnet.blocks()) {
    extents.push_back(problem_.magnet.extent(block));
    Vector3 lengths = extents.back().lengths;
    std::sort(lengths.begin(), lengths.end());
    width = std::max(width, lengths[1]);
  }
  const auto too_coarse_for_magnet = [&](const Cube& cube) {
    return cube.size > 2 * width &&
           std::any_of(extents.begin(), extents.end(),
                       [&](const Magnet::Extent& e) { return cube.box().intersects(e.box); });
  };
  while (octree_.refine(too_coarse_for_magnet)) {
  }
}

double Adaptive::boundary_value(const Vector3& x) const {
  return source_.magnet.potential(x) + induced_.potential(x) -
         problem_.uniform_field.dot(x - layout_.centre) / vacuum_permeability;
}

/// Moments (μ_r − 1) H dv of the permeable bodies.
void Adaptive::update_induced() {
  Multipole sum;
  sum.centre = layout_.centre;
  bodies_->for_each_permeable_point(high_->space, high_->psi,
                                    [&](const Vector3& x, double weight, const Vector3& gradient) {
                                      sum.add(x, -weight * gradient);
                                    });
  std::array<double, 12> values{};
  std::copy_n(sum.dipole.data(), 3, values.begin());
  std::copy_n(sum.moments.data(), 9, values.begin() + 3);
  const dealii::ArrayView<double> view(values.data(), values.size());
  dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(view), octree_.communicator(), view);
  std::copy_n(values.begin(), 3, sum.dipole.data());
  std::copy_n(values.begin() + 3, 9, sum.moments.data());
  induced_change_ = (sum.dipole - induced_.dipole).norm();
  induced_ = sum;
}

/// The shares of the induced moments on all ranks, summed over cubes of a quarter of the magnet's
/// distance from the plates.
std::vector<plates::InducedMoment> Adaptive::induced_moments() const {
  if (problem_.relative_permeability == 1) return {};
  double distance = layout_.radius;
  for (const Magnet::Block& block : problem_.magnet.blocks())
    for (const PermeableBox& plate : plates_of(problem_))
      distance = std::min(distance, plate.box.exteriorDistance(problem_.magnet.extent(block).box));
  const double cube = std::max(distance, finest_over_extent * layout_.radius) / 4;
  std::map<std::array<long, 3>, plates::InducedMoment> cubes;
  bodies_->for_each_permeable_point(
      high_->space, high_->psi, [&](const Vector3& x, double weight, const Vector3& gradient) {
        plates::InducedMoment& sum =
            cubes[{std::lround(x[0] / cube), std::lround(x[1] / cube), std::lround(x[2] / cube)}];
        sum.position += weight * x;
        sum.volume += weight;
        sum.moment -= weight * gradient;
      });
  std::vector<double> own;
  for (const auto& [place, sum] : cubes)
    for (const double value : {sum.position[0], sum.position[1], sum.position[2], sum.volume,
                               sum.moment[0], sum.moment[1], sum.moment[2]})
      own.push_back(value);
  std::vector<plates::InducedMoment> result;
  for (const std::vector<double>& part :
       dealii::Utilities::MPI::all_gather(octree_.communicator(), own))
    for (std::size_t i = 0; i + 7 <= part.size(); i += 7)
      if (part[i + 3] != 0)
        result.push_back({Vector3(part[i], part[i + 1], part[i + 2]) / part[i + 3],
                          part[i + 3],
                          {part[i + 4], part[i + 5], part[i + 6]}});
  return result;
}

/// A harmonic function that is at most δ on the boundary has a gradient of at most 3δ/d at the
/// distance d from it (mean-value property). δ holds the magnet's higher multipoles, and of the
/// induced moments the last mesh's change and the higher multipoles, at most |m| a²/(πL⁴) for
/// bodies within a radius a.
double Adaptive::truncation() const {
  const double L = half_width_;
  const double delta = source_.rest + induced_change_ / (4 * std::numbers::pi * L * L) +
                       induced_.dipole.norm() * layout_.radius * layout_.radius /
                           (std::numbers::pi * std::pow(L, 4));
  return 3 * vacuum_permeability * delta / (L - layout_.radius);
}

std::vector<Vector3> Adaptive::B_at_points(const PotentialSpace& space,
                                           const PotentialVector& psi) const {
  std::vector<Vector3> B = SensorFunctional(space, layout_.balls).gradients(psi);
  for (Vector3& value : B) value *= -vacuum_permeability;
  return B;
}

PotentialCycle Adaptive::solve() {
  high_.reset();
  low_.reset();
  coarse_.reset();
  bodies_.emplace(octree_, degree + 1);
  bodies_->add(problem_.magnet, problem_.relative_permeability);
  coarse_ = std::make_unique<PotentialMultigrid::Coarse>(octree_, *bodies_);
  const auto boundary = [&](const Vector3& x) { return boundary_value(x); };
  low_ = std::make_unique<Solution>(octree_, degree, *bodies_, *coarse_);
  low_->solve_for(*bodies_, boundary, nullptr);
  high_ = std::make_unique<Solution>(octree_, degree + 1, *bodies_, *coarse_);
  const PotentialVector guess = interpolated(low_->space, low_->psi, high_->space);
  high_->solve_for(*bodies_, boundary, &guess);

  PotentialCycle cycle;
  cycle.unknowns = low_->space.unknowns();
  cycle.B = B_at_points(low_->space, low_->psi);
  B_ = B_at_points(high_->space, high_->psi);
  for (std::size_t i = 0; i < B_.size(); ++i) cycle.difference.push_back(B_[i] - cycle.B[i]);
  update_induced();
  cycle.truncation = truncation();
  cycle.interface_error = interface_error();
  set_indicators();
  for (const Vector3& B : B_)
    if (!B.allFinite()) throw SolverError("the potential is not finite");
  return cycle;
}

/// Loads of the dual problems: the three components at one point, over |B| there. With more points
/// three sums over all of them with random signs: in the mean over the signs, the squares of their
/// solutions are the sums of the squares of all duals.
std::vector<std::vector<Vector3>> Adaptive::dual_directions() const {
  std::vector<std::vector<Vector3>> result;
  for (int d = 0; d < 3; ++d) {
    std::vector<Vector3> directions;
    unsigned int state = 12345;
    for (const Vector3& B : B_) {
      state = state * 1103515245U + 12345U;
      const double sign = ((state >> 16U) & 1U) != 0U ? 1 : -1;
      directions.emplace_back(sign / std::max(B.norm(), 1e-300) * Vector3::Unit(d));
    }
    result.push_back(directions);
  }
  return result;
}

std::shared_ptr<const FieldMesh> Adaptive::mesh() const {
  auto result = std::make_shared<FieldMesh>();
  result->leaves.resize(octree_.cells().size());
  Eigen::VectorXd u(low_->space.nodes());
  static_assert(degree == 2, "a leaf of FieldMesh has 27 nodes");
  for (std::size_t c = 0; c < result->leaves.size(); ++c) {
    FieldMesh::Leaf& leaf = result->leaves[c];
    const int cell = static_cast<int>(c);
    leaf.lower = octree_.cubes()[c].lower;
    leaf.size = octree_.cubes()[c].size;
    low_->space.read(cell, low_->psi, u);
    std::copy_n(u.data(), 27, leaf.psi.begin());
    leaf.magnetization = bodies_->mean_magnetization(cell);
    leaf.relative_permeability = bodies_->mean_permeability(cell);
  }
  gather_leaves(control_.communicator, result->leaves);
  return result;
}

/// Share of the permeable bodies in the difference of the degrees, T. With ψ_p and z_p of the
/// degree p, ∂J(ψ_p)/∂μ_r = −∫ ∇ψ_p·∇z_p over the body, so that the share is about
/// −∫ (μ_r − 1) ∇(ψ₃ − ψ₂)·∇z = J(w) with a(w, φ) = −∫ (μ_r − 1) ∇(ψ₃ − ψ₂)·∇φ: no dual is needed.
std::vector<Vector3> Adaptive::interface_error() const {
  const PotentialSpace& space = low_->space;
  const Eigen::MatrixXd raise = interpolation(space.basis(), high_->space.basis());
  Eigen::VectorXd u(space.nodes());
  Eigen::VectorXd v(high_->space.nodes());
  PotentialVector load = space.vector();
  for (const int cell : bodies_->cells()) {
    if (!bodies_->has_permeability(cell)) continue;
    space.read(cell, low_->psi, u);
    high_->space.read(cell, high_->psi, v);
    v = raise * u - v;
    space.add_free(cell, raise.transpose() * high_->matrix.bodies_part(cell, v), load);
  }
  load.compress(dealii::VectorOperation::add);
  PotentialVector w = space.vector();
  if (load.l2_norm() > 0) potential::solve(low_->matrix, low_->multigrid, load, dual_tolerance, w);
  space.complete(w);
  return B_at_points(space, w);
}

/// Indicator of a leaf: the product of the energy norms of the errors of ψ and of the duals on it.
/// The error of ψ is the difference of the two degrees. The error of a dual z is estimated from the
/// energies s₁ of its trilinear part and s₂ of the rest as s₂²/s₁, plus the interface error: no
/// polynomial of the leaf follows z across the surface of a permeable body.
void Adaptive::set_indicators() {
  const PotentialSpace& space = low_->space;
  const auto cells = static_cast<int>(octree_.cells().size());
  const LagrangeBasis linear({0, 1});
  const Eigen::MatrixXd to_linear = interpolation(space.basis(), linear);
  const Eigen::MatrixXd from_linear = interpolation(linear, space.basis());
  const Eigen::MatrixXd raise = interpolation(space.basis(), high_->space.basis());
  Eigen::VectorXd u(space.nodes());
  Eigen::VectorXd v(high_->space.nodes());
  indicators_.assign(octree_.cells().size(), 0);
  const SensorFunctional functional(space, layout_.balls);
  for (const std::vector<Vector3>& direction : dual_directions()) {
    PotentialVector z = space.vector();
    potential::solve(low_->matrix, low_->multigrid, functional.load(direction), dual_tolerance, z);
    z.update_ghost_values();
    for (int c = 0; c < cells; ++c) {
      space.read_free(c, z, u);
      const Eigen::VectorXd trilinear = from_linear * (to_linear * u);
      const double s1 = low_->matrix.energy(c, trilinear);
      const double s2 = low_->matrix.energy(c, u - trilinear);
      double& sum = indicators_[static_cast<std::size_t>(c)];
      if (s2 > 0) sum += s2 * std::min(1.0, s2 / s1);
      sum += bodies_->interface_indicator(c) / 4 * (s1 + s2);
    }
  }
  for (int c = 0; c < cells; ++c) {
    space.read(c, low_->psi, u);
    high_->space.read(c, high_->psi, v);
    v -= raise * u;
    double& indicator = indicators_[static_cast<std::size_t>(c)];
    indicator = std::sqrt(indicator * high_->matrix.energy(c, v));
  }
}

}  // namespace

Vector3 PotentialCycle::estimate(std::size_t point) const {
  const Vector3 error = difference[point] + 2 * interface_error[point];
  const Vector3 shared = (error.array().square() / 2 + error.squaredNorm() / 6).sqrt();
  return shared.array() + truncation;
}

namespace {

/// True if B has moved from the last mesh but one by no more than the two estimates together: a
/// single small estimate may be luck.
bool agrees_with_last(const std::vector<PotentialCycle>& cycles) {
  if (cycles.size() < 2) return false;
  const PotentialCycle& last = cycles.back();
  const PotentialCycle& before = cycles[cycles.size() - 2];
  for (std::size_t i = 0; i < last.B.size(); ++i)
    if ((last.B[i] - before.B[i]).norm() > last.estimate(i).norm() + before.estimate(i).norm())
      return false;
  return true;
}

}  // namespace

bool has_untested_jump(const PotentialProblem& problem) {
  const double mu = problem.relative_permeability;
  return std::max(mu, 1 / mu) > largest_tested_jump;
}

namespace {

void add_plates(const PotentialProblem& problem, const PotentialControl& control,
                const std::vector<plates::InducedMoment>& induced, PotentialResult& result) {
  std::vector<double> tolerance;
  for (const Vector3& B : result.B)
    tolerance.push_back(result.uncertainty.empty() ? std::numeric_limits<double>::infinity()
                                                   : control.tolerance / 2 * B.norm());
  const plates::AddedField added =
      problem.plates->field(problem.magnet, problem.relative_permeability - 1, induced,
                            problem.uniform_field, problem.points, tolerance);
  for (std::size_t i = 0; i < result.B.size(); ++i) {
    result.B[i] += added.B[i];
    if (!result.uncertainty.empty()) result.uncertainty[i].array() += added.uncertainty[i];
  }
  result.mesh = plates::with_plates(*result.mesh, *problem.plates, added);
}

}  // namespace

PotentialResult solve_potential(const PotentialProblem& problem, const PotentialControl& control) {
  start_mpi();
  require_valid(problem, control);
  Adaptive adaptive(problem, control);
  adaptive.make_first_mesh();
  PotentialResult result;
  const bool is_known = !has_untested_jump(problem);
  const bool has_plates = !plates_of(problem).empty();
  const double tolerance = has_plates ? control.tolerance / 2 : control.tolerance;
  while (true) {
    result.cycles.push_back(adaptive.solve());
    const PotentialCycle& cycle = result.cycles.back();
    result.B = cycle.B;
    result.uncertainty.clear();
    double worst = 0;
    for (std::size_t i = 0; i < cycle.B.size(); ++i) {
      result.uncertainty.push_back(safety * cycle.estimate(i));
      worst = std::max(worst, result.uncertainty.back().norm() / cycle.B[i].norm());
    }
    const bool is_exhausted =
        !is_known && cycle.unknowns > std::min(control.untested_unknowns, control.max_unknowns);
    if ((worst <= tolerance && agrees_with_last(result.cycles)) || is_exhausted) {
      if (!is_known) result.uncertainty.clear();
      result.mesh = adaptive.mesh();
      if (has_plates) add_plates(problem, control, adaptive.induced_moments(), result);
      return result;
    }
    if (cycle.unknowns > control.max_unknowns)
      throw SolverError("the potential was asked for " + std::to_string(control.tolerance) +
                        " of |B| and has " + std::to_string(worst) + " with " +
                        std::to_string(cycle.unknowns) +
                        " unknowns: ask for less, or allow more unknowns");
    adaptive.refine();
  }
}

}  // namespace ciliaval::fem::potential
