// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ciliaval::support {

/// The text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// True if two words are the same but for the case of ASCII letters.
bool equal_but_case(std::string_view a, std::string_view b);

/// The candidate that is nearest to the word, by insertions, deletions, replacements and swaps of
/// neighbours (optimal string alignment, case ignored), if it differs in one letter or no more than
/// a third of them; if none is near, the first one that the word, of three letters or more, is the
/// start of ("poisson", "poisson_ratio"); otherwise empty.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'x'?" for the nearest candidate; empty if none is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// The text for a terminal or a table: control characters but those of `allowed`, which a terminal
/// would obey, and bytes that are no UTF-8 as `\\x1B`.
std::string printable(std::string_view text, std::string_view allowed = "\n\t");

}  // namespace ciliaval::support
