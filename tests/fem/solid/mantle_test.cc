// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/postprocessing/mantle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"

namespace ciliaval::fem::solid {
namespace {

using postprocessing::mantle_compression;

const Cilium cilium{2e-3, {{"stub", 3e-3, 1e5, 0.49, 0}, {"magnet", 5e-3, 1e6, 0.49, 7e4}}};

/// A straight cilium that is displaced by a given map.
struct MappedCilium {
  Cilium shape;
  dealii::Triangulation<3> triangulation;
  std::unique_ptr<dealii::MappingQCache<3>> mapping;
  std::unique_ptr<discretisation::SolidSpace> space;

  explicit MappedCilium(const Cilium& of = cilium) : shape(of) {
    meshes::cylinder::CylinderMeshOptions options;
    options.square_cells = 2;
    options.rings = 1;
    options.finest_layer = 0.1;
    options.coarsest_layer = 0.2;
    meshes::cylinder::make_cylinder(shape, options, triangulation);
    mapping = meshes::cylinder::cylinder_mapping(triangulation);
    const std::vector<material::Hyperelastic> materials(
        shape.segments.size(), material::Hyperelastic::neo_hooke(3e4, 2e6));
    space = std::make_unique<discretisation::SolidSpace>(triangulation, *mapping, materials);
  }

