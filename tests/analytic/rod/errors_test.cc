// SPDX-License-Identifier: LGPL-2.1-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "problem/error.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/cylinder_body.h"

namespace ciliaval::analytic {
namespace {

using oracle::flux_density;
using oracle::paper_cilium;
using Slices = rod::VolumeOptions::Slices;

/// The text of the error of kind E that the field at x throws; empty if there is none.
template <class E>
std::string error_of(const FieldModel& model, const Deformation& deformation, const Vector3& x) {
  try {
    flux_density(model, paper_cilium(), deformation, x);
  } catch (const E& error) {
    return error.what();
  }
  return {};
}

TEST(FieldErrors, PointOnTheRimIsAnInputError) {
  for (const double S : {3e-3, 20e-3}) {
    const CentrelinePoint end = oracle::arc(60, 0.5)(S);
    for (const double phi : {0.0, 1.1, 4.0}) {
      const Vector3 rim =
          end.position + 1.5e-3 * (end.rotation * Vector3(std::cos(phi), std::sin(phi), 0));
      for (const Slices slices : {Slices::wedge, Slices::stacked})
        for (const rod::Method method : {rod::Method::closed_form, rod::Method::quadrature})
          EXPECT_NE(
              error_of<InputError>(rod::VolumeField({slices, method}), oracle::bent_cilium(), rim)
                  .find("rim"),
              std::string::npos);
      // A nanometre away there is a field, of which rounding leaves less than the default 1e-10.
      const Vector3 near_rim = rim + 1e-9 * end.normal();
      EXPECT_NO_THROW(
          flux_density(rod::VolumeField({Slices::wedge, rod::Method::closed_form, 1e-6}),
                       paper_cilium(), oracle::bent_cilium(), near_rim));
      EXPECT_NE(error_of<SolverError>(rod::VolumeField(), oracle::bent_cilium(), near_rim)
                    .find("larger tolerance"),
                std::string::npos);
    }
  }
}

TEST(FieldErrors, PointOnAPoleOrADipoleIsAnInputError) {
  const Vector3 pole = oracle::bent_cilium().centreline.at(20e-3).position;
  EXPECT_NE(error_of<InputError>(rod::LineField(), oracle::bent_cilium(), pole).find("pole"),
            std::string::npos);
  const Vector3 middle(0, 0, 11.5e-3);
  EXPECT_NE(error_of<InputError>(rod::DipoleField(), oracle::straight(paper_cilium()), middle)
                .find("dipole"),
            std::string::npos);
}

TEST(FieldErrors, PointThatIsNotFiniteIsAnInputError) {
  const Vector3 nowhere(0, std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_THROW(flux_density(rod::DipoleField(), paper_cilium(), oracle::bent_cilium(), nowhere),
               InputError);
  EXPECT_THROW(flux_density(rod::LineField(), paper_cilium(), oracle::bent_cilium(), nowhere),
               InputError);
  EXPECT_THROW(flux_density(rod::VolumeField(), paper_cilium(), oracle::bent_cilium(), nowhere),
               InputError);
}

TEST(FieldErrors, MissingBodyIsAnInputError) {
  EXPECT_NE(error_of<InputError>(body::MeshField(), oracle::bent_cilium(), oracle::paper_sensor)
                .find("body"),
            std::string::npos);
}

TEST(FieldErrors, CentrelineOfAnotherCiliumIsAnInputError) {
  Cilium shorter = paper_cilium();
  shorter.segments.back().length = 10e-3;
  EXPECT_THROW(
      flux_density(rod::VolumeField(), shorter, oracle::bent_cilium(), oracle::paper_sensor),
      InputError);
  EXPECT_THROW(flux_density(rod::LineField(), paper_cilium(), {}, oracle::paper_sensor),
               InputError);
}

TEST(FieldErrors, ToleranceBelowRoundingIsASolverError) {
  const Vector3 x = oracle::paper_sensor;
  EXPECT_THROW(
      flux_density(rod::LineField({sources::PushForward::F, rod::Method::quadrature, 1e-18}),
                   paper_cilium(), oracle::bent_cilium(), x),
      SolverError);
  EXPECT_THROW(flux_density(rod::VolumeField({Slices::stacked, rod::Method::closed_form, 1e-18}),
                            paper_cilium(), oracle::bent_cilium(), x),
               SolverError);
  EXPECT_THROW(flux_density(rod::VolumeField({Slices::wedge, rod::Method::quadrature, 1e-18}),
                            paper_cilium(), oracle::bent_cilium(), x),
               SolverError);
  const Deformation body = oracle::deformation_of({.degree = 2, .layers = 1}, oracle::identity);
  EXPECT_THROW(
      flux_density(body::MeshField({sources::PushForward::F, 1e-18}), paper_cilium(), body, x),
      SolverError);
}

TEST(FieldErrors, QuadratureInsideOrOnTheMagnetIsASolverError) {
  const CentrelinePoint section = oracle::arc(60, 0.5)(9e-3);
  const Vector3 n = section.rotation * Vector3::UnitX();
  for (const double r : {0.0, 1e-3, 1.5e-3, 1.5001e-3})
    for (const Slices slices : {Slices::wedge, Slices::stacked})
      EXPECT_NE(error_of<SolverError>(rod::VolumeField({slices, rod::Method::quadrature}),
                                      oracle::bent_cilium(), section.position + r * n)
                    .find("too near"),
                std::string::npos)
          << r;
  EXPECT_THROW(flux_density(rod::LineField({sources::PushForward::F, rod::Method::quadrature}),
                            paper_cilium(), oracle::bent_cilium(), section.position),
               SolverError);
  EXPECT_THROW(flux_density(rod::VolumeField({Slices::stacked}), paper_cilium(),
                            oracle::bent_cilium(), section.position + 1.5e-3 * n),
               SolverError);
}

// Rounding of the loops' places leaves 1e-8 there, so 1e-10 must be refused, not missed.
TEST(FieldErrors, StackedSlicesRefuseAnAccuracyThatRoundingTakesAway) {
  const CentrelinePoint section = oracle::arc(60, 0.5)(9e-3);
  const Vector3 x = section.position + (1.5e-3 + 1e-9) * (section.rotation * Vector3::UnitX());
  EXPECT_NE(error_of<SolverError>(rod::VolumeField({Slices::stacked}), oracle::bent_cilium(), x)
                .find("1e-10 of |B|"),
            std::string::npos);
  EXPECT_NO_THROW(flux_density(rod::VolumeField({Slices::stacked, rod::Method::closed_form, 1e-5}),
                               paper_cilium(), oracle::bent_cilium(), x));
}

TEST(FieldErrors, RodBentMoreSharplyThanItsRadiusIsASolverError) {
  const Deformation coil = oracle::sampled(paper_cilium(), oracle::arc(700, 0));
  EXPECT_NE(error_of<SolverError>(rod::VolumeField(), coil, oracle::paper_sensor).find("sharply"),
            std::string::npos);
}

TEST(FieldErrors, RotatedMomentsHaveNoFieldInsideTheMagnet) {
  const Deformation body = oracle::deformation_of({.degree = 3}, oracle::identity);
  EXPECT_NE(error_of<SolverError>(body::MeshField({sources::PushForward::R}), body,
                                  {0.4e-3, 0.2e-3, 9e-3})
                .find("not available"),
            std::string::npos);
}

TEST(FieldErrors, CellTurnedInsideOutIsASolverError) {
  const Deformation body = oracle::deformation_of(
      {.degree = 2, .layers = 1}, [](const Vector3& X) { return Vector3(-X.x(), X.y(), X.z()); });
  EXPECT_NE(
      error_of<SolverError>(body::MeshField({sources::PushForward::R}), body, oracle::paper_sensor)
          .find("det F"),
      std::string::npos);
}

TEST(FieldErrors, PointOnAChargedFaceOfTheMeshIsASolverError) {
  const Deformation body = oracle::deformation_of({.degree = 2, .layers = 1}, oracle::identity);
  EXPECT_THROW(flux_density(body::MeshField(), paper_cilium(), body, {0.2e-3, 0.3e-3, 20e-3}),
               SolverError);
}

}  // namespace
}  // namespace ciliaval::analytic
