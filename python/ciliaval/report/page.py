# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pages from files of results: each number on them stands in a file."""

from __future__ import annotations

import base64
import hashlib
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any, Union

from jinja2 import Environment, PackageLoader

from ..errors import FileError
from ..files import DAMAGE, content, replacing, text_of
from ..results import Document, Result, read
from ..units import in_words, number
from . import evidence, view3d
from .blocks import (
    Block, Cell, Details, Image, Images, Items, Section, Table, Text, View, faults,
)  # fmt: skip
from .case import case_blocks, case_row

_LARGEST_PICTURE = 4 << 20
_MOST_PICTURES = 24 << 20

Found = Union[Result, Document]

# Kind of a file -> the order on the page, the part's title, what makes its blocks.
_PARTS: dict[str, tuple[str, Callable[[Any], list[Block]]]] = {
    "case": ("Case {}", case_blocks),
    "study": ("Study {}", evidence.study_blocks),
    "budget": ("Error budget of {}", evidence.budget_blocks),
    "converge": ("Convergence of {}", evidence.convergence_blocks),
    "bench": ("Simulated test bench", evidence.bench_blocks),
    "readings": ("Loads from readings, case {}", evidence.readings_blocks),
    "surface": ("A surface from readings, case {}", evidence.surface_blocks),
    "calibrate": ("Calibration of {}", evidence.calibration_blocks),
    "claims": ("The paper's claims", evidence.claims_blocks),
    "check": ("Regression check", evidence.check_blocks),
}


@dataclass
class Page:
    """A page as HTML, and what of the folder it could not show."""

    html: str
    damaged: list[str]


def case_page(folder: Path) -> Page:
    """The page of the case whose results are in this folder. Raises FileError."""
    result = read(folder / "summary.json")
    if not isinstance(result, Result):
        raise FileError(f"{folder / 'summary.json'}: is not the summary of a case")
    file = folder / "summary.json"
    section = Section("case", _title(result), [*_blocks(result, file)])
    damaged = _lost(file, section)
    section.blocks.append(_origins([(file, result)], folder))
    footer = "Made by `ciliaval run` from summary.json and the files beside it."
    return Page(_html(f"CiliaVal: {result.name}", "", [section], footer), damaged)


@dataclass
class Frame:
    """A page that a notebook shows in a frame of its own."""

    html: str

    def _repr_html_(self) -> str:
        return f'<iframe srcdoc="{escape(self.html)}" style="width: 100%; height: 46rem; border: 0"></iframe>'


def view_frame(result: Result) -> Frame:
    """The interactive view alone. Raises FileError if there can be none."""
    view = view3d.view(result)
    if view is None:
        raise FileError(f"{result.name}: a view needs a model that has a shape, the case and Debian's libjs-three")
    return Frame(_html(view.title, "", [Section("view", result.title, [view])], ""))


