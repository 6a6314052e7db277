// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/load.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "problem/description/surface.h"
#include "problem/error.h"

namespace ciliaval {
namespace {

using Site = LoadParameter::Site;

constexpr double milli = 1e3;                                     ///< from SI to mN or mm
constexpr double two_turns = 4 * std::numbers::pi * (1 + 1e-12);  ///< rad, 720 deg included

constexpr Range any_magnitude{0, 1e9, false, turn_round};

/// The parameter, for which a value stands that these words say.
LoadParameter falls_back_to(LoadParameter parameter, double value, std::string_view words) {
  parameter.absence = description::Key::Absence::its_initial_value;
  parameter.initial = value;
  parameter.fallback = words;
  return parameter;
}

LoadParameter force_parameter() {
  return load_parameter("force", quantity::force, any_magnitude,
                        "`contact`, `section`: the horizontal force.", ", force {:g} mN", milli);
}

LoadParameter contact_height_parameter() {
  return load_parameter(
      "height", quantity::length, length_range,
      "`contact`, `probe`: the height z at which the force stays; between the base and the tip.",
      " at height {:g} mm", milli, Site::height);
}

LoadParameter azimuth_parameter() {
  return falls_back_to(load_parameter("azimuth", quantity::angle,
                                      {-two_turns, two_turns, false,
                                       "more than two turns is taken for a slip in the unit"},
                                      "Direction of the load in the plane, from +x towards +y.",
                                      ", azimuth {:g} deg", 180 / std::numbers::pi),
                       0, "0 deg");
}

description::Field<Load> slip_off_key() {
  constexpr std::string_view axis = "axis";
  constexpr std::string_view rim = "rim";
  description::Field<Load> key;
  key.name = "slip_off";
  key.doc =
      "`contact`, `probe`: a rod lets go where the tip of its `axis` comes down to the height, or "
      "where the `rim` of its end face comes down to the height + `models.solid.kernel_width`, as "
      "a solid always does.";
  key.choices = {axis, rim};
  key.absence = description::Key::Absence::nothing;
  key.initial = std::string(axis);
  key.get = [=](const Load& load) {
    return description::Value(std::string(load.slip_off_point() == SlipOffPoint::rim ? rim : axis));
  };
  key.set = [=](Load& load, const description::Value& value) {
    load.set_slip_off_point(std::get<std::string>(value) == rim ? SlipOffPoint::rim
                                                                : SlipOffPoint::axis);
  };
  return key;
}

/// A key of the table `touch`.
description::Field<Load> touch_key(description::Field<TouchLaw> of_law, std::string_view words) {
  // What is the paper's is not written; friction belongs to the other law alone.
  if (!of_law.condition) of_law.absence = description::Key::Absence::nothing;
  of_law.fallback = words;
  description::Field<Load> key;
  static_cast<description::Key&>(key) = of_law;
  key.get = [get = of_law.get](const Load& load) { return get(load.touch()); };
  key.set = [set = of_law.set](Load& load, const description::Value& value) {
    TouchLaw touch = load.touch();
    set(touch, value);
    load.set_touch(touch);
  };
  if (of_law.condition)
    key.condition = [condition = of_law.condition](const Load& load) {
      return condition(load.touch());
    };
  return key;
}

LoadTable touch_table() {
  using description::choice;
  using description::field;
  using Law = TouchLaw::Law;
  using At = TouchLaw::At;
  return {
      "touch",
      {touch_key(choice(&TouchLaw::law, "law",
                        {{"horizontal", Law::horizontal}, {"coulomb", Law::coulomb}},
                        "`contact`, `probe`: the force stays `horizontal`, as in the paper, or the "
                        "probe slides on the cilium with `coulomb` friction."),
                 ""),
       touch_key(description::only_with(
                     &TouchLaw::law, Law::coulomb, "'law = \"coulomb\"'",
                     field(&TouchLaw::friction, description::friction_key,
                           {0, 5, false, "it is a coefficient"}, "The coefficient of friction.")),
                 ""),
       touch_key(choice(&TouchLaw::at, "at", {{"axis", At::axis}, {"mantle", At::mantle}},
                        "The force acts on the `axis`, as in the paper, or on the `mantle`, at the "
                        "side from which the probe comes."),
                 ""),
       touch_key(field(&TouchLaw::radius, "radius", quantity::length, {0, 100, false, unit_slip},
                       "Of the probe, a pin across the azimuth with its centre at `height`; 0 is a "
                       "knife edge."),
                 "0 mm")}};
}

/// One of the values of a statement.
description::Field<LoadStatement::Values> stated(std::size_t place, std::string_view name,
                                                 const Quantity& quantity, const Range& range,
                                                 double value, std::string_view fallback,
                                                 std::string_view doc) {
  using Values = LoadStatement::Values;
  description::Field<Values> field;
  field.name = name;
  field.quantity = quantity;
  field.range = range;
  field.doc = doc;
  field.initial = value;
  field.fallback = fallback;
  field.is_along_path = true;
  field.get = [place](const Values& values) { return description::Value(values.at(place)); };
  field.set = [place](Values& values, const description::Value& v) {
    values.at(place) = std::get<double>(v);
  };
  return field;
}

/// Values of a flow's LoadStatement.
struct FlowValues {
  explicit FlowValues(const LoadStatement::Values& values)
      : velocity(values.at(0)),
        density(values.at(1)),
        drag_coefficient(values.at(2)),
        viscosity(values.at(3)) {}

