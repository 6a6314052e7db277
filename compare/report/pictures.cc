// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/report/pictures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <optional>

#include "compare/report/html.h"

namespace ciliaval::compare::report {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t most_bytes = 4u << 20;
constexpr std::uintmax_t most_bytes_together = 24u << 20;

std::vector<fs::path> png_files(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::path& place : {folder, folder / "pictures"}) {
    if (!fs::is_directory(place)) continue;
    std::vector<fs::path> here;
    for (const fs::directory_entry& entry : fs::directory_iterator(place))
      if (entry.is_regular_file() && entry.path().extension() == ".png")
        here.push_back(entry.path());
    std::sort(here.begin(), here.end());
    files.insert(files.end(), here.begin(), here.end());
  }
  return files;
}

/// Width and height from the header (PNG specification, 11.2.2: IHDR comes first); none if it is
/// no PNG or ends before its last chunk.
std::optional<plot::Size> size_of(const std::string& png) {
  using namespace std::string_view_literals;
  constexpr std::string_view signature = "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"sv;
  constexpr std::string_view end = "IEND\xae\x42\x60\x82"sv;
  if (!png.starts_with(signature) || !png.ends_with(end) || png.size() < 33) return std::nullopt;
  const auto number_at = [&](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value * 256 + static_cast<unsigned char>(png[i]) % 256;
    return value;
  };
  const plot::Size size{number_at(16), number_at(20)};
  constexpr int most_pixels = 20000;
  if (size.width < 1 || size.height < 1 || size.width > most_pixels || size.height > most_pixels)
    return std::nullopt;
  return size;
}

}  // namespace

std::string pictures_content(const fs::path& folder, Figures& figures,
                             std::vector<std::string>& damaged) {
  std::string text;
  std::uintmax_t together = 0;
  for (const fs::path& file : png_files(folder)) {
    const std::string name = file.lexically_relative(folder).string();
    const std::uintmax_t bytes = fs::file_size(file);
    if (bytes > most_bytes || together + bytes > most_bytes_together) {
      text += paragraph(fmt::format("{}: {:.1f} MB, too large to stand in this page", name,
                                    static_cast<double>(bytes) / (1u << 20)));
      continue;
    }
    std::ifstream stream(file, std::ios::binary);
    const std::string png{std::istreambuf_iterator<char>(stream), {}};
    const std::optional<plot::Size> size = size_of(png);
    if (!size) {
      damaged.push_back(fmt::format("{}: it is no PNG picture, or not all of one", file.string()));
      continue;
    }
    together += bytes;
    text += figures.picture(png, *size, name);
  }
  return text;
}

}  // namespace ciliaval::compare::report
