// SPDX-License-Identifier: LGPL-2.1-or-later
// What ranks send one another comes back to the bit.
#include "fem/solid/archive.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fem/solid/solid.h"

namespace ciliaval::fem {
namespace {

/// All numbers of a deformation, one after the other.
std::vector<double> numbers(const Deformation& deformation) {
  std::vector<double> all;
  const auto add = [&all](const auto& matrix) {
    all.insert(all.end(), matrix.data(), matrix.data() + matrix.size());
  };
  const auto add_all = [&add](const auto& matrices) {
    for (const auto& matrix : matrices) add(matrix);
  };
  for (const Centreline::Piece& piece : deformation.centreline.pieces()) {
    add(piece.S);
    for (const SectionState& state : piece.states) {
      add(state.position);
      add(state.rotation.coeffs());
      add(state.curvature);
      add(state.forces.force);
      add(state.forces.moment);
    }
  }
  add(deformation.centreline.breaks());
  add(deformation.body->nodes.nodes());
  for (const SolidCell& cell : deformation.body->cells) {
    all.push_back(static_cast<double>(cell.segment));
    add(cell.magnetization);
    add_all(cell.reference);
    add_all(cell.current);
    add(cell.jacobian);
    add_all(cell.cauchy_stress);
  }
  for (const ChargedFace& face : deformation.body->charged_faces) {
    add(face.magnetization_jump);
    add_all(face.reference);
    add_all(face.current);
  }
  return all;
}

TEST(SolidArchive, KeepsADeformation) {
  const Cilium cilium{3e-3, {{"base", 3e-3, 1e5, 0.49, 0}, {"magnet", 3e-3, 3e6, 0.49, 75e3}}};
  const MechanicsResult result =
      Solid({.refinement = 0}).solve(cilium, {ContactLoad{1e-3, 4.5e-3, 0.4}});
  const std::optional<Deformation>& deformation = result.steps.at(0).deformation;
  ASSERT_TRUE(deformation && deformation->body);
  std::optional<Deformation> read;
  std::optional<Deformation> none{std::in_place};
  deserialize(serialized(deformation, std::optional<Deformation>{}), read, none);
  ASSERT_TRUE(read && read->body);
  EXPECT_FALSE(none);
  const auto& body = *read->body;
  ASSERT_FALSE(body.charged_faces.empty());
  EXPECT_EQ(body.cells.size(), deformation->body->cells.size());
  EXPECT_EQ(body.cells.at(0).cauchy_stress.size(), 27U);
  EXPECT_EQ(numbers(*read), numbers(*deformation));
  EXPECT_EQ(read->centreline.at(3.3e-3).derivative, deformation->centreline.at(3.3e-3).derivative);
}

}  // namespace
}  // namespace ciliaval::fem
