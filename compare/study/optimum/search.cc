// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/study/optimum/search.h"

#include <Eigen/Dense>
#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <cstdint>
#include <exception>
#include <map>
#include <nlopt.hpp>
#include <utility>

namespace ciliaval::compare::study::optimum {
namespace {

using Point = std::vector<double>;

constexpr unsigned long seed = 20'261'122;
/// Step of the differences: their truncation is some 1e-8, and noise of 1e-12 makes as much.
constexpr double difference_step = 1e-4;
constexpr double bound_width = 1e-6;    ///< nearer to a bound than this is at it
constexpr double reached_width = 1e-5;  ///< the same of a constraint
constexpr double same_place = 1e-3;     ///< optima nearer than this are one
constexpr double global_step = 0.1;

/// The function with a memory, as NLopt wants to call it. NLopt passes no exception of another kind
/// through, so that one is kept here.
class Objective {
 public:
  Objective(const TrialFunction& function, std::size_t dimensions)
      : function_(function), dimensions_(dimensions) {}

  const Trial& at(const Point& u) {
    const auto known = trials_.find(u);
    if (known != trials_.end()) return known->second;
    return trials_.emplace(u, function_(u)).first->second;
  }

  /// ∂/∂u of the gain (row 0) and the constraints, by differences of second order within the box.
  Eigen::MatrixXd derivative(const Point& u) {
    const Eigen::VectorXd middle = values(u);
    Eigen::MatrixXd result(middle.size(), static_cast<Eigen::Index>(dimensions_));
    for (std::size_t i = 0; i < dimensions_; ++i) {
      const auto moved = [&](double steps) {
        Point point = u;
        point[i] = std::clamp(point[i] + steps * difference_step, 0.0, 1.0);
        return values(point);
      };
      const auto column = static_cast<Eigen::Index>(i);
      const double side = u[i] < difference_step ? 1 : u[i] > 1 - difference_step ? -1 : 0;
      if (side == 0)
        result.col(column) = (moved(1) - moved(-1)) / (2 * difference_step);
      else
        result.col(column) =
            side * (4 * moved(side) - moved(2 * side) - 3 * middle) / (2 * difference_step);
    }
    return result;
  }

  /// Begins a local search: best() is the best of what it asks for.
  void restart() { best_.reset(); }
  /// The feasible point with the largest gain since restart().
  const std::optional<Point>& best() const { return best_; }
  /// The point that misses the constraints least.
  const Point& nearest() const { return nearest_; }

  /// Lets NLopt search from a point; how it ends does not matter, as the best point is kept.
  void search(nlopt::opt optimiser, Point start) {
    optimiser.set_lower_bounds(0.0);
    optimiser.set_upper_bounds(1.0);
    optimiser.set_max_objective(&Objective::gain, this);
    const std::size_t constraints = at(start).constraints.size();
    if (constraints > 0)
      optimiser.add_inequality_mconstraint(&Objective::constraints, this,
                                           Point(constraints, feasibility / 10));
    double largest = 0;
    try {
      optimiser.optimize(start, largest);
    } catch (const nlopt::forced_stop&) {  // rethrown below
    } catch (const nlopt::roundoff_limited&) {
      // As far as it goes.
    } catch (const std::runtime_error&) {
      // NLOPT_FAILURE: SLSQP without a descent, at points without a gain.
    }
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  }

 private:
  Eigen::VectorXd values(const Point& u) {
    const Trial& trial = at(u);
    const auto count = static_cast<Eigen::Index>(trial.constraints.size());
    Eigen::VectorXd all(count + 1);
    all[0] = trial.gain;
    all.tail(count) = Eigen::VectorXd::Map(trial.constraints.data(), count);
    return all;
  }

  /// Remembers a point that the search itself asks for.
  void keep(const Point& u) {
    const Trial& trial = at(u);
    if (nearest_.empty() || trial.violation() < at(nearest_).violation()) nearest_ = u;
    if (!trial.is_defined || trial.violation() > feasibility) return;
    if (!best_ || trial.gain > at(*best_).gain) best_ = u;
  }