def results_page(folder: Path, made_by: str) -> Page:
    """One page of all results in a folder and the folders in it. A file that cannot be shown is
    named on the page and in `damaged`. Raises FileError if there is nothing."""
    found: list[tuple[Path, Found]] = []
    damaged: list[str] = []
    for file in _json_files(folder):
        try:
            found.append((file, read(file)))
        except FileError as error:
            damaged.append(str(error))
    order = list(_PARTS)
    found.sort(key=lambda entry: order.index(_kind(entry[1])))
    sections, shown = [], []
    rows: list[Sequence[str | Cell]] = []
    for n, (file, data) in enumerate(found):
        name = re.sub(r"[^a-z0-9]+", "-", str(file.relative_to(folder)).lower())
        try:
            section = Section(f"part-{n}-{name}", _title(data), _blocks(data, file))
            if isinstance(data, Result):
                steps, models, *values = case_row(data)
                rows.append([Cell(data.name, link=section.id), steps, Cell(models, "text"), *values])
        except FileError as error:
            damaged.append(str(error))
            continue
        except Exception as error:  # one result must not cost the others their place
            damaged.append(f"{file}: cannot be shown: {text_of(error)}")
            continue
        sections.append(section)
        shown.append((file, data))
        damaged += _lost(file, section)
    pictures = _pictures(folder, damaged)
    if not shown and not pictures and not damaged:
        raise FileError(
            f"there are no results in `{folder}`: `ciliaval run CASE.toml -o {folder}` makes some"
        )
    first = [_overview(rows)] if rows else []
    if damaged:
        first.append(Section("damaged", "Files that could not be shown", [Items(list(damaged))]))
    if pictures:
        sections.append(Section("pictures", "Pictures", [Images(pictures)]))
    absent = list(_missing(shown, bool(pictures), folder))
    if absent:
        sections.append(Section("missing", "What is not here, and how to make it", [Items(absent)]))
    sections.append(Section("provenance", "Provenance", [_origins(shown, folder)]))
    lead = "Models of a magnetic-cilium tactile sensor beside each other, and what separates them. "
    lead += "Each number is read from a result file named under Provenance."
    html = _html("CiliaVal: report of results", lead, [*first, *sections], f"Page made by {made_by}")
    return Page(html, damaged)


def _kind(data: Found) -> str:
    if isinstance(data, Result):
        return "case"
    if data.kind != "sense":
        return data.kind
    kinds = {"by_magnitude": "bench", "levels": "surface", "samples": "readings"}
    return next(kind for key, kind in kinds.items() if key in data)


def _name(data: Found) -> str:
    if isinstance(data, Result):
        return data.name
    return str(data.get("study") or data.get("case") or "")


def _title(data: Found) -> str:
    title = data.title if isinstance(data, Result) else str(data.get("title") or "")
    head = _PARTS[_kind(data)][0].format(_name(data))
    return f"{head}: {title}" if title else head


def _blocks(data: Found, file: Path) -> list[Block]:
    """Raises FileError if the file is damaged."""
    try:
        return _PARTS[_kind(data)][1](data)
    except DAMAGE as error:
        raise FileError(f"{file}: is damaged: {error!r}") from error


def _lost(file: Path, section: Section) -> list[str]:
    """A line on what of a file could not be shown; none if all was."""
    lost = list(faults(section.blocks))
    more = f" (and {len(lost) - 1} more of its parts)" if len(lost) > 1 else ""
    return [f"{file}: {lost[0]}{more}"] if lost else []


def _json_files(folder: Path) -> Iterator[Path]:
    """JSON files of the folder and of the folders in it, sorted; hidden ones are unfinished."""
    for path in sorted([*folder.glob("*.json"), *folder.glob("*/*.json")]):
        if not any(p.startswith(".") for p in path.relative_to(folder).parts):
            yield path


def _overview(rows: list[Sequence[str | Cell]]) -> Section:
    head = ["case", "load steps", "bending", "tip moves aside", "|ΔB| at the first sensor"]
    text = "The cases; tip and |ΔB| at the last step by the model that leaves out least"
    return Section("overview", "What was run", [Table(text, head, rows)])


def _missing(shown: list[tuple[Path, Found]], pictures: bool, folder: Path) -> Iterator[str]:
    """Parts that the page would show too, with the command; the paper's studies only beside the paper's other
    results."""
    kinds = {_kind(data) for _, data in shown}
    names = {(_kind(data), _name(data)) for _, data in shown}
    commands = {
        "case": ("case", "run CASE.toml -o {}"),
        "budget": ("error budget", "budget CASE.toml --json {}/NAME.budget.json"),
        "converge": ("convergence study", "converge CASE.toml --json {}/NAME.converge.json"),
    }
    for kind, (what, command) in commands.items():
        if kind not in kinds:
            yield f"No {what}: ciliaval {command.format(folder)}"
    if "claims" in kinds or any(name.startswith("fig4") for _, name in names):
        for name in ("fig4a-e1", "fig4a-e2", "fig4b", "fig4c"):
            if ("study", name) not in names:
                yield f"No study {name}: ciliaval study cases/paper/{name}.study.toml -o {folder}"
        if "claims" not in kinds:
            yield f"No ledger of the paper's claims: ciliaval claims --json {folder}/claims.json"
    if not pictures:
        yield f"No pictures: pvpython {folder}/CASE/vtk/open.py {folder}/pictures/NAME.png"


