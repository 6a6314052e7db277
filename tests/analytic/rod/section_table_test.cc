// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Every field model, gradient and force on every section. Oracle of this file: dipoles at Gauss
// points all over the section or along the centreline, with areas of its own; it shares the kernel
// of a dipole and the centreline with the models.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "analytic/body/mesh_field.h"
#include "analytic/forces/wrench.h"
#include "analytic/rod/field_models.h"
#include "analytic/sources/dipole.h"
#include "problem/error.h"
#include "problem/lagrange.h"
#include "problem/surroundings/magnets/field.h"
#include "tests/analytic/oracles/bent_rods.h"

namespace ciliaval::analytic {
namespace {

using oracle::record;
using rod::Method;
using sources::Dipole;
using sources::PushForward;
using Shape = CrossSection::Shape;
using Slices = rod::VolumeOptions::Slices;

constexpr double pi = std::numbers::pi;
constexpr std::array shapes{Shape::circle, Shape::tube, Shape::rectangle};

std::string name_of(Shape shape) {
  return shape == Shape::circle ? "circle" : shape == Shape::tube ? "tube" : "rectangle";
}

/// A point of a section and its share of the area.
struct Place {
  Eigen::Vector2d at;
  double area;
};

double area_of(const Cilium& c) {
  const CrossSection& s = c.section;
  if (s.shape == Shape::rectangle) return s.width * s.height;
  return pi / 4 * (std::pow(c.diameter, 2) - std::pow(s.inner_diameter, 2));
}

std::vector<Place> places(const Cilium& c) {
  const CrossSection& s = c.section;
  const QuadratureRule rule = gauss_legendre(10);
  std::vector<Place> result;
  if (s.shape == Shape::rectangle) {
    const Eigen::Rotation2Dd turn(s.orientation);
    for (std::size_t i = 0; i < 10; ++i)
      for (std::size_t j = 0; j < 10; ++j)
        result.push_back(
            {turn * Eigen::Vector2d(s.width / 2 * rule.nodes[i], s.height / 2 * rule.nodes[j]),
             s.width * s.height / 4 * rule.weights[i] * rule.weights[j]});
    return result;
  }
  constexpr int around = 40;
  const double inner = s.inner_diameter / 2;
  const double half = (c.diameter / 2 - inner) / 2;
  for (std::size_t i = 0; i < 10; ++i)
    for (int k = 0; k < around; ++k) {
      const double r = inner + half * (1 + rule.nodes[i]);
      const double phi = 2 * pi * k / around;
      result.push_back(
          {{r * std::cos(phi), r * std::sin(phi)}, half * rule.weights[i] * r * 2 * pi / around});
    }
  return result;
}

/// Dipoles of the places along the centreline: F·M of F = (d₁, d₂, v), v = ∂x/∂S (F) or d₃ (R).
std::vector<Dipole> dipoles(const Cilium& c, const Centreline& line,
                            const std::vector<Place>& section, PushForward push_forward) {
  std::vector<Dipole> result;
  const QuadratureRule rule = gauss_legendre(10, 0, 1);
  for (std::size_t piece = 0; piece + 1 < line.breaks().size(); ++piece) {
    const double begin = line.breaks()[piece];
    const double length = line.breaks()[piece + 1] - begin;
    const Vector3 M = magnetization(c.segments[c.segment_at(begin + length / 2)]);
    if (M.isZero(0)) continue;
    constexpr int parts = 10;
    for (int part = 0; part < parts; ++part)
      for (std::size_t i = 0; i < 10; ++i) {
        const double dS = length / parts * rule.weights[i];
        const CentrelinePoint p = line.at(begin + length / parts * (part + rule.nodes[i]), piece);
        for (const Place& place : section) {
          const Vector3 offset = p.rotation * Vector3(place.at.x(), place.at.y(), 0);
          const Vector3 v = push_forward == PushForward::R
                                ? p.normal()
                                : Vector3(p.derivative + p.curvature.cross(offset));
          result.push_back({p.position + offset,
                            place.area * dS * (p.rotation * Vector3(M[0], M[1], 0) + M[2] * v)});
        }
      }
  }
  return result;
}

Vector3 field_of(const std::vector<Dipole>& all, const Vector3& x) {
  Vector3 B = Vector3::Zero();
  for (const Dipole& d : all) B += sources::dipole_field(d.moment, x - d.position);
  return B;
}

Matrix3 gradient_of(const std::vector<Dipole>& all, const Vector3& x) {
  Matrix3 sum = Matrix3::Zero();
  for (const Dipole& d : all) sum += sources::dipole_gradient(d.moment, x - d.position);
  return sum;
}

struct Pose {
  Cilium cilium;
  Deformation deformation;
  std::vector<Vector3> points;  ///< 2 mm or more off the rod
};

double uniform(std::mt19937& random, double a, double b) {
  return std::uniform_real_distribution<double>(a, b)(random);
}

/// A rod of two magnetised segments, contorted, anywhere and any way up.
Pose random_pose(Shape shape, bool is_axial, std::mt19937& random,
                 const oracle::Shape& bent = oracle::contorted(), bool is_turned = true) {
  Pose pose;
  CrossSection section{.shape = shape};
  if (shape == Shape::tube) section.inner_diameter = uniform(random, 0.5e-3, 1.8e-3);
  if (shape == Shape::rectangle) {
    section.width = uniform(random, 1.5e-3, 4e-3);
    section.height = uniform(random, 0.3e-3, 1.2e-3);
    section.orientation = uniform(random, -3, 3);
  }
  pose.cilium = {shape == Shape::rectangle ? 0 : 2e-3,
                 {{"base", 3e-3, 1e6, 0.49, 0},
                  {"lower", uniform(random, 4e-3, 8e-3), 1e6, 0.49, uniform(random, 4e4, 9e4)},
                  {"upper", uniform(random, 4e-3, 8e-3), 1e6, 0.49, uniform(random, -9e4, 9e4)}},
                 section};
  if (!is_axial)
    for (std::size_t s : {1, 2})
      pose.cilium.segments[s].transverse_magnetization = {uniform(random, -9e4, 9e4),
                                                          uniform(random, -9e4, 9e4)};
  const Vector3 axis =
      Vector3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, 0.1, 1)).normalized();
  const Quaternion turn = is_turned ? Quaternion(Eigen::AngleAxisd(uniform(random, 0, 3), axis))
                                    : Quaternion::Identity();
  pose.deformation =
      oracle::sampled(pose.cilium, oracle::moved(bent, turn, uniform(random, 0, 0.02) * axis));
  const Centreline& line = pose.deformation.centreline;
  while (pose.points.size() < 3) {
    const Vector3 middle = line.at(uniform(random, 0, line.length())).position;
    const double reach = uniform(random, 2, 20) * 1e-3;
    const Vector3 x = middle + reach * Vector3(uniform(random, -1, 1), uniform(random, -1, 1),
                                               uniform(random, -1, 1));
    double distance = 1;
    for (double S = 0; S <= line.length(); S += 1e-4)
      distance = std::min(distance, (line.at(S).position - x).norm());
    if (distance > pose.cilium.radius() + 2e-3) pose.points.push_back(x);
  }
  return pose;
}