  bool is_by_correlation() const { return drag_coefficient == description::Key::stands_for_word; }
  double velocity, density, drag_coefficient, viscosity;
};

/// q = ½ρv²C_d d (paper, Eq. 11), N/m.
double drag_per_height(const LoadStatement::Values& values, const Cilium& cilium) {
  if (cilium.is_rectangular())
    throw InputError(
        "the drag of a rectangle is not known from a velocity: state force_per_height");
  const FlowValues flow(values);
  if (flow.velocity == 0) return 0;
  const double C_d = flow.is_by_correlation()
                         ? cylinder_drag_coefficient(flow.density * flow.velocity *
                                                     cilium.diameter / flow.viscosity)
                         : flow.drag_coefficient;
  return flow.density * flow.velocity * flow.velocity * C_d * cilium.diameter / 2;
}

description::Field<LoadStatement::Values> drag_coefficient() {
  auto key = stated(2, "drag_coefficient", quantity::number,
                    {1e-6, 1e6, false, "a drag coefficient is near 1"}, 1, "1",
                    "`flow` by `velocity`: the drag coefficient C_d, or \"cylinder\": of a long "
                    "cylinder across the flow at its Reynolds number density v d/viscosity, 1e-4 "
                    "to 2e5 (Sucker and Brauer, 1975).");
  key.word = "cylinder";
  return key;
}

description::Field<LoadStatement::Values> viscosity() {
  auto key = stated(3, "viscosity", quantity::viscosity, {1e-9, 1e6, false, unit_slip}, 1.0016e-3,
                    "1.0016 mPa s, of water at 20 deg C",
                    "`flow` by `velocity` with `drag_coefficient = \"cylinder\"`: of the fluid.");
  key.condition = [](const LoadStatement::Values& values) {
    return FlowValues(values).is_by_correlation();
  };
  key.goes_with = "'drag_coefficient = \"cylinder\"'";
  return key;
}

double minus_the_clearance(const LoadStatement::Values& values, const Cilium& /*cilium*/) {
  return -values[0];
}

std::vector<const LoadType*>& all_types() {
  static std::vector<const LoadType*> types{
      &ContactLoad::type(), &FlowLoad::type(),  &SectionLoad::type(),     &DeadLoad::type(),
      &ProbeLoad::type(),   &SweepLoad::type(), &EnvironmentLoad::type(), &MomentLoad::type()};
  return types;
}

void require_valid(const SweepLoad& sweep, const Load& load, const Cilium& cilium) {
  if (!load.surface()) throw InputError("a sweep needs a surface");
  if (cilium.section.shape != CrossSection::Shape::circle)
    throw InputError("a sweep is of a cilium of circular section only");
  surroundings::require_valid(*load.surface());
  if (!std::isfinite(sweep.travel)) throw InputError("the travel must be finite");
  if (!(std::isfinite(sweep.interference) && sweep.interference < cilium.length()))
    throw InputError("the interference must be finite and less than the length of the cilium");
}

std::optional<double> value_at(const Load& load, Site site) {
  for (std::size_t i = 0; i < load.values().size(); ++i)
    if (load.type().parameters[i].site == site) return load.values()[i];
  return std::nullopt;
}

}  // namespace

double cylinder_drag_coefficient(double Re) {
  if (!cylinder_reynolds_numbers.contains(Re)) {
    std::ostringstream message;
    message << "the drag of a cylinder is known for Reynolds numbers of 1e-4 to 2e5, not for " << Re
            << ": state the drag coefficient";
    throw InputError(message.str());
  }
  return 1.18 + 6.8 / std::pow(Re, 0.89) + 1.96 / std::sqrt(Re) -
         0.0004 * Re / (1 + 3.64e-7 * Re * Re);
}

LoadParameter load_parameter(std::string_view name, const Quantity& quantity, const Range& range,
                             std::string_view doc, std::string_view words, double display_factor,
                             Site site) {
  LoadParameter result;
  result.name = name;
  result.quantity = quantity;
  result.range = range;
  result.doc = doc;
  result.initial = 0.0;
  result.absence = description::Key::Absence::fault;
  result.is_along_path = true;
  result.words = words;
  result.display_factor = display_factor;
  result.site = site;
  return result;
}

LoadType::LoadType(std::string_view its_name, std::string_view its_description,
                   std::vector<LoadParameter> its_parameters,
                   std::optional<LoadStatement> its_statement,
                   std::optional<std::pair<std::string_view, std::string_view>> its_result,
                   description::Fields<Load> its_settings, std::vector<LoadTable> its_tables)
    : name(its_name),
      description(its_description),
      parameters(std::move(its_parameters)),
      settings(std::move(its_settings)),
      tables(std::move(its_tables)),
      statement(std::move(its_statement)),
      result(std::move(its_result)) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    parameters[i].get = [i](const Load& load) { return description::Value(load.values()[i]); };
    parameters[i].set = [i](Load& load, const description::Value& value) {
      load.set_value(i, std::get<double>(value));
    };
  }
}

