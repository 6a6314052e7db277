# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages of results (docs/guide/meshes.md): report.write("results") writes results/report.html.

`python3 -m ciliaval.report DIR` does the same; so does `ciliaval report DIR`, which starts it.
"""

from __future__ import annotations

from pathlib import Path


def write(folder: str | Path = "results", file: str | Path | None = None) -> list[str]:
    """One page of all results in a folder, to `file` (folder/report.html): self-contained HTML.

    Returns a line for each file that could not be shown. Raises FileError if there is no result.
    """
    from . import page

    folder = Path(folder)
    made = page.results_page(folder, "the Python package ciliaval")
    page.write(Path(file) if file else folder / "report.html", made)
    return made.damaged