/// The largest |model − exact|/|exact|, and that over the model's uncertainty.
struct Largest {
  double relative = 0;
  double over_uncertainty = 0;

  void add(const Pose& pose, const FieldModel& model, const std::vector<Dipole>& all) {
    const Field field = model.field(pose.cilium, pose.deformation, pose.points);
    for (std::size_t i = 0; i < pose.points.size(); ++i) {
      const Vector3 exact = field_of(all, pose.points[i]);
      const double error = (field.B[i] - exact).norm();
      relative = std::max(relative, error / exact.norm());
      over_uncertainty = std::max(over_uncertainty, error / field.uncertainty[i].norm());
    }
  }
};

void expect(const std::string& name, double value, double most) {
  record(name, value);
  EXPECT_LT(value, most) << name;
}

constexpr int poses = 6;

// The oracle's own rule is good to 1e-8 or so at 2 mm.
TEST(SectionTable, LinesAndDipolesHaveTheSectionsArea) {
  for (const Shape shape : shapes) {
    std::mt19937 random(3);
    Largest dipole;
    Largest line;
    for (int i = 0; i < 2 * poses; ++i) {
      const bool is_axial = i % 2 == 0;
      const Pose pose = random_pose(shape, is_axial, random);
      const Centreline& centreline = pose.deformation.centreline;
      const std::vector<Place> axis{{Eigen::Vector2d::Zero(), area_of(pose.cilium)}};
      for (const PushForward push_forward : {PushForward::F, PushForward::R}) {
        const std::vector<Dipole> all = dipoles(pose.cilium, centreline, axis, push_forward);
        for (const Method method : {Method::closed_form, Method::quadrature})
          line.add(pose, rod::LineField({push_forward, method}), all);
        // Each segment's moment at its centroid: the segments have equally many dipoles.
        std::vector<Dipole> two;
        const std::vector<double> ends = pose.cilium.interfaces();
        for (std::size_t s : {1, 2}) {
          Dipole sum{Vector3::Zero(), Vector3::Zero()};
          for (std::size_t k = 0; k < all.size() / 2; ++k)
            sum.moment += all[(s - 1) * all.size() / 2 + k].moment;
          const QuadratureRule rule = gauss_legendre(40, ends[s], ends[s + 1]);
          for (std::size_t k = 0; k < 40; ++k)
            sum.position +=
                rule.weights[k] / (ends[s + 1] - ends[s]) * centreline.at(rule.nodes[k]).position;
          two.push_back(sum);
        }
        dipole.add(pose, rod::DipoleField({push_forward}), two);
      }
    }
    expect("dipole of a " + name_of(shape), dipole.relative, 1e-9);
    expect("line of a " + name_of(shape), line.relative, 1e-8);
  }
}

