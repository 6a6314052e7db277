// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <concepts>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "problem/cilium.h"
#include "problem/description/field.h"
#include "problem/parameter.h"
#include "problem/surroundings/environment.h"
#include "problem/surroundings/surface.h"
#include "problem/touch.h"
#include "problem/types.h"

namespace ciliaval {

class Load;

/// One parameter of a load type: a key of [load].
struct LoadParameter : description::Field<Load> {
  std::string_view words;     ///< how a table says it, as a format of the value: "force {:g} mN"
  double display_factor = 1;  ///< from SI to the unit of `words`
  enum class Site { none, height, arclength };
  Site site = Site::none;  ///< height: 0 < z < L; arclength: 0 < S ≤ L
};
/// A parameter that a file must state; the load type tells its place among the others.
LoadParameter load_parameter(std::string_view name, const Quantity& quantity, const Range& range,
                             std::string_view doc, std::string_view words,
                             double display_factor = 1,
                             LoadParameter::Site site = LoadParameter::Site::none);

/// Range of Re in which cylinder_drag_coefficient() holds.
inline constexpr Range cylinder_reynolds_numbers{1e-4, 2e5, false, ""};

/// C_d of a long circular cylinder across the flow, Re = v d/ν,
///   C_d = 1.18 + 6.8/Re^0.89 + 1.96/Re^0.5 − 0.0004 Re/(1 + 3.64e-7 Re²)
/// (Sucker and Brauer, Wärme- und Stoffübertragung 8, 149, 1975). A free end, a wall at the base
/// and turbulence are not in it. Throws InputError beyond cylinder_reynolds_numbers.
double cylinder_drag_coefficient(double Re);

/// Values from which a file may state the magnitude of a load.
struct LoadStatement {
  using Values = std::vector<double>;
  description::Fields<Values> parameters;  ///< the first is required
  /// The magnitude, SI, from their values.
  double (*magnitude)(const Values& values, const Cilium& cilium) = nullptr;
};

/// Point of the tip that comes down to the contact height where the cilium slips off.
enum class SlipOffPoint {
  axis,  ///< the end of the centreline, as in the paper
  rim    ///< the lowest point of the end face, to the upper edge of a contact that has a height: so
         ///< does a solid
};

/// A sub-table of [load], "touch", with settings.
struct LoadTable {
  std::string_view name;
  description::Fields<Load> keys;
};

/// Name, description and parameters of a load type: the one declaration from which case files,
/// results, studies, tables and checkpoints take them.
struct LoadType {
  std::string_view name;
  std::string_view description;           ///< a line of `ciliaval list`
  std::vector<LoadParameter> parameters;  ///< the magnitude first, the azimuth last
  description::Fields<Load> settings;     ///< keys of [load] that are no numbers
  std::vector<LoadTable> tables;          ///< of settings that belong together
  std::optional<LoadStatement> statement;
  /// A key that [load] must not have, and why.
  std::optional<std::pair<std::string_view, std::string_view>> result;

