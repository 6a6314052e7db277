// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/sensing/response.h"
#include "fem/solid/solid_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "compare/models/registry.h"
#include "compare/sensing/sensing.h"
#include "fem/beam/beam.h"
#include "problem/error.h"
#include "tests/support/synthetic.h"

namespace ciliaval::compare {
namespace {

using testing::HasSubstr;

/// ΔB of a contact force at z = 16 mm, straight from the models.
template <class Mechanics, class FieldModel>
Eigen::VectorXd direct(const input::Case& problem, const Mechanics& mechanics,
                       const FieldModel& field, const sensing::Vector2& p) {
  const ContactLoad load{.force = p.norm(), .height = 16e-3, .azimuth = std::atan2(p.y(), p.x())};
  const MechanicsResult result = mechanics.solve(problem.cilium, {load});
  const Field bent =
      field.field(problem.cilium, *result.steps.front().deformation, problem.sensors);
  const Field straight = field.field(problem.cilium, result.undeformed, problem.sensors);
  Eigen::VectorXd change(static_cast<Eigen::Index>(3 * problem.sensors.size()));
  for (std::size_t s = 0; s < problem.sensors.size(); ++s)
    change.segment<3>(static_cast<Eigen::Index>(3 * s)) = bent.B[s] - straight.B[s];
  return change;
}

// Oracle: the models themselves under loads that are no nodes, with the load's own azimuth. One
// sensor is far off the axis, one on it.
TEST(Response, IsThatOfTheModels) {
  input::Case problem = test::paper_case({1e-3});
  problem.sensors = {{-0.1e-3, 0.2e-3, -1.55e-3}, {4e-3, -3e-3, 1e-3}, {0, 0, -3e-3}};
  const sensing::Shapes elastica = sensing::shapes_up_to(problem, "elastica", 4e-3);
  const sensing::Response volume(problem, "volume", elastica, problem.sensors);
  EXPECT_LT(volume.interpolation_error(), 1e-7 * volume.largest_change());
  const sensing::Response line(problem, "line", sensing::shapes_up_to(problem, "beam", 4e-3),
                               problem.sensors);
  for (const sensing::Vector2& p :
       {sensing::polar(3.3e-3, 0.4), sensing::polar(0.7e-3, -2.5), sensing::polar(4e-3, 1.9),
        sensing::polar(1e-5, 3.1), sensing::polar(0, 0)}) {
    const Eigen::VectorXd a =
        direct(problem, analytic::elastica::Elastica(), analytic::rod::VolumeField(), p);
    EXPECT_LT((volume.change(p) - a).norm(), 1e-8 * volume.largest_change()) << p.transpose();
    const Eigen::VectorXd b = direct(problem, fem::beam::Beam(), analytic::rod::LineField(), p);
    EXPECT_LT((line.change(p) - b).norm(), 1e-8 * line.largest_change()) << p.transpose();
  }
}

// Oracle: central differences; at zero load too, and beyond the range along the load.
TEST(Response, ItsDerivativeIsThatOfTheChange) {
  input::Case problem = test::paper_case({1e-3});
  problem.sensors.push_back({3e-3, 1e-3, -2e-3});
  const sensing::Response response(
      problem, "line", sensing::shapes_up_to(problem, "elastica", 3e-3), problem.sensors);
  constexpr double h = 1e-7;
  for (const sensing::Vector2& p :
       {sensing::polar(2e-3, 0.4), sensing::polar(0.1e-3, -2.5), sensing::polar(0, 0),
        sensing::polar(1.5e-3, 0.2), sensing::polar(2.9e-3, 1.6)}) {
    const Eigen::MatrixX2d derivative = response.derivative(p);
    for (int axis : {0, 1}) {
      const sensing::Vector2 step = h * sensing::Vector2::Unit(axis);
      const Eigen::VectorXd difference =
          (response.change(p + step) - response.change(p - step)) / (2 * h);
      EXPECT_LT((difference - derivative.col(axis)).norm(), 1e-6 * derivative.norm())
          << p.transpose() << ", axis " << axis;
    }
  }
  const sensing::Vector2 e = sensing::polar(1, 0.7);
  const Eigen::VectorXd beyond = (response.change(3.6e-3 * e) - response.change(3.4e-3 * e)) / 2e-4;
  EXPECT_LT((beyond - response.derivative(3e-3 * e) * e).norm(), 1e-9 * beyond.norm());
}

// Oracle: the slip-off that the elastica itself states for one load, and a range just below it.
TEST(Response, RangesEndAtTheSlipOff) {
  const input::Case problem = test::paper_case({1e-3});
  const auto model = models::entry_of(models::mechanics_models(), "elastica").make(problem.options);
  const double limit = model->solve(problem.cilium, {with_magnitude(problem.load_path[0], 1)})
                           .steps[0]
                           .slip_off_force.value();
  for (const double asked : {1.01 * limit, 7e-3, 1e3}) {
    const sensing::Shapes shapes = sensing::shapes_within(problem, "elastica", asked);
    EXPECT_LT(shapes.largest(), limit) << asked;
    EXPECT_GT(shapes.largest(), 0.9999 * limit) << asked;
    EXPECT_THAT(shapes.limit, HasSubstr("slips off"));
    EXPECT_LT(sensing::Response(problem, "volume", shapes, problem.sensors).interpolation_error(),
              1e-9);  // T, of 4e-4 T
    EXPECT_THAT(sensing::range_remark(shapes, asked, "N").value_or(""),
                HasSubstr("Loads are looked for up to 5.8"));
  }
  EXPECT_EQ(sensing::shapes_within(problem, "elastica", 0.9 * limit).limit, "");
  EXPECT_FALSE(sensing::range_remark(sensing::shapes_within(problem, "elastica", 1e-3), 1e-3, "N"));
}

TEST(Response, RefusesWhatItCannotServe) {
  input::Case problem = test::paper_case({1e-3});
  try {
    sensing::shapes_up_to(problem, "elastica", 7e-3);
    FAIL();
  } catch (const SolverError& error) {
    EXPECT_THAT(error.what(), HasSubstr("within the range of loads up to 0.007 N"));
  }
  const auto refuses = [&](const Load& load) {
    input::Case other = problem;
    other.load_path = {load};
    EXPECT_THROW(sensing::shapes_up_to(other, "elastica", 1e-4), InputError);
  };
  refuses(EnvironmentLoad{1, 0});
  surroundings::Environment around;
  around.uniform_field = {1e-3, 0, 0};  // a response is the same from all sides
  refuses(with_environment(problem.load_path.front(), around));
  EXPECT_THROW(sensing::shapes_up_to(problem, "elastica", 0), InputError);
  EXPECT_THROW(sensing::shapes_up_to(problem, "elastica", std::nan("")), InputError);
  problem.options.of<fem::solid::SolidOptions>().mesh = "mine.msh";
  EXPECT_THROW(sensing::shapes_up_to(problem, "solid", 1e-3), InputError);
  EXPECT_EQ(sensing::parse_pair("beam/volume").name(), "beam/volume");
  EXPECT_THROW(sensing::parse_pair("elastica"), InputError);
  EXPECT_THROW(sensing::parse_pair("elastic/volume"), InputError);
  EXPECT_THROW(sensing::parse_pair("elastica/mesh"), InputError);
}

}  // namespace
}  // namespace ciliaval::compare
