// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/solid/checkpoint.h"

#include <cstdio>
#include <fstream>
#include <iterator>

#include "fem/checkpoint_file.h"
#include "fem/parallel.h"
#include "fem/solid/archive.h"
#include "problem/error.h"

namespace ciliaval::fem::solid {
using namespace discretisation;
using namespace equilibrium;
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string describe(const Load& load) {
  std::string text = std::string(type(load)) + ", " + number(magnitude(load)) + " " +
                     std::string(magnitude_unit(load));
  if (const auto height = contact_height(load)) text += ", height " + number(*height) + " m";
  if (const auto section = load.as<SectionLoad>())
    text += ", arclength " + number(section->arclength) + " m";
  return text + ", azimuth " + number(azimuth(load)) + " rad";
}

std::string describe(const meshes::cylinder::CylinderMeshOptions& mesh) {
  std::string text = std::to_string(mesh.square_cells) + " cells and " +
                     std::to_string(mesh.rings) + " rings with ratio " + number(mesh.ring_ratio) +
                     ", layers from " + number(mesh.finest_layer) + " to " +
                     number(mesh.coarsest_layer) + " growing by " + number(mesh.growth);
  for (const double plane : mesh.planes) text += ", a plane at " + number(plane) + " m";
  return text + (mesh.half ? ", half" : ", whole");
}

/// What is in a file. That it cannot be read is for others to say.
std::string describe_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  char text[64];
  std::snprintf(text, sizeof text, "a file of %zu bytes with the checksum %08x", bytes.size(),
                static_cast<unsigned int>(checksum(bytes)));
  return text;
}

/// Reads the first of the values that were serialised together. `path` is for the message.
void deserialize_file(const std::filesystem::path& path, const std::string& bytes,
                      auto&... values) {
  try {
    deserialize(bytes, values...);
  } catch (const std::exception& error) {
    throw CheckpointError(
        refusal(path, std::string("its content cannot be read: ") + error.what()));
  }
}

}  // namespace

Facts solid_facts(const Cilium& cilium, const LoadPath& path, const SolidOptions& options,
                  std::span<const meshes::cylinder::CylinderMeshOptions> meshes) {
  Facts facts{{"diameter", number(cilium.diameter) + " m"},
              {"number of segments", std::to_string(cilium.segments.size())}};
  for (const auto& [name, length, young_modulus, poisson_ratio, magnetization] : cilium.segments) {
    const std::string of = " of segment `" + name + "`";
    facts.emplace_back("length" + of, number(length) + " m");
    facts.emplace_back("young_modulus" + of, number(young_modulus) + " Pa");
    facts.emplace_back("poisson_ratio" + of, number(poisson_ratio));
    facts.emplace_back("magnetization" + of, number(magnetization) + " A/m");
  }
  facts.emplace_back("number of load steps", std::to_string(path.size()));
  for (std::size_t i = 0; i < path.size(); ++i)
    facts.emplace_back("load of step " + std::to_string(i + 1), describe(path[i]));
  const auto& [material, mooney_ratio, yeoh_ratios, refinement, initial_guess, symmetry, mesh,
               mesh_unit, kernel_width, tolerance, max_iterations, max_cutbacks, solver] = options;
  static_cast<void>(max_iterations);
  static_cast<void>(max_cutbacks);
  const auto option = [&facts](const std::string& name, const std::string& value) {
    facts.emplace_back("models.solid." + name, value);
  };
  option("material", std::to_string(static_cast<int>(material)));
  option("mooney_ratio", number(mooney_ratio));
  option("yeoh_ratios", number(yeoh_ratios[0]) + ", " + number(yeoh_ratios[1]));
  option("mesh", mesh.empty() ? "none" : describe_file(mesh));
  option("mesh_unit", number(mesh_unit) + " m");
  option("refinement", std::to_string(refinement));
  option("initial_guess", initial_guess == InitialGuess::beam ? "beam" : "none");
  option("symmetry", symmetry ? "true" : "false");
  option("kernel_width", number(kernel_width) + " m");
  option("tolerance", number(tolerance));
  option("solver", std::to_string(static_cast<int>(solver)));
  for (std::size_t i = 0; i < meshes.size(); ++i)
    facts.emplace_back("built-in mesh " + std::to_string(i + 1), describe(meshes[i]));
  return facts;
}