  template <class Work>
  void guarded(const Work& work) {
    try {
      work();
    } catch (...) {
      exception_ = std::current_exception();
      throw nlopt::forced_stop();
    }
  }

  static double gain(const Point& u, Point& gradient, void* data) {
    auto& self = *static_cast<Objective*>(data);
    double value = 0;
    self.guarded([&] {
      self.keep(u);
      value = self.at(u).gain;
      if (gradient.empty()) return;
      const Eigen::VectorXd derivative = self.derivative(u).row(0);
      std::copy(derivative.begin(), derivative.end(), gradient.begin());
    });
    return value;
  }

  static void constraints(unsigned int count, double* result, unsigned int n, const double* u,
                          double* gradient, void* data) {
    auto& self = *static_cast<Objective*>(data);
    self.guarded([&] {
      const Point point(u, u + n);
      const Trial& trial = self.at(point);
      std::copy(trial.constraints.begin(), trial.constraints.end(), result);
      if (gradient == nullptr) return;
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      RowMajor::Map(gradient, count, n) = self.derivative(point).bottomRows(count);
    });
  }

  const TrialFunction& function_;
  std::size_t dimensions_;
  std::map<Point, Trial> trials_;
  std::optional<Point> best_;
  Point nearest_;
  std::exception_ptr exception_;
};

/// The non-negative combination of the columns that is nearest to b, over all subsets of the
/// columns: there are a few.
Eigen::VectorXd non_negative_combination(const Eigen::MatrixXd& columns, const Eigen::VectorXd& b) {
  const Eigen::Index count = columns.cols();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(count);
  double least = b.norm();
  for (unsigned int subset = 1; subset < 1U << count; ++subset) {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index j = 0; j < count; ++j)
      if ((subset >> j & 1U) != 0) chosen.push_back(j);
    const Eigen::MatrixXd part = columns(Eigen::all, chosen);
    const Eigen::VectorXd weights = part.completeOrthogonalDecomposition().solve(b);
    const double distance = (part * weights - b).norm();
    if (weights.minCoeff() < 0 || distance >= least * (1 - 1e-9)) continue;
    least = distance;
    best.setZero();
    best(chosen) = weights;
  }
  return best;
}

/// The point, on a bound if it is within rounding of it and loses nothing there.
Point snapped(Objective& objective, const Point& u) {
  Point on = u;
  for (double& x : on)
    if (x <= bound_width || x >= 1 - bound_width) x = std::round(x);
  const Trial& there = objective.at(on);
  const bool loses = !there.is_defined || there.violation() > feasibility ||
                     there.gain < objective.at(u).gain - feasibility;
  return loses ? u : on;
}

/// A point with its multipliers.
LocalOptimum judged(Objective& objective, const Point& u) {
  LocalOptimum optimum{u, objective.at(u), {}, {}, {}, 0, 1};
  const Eigen::MatrixXd derivative = objective.derivative(u);
  const Eigen::Index n = derivative.cols();
  std::vector<Eigen::VectorXd> columns;
  std::vector<double*> multipliers;
  optimum.multipliers.resize(optimum.trial.constraints.size());
  optimum.bound_multipliers.resize(u.size());
  for (std::size_t j = 0; j < optimum.multipliers.size(); ++j) {
    if (optimum.trial.constraints[j] < -reached_width) continue;
    columns.emplace_back(derivative.row(static_cast<Eigen::Index>(j) + 1));
    multipliers.push_back(&optimum.multipliers[j]);
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    optimum.at_bound.push_back(u[i] <= bound_width ? -1 : u[i] >= 1 - bound_width ? 1 : 0);
    if (optimum.at_bound[i] == 0) continue;
    columns.emplace_back(optimum.at_bound[i] *
                         Eigen::VectorXd::Unit(n, static_cast<Eigen::Index>(i)));
    multipliers.push_back(&optimum.bound_multipliers[i]);
  }
  Eigen::MatrixXd matrix(n, static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j)
    matrix.col(static_cast<Eigen::Index>(j)) = columns[j];
  const Eigen::VectorXd gradient = derivative.row(0);
  const Eigen::VectorXd weights = non_negative_combination(matrix, gradient);
  for (std::size_t j = 0; j < columns.size(); ++j)
    *multipliers[j] = weights[static_cast<Eigen::Index>(j)];
  const Eigen::VectorXd rest = gradient - matrix * weights;
  optimum.residual = rest.cwiseAbs().maxCoeff();
  return optimum;
}

/// Where the local searches start besides the given points.
std::vector<Point> sobol_points(std::size_t dimensions, unsigned int count) {
  std::vector<Point> points(count, Point(dimensions));
  boost::random::sobol_engine<std::uint64_t, 64> sobol(dimensions);
  sobol.discard(dimensions);  // the first point is a corner
  for (Point& point : points)
    for (double& u : point) u = std::ldexp(static_cast<double>(sobol()), -64);
  return points;
}

double distance(const Point& a, const Point& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// COBYLA, then SLSQP from its end.
void search_locally(Objective& objective, const Point& start) {
  const auto n = static_cast<unsigned int>(start.size());
  nlopt::opt rough(nlopt::LN_COBYLA, n);
  rough.set_initial_step(global_step);
  rough.set_xtol_abs(1e-3);
  rough.set_maxeval(static_cast<int>(60 * (n + 1)));
  objective.restart();
  objective.search(rough, start);
  if (!objective.best()) return;
  nlopt::opt fine(nlopt::LD_SLSQP, n);
  fine.set_xtol_abs(1e-9);
  fine.set_maxeval(100);
  objective.search(fine, *objective.best());
}

/// The distinct ones, the best first.
void merge(std::vector<LocalOptimum>& optima) {
  std::stable_sort(optima.begin(), optima.end(), [](const LocalOptimum& a, const LocalOptimum& b) {
    return a.trial.gain > b.trial.gain;
  });
  std::vector<LocalOptimum> distinct;
  for (LocalOptimum& optimum : optima) {
    const auto same = std::find_if(distinct.begin(), distinct.end(), [&](const LocalOptimum& d) {
      return distance(d.u, optimum.u) < same_place;
    });
    if (same == distinct.end())
      distinct.push_back(std::move(optimum));
    else
      ++same->starts;
  }
  optima = std::move(distinct);
}

}  // namespace

double Trial::violation() const {
  double largest = 0;
  for (const double g : constraints) largest = std::max(largest, g);
  return largest;
}

SearchResult maximise(const TrialFunction& function, const std::vector<double>& start,
                      const SearchOptions& options) {
  Objective objective(function, start.size());
  std::vector<Point> starts{start};
  if (options.global_evaluations > 0) {
    nlopt::srand(seed);
    nlopt::opt global(nlopt::GN_ISRES, static_cast<unsigned int>(start.size()));
    global.set_maxeval(static_cast<int>(options.global_evaluations));
    objective.search(global, start);
    starts.push_back(objective.best().value_or(objective.nearest()));
  }
  const std::vector<Point> further = sobol_points(start.size(), options.starts);
  starts.insert(starts.end(), further.begin(), further.end());
  SearchResult result;
  std::vector<LocalOptimum> elsewhere;
  for (const Point& point : starts) {
    search_locally(objective, point);
    ++result.local_searches;
    if (!objective.best()) {
      ++result.infeasible;
      continue;
    }
    LocalOptimum optimum = judged(objective, snapped(objective, *objective.best()));
    (optimum.residual < stationary ? result.optima : elsewhere).push_back(std::move(optimum));
  }
  result.not_stationary = elsewhere.size();
  merge(result.optima);
  merge(elsewhere);
  // A better point is the result, even if nothing is known of its surroundings.
  if (!elsewhere.empty() &&
      (result.optima.empty() ||
       elsewhere.front().trial.gain > result.optima.front().trial.gain + feasibility))
    result.optima.insert(result.optima.begin(), elsewhere.front());
  result.nearest = objective.nearest();
  return result;
}

}  // namespace ciliaval::compare::study::optimum