TEST(SectionTable, ThePapersLineOfSlicesHasTheSectionsArea) {
  for (const Shape shape : shapes) {
    std::mt19937 random(4);
    Largest line;
    for (int i = 0; i < poses; ++i) {
      const Pose pose =
          random_pose(shape, i % 2 == 0, random,
                      oracle::arc(uniform(random, 5, 50), uniform(random, -3, 3)), false);
      const std::vector<Place> axis{{Eigen::Vector2d::Zero(), area_of(pose.cilium)}};
      const std::vector<Dipole> all =
          dipoles(pose.cilium, pose.deformation.centreline, axis, PushForward::F);
      for (const unsigned int n : {30U, 300U})
        for (const PushForward push_forward : {PushForward::F, PushForward::R})
          line.add(pose, rod::LineField({push_forward, Method::uniform, 1e-10, n}), all);
    }
    expect("uniform line of a " + name_of(shape), line.relative, 0.05);
    expect("uniform line of a " + name_of(shape) + ", over its uncertainty", line.over_uncertainty,
           1);
  }
}

TEST(SectionTable, VolumesHaveTheSectionsShape) {
  for (const Shape shape : shapes) {
    std::mt19937 random(5);
    Largest wedge;
    Largest stacked;
    for (int i = 0; i < poses; ++i) {
      const bool is_axial = i % 2 == 0;
      const Pose pose = random_pose(shape, is_axial, random);
      const std::vector<Place> section = places(pose.cilium);
      const Centreline& line = pose.deformation.centreline;
      const std::vector<Dipole> all = dipoles(pose.cilium, line, section, PushForward::F);
      wedge.add(pose, rod::VolumeField(), all);
      wedge.add(pose, rod::VolumeField({Slices::wedge, Method::quadrature, 1e-8}), all);
      const std::vector<Dipole> flat = dipoles(pose.cilium, line, section, PushForward::R);
      stacked.add(pose, rod::VolumeField({Slices::stacked, Method::quadrature, 1e-8}), flat);
      if (shape == Shape::circle && is_axial)
        stacked.add(pose, rod::VolumeField({Slices::stacked}), flat);
    }
    expect("wedge of a " + name_of(shape), wedge.relative, 1e-7);
    expect("stacked slices of a " + name_of(shape), stacked.relative, 1e-7);
  }
}

