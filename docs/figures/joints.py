#!/usr/bin/env python3
"""Draws docs/figures/joints.svg, random cilia by rods and solid (Debian: python3-matplotlib):

    build/release/tests/coverage/corrected_rods 100 0 > designs.csv
    python3 docs/figures/joints.py designs.csv docs/figures/joints.svg
"""
# SPDX-License-Identifier: LGPL-2.1-or-later

import csv
import sys

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "ciliaval"
import matplotlib.pyplot as plt  # noqa: E402


def main(table: str, picture: str) -> None:
    with open(table, newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["tip"]]
    figure, axes = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True, layout="constrained")
    for ax, quantity, title in zip(axes, ("tip", "dB"), ("tip", "ΔB at the sensor")):
        for model, colour, marker in (("beam", "0.6", "x"), ("corrected beam", "#1f5fa8", "o")):
            own = [row for row in rows if row["model"] == model]
            ax.plot(
                [float(row["L1/d"]) for row in own],
                [100 * float(row[quantity]) for row in own],
                marker, color=colour, markersize=4, label=model, linestyle="none",
            )
        ax.axhline(1, color="0.8", linewidth=0.8, zorder=0)
        ax.set(xscale="log", yscale="log", xlabel="L₁/d", title=title)
        ax.set_xticks([0.5, 1, 2, 4, 8], ["0.5", "1", "2", "4", "8"])
        ax.minorticks_off()
    axes[0].set_ylabel("difference from the solid, %")
    axes[0].legend(frameon=False)
    figure.savefig(picture, metadata={"Date": None})


if __name__ == "__main__":
    main(*sys.argv[1:])
