#!/usr/bin/env python3
"""Draws docs/figures/fig6-ratio.svg, |dB| over the surface of Fig. 6 for other moduli of the magnet:

    PYTHONPATH=build/release/python python3 docs/figures/ratio.py docs/figures/fig6-ratio.svg
"""
# SPDX-License-Identifier: LGPL-2.1-or-later

import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "ciliaval"
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import ciliaval as cv  # noqa: E402


def main(picture: str) -> None:
    case = cv.Case(Path(__file__).parents[2] / "cases/paper/fig6-surface.toml")
    case.mechanics, case.fields = ["elastica"], ["volume"]
    figure, ax = plt.subplots(figsize=(7, 3.6), layout="constrained")
    for ratio, colour in zip((1, 2, 5, 30), ("#c1272d", "#e07b39", "#7a7a7a", "#1f5fa8")):
        E_1 = case.cilium.segments[0].young_modulus
        result = case.changed({"cilium.segment.magnet.young_modulus": ratio * E_1}).run()
        change = np.linalg.norm(result.dB("elastica/volume")[:, 0], axis=1)
        ax.plot(1e3 * result.load("travel"), 1e6 * change, color=colour, label=f"E₂/E₁ = {ratio}")
    ax.set(xlabel="travel, mm", ylabel="|ΔB|, µT", xlim=(0, 52), ylim=(0, None))
    ax.legend(frameon=False, ncols=4, loc="lower center", bbox_to_anchor=(0.5, 1))
    figure.savefig(picture, metadata={"Date": None})
    if len(sys.argv) > 2:
        figure.savefig(sys.argv[2], dpi=90)


if __name__ == "__main__":
    main(sys.argv[1])
