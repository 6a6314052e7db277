// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/deformation.h"

#include <utility>
#include <vector>

namespace ciliaval {
namespace {

void turn(std::vector<Vector3>& vectors, const Matrix3& Q) {
  for (Vector3& v : vectors) v = Q * v;
}

Centreline turned(const Centreline& centreline, const Quaternion& q) {
  std::vector<Centreline::Piece> pieces = centreline.pieces();
  for (Centreline::Piece& piece : pieces)
    for (SectionState& state : piece.states) {
      state.position = q * state.position;
      state.rotation = q * state.rotation * q.conjugate();
      state.curvature = q * state.curvature;
      state.forces.force = q * state.forces.force;
      state.forces.moment = q * state.forces.moment;
    }
  return Centreline(std::move(pieces));
}

SolidBody turned(SolidBody body, const Matrix3& Q) {
  for (SolidCell& cell : body.cells) {
    cell.magnetization = Q * cell.magnetization;
    turn(cell.reference, Q);
    turn(cell.current, Q);
    for (Matrix3& stress : cell.cauchy_stress) stress = Q * stress * Q.transpose();
  }
  for (ChargedFace& face : body.charged_faces) {
    face.magnetization_jump = Q * face.magnetization_jump;
    turn(face.reference, Q);
    turn(face.current, Q);
  }
  return body;
}

}  // namespace

Deformation turned(const Deformation& deformation, double angle) {
  if (angle == 0) return deformation;
  const Quaternion q(Eigen::AngleAxisd(angle, Vector3::UnitZ()));
  Deformation result{turned(deformation.centreline, q), nullptr};
  if (deformation.body)
    result.body =
        std::make_shared<const SolidBody>(turned(*deformation.body, q.toRotationMatrix()));
  return result;
}

}  // namespace ciliaval
