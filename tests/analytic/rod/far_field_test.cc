// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Thin magnets and far points, where charges and poles cancel by thickness over distance. Oracle of
// this file: closed forms in 50 digits (standing_magnets.h).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/rod/field_models.h"
#include "problem/lagrange.h"
#include "tests/analytic/oracles/bent_rods.h"
#include "tests/analytic/oracles/standing_magnets.h"

namespace ciliaval::analytic {
namespace {

using oracle::FieldAndGradient;
using oracle::record;
using Shape = CrossSection::Shape;
using Slices = rod::VolumeOptions::Slices;
using sources::PushForward;

class Random {
 public:
  explicit Random(unsigned int seed) : engine_(seed) {}
  double uniform(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(engine_);
  }
  double logarithmic(double a, double b) { return std::exp(uniform(std::log(a), std::log(b))); }
  Vector3 direction() {
    std::normal_distribution<double> normal;
    return Vector3(normal(engine_), normal(engine_), normal(engine_)).normalized();
  }
  Quaternion rotation() { return Quaternion(Eigen::AngleAxisd(uniform(0, 3), direction())); }

 private:
  std::mt19937 engine_;
};

/// A straight film on a rod that is not magnetic, anywhere and any way up, and a point.
struct Film {
  Cilium cilium;
  Deformation deformation;
  double thickness;
  Vector3 M;
  double distance;  ///< of the point from the film's lower face
  Vector3 point;
  Vector3 from_face;  ///< the point in the film's own axes from the centre of its lower face
  Quaternion pose;

