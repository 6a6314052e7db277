// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/support/words.h"

#include <algorithm>
#include <boost/locale/utf.hpp>
#include <cctype>
#include <vector>

namespace ciliaval::support {
namespace {

char lower(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

/// Optimal string alignment distance.
std::size_t distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) {
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        d[i][j] = i + j;
        continue;
      }
      const std::size_t replace = lower(a[i - 1]) == lower(b[j - 1]) ? 0 : 1;
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + replace});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
          lower(a[i - 2]) == lower(b[j - 1]))
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  }
  return d[a.size()][b.size()];
}

}  // namespace

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

bool equal_but_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
  constexpr std::size_t longest = 40;  // no key is as long
  constexpr std::size_t shortest_start = 3;
  if (word.empty() || word.size() > longest) return {};
  std::string_view best;
  std::size_t least = longest;
  for (const std::string_view candidate : candidates) {
    const std::size_t d = distance(word, candidate);
    if (d < least && d <= std::max<std::size_t>(1, candidate.size() / 3)) {
      least = d;
      best = candidate;
    }
  }
  if (!best.empty() || word.size() < shortest_start) return best;
  const auto starts = [word](std::string_view candidate) {
    return equal_but_case(word, candidate.substr(0, word.size()));
  };
  const auto found = std::find_if(candidates.begin(), candidates.end(), starts);
  return found == candidates.end() ? std::string_view() : *found;
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  const std::string_view best = nearest(word, candidates);
  return best.empty() ? std::string() : "; did you mean '" + std::string(best) + "'?";
}

std::string printable(std::string_view text, std::string_view allowed) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  std::string result;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    const char* next = at;
    const auto point = Utf8::decode(next, end);
    const bool is_text = boost::locale::utf::is_valid_codepoint(point);
    if (!is_text) next = at + 1;
    const bool is_control = point < 0x20 || (point >= 0x7F && point < 0xA0);
    if (is_text && (!is_control || allowed.find(*at) != std::string_view::npos)) {
      result.append(at, next);
    } else {
      constexpr std::string_view digits = "0123456789ABCDEF";
      for (; at != next; ++at) {
        const auto byte = static_cast<unsigned char>(*at);
        result += {'\\', 'x', digits[byte / 16], digits[byte % 16]};
      }
    }
    at = next;
  }
  return result;
}

}  // namespace ciliaval::support
