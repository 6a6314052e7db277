# SPDX-License-Identifier: LGPL-2.1-or-later
"""Claim that four textures are told apart after a high-pass filter (3.6, Fig. 6d)."""

from __future__ import annotations

import numpy as np

from ..arrays import Array
from ..sensing import record
from ..sensing.response import Pair
from .cases import Setting, run
from .claim import Claim, Unstated, in_range, scanned

_TEXTURES = ("foil-knit", "leather", "felt", "seersucker")
_PIECES = 6  # of each
_PAIR = Pair("elastica", "volume")
_ORDER = 4  # of the paper's filter
_RIGHT = 90.0  # % of a texture's pieces
_NOISE = 0.5  # uT, of the shipped cases


class Piece:
    """A piece of a texture: dB at the sensor over time, and what its logger and filter are."""

    def __init__(self, setting: Setting, texture: str, seed: int):
        case = setting.case(f"fig6-{texture}")
        tables = setting.tables(f"fig6-{texture}.toml")
        # Another profile, friction up to 20 % and interference up to 10 % off.
        off = np.random.default_rng([seed, _TEXTURES.index(texture)]).uniform(-1, 1, 2)
        friction = float(tables["surface"]["friction"])
        interference = case.loads[0].parameters["interference"]
        values = {
            "surface.friction": friction * (1 + 0.2 * off[0]),
            "load.interference": interference * (1 + 0.1 * off[1]),
        }
        if "seed" in tables["surface"]:  # a profile at random
            values["surface.seed"] = seed
        piece = case.changed(values)
        piece.mechanics, piece.fields = [_PAIR.mechanics], [_PAIR.field]
        result = run(piece, setting)
        travel, speed = result.load("travel"), result.load("speed")[0]
        self.time = np.concatenate([[0], np.cumsum(np.abs(np.diff(travel)))]) / speed
        self.rate = float(tables["signal"]["sampling_rate"].removesuffix(" Hz"))
        self.cutoff = float(tables["signal"]["cutoff"].removesuffix(" Hz"))
        self.seed = seed
        self.dB = result.dB(str(_PAIR))[:, 0]

    def features(self, noise: float) -> Array:
        """Features of the filtered record with this noise, T, for a classifier: the logarithms of its root mean square
        and of one plus the number of its changes of sign."""
        filtered = record(
            self.time, self.dB, self.rate, noise, self.cutoff, _ORDER, "zero_phase", self.seed
        ).filtered
        crossings = np.count_nonzero(np.diff(np.signbit(filtered[:, 0])))
        return np.log([np.sqrt(np.mean(np.sum(filtered**2, axis=1))), 1 + crossings])


def confusion(features: Array) -> Array:
    """Numbers of the pieces of each texture (row) that are found as each texture (column), by the nearest mean of the
    others, each feature over its scatter within a texture. features: (textures, pieces, n)."""
    textures, pieces, _ = features.shape
    found = np.zeros((textures, textures), dtype=int)
    for texture in range(textures):
        for piece in range(pieces):
            kept = np.ones((textures, pieces), dtype=bool)
            kept[texture, piece] = False
            means = np.array([features[t][kept[t]].mean(axis=0) for t in range(textures)])
            scatter = sum(((features[t][kept[t]] - means[t]) ** 2).sum(axis=0) for t in range(textures))
            distance = ((features[texture, piece] - means) ** 2 / scatter).sum(axis=1)
            found[texture, int(np.argmin(distance))] += 1
    return found


def told_apart(setting: Setting) -> Claim:
    claim = Claim("3.6, Fig. 6d", "four textures are told apart after a fourth-order high-pass filter")
    records = [[Piece(setting, t, seed) for seed in range(1, _PIECES + 1)] for t in _TEXTURES]

    def found(noise: float) -> Array:
        return confusion(np.array([[piece.features(noise) for piece in of] for of in records]))

    at_used = found(1e-6 * _NOISE)
    for i, texture in enumerate(_TEXTURES):
        right = 100 * at_used[i, i] / _PIECES
        claim.findings.append(in_range(f"{_PAIR}, {texture}", right, "%", _RIGHT, 100))
    noise = Unstated("noise", "uT", 0.1, 4, _NOISE, "not in the paper: an MLX90393 has 0.3 to 4 uT by its averaging", is_logarithmic=True)
    claim.scans = [
        scanned(noise, str(_PAIR), lambda x: 100 * float(np.diag(found(1e-6 * x)).min()) / _PIECES - _RIGHT)
    ]
    table = "; ".join(f"{t}: {', '.join(map(str, row))}" for t, row in zip(_TEXTURES, at_used))
    claim.note = (
        f"Of {_PIECES} pieces each (other profiles, friction 20 %, interference 10 % off), by the nearest mean of r.m.s. and "
        f"changes of sign of the filtered record, each piece left out in its turn. Found as {', '.join(_TEXTURES)}: {table}. The "
        "textures are assumed, not the paper's."
    )
    return claim
