// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Many points are dealt out to threads: that must change nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/field_points.h"
#include "problem/error.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/cylinder_body.h"

namespace ciliaval::analytic {
namespace {

using oracle::paper_cilium;
using Slices = rod::VolumeOptions::Slices;

/// Points on a sphere around the magnet.
std::vector<Vector3> around(std::size_t n) {
  std::vector<Vector3> points;
  for (std::size_t i = 0; i < n; ++i) {
    const double z = 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 1;
    const double phi = 2.399963 * static_cast<double>(i);
    const double rho = std::sqrt(1 - z * z);
    points.push_back(Vector3(0.5e-3, 0.2e-3, 10e-3) +
                     16e-3 * Vector3(rho * std::cos(phi), rho * std::sin(phi), z));
  }
  return points;
}

// Oracle: one point at a time, which no thread but the caller's computes.
TEST(Threads, GiveEachPointTheFieldItHasAlone) {
  const Deformation rod = oracle::sampled(paper_cilium(), oracle::arc(60, 0.5));
  const Deformation body = oracle::deformation_of({.degree = 2, .layers = 2}, oracle::identity);
  struct Named {
    std::string name;
    std::shared_ptr<FieldModel> model;
    const Deformation& deformation;
    std::size_t points;
  };
  const std::vector<Named> models = {
      {"line", std::make_shared<rod::LineField>(), rod, 9000},
      {"dipole", std::make_shared<rod::DipoleField>(), rod, 9000},
      {"wedge", std::make_shared<rod::VolumeField>(), rod, 3000},
      {"stacked", std::make_shared<rod::VolumeField>(rod::VolumeOptions{Slices::stacked}), rod,
       500},
      {"mesh F", std::make_shared<body::MeshField>(), body, 50},
      {"mesh R",
       std::make_shared<body::MeshField>(body::MeshOptions{sources::PushForward::R, 1e-5}), body,
       20}};
  for (const Named& named : models) {
    const std::vector<Vector3> points = around(named.points);
    const Field together = named.model->field(paper_cilium(), named.deformation, points);
    ASSERT_EQ(together.B.size(), points.size());
    ASSERT_EQ(together.uncertainty.size(), points.size());
    for (std::size_t i = 0; i < points.size(); i += 7) {
      const Field alone =
          named.model->field(paper_cilium(), named.deformation, std::span(&points[i], 1));
      EXPECT_EQ(together.B[i], alone.B.front()) << named.name << ' ' << i;
      EXPECT_EQ(together.uncertainty[i], alone.uncertainty.front()) << named.name << ' ' << i;
    }
  }
}

// Two bad points: whichever thread comes first, the message is that of the first in the list.
TEST(Threads, ReportTheFirstPointThatFails) {
  const Deformation rod = oracle::sampled(paper_cilium(), oracle::arc(60, 0.5));
  std::vector<Vector3> points = around(5000);
  const CentrelinePoint tip = rod.centreline.at(20e-3);
  const Vector3 rim = tip.position + 1.5e-3 * (tip.rotation * Vector3::UnitX());
  points[700] = rim;
  points[4000] = Vector3::Constant(std::nan(""));
  for (int i = 0; i < 20; ++i) {
    try {
      rod::VolumeField().field(paper_cilium(), rod, points);
      FAIL() << "no error";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("rim"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace ciliaval::analytic