TEST(SectionTable, ThePapersSlicesOfAVolumeAreRound) {
  std::mt19937 random(6);
  Largest volume;
  const auto bent = [&] { return oracle::arc(uniform(random, 5, 50), uniform(random, -3, 3)); };
  const Pose round = random_pose(Shape::circle, false, random, bent(), false);
  volume.add(
      round, rod::VolumeField({Slices::wedge, Method::uniform}),
      dipoles(round.cilium, round.deformation.centreline, places(round.cilium), PushForward::F));
  expect("uniform volume of a circle", volume.relative, 0.01);
  for (const Shape shape : {Shape::tube, Shape::rectangle}) {
    const Pose pose = random_pose(shape, true, random, bent(), false);
    EXPECT_THROW(rod::VolumeField({Slices::wedge, Method::uniform})
                     .field(pose.cilium, pose.deformation, pose.points),
                 InputError);
    EXPECT_THROW(
        rod::VolumeField({Slices::stacked}).field(pose.cilium, pose.deformation, pose.points),
        InputError);
  }
}

TEST(SectionTable, GradientsHaveTheSectionsAreaAndShape) {
  for (const Shape shape : shapes) {
    std::mt19937 random(7);
    double line = 0;
    double volume = 0;
    const auto add = [](const Pose& pose, const auto& model, const std::vector<Dipole>& all,
                        double& largest) {
      const std::vector<Matrix3> found = model.gradient(pose.cilium, pose.deformation, pose.points);
      for (std::size_t i = 0; i < found.size(); ++i) {
        const Matrix3 exact = gradient_of(all, pose.points[i]);
        largest = std::max(largest, (found[i] - exact).norm() / exact.norm());
      }
    };
    for (int i = 0; i < poses; ++i) {
      const Pose pose = random_pose(shape, true, random);
      const Centreline& centreline = pose.deformation.centreline;
      const std::vector<Place> axis{{Eigen::Vector2d::Zero(), area_of(pose.cilium)}};
      for (const PushForward push_forward : {PushForward::F, PushForward::R})
        add(pose, rod::LineField({push_forward}),
            dipoles(pose.cilium, centreline, axis, push_forward), line);
      if (shape != Shape::rectangle)
        add(pose, rod::VolumeField(),
            dipoles(pose.cilium, centreline, places(pose.cilium), PushForward::F), volume);
    }
    expect("gradient of a line of a " + name_of(shape), line, 1e-7);
    expect("gradient of a volume of a " + name_of(shape), volume, 1e-6);
  }
}

// Oracle: ∇(m·B) and x × ∇(m·B) + m × B of the dipoles in the magnet's field.
TEST(SectionTable, ForcesHaveTheSectionsAreaAndShape) {
  for (const Shape shape : shapes) {
    std::mt19937 random(8);
    double largest = 0;
    for (int i = 0; i < 2; ++i) {
      const Pose pose = random_pose(shape, i % 2 == 0, random);
      surroundings::magnets::Magnet magnet;
      magnet.shape = surroundings::magnets::Shape::ball;
      magnet.diameter = 2e-3;
      magnet.position = pose.points[0];
      magnet.magnetization = {2e5, -3e5, 8e5};
      forces::Wrench exact;
      for (const Dipole& d :
           dipoles(pose.cilium, pose.deformation.centreline, places(pose.cilium), PushForward::F)) {
        const auto jet = surroundings::magnets::jet(magnet, d.position);
        const Vector3 force = jet.gradient.transpose() * d.moment;
        exact.force += force;
        exact.torque += d.position.cross(force) + d.moment.cross(jet.B);
      }
      const forces::Wrench found =
          forces::wrench_on_cilium(pose.cilium, pose.deformation, {magnet});
      largest = std::max({largest, (found.force - exact.force).norm() / exact.force.norm(),
                          (found.torque - exact.torque).norm() / exact.torque.norm()});
      const forces::Wrench back = forces::wrench_on_magnet(pose.cilium, pose.deformation, magnet);
      largest = std::max(largest, (back.force + exact.force).norm() / exact.force.norm());
    }
    expect("force and torque of a " + name_of(shape), largest, 1e-6);
  }
}