  LoadType(std::string_view name, std::string_view description,
           std::vector<LoadParameter> parameters, std::optional<LoadStatement> statement = {},
           std::optional<std::pair<std::string_view, std::string_view>> result = {},
           description::Fields<Load> settings = {}, std::vector<LoadTable> tables = {});
  /// Parameters and settings as keys, or all but the magnitude.
  description::Fields<Load> keys(bool with_magnitude = true) const;
};

/// A plain struct of doubles with the parameters of a load type, in the order of its declaration.
template <class T>
concept LoadParameters = std::is_aggregate_v<T> && std::is_trivially_copyable_v<T> && sizeof(T) %
                                 sizeof(double) ==
                             0 &&
                         requires {
  { T::type() } -> std::same_as<const LoadType&>;
};

/// Horizontal force that stays at the current height z = h while the cilium slides under it (paper,
/// Eq. 1–2).
struct ContactLoad {
  static const LoadType& type();
  double force = 0;    ///< F, N
  double height = 0;   ///< h, m
  double azimuth = 0;  ///< φ, rad
};

/// Horizontal force q per unit current height over the whole cilium: drag on the projected area
/// (paper, Eq. 3–4, 10–11).
struct FlowLoad {
  static const LoadType& type();
  double force_per_height = 0;  ///< q, N/m
  double azimuth = 0;           ///< φ, rad
};

/// Horizontal dead force spread evenly over the material cross-section at reference arc length S.
struct SectionLoad {
  static const LoadType& type();
  double force = 0;      ///< F, N
  double arclength = 0;  ///< S, m
  double azimuth = 0;    ///< φ, rad
};

/// Horizontal dead force per reference length over the whole cilium, spread evenly over the
/// section.
struct DeadLoad {
  static const LoadType& type();
  double force_per_length = 0;  ///< q, N/m
  double azimuth = 0;           ///< φ, rad
};

/// Dead couple on the end face about the axis e_z × e, which turns the tip towards e. It has no
/// resultant force.
struct MomentLoad {
  static const LoadType& type();
  double moment = 0;   ///< M, N·m
  double azimuth = 0;  ///< φ, rad
};

/// Displacement control of the contact point (the test bench): the point of the cilium at the
/// current height z = h is pushed aside to the deflection δ along e. The contact force is as of a
/// ContactLoad; its amount is a result (MechanicsStep::applied_force). A δ that the cilium cannot
/// reach is a slip-off, not an error of the input: each model finds the δ at which the cilium lets
/// go (MechanicsStep::slip_off_displacement).
struct ProbeLoad {
  static const LoadType& type();
  double displacement = 0;  ///< δ, m
  double height = 0;        ///< h, m
  double azimuth = 0;       ///< φ, rad
};

/// A rigid surface that passes over the cilium along e: z = L − δ − p(x − s), x along e, p the
/// height of its profile. The steps of a path lead from place to place on straight lines.
struct SweepLoad {
  static const LoadType& type();
  double interference =
      0;               ///< δ, m, how far p = 0 lies below the straight cilium's tip; may be < 0
  double travel = 0;   ///< s, m
  double speed = 0;    ///< ds/dt, m/s; the equilibria do not depend on it
  double azimuth = 0;  ///< φ of e, rad
};

/// Nothing but the environment (surroundings::Environment), which acts with the factor `scale`:
/// what a step has where no other load is asked for.
struct EnvironmentLoad {
  static const LoadType& type();
  double scale = 1;    ///< of gravity and field
  double azimuth = 0;  ///< φ of the plane in which the cilium bends, rad
};

/// One step of a load path: a load type and the values of its parameters, SI; of a sweep the
/// surface; and the environment, whatever the type.
class Load {
 public:
  static constexpr std::size_t most_parameters = 8;

  Load() : Load(ContactLoad{}) {}
  template <LoadParameters T>
  Load(const T& load) : type_(&T::type()) {  // NOLINT: a load of a type is a load
    static_assert(sizeof(T) / sizeof(double) <= most_parameters);
    const auto values = std::bit_cast<std::array<double, sizeof(T) / sizeof(double)>>(load);
    std::copy(values.begin(), values.end(), values_.begin());
  }
  Load(const SweepLoad& load, std::shared_ptr<const surroundings::Surface> surface) : Load(load) {
    surface_ = std::move(surface);
  }
  /// A load with the values that stand for keys that are not stated.
  explicit Load(const LoadType& type);

  const LoadType& type() const { return *type_; }
  std::span<const double> values() const { return std::span(values_).first(count()); }
  /// The value of a parameter; none if the type has none of this name.
  std::optional<double> value(std::string_view parameter) const;
  void set_value(std::size_t parameter, double value) { values_.at(parameter) = value; }
  /// The surface of a sweep; null of another load.
  const std::shared_ptr<const surroundings::Surface>& surface() const { return surface_; }
  void set_surface(std::shared_ptr<const surroundings::Surface> surface) {
    surface_ = std::move(surface);
  }
  /// Slip-off point of a contact or a probe.
  SlipOffPoint slip_off_point() const { return slip_off_point_; }
  void set_slip_off_point(SlipOffPoint point) { slip_off_point_ = point; }
  /// How a contact or a probe touches.
  const TouchLaw& touch() const { return touch_; }
  void set_touch(const TouchLaw& touch) { touch_ = touch; }
  /// Environment of the cilium; acting_environment() returns the part that acts on it.
  const surroundings::Environment& environment() const { return environment_; }
  void set_environment(const surroundings::Environment& environment) { environment_ = environment; }