def _pictures(folder: Path, damaged: list[str]) -> list[Image]:
    """The PNG files of the folder and of pictures/ in it; one that is too large is named."""
    pictures, total = [], 0
    for file in sorted([*folder.glob("*.png"), *folder.glob("pictures/*.png")]):
        try:
            data = content(file)
        except FileError as error:
            damaged.append(str(error))
            continue
        if data[:8] != b"\x89PNG\r\n\x1a\n" or len(data) < 33:
            damaged.append(f"{file}: is no PNG picture")
            continue
        if len(data) > _LARGEST_PICTURE or total + len(data) > _MOST_PICTURES:
            damaged.append(f"{file}: is left out, it would make the page too large")
            continue
        total += len(data)
        width, height = (int.from_bytes(data[i : i + 4], "big") for i in (16, 20))
        scale = min(1.0, 900 / max(width, 1))
        source = f"data:image/png;base64,{base64.b64encode(data).decode()}"
        size = round(scale * width), round(scale * height)
        pictures.append(Image(file.stem, f"The picture is that of {file.name}.", source, *size))
    return pictures


def _origins(shown: list[tuple[Path, Found]], folder: Path) -> Block:
    """Table of the program that made each file; remarks on files from different states of it."""
    table = Table(
        "Which program made which file, when and how", ["file", "version", "git", "date", "command"]
    )
    states, libraries = set(), set()
    for file, data in shown:
        origin = (data.provenance if isinstance(data, Result) else data.get("provenance")) or {}
        row: list[str | Cell] = [str(file.relative_to(folder))]
        for key in ("version", "git", "date", "command"):
            kind = "text" if key == "command" else "word"
            row.append(Cell(str(origin.get(key) or "not stated"), kind))
        table.rows.append(row)
        if origin.get("git"):
            states.add(str(origin["git"]))
        if isinstance(origin.get("libraries"), dict):
            libraries.add(in_words(f"{name} {v}" for name, v in origin["libraries"].items()))
    blocks: list[Block] = [table, *(Text(f"Libraries: {line}.") for line in sorted(libraries))]
    if len(states) > 1:
        text = f"The files come from {len(states)} different states of the program: their numbers need not belong together."
        blocks.insert(0, Text(text, "bad"))
    return Details("Where the numbers come from", blocks)


def _has_view(blocks: list[Block]) -> bool:
    return any(isinstance(b, View) for b in blocks)


def _html(title: str, lead: str, sections: list[Section], footer: str) -> str:
    scripts = view3d.scripts() if any(_has_view(s.blocks) for s in sections) else []
    # "</script>" inside a script would end it.
    scripts = [script.replace("</script", "<\\/script") for script in scripts]
    hashes = [base64.b64encode(hashlib.sha256(s.encode()).digest()).decode() for s in scripts]
    environment = Environment(loader=PackageLoader("ciliaval.report"), autoescape=True)
    environment.filters["number"] = number
    style = (Path(__file__).parent / "templates" / "style.css").read_text(encoding="utf-8")
    return environment.get_template("page.html.j2").render(
        title=title, lead=lead, sections=sections, footer=footer, style=style,
        scripts=scripts, hashes=hashes,
    )  # fmt: skip


def write(file: Path, page: Page) -> None:
    """The old page is replaced at once or not at all. Raises FileError."""
    with replacing(file) as scratch:
        scratch.write_text(page.html, encoding="utf-8", errors="replace")