description::Fields<Load> LoadType::keys(bool with_magnitude) const {
  description::Fields<Load> keys(parameters.begin() + (with_magnitude ? 0 : 1), parameters.end());
  keys.insert(keys.end(), settings.begin(), settings.end());
  return keys;
}

const LoadType& ContactLoad::type() {
  static const LoadType type{
      "contact",
      "horizontal force that stays at a height while the cilium slides under it",
      {force_parameter(), contact_height_parameter(), azimuth_parameter()},
      {},
      {},
      {slip_off_key()},
      {touch_table()}};
  return type;
}

const LoadType& FlowLoad::type() {
  static const LoadType type{
      "flow",
      "horizontal force per unit of current height: drag",
      {falls_back_to(
           load_parameter("force_per_height", quantity::force_per_length, any_magnitude,
                          "`flow`: the force q per unit of current height; this or `velocity`.",
                          ", {:g} N per metre of height"),
           0, "from `velocity`"),
       azimuth_parameter()},
      LoadStatement{
          {stated(0, "velocity", quantity::velocity, {0, 1e4, false, turn_round}, 0, "none",
                  "`flow`: the fluid's velocity v, q = density v^2 drag_coefficient d/2 "
                  "(paper, Eq. 11)."),
           stated(1, "density", quantity::density, {1e-9, 1e6, false, unit_slip}, 1000,
                  "1000 kg/m^3", "`flow` by `velocity`: the fluid's density."),
           drag_coefficient(), viscosity()},
          &drag_per_height}};
  return type;
}

const LoadType& SectionLoad::type() {
  static const LoadType type{
      "section",
      "dead force on one material cross-section",
      {force_parameter(),
       load_parameter("arclength", quantity::length, length_range,
                      "`section`: the arc length of the loaded section; not beyond the tip.",
                      " at arc length {:g} mm", milli, Site::arclength),
       azimuth_parameter()}};
  return type;
}

const LoadType& DeadLoad::type() {
  static const LoadType type{
      "dead",
      "dead force per unit of reference length",
      {load_parameter("force_per_length", quantity::force_per_length, any_magnitude,
                      "`dead`: the force per reference length.", ", {:g} N per metre of length"),
       azimuth_parameter()}};
  return type;
}

const LoadType& MomentLoad::type() {
  static const LoadType type{
      "moment",
      "dead couple on the end face that turns the tip towards the azimuth",
      {load_parameter("moment", quantity::moment, any_magnitude,
                      "`moment`: the couple at the tip about the horizontal axis across the "
                      "azimuth; 2 pi E I/L rolls a uniform cilium up into a circle.",
                      ", moment {:g} uN m", 1e6),
       azimuth_parameter()}};
  return type;
}

