// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/input/case_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <type_traits>

namespace ciliaval::compare::input {
namespace {

constexpr std::array<std::string_view, 4> known_mechanics{"elastica", "beam", "calculix", "solid"};
constexpr std::array<std::string_view, 5> known_fields{"dipole", "line", "volume", "mesh",
                                                       "potential"};

constexpr std::array<LaterKey, 2> known_later{{
    {"environment", "gravity, buoyancy and uniform fields"},
    {"cilium.segment.density", "weight (it goes with [environment])"},
}};

const std::array<TextKey, 11> text_keys{{
    {"case", "name", "text", "",
     "Name of the results' folder: letters, digits, `.`, `_`, `-`, not starting with `.` or `-`, "
     "at most 100."},
    {"case", "title", "text", "the name", "A line for people, at most 200 characters."},
    {"case", "references", "text", "none",
     "Number and checksum of the references in the case's baseline, as `check` states them."},
    {"cilium.segment", "name", "text", "", "Name of the segment, different from the others'."},
    {"load", "type", "`contact`, `flow`, `section`, `dead` or `probe`", "",
     "What the load is and does as the cilium bends."},
    {"models", "mechanics", "list of `elastica`, `beam`, `calculix`, `solid`", "",
     "The mechanics models to run, at least one."},
    {"models", "fields", "list of `dipole`, `line`, `volume`, `mesh`, `potential`", "none",
     "The field models to run on the deformation of each mechanics model; `mesh` takes "
     "`solid` and `calculix` only."},
    {key::external_table, "name", "text", "",
     "Name of an external model (docs/guide/referees.md), not that of a model; a plain file name."},
    {key::external_table, "centrelines", "list of file names", "none",
     "CSV files with a centreline each, one for each load step, beside the case file unless "
     "absolute; these or `readings`."},
    {key::external_table, "readings", "file name", "none",
     "CSV file with the readings of every load step and sensor."},
    {key::external_table, "background", "file name", "none",
     "CSV file with the ambient field at each azimuth, to be taken off the readings."},
}};

const std::vector<const QuantityKey*>& quantity_keys() {
  static const std::vector<const QuantityKey*> keys = [] {
    std::vector<const QuantityKey*> all{&key::diameter, &key::segment_length, &key::young_modulus,
                                        &key::poisson_ratio, &key::magnetization};
    const auto add = [&](const std::vector<LoadParameter>& parameters, bool last) {
      for (const LoadParameter& parameter : parameters)
        if ((parameter.key.name == "azimuth") == last &&
            std::none_of(all.begin(), all.end(), [&](const QuantityKey* k) {
              return k->table == parameter.key.table && k->name == parameter.key.name;
            }))
          all.push_back(&parameter.key);
    };
    for (const bool last : {false, true})
      for (const LoadType* type : load_types()) {
        add(type->parameters, last);
        if (type->statement) add(type->statement->parameters, last);
      }
    all.insert(all.end(),
               {&key::position, &key::plate_lower, &key::plate_upper, &key::plate_permeability,
                &key::tip_uncertainty, &key::field_uncertainty});
    return all;
  }();
  return keys;
}

/// A knob that is a double, an unsigned int, a bool or two doubles of the options of one model.
template <typename Options, typename T>
Knob number_knob(Options ModelOptions::*model, T Options::*member, std::string_view id,
                 std::string_view name, const Quantity& quantity, const Range& range,
                 std::string_view doc) {
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, unsigned int> ||
                std::is_same_v<T, bool> || std::is_same_v<T, std::array<double, 2>>);
  return {id,
          name,
          quantity,
          range,
          {},
          doc,
          [=](const ModelOptions& o) { return KnobValue((o.*model).*member); },
          [=](ModelOptions& o, const KnobValue& v) { (o.*model).*member = std::get<T>(v); }};
}

/// A knob that is an enumeration, by the names of its values.
template <typename Options, typename T>
Knob choice_knob(Options ModelOptions::*model, T Options::*member, std::string_view id,
                 std::string_view name, std::vector<std::pair<std::string_view, T>> values,
                 std::string_view doc) {
  std::vector<std::string_view> choices;
  choices.reserve(values.size());
  for (const auto& [text, value] : values) choices.push_back(text);
  return {id,
          name,
          quantity::number,
          {},
          choices,
          doc,
          [=](const ModelOptions& o) {
            for (const auto& [text, value] : values)
              if ((o.*model).*member == value) return KnobValue(std::string(text));
            return KnobValue(std::string(values.front().first));
          },
          [=](ModelOptions& o, const KnobValue& v) {
            for (const auto& [text, value] : values)
              if (std::get<std::string>(v) == text) (o.*model).*member = value;
          }};
}

/// A knob that is the name of a file; empty: none.
template <typename Options>
Knob file_knob(Options ModelOptions::*model, std::filesystem::path Options::*member,
               std::string_view id, std::string_view name, std::string_view doc) {
  return {
      id,
      name,
      quantity::number,
      {},
      {},
      doc,
      [=](const ModelOptions& o) { return KnobValue(((o.*model).*member).string()); },
      [=](ModelOptions& o, const KnobValue& v) { (o.*model).*member = std::get<std::string>(v); }};
}

/// A TOML string in double quotes; the text has no control characters.
std::string in_toml_quotes(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

constexpr Range any_bool{};
constexpr Range tolerance_range{1e-15, 1e-3, false,
                                "double precision resolves no less, and more is no solution"};
constexpr Range iterations_range{1, 1000, false, "the solver must end"};
constexpr Range cutbacks_range{0, 50, false, "50 halvings leave nothing of a step"};

void append_elastica(std::vector<Knob>& all) {
  using analytic::elastica::ElasticaOptions;
  all.push_back(choice_knob(
      &ModelOptions::elastica, &ElasticaOptions::form, "elastica", "form",
      {{"arclength", ElasticaOptions::Form::arclength}, {"height", ElasticaOptions::Form::height}},
      "`arclength`: dθ/dS = M/(EI), any load; `height`: the paper's "
      "quadrature in z (Eq. 1-4), `contact`, `flow` and `probe` only."));
  all.push_back(number_knob(&ModelOptions::elastica, &ElasticaOptions::tolerance, "elastica",
                            "tolerance", quantity::number, tolerance_range,
                            "Relative, of position over length and of angle."));
}

void append_beam(std::vector<Knob>& all) {
  using fem::beam::BeamOptions;
  constexpr auto beam = &ModelOptions::beam;
  all.push_back(number_knob(beam, &BeamOptions::degree, "beam", "degree", quantity::number,
                            {1, 20, false, "higher elements gain nothing here"},
                            "Degree of the interpolation of position and rotation."));
  all.push_back(number_knob(beam, &BeamOptions::refinement, "beam", "refinement", quantity::number,
                            {0, 12, false, "finer beams exceed the memory of a machine"},
                            "Each step halves the elements."));
  all.push_back(number_knob(beam, &BeamOptions::shear_rigid, "beam", "shear_rigid",
                            quantity::number, any_bool,
                            "No shear and no extension: the elastica's assumptions."));
  all.push_back(number_knob(beam, &BeamOptions::tolerance, "beam", "tolerance", quantity::number,
                            tolerance_range, "Of the residual and the increment, relative."));
  all.push_back(number_knob(beam, &BeamOptions::max_iterations, "beam", "max_iterations",
                            quantity::number, iterations_range,
                            "Newton iterations of a load increment."));
  all.push_back(number_knob(beam, &BeamOptions::max_cutbacks, "beam", "max_cutbacks",
                            quantity::number, cutbacks_range,
                            "Halvings of a load increment that does not converge."));
}

/// The solid's energies. The defaults of the ratios are the orders of magnitude of rubbers, none
/// measured on the paper's: C₀₁/C₁₀ = 1/4 is what is taken where only a hardness is known, and
/// Yeoh (Rubber Chem. Technol. 66, 754, 1993) finds a C₂₀ of −0.1 to −0.01 C₁₀, which makes rubber
/// softer in moderate shear, and a C₃₀ of some +0.01 C₁₀, which makes it stiff again.
void append_material(std::vector<Knob>& all) {
  using fem::solid::SolidOptions;
  using Material = SolidOptions::Material;
  constexpr auto solid = &ModelOptions::solid;
  all.push_back(choice_knob(solid, &SolidOptions::material, "solid", "material",
                            {{"neo-hooke", Material::neo_hooke},
                             {"mooney-rivlin", Material::mooney_rivlin},
                             {"yeoh", Material::yeoh}},
                            "Energy W + K/2 (J-1)²: `neo-hooke` W = μ/2 (Ī₁-3), `mooney-rivlin` "
                            "C10 (Ī₁-3) + C01 (Ī₂-3), `yeoh` C10 (Ī₁-3) + C20 (Ī₁-3)² + C30 "
                            "(Ī₁-3)³; E and ν of the segment give μ = 2 (C10 + C01) and K."));
  Knob mooney =
      number_knob(solid, &SolidOptions::mooney_ratio, "solid", "mooney_ratio", quantity::number,
                  {0, 10, false,
                   "with a negative C01 the solid is unstable, and rubber has a C01 "
                   "below C10"},
                  "`mooney-rivlin`: C01/C10. The default is a round figure for rubber.");
  mooney.goes_with = "material = \"mooney-rivlin\"";
  mooney.belongs = [](const ModelOptions& o) {
    return o.solid.material == Material::mooney_rivlin;
  };
  all.push_back(std::move(mooney));
  Knob yeoh = number_knob(solid, &SolidOptions::yeoh_ratios, "solid", "yeoh_ratios",
                          quantity::number, {-10, 10, false, "rubber has ratios well below 1"},
                          "`yeoh`: C20/C10 and C30/C10. Neither negative, or (C20/C10)² < 5/3 "
                          "C30/C10. The defaults are round figures for rubber.");
  yeoh.goes_with = "material = \"yeoh\"";
  yeoh.belongs = [](const ModelOptions& o) { return o.solid.material == Material::yeoh; };
  all.push_back(std::move(yeoh));
}

void append_calculix(std::vector<Knob>& all) {
  using fem::calculix::CalculixOptions;
  constexpr auto calculix = &ModelOptions::calculix;
  all.push_back(number_knob(calculix, &CalculixOptions::refinement, "calculix", "refinement",
                            quantity::number, {0, 3, false, "the solid has the meshes 0 to 3"},
                            "Mesh: that of the solid with this refinement."));
  all.push_back(number_knob(calculix, &CalculixOptions::error_estimate, "calculix",
                            "error_estimate", quantity::number, any_bool,
                            "Solve the next coarser mesh too, for `tip_uncertainty`."));
  all.push_back(number_knob(calculix, &CalculixOptions::first_increment, "calculix",
                            "first_increment", quantity::number,
                            {1e-6, 1, false, "it is a part of the load"},
                            "Part of the load that CalculiX tries first; it goes on by itself."));
  all.push_back(number_knob(calculix, &CalculixOptions::threads, "calculix", "threads",
                            quantity::number, {1, 1024, false, "a machine has no more"},
                            "Threads of CalculiX."));
  all.push_back(number_knob(calculix, &CalculixOptions::time_limit, "calculix", "time_limit",
                            quantity::time, {1e-3, 1e7, false, unit_slip},
                            "Of one run of CalculiX, of which each step takes one, or two with "
                            "`error_estimate`; then it is ended, and the step has failed."));
  all.push_back(file_knob(calculix, &CalculixOptions::program, "calculix", "program",
                          "The program: a name that is looked for in PATH, or with a slash a "
                          "file, beside the case file unless absolute."));
  all.push_back(file_knob(calculix, &CalculixOptions::keep, "calculix", "keep",
                          "Folder, beside the case file unless absolute, in which CalculiX's files "
                          "stay, one subfolder for each run. Empty: they are removed."));
}

void append_solid(std::vector<Knob>& all) {
  using fem::solid::SolidOptions;
  constexpr auto solid = &ModelOptions::solid;
  append_material(all);
  all.push_back(number_knob(solid, &SolidOptions::refinement, "solid", "refinement",
                            quantity::number, {0, 3, false, "the solid has the meshes 0 to 3"},
                            "Mesh: 0 coarse, 1 default, 2 fine, 3 to certify these."));
  all.push_back(choice_knob(
      solid, &SolidOptions::initial_guess, "solid", "initial_guess",
      {{"beam", fem::solid::InitialGuess::beam}, {"none", fem::solid::InitialGuess::none}},
      "What the coarsest mesh starts from: the beam's solution at the same "
      "load, or its own last ones."));
  all.push_back(number_knob(solid, &SolidOptions::symmetry, "solid", "symmetry", quantity::number,
                            any_bool,
                            "Solve one side of the bending plane; the other is its mirror "
                            "image."));
  all.push_back(
      file_knob(solid, &SolidOptions::mesh, "solid", "mesh",
                "Gmsh file (docs/guide/meshes.md) in place of the built-in mesh, beside the "
                "case file unless absolute; `refinement` and `symmetry` are then not "
                "used. Empty: the built-in mesh."));
  all.push_back(number_knob(solid, &SolidOptions::mesh_unit, "solid", "mesh_unit", quantity::length,
                            {1e-9, 1, false, unit_slip},
                            "What a coordinate of 1 in that file is: `\"1 mm\"`."));
  all.push_back(number_knob(
      solid, &SolidOptions::kernel_width, "solid", "kernel_width", quantity::length, length_range,
      "Half-width w of the contact kernel; `contact` and `probe` need 0 < h-w "
      "and h+w below the tip."));
  all.push_back(number_knob(solid, &SolidOptions::tolerance, "solid", "tolerance", quantity::number,
                            tolerance_range,
                            "Of the residual, relative to the applied force, and of the "
                            "increment."));
  all.push_back(number_knob(solid, &SolidOptions::max_iterations, "solid", "max_iterations",
                            quantity::number, iterations_range,
                            "Newton iterations of a load increment."));
  all.push_back(number_knob(
      solid, &SolidOptions::max_cutbacks, "solid", "max_cutbacks", quantity::number, cutbacks_range,
      "Cuts, to a quarter, of a load step that does not converge, in a row."));
  all.push_back(
      choice_knob(solid, &SolidOptions::solver, "solid", "solver",
                  {{"auto", fem::solid::solvers::SolverKind::automatic},
                   {"direct", fem::solid::solvers::SolverKind::direct},
                   {"iterative", fem::solid::solvers::SolverKind::iterative}},
                  "Linear systems: sparse LU, or GMRES with multigrid; `auto` takes LU up "
                  "to 100,000 unknowns."));
}

void append_fields(std::vector<Knob>& all) {
  using analytic::rod::Method;
  using analytic::sources::PushForward;
  using Slices = analytic::rod::VolumeOptions::Slices;
  const std::vector<std::pair<std::string_view, PushForward>> push_forward{{"F", PushForward::F},
                                                                           {"R", PushForward::R}};
  const std::vector<std::pair<std::string_view, Method>> method{
      {"closed_form", Method::closed_form},
      {"quadrature", Method::quadrature},
      {"uniform", Method::uniform}};
  constexpr std::string_view rod = "`F`: M dr (ideal hard magnet); `R`: M d₃ dS (rigid sections).";

  all.push_back(choice_knob(&ModelOptions::dipole, &analytic::rod::DipoleOptions::push_forward,
                            "dipole", "push_forward", push_forward, rod));
  all.push_back(choice_knob(&ModelOptions::line, &analytic::rod::LineOptions::push_forward, "line",
                            "push_forward", push_forward, rod));
  all.push_back(choice_knob(
      &ModelOptions::line, &analytic::rod::LineOptions::method, "line", "method", method,
      "`closed_form`: two poles; `quadrature`: its check; `uniform`: the paper's "
      "sum over slices of equal height."));
  all.push_back(number_knob(&ModelOptions::line, &analytic::rod::LineOptions::tolerance, "line",
                            "tolerance", quantity::number, tolerance_range,
                            "Relative to the field, of the quadrature."));
  Knob line = number_knob(&ModelOptions::line, &analytic::rod::LineOptions::elements, "line",
                          "elements", quantity::number, {1, 1e6, false, "more take gigabytes"},
                          "`uniform`: n dipoles in each magnetic segment.");
  line.goes_with = "method = \"uniform\"";
  line.belongs = [](const ModelOptions& o) { return o.line.method == Method::uniform; };
  all.push_back(std::move(line));
  all.push_back(choice_knob(&ModelOptions::volume, &analytic::rod::VolumeOptions::slices, "volume",
                            "slices", {{"wedge", Slices::wedge}, {"stacked", Slices::stacked}},
                            "`wedge`: the true volume of the bent rod; `stacked`: the paper's Eq. "
                            "8-9, flat slices of equal thickness."));
  all.push_back(choice_knob(&ModelOptions::volume, &analytic::rod::VolumeOptions::method, "volume",
                            "method", method,
                            "`closed_form`: charged discs or current loops; `quadrature`: their "
                            "check; `uniform`: the paper's sum over slices of equal height."));
  all.push_back(number_knob(&ModelOptions::volume, &analytic::rod::VolumeOptions::tolerance,
                            "volume", "tolerance", quantity::number, tolerance_range,
                            "Relative to the field."));
  Knob volume = number_knob(&ModelOptions::volume, &analytic::rod::VolumeOptions::elements,
                            "volume", "elements", quantity::number,
                            {1, 400, false, "more than 400^3 dipoles take too long"},
                            "`uniform`: n³ dipoles in each magnetic segment, n in z, r and φ.");
  volume.goes_with = "method = \"uniform\"";
  volume.belongs = [](const ModelOptions& o) { return o.volume.method == Method::uniform; };
  all.push_back(std::move(volume));
  all.push_back(choice_knob(&ModelOptions::mesh, &analytic::body::MeshOptions::push_forward, "mesh",
                            "push_forward", push_forward,
                            "`F`: m = F·M/J (ideal hard magnet); `R`: m = R·M (rigid sections)."));
  all.push_back(number_knob(&ModelOptions::mesh, &analytic::body::MeshOptions::tolerance, "mesh",
                            "tolerance", quantity::number, tolerance_range,
                            "Relative to the field."));
}

void append_potential(std::vector<Knob>& all) {
  using fem::potential::MagnetPushForward;
  using fem::potential::PotentialOptions;
  constexpr auto potential = &ModelOptions::potential;
  all.push_back(number_knob(potential, &PotentialOptions::relative_permeability, "potential",
                            "relative_permeability", quantity::number, key::permeability_range,
                            "Recoil permeability μ_r of the magnetised segments: about 1.05 for "
                            "NdFeB composites; 1 is what the dipole models assume."));
  all.push_back(choice_knob(
      potential, &PotentialOptions::push_forward, "potential", "push_forward",
      {{"F", MagnetPushForward::F}, {"R", MagnetPushForward::R}},
      "`F`: m = F·M/J (ideal hard magnet); `R`: m = R·M, of rods M d₃ (rigid sections)."));
  all.push_back(number_knob(potential, &PotentialOptions::tolerance, "potential", "tolerance",
                            quantity::number,
                            {1e-7, 0.1, false, "finer meshes exceed the memory of a machine"},
                            "Estimated error of B at each sensor, relative to |B|."));
  all.push_back(number_knob(potential, &PotentialOptions::max_unknowns, "potential", "max_unknowns",
                            quantity::number,
                            {1000, 20000000, false, "more exceed the memory of a machine"},
                            "Where the tolerance is not reached with these, it is an error."));
}

std::string row(std::string_view table, std::string_view name, std::string_view value,
                std::string_view range, std::string_view fallback, std::string_view doc) {
  return fmt::format("| `{}.{}` | {} | {} | {} | {} |\n", table, name, value, range,
                     fallback.empty() ? "required" : fallback, doc);
}

std::string row(const QuantityKey& k) {
  const std::string value = k.quantity.unit.empty()
                                ? std::string(k.quantity.name)
                                : fmt::format("{}, `\"{}\"`", k.quantity.name, k.quantity.example);
  return row(k.table, k.name, value, describe(k.range, k.quantity), k.fallback, k.doc);
}

std::string row(const Knob& knob) {
  const KnobValue fallback = knob.get(ModelOptions{});
  std::string value = "`true` or `false`";
  std::string range;
  if (!knob.choices.empty()) {
    value = fmt::format("`{}`", fmt::join(knob.choices, "` or `"));
  } else if (std::holds_alternative<std::string>(fallback)) {
    value = "file name";
  } else if (!std::holds_alternative<bool>(fallback)) {
    const bool whole = std::holds_alternative<unsigned int>(fallback);
    value = whole ? "whole number" : knob.quantity.name;
    if (std::holds_alternative<std::array<double, 2>>(fallback)) value = "two plain numbers";
    range = describe(knob.range, knob.quantity);
  }
  return row(fmt::format("models.{}", knob.model), knob.name, value, range,
             fmt::format("`{}`", to_toml(knob, fallback)), knob.doc);
}

}  // namespace

std::string describe(const Range& range, const Quantity& quantity) {
  const bool is_angle = quantity.unit == quantity::angle.unit;
  const std::string_view name = is_angle ? "deg" : quantity.unit;
  const double factor = is_angle ? 180 / std::numbers::pi : 1;
  const std::string unit = name.empty() ? "" : fmt::format(" {}", name);
  const std::string lower = fmt::format("{:g}{}", range.lower * factor, unit);
  const std::string upper = fmt::format("{:g}{}", range.upper * factor, unit);
  if (range.excludes_ends) return fmt::format("between {} and {}, both excluded", lower, upper);
  return fmt::format("from {} to {}", lower, upper);
}

const std::vector<Knob>& knobs() {
  static const std::vector<Knob> all = [] {
    std::vector<Knob> list;
    append_elastica(list);
    append_beam(list);
    append_calculix(list);
    append_solid(list);
    append_fields(list);
    append_potential(list);
    return list;
  }();
  return all;
}

bool belongs(const Knob& knob, const ModelOptions& options) {
  return !knob.belongs || knob.belongs(options);
}

std::span<const std::string_view> mechanics_ids() {
  return known_mechanics;
}

std::span<const std::string_view> field_ids() {
  return known_fields;
}

std::span<const LaterKey> later_keys() {
  return known_later;
}

std::string to_toml(const Knob& knob, const KnobValue& value) {
  return std::visit(
      [&knob](const auto& v) -> std::string {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, std::string>) return in_toml_quotes(v);
        if constexpr (std::is_same_v<T, bool>) return v ? "true" : "false";
        if constexpr (std::is_same_v<T, unsigned int>) return fmt::format("{}", v);
        if constexpr (std::is_same_v<T, std::array<double, 2>>)
          return fmt::format("[{}, {}]", format_number(v[0]), format_number(v[1]));
        if constexpr (std::is_same_v<T, double>)
          return knob.quantity.unit.empty()
                     ? format_number(v)
                     : fmt::format("\"{}\"", format_quantity(v, knob.quantity));
      },
      value);
}

std::string key_table() {
  std::string table =
      "| key | value | range | default | meaning |\n| --- | --- | --- | --- | --- |\n";
  for (const std::string_view part : {"case", "cilium", "cilium.segment", "load", "sensor"}) {
    for (const TextKey& k : text_keys)
      if (k.table == part) table += row(k.table, k.name, k.value, "", k.fallback, k.doc);
    for (const QuantityKey* k : quantity_keys())
      if (k->table == part) table += row(*k);
  }
  for (const TextKey& k : text_keys)
    if (k.table == "models") table += row(k.table, k.name, k.value, "", k.fallback, k.doc);
  for (const Knob& knob : knobs()) table += row(knob);
  for (const QuantityKey* k : quantity_keys())
    if (k->table == key::plate_table) table += row(*k);
  for (const TextKey& k : text_keys)
    if (k.table == key::external_table)
      table += row(k.table, k.name, k.value, "", k.fallback, k.doc);
  for (const QuantityKey* k : quantity_keys())
    if (k->table == key::external_table) table += row(*k);
  return table;
}

}  // namespace ciliaval::compare::input