  template <LoadParameters T>
  bool is() const {
    return type_ == &T::type();
  }
  /// A copy of the parameters of a load of type T; none of another type.
  template <LoadParameters T>
  std::optional<const T> as() const {
    if (!is<T>()) return std::nullopt;
    std::array<double, sizeof(T) / sizeof(double)> values;
    std::copy_n(values_.begin(), values.size(), values.begin());
    return std::bit_cast<T>(values);
  }

 private:
  std::size_t count() const { return type_->parameters.size(); }

  const LoadType* type_;
  std::array<double, most_parameters> values_{};
  std::shared_ptr<const surroundings::Surface> surface_;
  SlipOffPoint slip_off_point_ = SlipOffPoint::axis;
  TouchLaw touch_;
  surroundings::Environment environment_;
};

/// Loads that the cilium bears one after the other, all of one type.
using LoadPath = std::vector<Load>;

/// Every load type, first the types of this file.
std::span<const LoadType* const> load_types();
/// Adds a type that a program brings along. It must live as long as the program.
void add_load_type(const LoadType& type);
/// The load type of this name, or null.
const LoadType* find_load_type(std::string_view name);

std::string_view type(const Load& load);
double azimuth(const Load& load);
/// e = (cos φ, sin φ, 0), the direction of the load.
Vector3 direction(const Load& load);
/// The force F (N), the force per length q (N/m), the moment M (N·m) or the displacement δ (m),
/// whichever the type has.
double magnitude(const Load& load);
/// Unit of the magnitude: "N", "N/m", "N m" or "m".
std::string_view magnitude_unit(const Load& load);
/// h of a load that acts at a current height (contact, probe), m.
std::optional<double> contact_height(const Load& load);
/// S of a load that acts at a material section (section), m.
std::optional<double> loaded_arclength(const Load& load);
/// The same load with another magnitude.
Load with_magnitude(const Load& load, double magnitude);
/// The same load in another direction, rad; the environment stays.
Load with_azimuth(const Load& load, double azimuth);
/// Load and environment turned by the angle about the z axis, rad.
Load turned(const Load& load, double angle);
/// The environment that acts under the load: of an EnvironmentLoad by its factor.
surroundings::Environment acting_environment(const Load& load);
/// The same load with another environment.
Load with_environment(const Load& load, const surroundings::Environment& environment);
/// The load of magnitude 0 without an environment, under which the cilium is straight.
Load nothing_of(const Load& load);
/// (1−t)·from + t·to in every parameter and in the environment, for load stepping. Throws
/// InputError if the types differ.
Load interpolate(const Load& from, const Load& to, double t);
/// True if type, values, settings, surface and environment are the same.
bool operator==(const Load& a, const Load& b);

/// Throws the InputError of a model that knows the plain touch alone, if the load states another.
void require_plain_touch(const Load& load, std::string_view model);

/// Throws the InputError of a model that does not know the load's type.
[[noreturn]] void refuse_type(const Load& load, std::string_view model);

/// Throws InputError if the load is not one the cilium can bear in the models' sense: magnitude
/// finite and not negative (turn the azimuth by 180° instead), 0 < h < L, 0 < S ≤ L; of a sweep a
/// valid surface, and δ < L; a valid environment.
void require_valid(const Load& load, const Cilium& cilium);

/// Throws InputError unless all loads are sweeps of one surface and azimuth.
void require_one_surface(const LoadPath& path);

/// The way of a sweep.
struct SweepWay {
  double travel = 0;  ///< of the last place (if there_and_back, of the one in the middle), m
  unsigned int samples = 101;  ///< places on the way there, both ends included
  bool there_and_back = false;
};
/// Steps at places of equal distance, from `start` on: there, and back again over the same places.
/// Throws InputError unless there are two samples or more.
LoadPath sweep_path(const Load& start, const SweepWay& way);
/// The way of a path that sweep_path() made.
SweepWay sweep_way(const LoadPath& path);
/// The load at another place of the sweep, m.
Load with_travel(const Load& sweep, double travel);

}  // namespace ciliaval