  postprocessing::MantleCompression compression(
      const std::function<Vector3(const Vector3& X)>& map) const {
    discretisation::SolidState state = space->undeformed();
    for (const discretisation::SolidElement& element : space->elements())
      for (std::size_t a = 0; a < discretisation::element_nodes; ++a) {
        const Vector3 X = element.nodes.row(static_cast<Eigen::Index>(a)).transpose();
        const Vector3 x = map(X);
        for (std::size_t c = 0; c < 3; ++c) {
          const auto i = static_cast<Eigen::Index>(c);
          state.displacement[element.dofs[c * discretisation::element_nodes + a]] = x[i] - X[i];
        }
      }
    return mantle_compression(*space, shape, state);
  }
};

/// Shortened to s and wide by w, and turned: λ₁ = s, λₙ = w all round.
TEST(MantleCompression, IsTheRatioOfTheStretchesWhateverTheRotation) {
  const Eigen::AngleAxisd turn(1.1, Vector3(1, 2, -1).normalized());
  const auto found = MappedCilium().compression(
      [&](const Vector3& X) { return turn * Vector3(1.25 * X.x(), 1.25 * X.y(), 0.6 * X.z()); });
  EXPECT_NEAR(found.ratio, 1.25 / 0.6, 1e-11);
  EXPECT_NEAR(found.stretch, 0.6, 1e-11);
}

/// Under tension the hoops are shortened, as much as the mantle gets thinner.
TEST(MantleCompression, IsOneUnderTension) {
  const auto found = MappedCilium().compression(
      [](const Vector3& X) { return Vector3(0.8 * X.x(), 0.8 * X.y(), 1.7 * X.z()); });
  EXPECT_NEAR(found.ratio, 1, 1e-11);
}

/// Simple shear γ: where the mantle's normal is φ off Y, the products of the tangents are 1, 1 + γ²
/// and γ cos φ, and det F = 1.
TEST(MantleCompression, SeesAnObliqueCompression) {
  const double shear = 0.9;
  const auto found = MappedCilium().compression(
      [&](const Vector3& X) { return Vector3(X.x() + shear * X.z(), X.y(), X.z()); });
  // The Gauss point that is nearest to Y, on an arc of 45 degrees that ends there.
  const double phi = std::numbers::pi / 8 * (1 - 1 / std::sqrt(3));
  const double product = shear * std::cos(phi);
  const double mean = 1 + shear * shear / 2;
  const double determinant = 1 + shear * shear - product * product;
  const double least = std::sqrt(mean - std::sqrt(mean * mean - determinant));
  EXPECT_NEAR(found.ratio, 1 / (std::sqrt(determinant) * least), 1e-3);
}

/// λ₁ = 1 − cZ, λₙ = 1: the largest ratio is that of the highest point that counts.
TEST(MantleCompression, LeavesOutTheRims) {
  const double c = 60;
  const auto found = MappedCilium().compression(
      [&](const Vector3& X) { return Vector3(X.x(), X.y(), X.z() - c / 2 * X.z() * X.z()); });
  const double highest = 8e-3 - 0.1 * 2e-3;
  EXPECT_LE(found.height, highest);
  EXPECT_GT(found.height, highest - 0.2 * 2e-3);
  EXPECT_NEAR(found.ratio, 1 / (1 - c * found.height), 1e-9);
}

/// λ₁ = 1 − a + b|Z − Z_i|, smallest at the interface, whose rim does not count.
TEST(MantleCompression, LeavesOutTheRimsOfInterfaces) {
  const double interface = 3e-3;
  const double b = 100;
  const auto found = MappedCilium().compression([&](const Vector3& X) {
    const double Z = X.z() - interface;
    return Vector3(X.x(), X.y(), interface + 0.5 * Z + b / 2 * Z * std::abs(Z));
  });
  const double distance = std::abs(found.height - interface);
  EXPECT_GE(distance, 0.1 * 2e-3);
  EXPECT_LE(distance, 0.3 * 2e-3);
  EXPECT_NEAR(found.stretch, 0.5 + b * distance, 1e-9);
}

/// A thin soft joint, of one layer of cells, is looked at.
TEST(MantleCompression, SeesAThinSegment) {
  const double a = 3e-3;
  const double b = 3.1e-3;
  const Cilium glued{
      2e-3,
      {{"stub", a, 1e6, 0.49, 0}, {"glue", b - a, 1e5, 0.49, 0}, {"magnet", 5e-3, 1e6, 0.49, 7e4}}};
  const auto found = MappedCilium(glued).compression([&](const Vector3& X) {
    const double shortened = 0.5 * (std::clamp(X.z(), a, b) - a);
    return Vector3(X.x(), X.y(), X.z() - shortened);
  });
  EXPECT_NEAR(found.ratio, 2, 1e-9);
  EXPECT_GT(found.height, a);
  EXPECT_LT(found.height, b);
}

TEST(MantleCompression, IsInfiniteWhereTheMantleIsInsideOut) {
  const auto found =
      MappedCilium().compression([](const Vector3& X) { return Vector3(X.x(), X.y(), -X.z()); });
  EXPECT_TRUE(std::isinf(found.ratio));
}

/// A short soft stub that bends by 40° folds; at a third of this it does not.
TEST(SolidFold, LeavesTheErrorUnknown) {
  const Cilium soft{2e-3, {{"stub", 1.2e-3, 1e5, 0.49, 0}, {"magnet", 10e-3, 1e7, 0.49, 7e4}}};
  SolidOptions options;
  options.refinement = 0;
  const MechanicsResult result = Solid(options).solve(
      soft,
      {SectionLoad{0.6e-3, 8e-3, 0}, SectionLoad{6e-3, 8e-3, 0}, SectionLoad{0.6e-3, 8e-3, 0}});
  for (const std::size_t i : {0, 2}) {
    EXPECT_EQ(result.steps[i].message, "");
    EXPECT_TRUE(result.steps[i].tip_uncertainty) << i;
  }
  const MechanicsStep& folded = result.steps[1];
  ASSERT_EQ(folded.status, Status::converged) << folded.message;
  EXPECT_NE(folded.message.find("folds"), std::string::npos) << folded.message;
  EXPECT_FALSE(folded.tip_uncertainty);
  EXPECT_FALSE(folded.tip_angle_uncertainty);
  EXPECT_FALSE(folded.applied_force_uncertainty);
}

/// The probe of the paper's cilium slips off where its base is about to fold.
TEST(SolidFold, LeavesTheSlipOffsErrorUnknown) {
  const Cilium paper{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 17e-3, 3e6, 0.49, 75e3}}};
  SolidOptions options;
  options.refinement = 0;
  const MechanicsResult result = Solid(options).solve(paper, {ContactLoad{6e-3, 16e-3, 0}});
  const MechanicsStep& step = result.steps.front();
  ASSERT_EQ(step.status, Status::slipped_off) << step.message;
  EXPECT_NE(step.message.find("folds"), std::string::npos) << step.message;
  EXPECT_TRUE(step.slip_off_force);
  EXPECT_FALSE(step.slip_off_uncertainty);
}

}  // namespace
}  // namespace ciliaval::fem::solid