std::string difference(const Facts& saved, const Facts& asked) {
  std::string text;
  int found = 0;
  const auto value_in = [](const Facts& facts, const std::string& name) -> const std::string* {
    for (const auto& [key, value] : facts)
      if (key == name) return &value;
    return nullptr;
  };
  const auto say = [&](const std::string& name, const std::string* there, const std::string* now) {
    if (++found > 3) return;
    text += (text.empty() ? "" : "; ") + name + " was " +
            (there != nullptr ? *there : "not given") + ", now it is " +
            (now != nullptr ? *now : "not given");
  };
  for (const auto& [name, value] : asked) {
    const std::string* there = value_in(saved, name);
    if (there == nullptr || *there != value) say(name, there, &value);
  }
  for (const auto& [name, value] : saved)
    if (value_in(asked, name) == nullptr) say(name, &value, nullptr);
  return found > 3 ? text + "; and " + std::to_string(found - 3) + " more" : text;
}

SolidCheckpoint::SolidCheckpoint(Checkpoint files, Facts facts, MPI_Comm communicator)
    : files_(std::move(files)), facts_(std::move(facts)), communicator_(communicator) {}

std::filesystem::path SolidCheckpoint::step_file(std::size_t step) const {
  char text[32];
  std::snprintf(text, sizeof text, ".%04zu", step);
  std::filesystem::path path = files_.path;
  path += text;
  return path;
}

std::string SolidCheckpoint::verified_content() const {
  const std::optional<std::string> content = read_checkpoint_file(files_.path, files_.program);
  if (!content) return {};
  Facts facts;
  std::vector<MechanicsStep> steps;
  std::vector<std::uint32_t> checksums;
  deserialize_file(files_.path, *content, facts);
  const std::string other = difference(facts, facts_);
  if (!other.empty())
    throw CheckpointError(refusal(files_.path, "it is that of another problem: " + other));
  deserialize_file(files_.path, *content, facts, steps, checksums);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].status != Status::converged) continue;
    const auto state = read_checkpoint_file(step_file(i), files_.program);
    if (!state) throw CheckpointError(refusal(step_file(i), "the file is missing"));
    if (checksum(*state) != checksums.at(i))
      throw CheckpointError(refusal(step_file(i), "it belongs to another run"));
  }
  return *content;
}

std::size_t SolidCheckpoint::verify() const {
  if (files_.path.empty()) return 0;
  const std::string content = verified_content();
  if (content.empty()) return 0;
  Facts facts;
  std::vector<MechanicsStep> steps;
  deserialize_file(files_.path, content, facts, steps);
  return steps.size();
}

std::vector<std::optional<LoadPathState>> SolidCheckpoint::read() {
  std::vector<std::optional<LoadPathState>> levels;
  if (files_.path.empty()) return levels;
  const std::string content = from_first_rank(communicator_, [this] { return verified_content(); });
  if (content.empty()) return levels;
  Facts facts;
  deserialize_file(files_.path, content, facts, steps_, checksums_, levels);
  saved_ = true;
  return levels;
}

SolidState SolidCheckpoint::finished_state(std::size_t step) const {
  const std::string content = from_first_rank(communicator_, [&] {
    return read_checkpoint_file(step_file(step), files_.program).value_or("");
  });
  if (checksum(content) != checksums_.at(step))
    throw CheckpointError(refusal(step_file(step), "it was changed while it was read"));
  SolidState state;
  deserialize_file(step_file(step), content, state);
  return state;
}

void SolidCheckpoint::add(const MechanicsStep& step, const SolidState* state) {
  if (files_.path.empty()) return;
  const std::string content = state != nullptr ? serialized(*state) : "";
  if (state != nullptr)
    from_first_rank(communicator_, [&] {
      write_checkpoint_file(step_file(steps_.size()), files_.program, content);
      return std::string();
    });
  checksums_.push_back(state != nullptr ? checksum(content) : 0);
  steps_.push_back(step);
  steps_.back().deformation.reset();
}

void SolidCheckpoint::save(std::span<const LoadPathState* const> levels) {
  if (files_.path.empty()) return;
  from_first_rank(communicator_, [&] {
    std::vector<std::optional<LoadPathState>> states;
    for (const LoadPathState* level : levels)
      states.push_back(level != nullptr ? std::optional(*level) : std::nullopt);
    write_checkpoint_file(files_.path, files_.program,
                          serialized(facts_, steps_, checksums_, states));
    return std::string();
  });
  saved_ = true;
}

std::optional<std::filesystem::path> SolidCheckpoint::file() const {
  return saved_ ? std::optional(files_.path) : std::nullopt;
}

}  // namespace ciliaval::fem::solid
