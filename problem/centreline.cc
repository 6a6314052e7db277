// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/centreline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "problem/error.h"

namespace ciliaval {
namespace {

/// q and −q are the same rotation; interpolation needs neighbours on the same side.
void align_signs(std::vector<SectionState>& states) {
  for (std::size_t i = 1; i < states.size(); ++i) {
    Quaternion& q = states[i].rotation;
    if (q.dot(states[i - 1].rotation) < 0) q.coeffs() = -q.coeffs();
  }
}

}  // namespace

double CentrelinePoint::theta() const {
  const Vector3 d3 = normal();
  return std::atan2(std::hypot(d3.x(), d3.y()), d3.z());
}

double CentrelinePoint::bending_curvature() const {
  const Vector3 d3 = normal();
  return (curvature - curvature.dot(d3) * d3).norm();
}

Centreline::Centreline(std::vector<Piece> pieces) : pieces_(std::move(pieces)) {
  if (pieces_.empty()) throw InputError("a centreline needs at least one piece");
  for (Piece& piece : pieces_) {
    if (piece.S.size() < 2 || piece.S.size() != piece.states.size())
      throw InputError("a piece of a centreline needs two nodes or more, each with its state");
    if (!std::is_sorted(piece.S.begin(), piece.S.end()))
      throw InputError("the nodes of a centreline must increase");
    if (!breaks_.empty() && breaks_.back() != piece.S.front())
      throw InputError("the pieces of a centreline do not join");
    if (breaks_.empty()) breaks_.push_back(piece.S.front());
    breaks_.push_back(piece.S.back());
    align_signs(piece.states);
    const LagrangeBasis& basis = bases_.emplace_back(piece.S);
    std::vector<Vector3>& derivatives = derivatives_.emplace_back();
    for (std::size_t j = 0; j < basis.size(); ++j) {
      Vector3& derivative = derivatives.emplace_back(Vector3::Zero());
      for (std::size_t i = 0; i < basis.size(); ++i)
        derivative += basis.slope(i, j) * piece.states[i].position;
    }
  }
}

std::size_t Centreline::piece_at(double S) const {
  if (pieces_.empty()) throw InputError("the centreline is empty");
  if (std::isnan(S)) throw InputError("the material point of a centreline is not a number");
  const auto above = std::upper_bound(breaks_.begin(), breaks_.end(), S);
  const auto index = std::max<std::ptrdiff_t>(above - breaks_.begin() - 1, 0);
  return std::min(static_cast<std::size_t>(index), pieces_.size() - 1);
}

CentrelinePoint Centreline::at(double S) const {
  return at(S, piece_at(S));
}

CentrelinePoint Centreline::at(double S, std::size_t piece) const {
  const Piece& p = pieces_.at(piece);
  const LagrangeBasis& basis = bases_[piece];
  const std::vector<Vector3>& derivatives = derivatives_[piece];
  S = std::clamp(S, p.S.front(), p.S.back());
  CentrelinePoint point;
  // dr/dS of the interpolant is a polynomial too, so it is interpolated from its nodal values.
  point.derivative.setZero();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < basis.size(); ++i) {
    const SectionState& state = p.states[i];
    const double distance = S - basis.nodes()[i];
    if (distance == 0) return node(piece, i);
    const double share = basis.weights()[i] / distance;
    sum += share;
    point.position += share * state.position;
    point.derivative += share * derivatives[i];
    rotation += share * state.rotation.coeffs();
    point.curvature += share * state.curvature;
    point.forces.force += share * state.forces.force;
    point.forces.moment += share * state.forces.moment;
  }
  const double scale = 1 / sum;
  point.position *= scale;
  point.derivative *= scale;
  point.curvature *= scale;
  point.forces.force *= scale;
  point.forces.moment *= scale;
  point.rotation.coeffs() = (scale * rotation).normalized();
  return point;
}

CentrelinePoint Centreline::node(std::size_t piece, std::size_t i) const {
  CentrelinePoint point;
  static_cast<SectionState&>(point) = pieces_.at(piece).states.at(i);
  point.rotation.normalize();
  point.derivative = derivatives_[piece][i];
  return point;
}

void differentiate_rotation(Centreline::Piece& piece) {
  std::vector<SectionState>& states = piece.states;
  align_signs(states);
  const LagrangeBasis basis(piece.S);
  for (std::size_t i = 0; i < states.size(); ++i) {
    Quaternion derivative(0, 0, 0, 0);
    for (std::size_t j = 0; j < states.size(); ++j)
      derivative.coeffs() += basis.slope(j, i) * states[j].rotation.coeffs();
    states[i].curvature = 2 * (derivative * states[i].rotation.conjugate()).vec();
  }
}

Centreline straight_centreline(const std::vector<double>& breaks) {
  std::vector<Centreline::Piece> pieces;
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    Centreline::Piece piece{{breaks[i], breaks[i + 1]}, std::vector<SectionState>(2)};
    piece.states[0].position = breaks[i] * Vector3::UnitZ();
    piece.states[1].position = breaks[i + 1] * Vector3::UnitZ();
    pieces.push_back(std::move(piece));
  }
  return Centreline(std::move(pieces));
}

}  // namespace ciliaval
