# SPDX-License-Identifier: LGPL-2.1-or-later
"""The site is built without a warning, and its links lead to files and anchors that exist."""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

SOURCE = Path(__file__).resolve().parents[2]


class Page(HTMLParser):
    """Links and anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.anchors = set(), set()
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.links.add(value)
            elif name in ("id", "name") and value:
                self.anchors.add(value)


def dead_links(folder):
    """ "page.html: link" for each link within the folder that leads nowhere."""
    pages = {p: Page(p.read_text(encoding="utf-8")) for p in folder.rglob("*.html")}
    dead = []
    for path, page in pages.items():
        for link in page.links:
            url = urlsplit(link)
            if url.scheme or url.netloc:
                continue
            target = (path.parent / unquote(url.path)).resolve() if url.path else path
            anchor = unquote(url.fragment)
            if not target.exists() or (anchor and target in pages and anchor not in pages[target].anchors):
                dead.append(f"{path.relative_to(folder)}: {link}")
    return sorted(dead)


class Links(unittest.TestCase):
    def test_dead_ones_are_found(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name).resolve()
            (folder / "a.html").write_text('<a href="b.html#here">b</a> <a href="b.html#no">c</a> <img src="no.png">')
            (folder / "b.html").write_text('<p id="here"><a href="https://example.org/no">out</a> <a href="#here">in</a></p>')
            self.assertEqual(dead_links(folder), ["a.html: b.html#no", "a.html: no.png"])


class Site(unittest.TestCase):
    def test_is_built_without_a_warning_and_its_links_lead_somewhere(self):
        with tempfile.TemporaryDirectory() as name:
            site = Path(name).resolve()
            environment = {**os.environ, "PYTHON": sys.executable}
            build = os.environ.get("CILIAVAL_BUILD", SOURCE / "build" / "release")
            done = subprocess.run(
                [SOURCE / "scripts" / "site.sh", build, site], env=environment, capture_output=True, text=True, check=False
            )
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
            html = site / "html"
            self.assertEqual(dead_links(html), [])
            scripts = {p.stem for p in (SOURCE / "docs" / "gallery").glob("*.py")}
            pictures = {p.name for p in (html / "_images").glob("sphx_glr_*_001.png")}
            self.assertEqual(pictures, {f"sphx_glr_{s}_001.png" for s in scripts})
            for page, word in (("api/python", "slipped_off"), ("cpp/annotated", "Cilium")):
                if page.startswith("api") or shutil.which("doxygen"):
                    self.assertIn(word, (html / f"{page}.html").read_text(encoding="utf-8"))


if __name__ == "__main__":
    missing = [m for m in ("sphinx", "furo", "myst_parser", "sphinx_copybutton", "sphinx_gallery") if not importlib.util.find_spec(m)]
    if missing:
        print("not installed:", *missing)
        sys.exit(77)
    unittest.main()
