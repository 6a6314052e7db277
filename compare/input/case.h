// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "analytic/elastica/elastica.h"
#include "analytic/rod/field_models.h"
#include "compare/input/external/external.h"
#include "fem/beam/beam.h"
#include "fem/calculix/calculix_model.h"
#include "fem/potential/potential.h"
#include "fem/solid/solid.h"
#include "problem/cilium.h"
#include "problem/load.h"
#include "problem/types.h"

namespace ciliaval::compare {

/// The knobs of every model, with their defaults from the models' own headers.
struct ModelOptions {
  analytic::ElasticaOptions elastica;
  fem::BeamOptions beam;
  fem::CalculixOptions calculix;
  fem::SolidOptions solid;
  analytic::DipoleOptions dipole;
  analytic::LineOptions line;
  analytic::VolumeOptions volume;
  analytic::MeshOptions mesh;
  fem::PotentialOptions potential;
};

/// A validation case, as a case file states it (docs/cases.md), in SI units.
struct Case {
  std::string name;   ///< a plain file name: the results go to DIR/name
  std::string title;  ///< for people
  Cilium cilium;
  LoadPath load_path;
  std::vector<double> flow_velocity;          ///< v of each step, m/s, if the flow was given by its
                                              ///< velocity; otherwise empty
  std::vector<double> flow_density;           ///< ρ of each step, kg/m³, where flow_velocity is
  std::vector<double> flow_drag_coefficient;  ///< C_d of each step, where flow_velocity is
  std::vector<Vector3> sensors;               ///< m
  std::vector<std::string> mechanics;         ///< ids of mechanics models, in the order asked for
  std::vector<std::string> fields;            ///< ids of field models
  std::vector<ExternalModel> external;        ///< what other programs and test benches gave
  ModelOptions options;
};

/// Reads and checks a case file. Throws InputError with every fault found, a line each:
/// `file:line:column: what is wrong; did you mean …?`. A file that is missing, not a regular file,
/// unreadable or larger than 1 MB is an InputError too: it is the user's command that names it.
Case read_case(const std::filesystem::path& file);

/// The same from a text; `file` is the name that the messages give.
Case read_case(std::string_view text, std::string_view file);

/// The drag per unit height q = ½ρv²C_d d (paper, Eq. 11), N/m, of velocity v (m/s), density ρ
/// (kg/m³), drag coefficient C_d and diameter d (m).
double drag_per_height(double velocity, double density, double drag_coefficient, double diameter);

inline constexpr double default_fluid_density = 1000;  ///< kg/m³, water (paper, section 3.5)
inline constexpr double default_drag_coefficient = 1;  ///< (paper, section 3.5)

/// The case as TOML with every value it used, defaults included, in SI units: read_case() of it
/// gives the same case.
std::string to_toml(const Case& c);

}  // namespace ciliaval::compare
