# SPDX-License-Identifier: LGPL-2.1-or-later
"""Blocks of a page. templates/page.html.j2 shows each kind."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Union

from matplotlib.figure import Figure as Drawing

from ..files import text_of
from ..plot.style import style


@dataclass
class Text:
    """A paragraph. kind: "" or "bad"."""

    text: str
    kind: str = ""


@dataclass
class Items:
    """A list of sentences."""

    items: list[str]


@dataclass
class Cell:
    """A cell of a table. kind: of style.css; rows: how many it spans; link: the id it leads to."""

    text: str
    kind: str = ""
    rows: int = 1
    link: str = ""


@dataclass
class Table:
    """head: a title for each column; the first cell of a row names it."""

    caption: str
    head: list[str]
    rows: list[Sequence[Union[str, Cell]]] = field(default_factory=list)


@dataclass
class Image:
    """A figure as a picture in the page itself, with its size in CSS pixels; or why there is none."""

    title: str
    caption: str
    source: str
    width: int
    height: int
    fault: str = ""


@dataclass
class Images:
    """Figures side by side where there is room."""

    images: list[Image]


@dataclass
class Opening:
    """A figure with what was found, side by side where there is room."""

    image: Image | None
    findings: list[str]


@dataclass
class Details:
    """Blocks that open on a click."""

    title: str
    blocks: Sequence["Block"]


@dataclass
class Code:
    """Text as it is in a file."""

    title: str
    text: str


@dataclass
class Heading:
    text: str


@dataclass
class View:
    """An interactive view: view.js draws `data`, a JSON object."""

    title: str
    caption: str
    data: dict[str, Any]


Block = Union[Text, Items, Table, Images, Opening, Details, Code, Heading, View, "Fault"]


@dataclass
class Section:
    """A part of a page. id: of its heading."""

    id: str
    title: str
    blocks: list[Block]


@dataclass
class Fault:
    """Part of a result that could not be shown, and the reason."""

    text: str


def image(title: str, caption: str, draw: Callable[[], Drawing]) -> Image:
    """A figure of matplotlib's as SVG. One that cannot be drawn leaves the others as they are."""
    try:
        drawing = draw()
        stream = io.BytesIO()
        with style():
            drawing.savefig(stream, format="svg", metadata={"Date": None})
    except Exception as error:  # whatever the numbers of a damaged file make of a drawing
        return Image(title, caption, "", 0, 0, f"{title}: cannot be drawn: {text_of(error)}")
    source = base64.b64encode(stream.getvalue()).decode()
    width, height = (round(96 * size) for size in drawing.get_size_inches())
    return Image(title, caption, f"data:image/svg+xml;base64,{source}", width, height)


def guarded(what: str, make: Callable[[], list[Block]]) -> list[Block]:
    """A part of a page; where it cannot be made, why, in its place."""
    try:
        return make()
    except Exception as error:  # the other parts are as good without it
        return [Fault(f"{what}: cannot be shown: {text_of(error)}")]


def faults(blocks: Sequence[Block]) -> Iterator[str]:
    """Texts on the missing parts of these blocks, with the reasons."""
    for block in blocks:
        if isinstance(block, Fault):
            yield block.text
        elif isinstance(block, Images):
            yield from (i.fault for i in block.images if i.fault)
        elif isinstance(block, Opening) and block.image and block.image.fault:
            yield block.image.fault
        elif isinstance(block, Details):
            yield from faults(block.blocks)
