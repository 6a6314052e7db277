// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <vector>

#include "problem/lagrange.h"
#include "problem/types.h"

namespace ciliaval {

/// Forces that the part above a section exerts on the part below.
struct SectionForces {
  Vector3 force = Vector3::Zero();   ///< n, N, spatial components
  Vector3 moment = Vector3::Zero();  ///< m about the section's centroid, N·m, spatial components
};

/// State of the cross-section at one material point of the centreline.
struct SectionState {
  Vector3 position = Vector3::Zero();            ///< r, m
  Quaternion rotation = Quaternion::Identity();  ///< Λ: section directors d_i = Λ e_i; identity in
                                                 ///< the straight cilium
  Vector3 curvature = Vector3::Zero();  ///< κ with dΛ/dS = [κ]× Λ, 1/m, spatial components
  SectionForces forces{};
};

/// A point of the centreline between nodes: the section's state and dr/dS.
struct CentrelinePoint : SectionState {
  Vector3 derivative = Vector3::UnitZ();  ///< dr/dS; not parallel to d₃ under shear, not of unit
                                          ///< length under extension

  /// d₃, the unit normal of the section.
  Vector3 normal() const { return rotation * Vector3::UnitZ(); }
  double theta() const;              ///< angle of d₃ from +z, rad
  double bending_curvature() const;  ///< |κ − (κ·d₃)d₃|, 1/m
};

/// The deformed centreline as a function of the reference arc length S: Lagrange interpolation of
/// the nodal states on each of a list of smooth pieces, whose ends (segment interfaces, load
/// points, element ends) are the breaks.
class Centreline {
 public:
  struct Piece {
    std::vector<double> S;  ///< nodes, increasing, m; first and last are the piece's ends
    std::vector<SectionState> states;  ///< one for each node
  };

  Centreline() = default;
  /// Pieces from base to tip without gaps. Throws InputError if they are empty or do not join.
  explicit Centreline(std::vector<Piece> pieces);

  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Ends of the pieces, 0 first, L last. Integrate between them, never across.
  const std::vector<double>& breaks() const { return breaks_; }
  double length() const { return breaks_.empty() ? 0 : breaks_.back(); }

  /// State at the material point S, clamped to [0, L]; at a break, the upper piece's. Throws
  /// InputError if S is NaN or the centreline is empty.
  CentrelinePoint at(double S) const;
  /// State at S by the interpolation of one piece: for one-sided values at breaks.
  CentrelinePoint at(double S, std::size_t piece) const;
  /// State at a node of a piece, which takes no interpolation.
  CentrelinePoint node(std::size_t piece, std::size_t i) const;
  std::size_t piece_at(double S) const;

 private:
  std::vector<Piece> pieces_;
  std::vector<LagrangeBasis> bases_;
  std::vector<std::vector<Vector3>> derivatives_;  ///< dr/dS at the nodes of each piece
  std::vector<double> breaks_;
};

/// Sets the curvature at the nodes of a piece, κ = 2 vec(q′ q̄), from the interpolation of the
/// nodes' rotations q, whose signs it aligns.
void differentiate_rotation(Centreline::Piece& piece);

/// The undeformed centreline r = S e_z of the given length, broken at `breaks` (which include 0 and
/// L).
Centreline straight_centreline(const std::vector<double>& breaks);

}  // namespace ciliaval
