// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/case.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "compare/case_sections.h"
#include "compare/case_syntax.h"
#include "problem/error.h"

namespace ciliaval::compare {
namespace {

constexpr std::uintmax_t largest_file = 1'000'000;  ///< bytes

/// The text of a regular file. Throws InputError.
std::string read_file(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status))
    throw InputError(fmt::format("{}: the case file does not exist", name));
  if (std::filesystem::is_directory(status))
    throw InputError(fmt::format("{}: is a folder, not a case file", name));
  if (!std::filesystem::is_regular_file(status))
    throw InputError(fmt::format("{}: is not a regular file", name));
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error && size > largest_file)
    throw InputError(fmt::format("{}: {} bytes are too large for a case file (at most {})", name,
                                 size, largest_file));
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad())
    throw InputError(
        fmt::format("{}: the case file cannot be read: {}", name, std::strerror(errno)));
  return text;
}

}  // namespace

Case read_case(std::string_view text, std::string_view file) {
  const toml::table table = parse_toml(text, file);
  Faults faults;
  Section root(&table, "the case file", "", {}, faults);
  Case c;
  read_header(root, c);
  const bool cilium = read_cilium(root, c);
  const bool load = read_load(root, c);
  read_sensor(root, c);
  const bool models = read_models(root, c);
  if (!c.options.solid.mesh.empty())  // beside the case file
    c.options.solid.mesh =
        std::filesystem::absolute(std::filesystem::path(file).parent_path() / c.options.solid.mesh)
            .lexically_normal();
  root.finish();
  if (cilium) snap_to_interfaces(c.cilium, c.load_path);
  check_together(table, c, {cilium, load, models}, faults);
  if (!faults.empty()) throw InputError(faults.report(file));

  // What the models themselves demand; a case that comes so far has it.
  require_valid(c.cilium);
  for (const Load& step : c.load_path) require_valid(step, c.cilium);
  return c;
}

Case read_case(const std::filesystem::path& file) {
  return read_case(read_file(file), file.string());
}

}  // namespace ciliaval::compare