  Vector3 in_space(const Vector3& v) const { return pose * v; }
  Matrix3 in_space(const Matrix3& m) const {
    const Matrix3 R = pose.toRotationMatrix();
    return R * m * R.transpose();
  }
};

CrossSection section(Shape shape, Random& random) {
  CrossSection result;
  result.shape = shape;
  if (shape == Shape::tube) result.inner_diameter = random.uniform(0.3e-3, 2.7e-3);
  if (shape != Shape::rectangle) return result;
  result.width = random.logarithmic(0.3e-3, 5e-3);
  result.height = random.logarithmic(0.3e-3, 5e-3);
  result.orientation = random.uniform(-3, 3);
  return result;
}

Film random_film(Shape shape, bool is_axial, Random& random) {
  Film film;
  film.thickness = random.logarithmic(1e-6, 2e-2);
  film.M = is_axial ? Vector3(0, 0, 9e5) : Vector3(1e6 * random.direction());
  const double rod = random.uniform(1e-3, 20e-3);
  film.cilium = {shape == Shape::rectangle ? 0 : 3e-3,
                 {{"rod", rod, 1e6, 0.49, 0}, {"film", film.thickness, 3e6, 0.49, film.M[2]}},
                 section(shape, random)};
  film.cilium.segments[1].transverse_magnetization = {film.M[0], film.M[1]};
  film.pose = random.rotation();
  const Vector3 base = random.uniform(0, 0.05) * random.direction();
  const oracle::Shape straight = [](double S) {
    CentrelinePoint point;
    point.position = S * Vector3::UnitZ();
    return point;
  };
  film.deformation = oracle::sampled(film.cilium, oracle::moved(straight, film.pose, base), 3);
  film.distance = random.logarithmic(2 * film.cilium.radius(), 10);
  const Vector3 face = base + film.pose * Vector3(0, 0, rod);
  film.point = face + film.distance * random.direction();
  film.from_face = film.pose.conjugate() * (film.point - face);
  return film;
}

/// B and gradient of the film as a volume; its section's axes are turned by the orientation.
FieldAndGradient of_volume(const Film& film, bool with_gradient = false) {
  const CrossSection& s = film.cilium.section;
  FieldAndGradient own;
  if (s.shape == Shape::rectangle) {
    const Quaternion turn(Eigen::AngleAxisd(s.orientation, Vector3::UnitZ()));
    own = oracle::standing_cuboid(turn.conjugate() * film.M, {s.width, s.height, film.thickness},
                                  turn.conjugate() * film.from_face, with_gradient);
    const Matrix3 R = turn.toRotationMatrix();
    own = {turn * own.B, R * own.gradient * R.transpose()};
  } else {
    own = oracle::standing_tube(film.M[2], 1.5e-3, s.inner_diameter / 2, film.thickness,
                                film.from_face, with_gradient);
  }
  return {film.in_space(own.B), film.in_space(own.gradient)};
}

FieldAndGradient of_poles(const Film& film, bool with_gradient = false) {
  const FieldAndGradient own = oracle::standing_poles(
      film.M[2] * film.cilium.area(), film.thickness, film.from_face, with_gradient);
  return {film.in_space(own.B), film.in_space(own.gradient)};
}

/// Allowed error over |B|: the tolerance and the rounding of the film's ends, at (|r| + L) each,
/// and of the kernel.
double allowed(const Film& film, double tolerance) {
  return tolerance + 500 * epsilon * 0.1 / film.thickness;
}

/// Errors of a model over its uncertainty, and the uncertainty over what is allowed.
struct Largest {
  double error = 0;
  double uncertainty = 0;
};

void check(const Film& film, const FieldModel& model, const Vector3& exact, double tolerance,
           Largest& largest) {
  const Field field = model.field(film.cilium, film.deformation, std::vector<Vector3>{film.point});
  const double uncertainty = field.uncertainty[0].norm();
  largest.error = std::max(largest.error, (field.B[0] - exact).norm() / uncertainty);
  largest.uncertainty =
      std::max(largest.uncertainty, uncertainty / exact.norm() / allowed(film, tolerance));
}

void report(const std::string& name, const Largest& largest) {
  record(name + ": error over uncertainty", largest.error);
  record(name + ": uncertainty over its bound", largest.uncertainty);
  EXPECT_LT(largest.error, 1) << name;
  EXPECT_LT(largest.uncertainty, 1) << name;
}

constexpr int films = 60;

TEST(ThinFilm, EveryVolumeGivesItsFieldAtAnyDistanceWithAnHonestUncertainty) {
  for (const Shape shape : {Shape::circle, Shape::tube, Shape::rectangle}) {
    Random random(7);
    Largest closed;
    Largest quadrature;
    Largest loops;
    for (int i = 0; i < films; ++i) {
      const Film film = random_film(shape, true, random);
      const Vector3 exact = of_volume(film).B;
      check(film, rod::VolumeField(), exact, 1e-10, closed);
      check(film, rod::VolumeField({.method = rod::Method::quadrature}), exact, 1e-10, quadrature);
      if (shape == Shape::circle)
        check(film, rod::VolumeField({.slices = Slices::stacked}), exact, 1e-10, loops);
    }
    const std::string name = shape == Shape::circle ? "circle"
                             : shape == Shape::tube ? "tube"
                                                    : "rectangle";
    report("volume of a " + name, closed);
    report("quadrature of a " + name, quadrature);
    if (shape == Shape::circle) report("loops", loops);
  }
}

TEST(ThinFilm, VolumeMagnetisedAnyWay) {
  Random random(8);
  Largest closed;
  for (int i = 0; i < films; ++i) {
    const Film film = random_film(Shape::rectangle, false, random);
    check(film, rod::VolumeField(), of_volume(film).B, 1e-10, closed);
  }
  report("volume of a rectangle, M any way", closed);
}

TEST(ThinFilm, LinesAndDipolesToo) {
  for (const Shape shape : {Shape::circle, Shape::tube, Shape::rectangle}) {
    Random random(9);
    Largest poles;
    Largest quadrature;
    Largest rigid;
    Largest uniform;
    for (int i = 0; i < films; ++i) {
      Film film = random_film(shape, true, random);
      const Vector3 exact = of_poles(film).B;
      check(film, rod::LineField(), exact, 1e-10, poles);
      check(film, rod::LineField({.method = rod::Method::quadrature}), exact, 1e-10, quadrature);
      check(film, rod::LineField({.push_forward = PushForward::R}), exact, 1e-10, rigid);
      if ((film.pose * Vector3::UnitZ()).z() > 0.1)  // its slices are of equal height
        check(film, rod::LineField({.method = rod::Method::uniform}), exact, 1e-2, uniform);
    }
    report("line, poles", poles);
    report("line, quadrature", quadrature);
    report("line, R", rigid);
    report("line, uniform", uniform);
  }
}

// Far away B is that of the dipole, up to (size/distance)².
TEST(ThinFilm, DipoleKnowsTheRoundingOfItsMoment) {
  Random random(10);
  Largest largest;
  for (int i = 0; i < films; ++i) {
    Film film = random_film(Shape::circle, true, random);
    if (film.thickness > 1e-3 || film.distance < 1e3 * film.thickness) continue;
    check(film, rod::DipoleField(), of_poles(film).B, 1e-6, largest);
  }
  record("dipole: uncertainty over its bound", largest.uncertainty);
  EXPECT_LT(largest.uncertainty, 1);
}

TEST(ThinFilm, GradientsKeepTheirDigits) {
  double volume = 0;
  double line = 0;
  for (const Shape shape : {Shape::circle, Shape::tube}) {
    Random random(11);
    for (int i = 0; i < films / 3; ++i) {
      const Film film = random_film(shape, true, random);
      const std::vector<Vector3> points{film.point};
      const auto error = [&](const auto& model, const Matrix3& exact) {
        const Matrix3 found = model.gradient(film.cilium, film.deformation, points)[0];
        return (found - exact).norm() / exact.norm() / allowed(film, 1e-10);
      };
      volume = std::max(volume, error(rod::VolumeField(), of_volume(film, true).gradient));
      line = std::max(line, error(rod::LineField(), of_poles(film, true).gradient));
    }
  }
  record("gradient of a volume, error over its bound", volume);
  record("gradient of a line, error over its bound", line);
  EXPECT_LT(volume, 1);
  EXPECT_LT(line, 1);
}

/// The film as one hexahedron, whose faces across M are charged.
Deformation as_body(const Film& film) {
  auto body = std::make_shared<SolidBody>();
  body->nodes = LagrangeBasis({0, 0.5, 1});
  const CrossSection& s = film.cilium.section;
  const double bottom = film.cilium.segments[0].length;
  const Quaternion turn(Eigen::AngleAxisd(s.orientation, Vector3::UnitZ()));
  const Vector3 edges(s.width, s.height, film.thickness);
  const auto reference = [&](const Vector3& xi) -> Vector3 {
    return turn * Vector3((xi - Vector3(0.5, 0.5, 0)).cwiseProduct(edges)) +
           bottom * Vector3::UnitZ();
  };
  const Vector3 face = film.point - film.pose * film.from_face;
  const auto current = [&](const Vector3& xi) -> Vector3 {
    return face + film.pose * (turn * Vector3((xi - Vector3(0.5, 0.5, 0)).cwiseProduct(edges)));
  };
  SolidCell cell;
  cell.segment = 1;
  cell.magnetization = film.M;
  for (const double c : {0.0, 0.5, 1.0})
    for (const double b : {0.0, 0.5, 1.0})
      for (const double a : {0.0, 0.5, 1.0}) {
        cell.reference.push_back(reference({a, b, c}));
        cell.current.push_back(current({a, b, c}));
      }
  body->cells.push_back(cell);
  for (int k = 0; k < 3; ++k)
    for (const double side : {0.0, 1.0}) {
      ChargedFace charged;
      charged.magnetization_jump = film.M;
      for (const double second : {0.0, 0.5, 1.0})
        for (const double first : {0.0, 0.5, 1.0}) {
          Vector3 xi;
          xi[k] = side;
          xi[(k + 1) % 3] = side > 0 ? first : second;
          xi[(k + 2) % 3] = side > 0 ? second : first;
          charged.reference.push_back(reference(xi));
          charged.current.push_back(current(xi));
        }
      body->charged_faces.push_back(charged);
    }
  return {film.deformation.centreline, body};
}

TEST(ThinFilm, MeshGivesItsFieldByItsCells) {
  Random random(12);
  Largest faces;
  Largest rigid;
  for (int i = 0; i < films; ++i) {
    Film film = random_film(Shape::rectangle, i % 2 == 0, random);
    film.deformation = as_body(film);
    const Vector3 exact = of_volume(film).B;
    check(film, body::MeshField(), exact, 1e-8, faces);
    check(film, body::MeshField({.push_forward = PushForward::R}), exact, 1e-8, rigid);
  }
  report("mesh, F", faces);
  report("mesh, R", rigid);
}

}  // namespace
}  // namespace ciliaval::analytic
