// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "problem/cilium.h"
#include "problem/description/field.h"

namespace ciliaval::description {

template <>
const Fields<Segment>& fields<Segment>();  ///< [[cilium.segment]]
template <>
const Fields<CrossSection>& fields<CrossSection>();  ///< [cilium.section]
template <>
const Fields<Cilium>& fields<Cilium>();  ///< those of [cilium] itself

}  // namespace ciliaval::description
