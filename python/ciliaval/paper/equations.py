# SPDX-License-Identifier: LGPL-2.1-or-later
"""Eq. 6 and 8 of the paper as they are printed, and as Eq. 5 means them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.constants import mu_0

from .._core import Shape
from ..arrays import Array

_ANGLES = 24
_PIECES = 32  # of the magnet, each with Gauss points along it


@dataclass(frozen=True)
class PrintedFields:
    """The integrals of Eq. 6 (a line of dipoles) and Eq. 8 (over the volume), each (3,), T: as they
    are meant, Eq. 5 with dS = dz/cos(theta), and to the letter. To the letter Eq. 6 has 1/cos(theta)
    once in x and twice in y and z, Eq. 8 twice in all: one is that of dS, the other too many."""

    line: Array
    line_printed: Array
    volume: Array
    volume_printed: Array


def printed_fields(shape: Shape, point: Array) -> PrintedFields:
    """Both integrals for a round rod at a point outside of it, by Gauss-Legendre quadrature along
    the axis and the radius and equal angles around it. point: (3,), m."""
    radius = shape.cilium.diameter / 2
    azimuth = shape.load.parameters.get("azimuth", 0.0)
    across = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    side = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    nodes, weights = np.polynomial.legendre.leggauss(15)  # type: ignore[no-untyped-call]

    S, dS, moment = [], [], []  # of the slices
    begin = 0.0
    for segment in shape.cilium.segments:
        end = begin + segment.length
        edges = np.linspace(begin, end, _PIECES + 1)
        if segment.magnetization:
            for a, b in zip(edges, edges[1:]):
                S.append(a + (b - a) * (1 + nodes) / 2)
                dS.append((b - a) * weights / 2)
                moment.append(np.full(len(nodes), float(segment.magnetization)))
        begin = end
    S, dS, M = (np.concatenate(parts) for parts in (S, dS, moment))
    theta = np.interp(S, shape.S, shape.theta)
    axis = np.array([np.interp(S, shape.S, column) for column in shape.centreline.T]).T
    normal = np.sin(theta)[:, None] * across + np.cos(theta)[:, None] * up
    in_plane = np.cos(theta)[:, None] * across - np.sin(theta)[:, None] * up
    cosine = np.cos(theta)

    slices = _dipole(np.pi * radius**2 * (M * dS)[:, None] * normal, point - axis)
    line = slices.sum(axis=0)
    x_once = np.stack([slices[:, 0], slices[:, 1] / cosine, slices[:, 2] / cosine], axis=1)
    volume = np.zeros(3)
    volume_printed = np.zeros(3)
    for r, dr in zip(radius * (1 + nodes) / 2, radius * weights / 2):
        for phi in 2 * np.pi * np.arange(_ANGLES) / _ANGLES:
            place = axis + r * (np.cos(phi) * in_plane + np.sin(phi) * side)
            part = 2 * np.pi / _ANGLES * r * dr * (M * dS)[:, None] * normal
            B = _dipole(part, point - place)
            volume += B.sum(axis=0)
            volume_printed += (B / cosine[:, None]).sum(axis=0)
    return PrintedFields(line, x_once.sum(axis=0), volume, volume_printed)


def _dipole(moment: Array, a: Array) -> Array:
    """Eq. 5: B of moments (n, 3), A m², at the distances a (n, 3), m; T."""
    distance = np.linalg.norm(a, axis=1)[:, None]
    along = (moment * a).sum(axis=1)[:, None]
    return np.asarray(mu_0 / (4 * np.pi) * (3 * along * a / distance**5 - moment / distance**3))