/// The map of a patch of the section, [0, 1]² to (X, Y).
using SectionPatch = std::function<Eigen::Vector2d(double a, double b)>;

std::vector<SectionPatch> patches(const Cilium& c) {
  const CrossSection& s = c.section;
  if (s.shape == Shape::rectangle)
    return {[s](double a, double b) -> Eigen::Vector2d {
      return Eigen::Rotation2Dd(s.orientation) *
             Eigen::Vector2d((a - 0.5) * s.width, (b - 0.5) * s.height);
    }};
  std::vector<SectionPatch> result;
  for (int k = 0; k < 8; ++k)
    result.emplace_back([&c, k](double a, double b) -> Eigen::Vector2d {
      const double inner = c.section.inner_diameter / 2;
      const double r = inner + a * (c.diameter / 2 - inner);
      return r * Eigen::Vector2d(std::cos((k + b) * pi / 4), std::sin((k + b) * pi / 4));
    });
  return result;
}

/// The axially magnetised segments as cells of degree 6, six layers in each.
Deformation as_body(const Cilium& c, const Centreline& line) {
  const std::vector<double> nodes = chebyshev_points(7, 0, 1);
  auto body = std::make_shared<SolidBody>();
  body->nodes = LagrangeBasis(nodes);
  const auto moved = [&](const Vector3& X) -> Vector3 {
    const CentrelinePoint p = line.at(X.z());
    return p.position + p.rotation * Vector3(X.x(), X.y(), 0);
  };
  const std::vector<double> ends = c.interfaces();
  for (const SectionPatch& patch : patches(c)) {
    const auto reference = [&](double a, double b, double S) -> Vector3 {
      const Eigen::Vector2d at = patch(a, b);
      return {at.x(), at.y(), S};
    };
    for (std::size_t s : {1, 2}) {
      constexpr int layers = 6;
      for (int layer = 0; layer < layers; ++layer) {
        SolidCell cell;
        cell.segment = s;
        cell.magnetization = magnetization(c.segments[s]);
        for (const double zeta : nodes)
          for (const double b : nodes)
            for (const double a : nodes)
              cell.reference.push_back(
                  reference(a, b, std::lerp(ends[s], ends[s + 1], (layer + zeta) / layers)));
        for (const Vector3& X : cell.reference) cell.current.push_back(moved(X));
        body->cells.push_back(cell);
      }
      for (const bool upper : {false, true}) {
        ChargedFace face;
        face.magnetization_jump = magnetization(c.segments[s]);
        for (const double second : nodes)
          for (const double first : nodes)
            face.reference.push_back(upper ? reference(first, second, ends[s + 1])
                                           : reference(second, first, ends[s]));
        for (const Vector3& X : face.reference) face.current.push_back(moved(X));
        body->charged_faces.push_back(face);
      }
    }
  }
  return {line, body};
}

TEST(SectionTable, MeshesHaveTheSectionsShape) {
  for (const Shape shape : shapes) {
    std::mt19937 random(9);
    Largest mesh;
    for (int i = 0; i < poses; ++i) {
      Pose pose = random_pose(shape, true, random);
      pose.deformation = as_body(pose.cilium, pose.deformation.centreline);
      mesh.add(
          pose, body::MeshField(),
          dipoles(pose.cilium, pose.deformation.centreline, places(pose.cilium), PushForward::F));
    }
    expect("mesh of a " + name_of(shape), mesh.relative, 1e-6);
  }
}

}  // namespace
}  // namespace ciliaval::analytic
