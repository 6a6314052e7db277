// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/checkpoint_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <boost/crc.hpp>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <vector>

#include "problem/error.h"

namespace ciliaval::fem {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view magic = "ciliaval-checkpoint";
constexpr int format = 1;

std::string first_line(std::string_view rest) {
  char text[64];
  std::snprintf(text, sizeof text, " %d %08x %zu\n", format,
                static_cast<unsigned int>(checksum(rest)), rest.size());
  return std::string(magic) + text;
}

/// An open file, closed at the end of its scope.
struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor() {
    if (number >= 0) close(number);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

[[noreturn]] void fail_to_write(const fs::path& path) {
  throw CheckpointError("cannot write the checkpoint `" + path.string() +
                        "`: " + std::strerror(errno) +
                        "; make room for it, or choose another folder with -o DIR");
}

void write_all(int file, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_to_write(path);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// All bytes of a regular file; none if nothing is there.
std::optional<std::string> read_bytes(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return std::nullopt;
  if (!fs::status_known(status)) throw CheckpointError(refusal(path, error.message()));
  if (!fs::is_regular_file(status))
    throw CheckpointError(refusal(path, fs::is_directory(status) ? "it is a folder, not a file"
                                                                 : "it is not a regular file"));
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad())
    throw CheckpointError(refusal(path, std::string("it cannot be read: ") + std::strerror(errno)));
  return bytes;
}

/// The words of a line that ends at the first line break; empty without one.
std::vector<std::string_view> words_of_line(std::string_view text) {
  std::vector<std::string_view> words;
  const std::size_t end = text.substr(0, 200).find('\n');
  if (end == std::string_view::npos) return words;
  text = text.substr(0, end);
  while (true) {
    const std::size_t space = text.find(' ');
    words.push_back(text.substr(0, space));
    if (space == std::string_view::npos) return words;
    text.remove_prefix(space + 1);
  }
}

std::optional<std::size_t> number(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// What is wrong with the bytes of a checkpoint; empty if nothing is.
std::string fault(std::string_view bytes) {
  if (bytes.empty()) return "it is empty";
  const std::vector<std::string_view> words = words_of_line(bytes);
  if (words.size() != 4 || words[0] != magic)
    return "it is not a checkpoint, or its start is damaged";
  if (words[1] != std::to_string(format))
    return "its format is " + std::string(words[1]) + ", but this program reads format " +
           std::to_string(format);
  const std::string_view rest = bytes.substr(bytes.find('\n') + 1);
  const std::optional<std::size_t> size = number(words[3]);
  if (size && rest.size() < *size)
    return "it is cut short: " + std::to_string(rest.size()) + " bytes are left of " +
           std::to_string(*size);
  if (size != rest.size() || bytes.substr(0, bytes.size() - rest.size()) != first_line(rest))
    return "it is damaged: its checksum is wrong";
  return {};
}

}  // namespace

std::uint32_t checksum(std::string_view bytes) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

std::string refusal(const fs::path& path, std::string_view reason) {
  return "the checkpoint `" + path.string() + "` cannot be used: " + std::string(reason) +
         "; nothing was read from it. Start anew with --fresh, which deletes it";
}

void write_checkpoint_file(const fs::path& path, std::string_view program,
                           std::string_view content) {
  std::string rest(program);
  rest += '\n';
  rest += content;
  fs::path temporary = path;
  temporary += ".tmp";
  {
    const Descriptor file(open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (file.number < 0) fail_to_write(path);
    write_all(file.number, first_line(rest), path);
    write_all(file.number, rest, path);
    if (fsync(file.number) != 0) fail_to_write(path);
  }
  if (std::rename(temporary.c_str(), path.c_str()) != 0) fail_to_write(path);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const Descriptor directory(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (directory.number < 0 || (fsync(directory.number) != 0 && errno != EINVAL))
    fail_to_write(path);
}

std::optional<std::string> read_checkpoint_file(const fs::path& path, std::string_view program) {
  const std::optional<std::string> bytes = read_bytes(path);
  if (!bytes) return std::nullopt;
  const std::string wrong = fault(*bytes);
  if (!wrong.empty()) throw CheckpointError(refusal(path, wrong));
  const std::size_t start = bytes->find('\n') + 1;
  const std::size_t end = bytes->find('\n', start);
  const std::string author = bytes->substr(start, end - start);
  if (author != program)
    throw CheckpointError(
        refusal(path, "it was written by " + author + ", and this is " + std::string(program)));
  return bytes->substr(end + 1);
}

}  // namespace ciliaval::fem
