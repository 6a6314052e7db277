// SPDX-License-Identifier: LGPL-2.1-or-later
// Every program that these tests start makes no page (without_page.sh).
#include <cstdlib>

namespace {

[[maybe_unused]] const int is_set = setenv("CILIAVAL_PYTHON", CILIAVAL_WITHOUT_PAGE, 1);

}  // namespace