const LoadType& ProbeLoad::type() {
  static const LoadType type{
      "probe",
      "displacement of the contact point at a height: the contact force is a result",
      {load_parameter("displacement", quantity::length,
                      {0, 100, false,
                       "a displacement is not negative (to turn it round, add 180 deg to the "
                       "azimuth) and a larger one is taken for a slip in the unit"},
                      "`probe`: the deflection of the contact point; the force is a result.",
                      ", displacement {:g} mm", milli),
       contact_height_parameter(), azimuth_parameter()},
      std::nullopt,
      {{"force",
        "'force' is a result of the load type 'probe', whose 'displacement' is given: leave it out "
        "or use the type 'contact'"}},
      {slip_off_key()},
      {touch_table()}};
  return type;
}

const LoadType& SweepLoad::type() {
  static const LoadType type{
      "sweep",
      "a rigid surface that passes over the tip: [surface]",
      {falls_back_to(
           load_parameter("interference", quantity::length, {-100, 100, false, unit_slip},
                          "`sweep`: how far the surface (profile height 0) lies below the straight "
                          "cilium's tip; this or `clearance`.",
                          ", interference {:g} mm", milli),
           0, "from `clearance`"),
       load_parameter("travel", quantity::length, {0, 100, false, unit_slip},
                      "`sweep`: how far the surface moves along the azimuth.", ", travel {:g} mm",
                      milli),
       falls_back_to(
           load_parameter("speed", quantity::velocity, {1e-9, 1e3, false, unit_slip},
                          "`sweep`: of the surface; it makes times of the travel, nothing else.",
                          ""),
           0.01, "10 mm/s"),
       azimuth_parameter()},
      LoadStatement{
          {stated(0, "clearance", quantity::length, {-100, 100, false, unit_slip}, 0, "none",
                  "`sweep`: how far the surface lies above the straight cilium's "
                  "tip, minus the interference.")},
          &minus_the_clearance}};
  return type;
}

const LoadType& EnvironmentLoad::type() {
  static const LoadType type{
      "environment",
      "nothing but the environment: weight, field",
      {falls_back_to(load_parameter("scale", quantity::number, {0, 1e6, false, turn_round},
                                    "`environment`: a factor on gravity and field of "
                                    "[environment].",
                                    ", environment times {:g}"),
                     1, "1"),
       azimuth_parameter()}};
  return type;
}

std::span<const LoadType* const> load_types() {
  return all_types();
}

void add_load_type(const LoadType& type) {
  all_types().push_back(&type);
}

const LoadType* find_load_type(std::string_view name) {
  for (const LoadType* type : load_types())
    if (type->name == name) return type;
  return nullptr;
}

Load::Load(const LoadType& type) : type_(&type) {
  if (count() > most_parameters)
    throw InputError("the load type '" + std::string(type.name) + "' has " +
                     std::to_string(count()) + " parameters, more than " +
                     std::to_string(most_parameters));
  for (const LoadParameter& parameter : type.parameters) parameter.set(*this, parameter.initial);
}

std::optional<double> Load::value(std::string_view parameter) const {
  for (std::size_t i = 0; i < count(); ++i)
    if (type_->parameters[i].name == parameter) return values_[i];
  return std::nullopt;
}

std::string_view type(const Load& load) {
  return load.type().name;
}

double azimuth(const Load& load) {
  return load.values().back();
}

Vector3 direction(const Load& load) {
  const double phi = azimuth(load);
  return {std::cos(phi), std::sin(phi), 0.0};
}

double magnitude(const Load& load) {
  return load.values().front();
}

std::string_view magnitude_unit(const Load& load) {
  return load.type().parameters.front().quantity.unit;
}

std::optional<double> contact_height(const Load& load) {
  return value_at(load, Site::height);
}

std::optional<double> loaded_arclength(const Load& load) {
  return value_at(load, Site::arclength);
}

Load with_magnitude(const Load& load, double magnitude) {
  Load result = load;
  result.set_value(0, magnitude);
  return result;
}

Load with_azimuth(const Load& load, double azimuth) {
  Load result = load;
  result.set_value(load.values().size() - 1, azimuth);
  return result;
}

Load turned(const Load& load, double angle) {
  return with_environment(with_azimuth(load, azimuth(load) + angle),
                          surroundings::turned(load.environment(), angle));
}

surroundings::Environment acting_environment(const Load& load) {
  const auto alone = load.as<EnvironmentLoad>();
  return alone ? surroundings::scaled(load.environment(), alone->scale) : load.environment();
}

Load with_environment(const Load& load, const surroundings::Environment& environment) {
  Load result = load;
  result.set_environment(environment);
  return result;
}

Load nothing_of(const Load& load) {
  return with_environment(with_magnitude(load, 0), surroundings::scaled(load.environment(), 0));
}

Load interpolate(const Load& from, const Load& to, double t) {
  if (&from.type() != &to.type())
    throw InputError("a load path cannot change from one load type to another");
  Load result = from;
  for (std::size_t i = 0; i < from.values().size(); ++i)
    result.set_value(i, std::lerp(from.values()[i], to.values()[i], t));
  result.set_environment(surroundings::interpolate(from.environment(), to.environment(), t));
  return result;
}

bool operator==(const Load& a, const Load& b) {
  return &a.type() == &b.type() && std::ranges::equal(a.values(), b.values()) &&
         a.slip_off_point() == b.slip_off_point() && a.touch() == b.touch() &&
         a.surface() == b.surface() && a.environment() == b.environment();
}

void require_plain_touch(const Load& load, std::string_view model) {
  if (!load.touch().is_plain())
    throw InputError("the " + std::string(model) +
                     " takes no 'touch': its contact force is horizontal and on the axis");
}

void refuse_type(const Load& load, std::string_view model) {
  throw InputError("the " + std::string(model) + " does not take the load type '" +
                   std::string(type(load)) + "'");
}

void require_valid(const Load& load, const Cilium& cilium) {
  if (!std::isfinite(azimuth(load))) throw InputError("the azimuth must be finite");
  cilium.extent(azimuth(load));  // throws where a rectangle would leave the plane
  surroundings::require_valid(load.environment(), cilium);
  if (const auto sweep = load.as<SweepLoad>()) return require_valid(*sweep, load, cilium);
  if (!std::isfinite(magnitude(load)) || magnitude(load) < 0)
    throw InputError(
        "the load must be finite and not negative; to turn it round, add 180 deg to the azimuth");
  const std::optional<double> height = contact_height(load);
  if (height && !(*height > 0 && *height < cilium.length()))
    throw InputError("the contact height must lie between the base and the tip of the cilium");
  if (!load.touch().is_plain() && load.slip_off_point() == SlipOffPoint::rim)
    throw InputError(
        "slip_off = 'rim' is of a horizontal force; a probe with 'touch' slips off where its "
        "contact reaches the tip, or where its force is largest");
  const std::optional<double> arclength = loaded_arclength(load);
  if (arclength && !(*arclength > 0 && *arclength <= cilium.length()))
    throw InputError(
        "the loaded section must lie above the base and not beyond the tip of the cilium");
}

void require_one_surface(const LoadPath& path) {
  for (const Load& load : path)
    if (!load.is<SweepLoad>() || load.surface() != path.front().surface() ||
        azimuth(load) != azimuth(path.front()))
      throw InputError("the steps of a sweep have one surface and one azimuth");
}

Load with_travel(const Load& sweep, double travel) {
  SweepLoad place = sweep.as<SweepLoad>().value();
  place.travel = travel;
  return with_environment(Load(place, sweep.surface()), sweep.environment());
}

LoadPath sweep_path(const Load& start, const SweepWay& way) {
  if (way.samples < 2) throw InputError("a sweep needs two samples or more");
  const double from = start.as<SweepLoad>().value().travel;
  LoadPath path;
  for (unsigned int i = 0; i < way.samples; ++i)
    path.push_back(with_travel(start, std::lerp(from, way.travel, i / (way.samples - 1.0))));
  for (unsigned int i = way.samples - 1; way.there_and_back && i > 0; --i)
    path.push_back(path[i - 1]);
  return path;
}

SweepWay sweep_way(const LoadPath& path) {
  const auto travel = [&](std::size_t i) { return path[i].as<SweepLoad>().value().travel; };
  const auto n = static_cast<unsigned int>(path.size());
  if (n > 2 && travel(n - 1) == travel(0)) return {travel(n / 2), n / 2 + 1, true};
  return {travel(n - 1), n, false};
}

}  // namespace ciliaval
