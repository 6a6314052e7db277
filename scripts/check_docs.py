#!/usr/bin/env python3
"""Checks the documentation against the tree: exit code 1 and a line for each fault.

- Relative links in the Markdown files lead to files and headings that exist.
- Each page that a source or a script names (docs/….md) exists.
- Each path and each test named in a page of docs/ exists.
- In docs/equations.md each file exists and holds the functions named beside it.

SPDX-License-Identifier: LGPL-2.1-or-later
"""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else __file__).resolve()
root = root if root.is_dir() else root.parent.parent
listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True).stdout.split("\n")
# Without git, in a source archive: everything but builds and results.
names = [n for n in listed if n] or [str(p.relative_to(root)) for p in root.rglob("*") if not {"build", "results"} & set(p.parts)]
texts = {n: (root / n).read_text(encoding="utf-8", errors="replace") for n in names
         if (root / n).is_file() and re.search(r"\.(md|cc|h|in|py|sh|toml|cmake|txt|geo|cff)$", n)}
faults = []


def headings(text):
    text = re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)
    return {re.sub(r"[^\w\- ]", "", title.strip().lower()).replace(" ", "-") for title in re.findall(r"^#+ (.*)$", text, flags=re.M)}


for name in (n for n in texts if n.endswith(".md")):
    prose = re.sub(r"^```.*?^```|`[^`\n]*`", "", texts[name], flags=re.M | re.S)
    for link in re.findall(r"\]\(([^)\s]+)\)", prose):
        if re.match(r"[a-z]+:", link):
            continue
        path, _, heading = link.partition("#")
        target = (root / name).parent / path if path else root / name
        if not target.exists():
            faults.append(f"{name}: the link {link} leads nowhere")
        elif heading and heading not in headings(target.read_text(encoding="utf-8")):
            faults.append(f"{name}: {link}: there is no such heading")

for name, text in texts.items():
    for page in set(re.findall(r"\bdocs/[\w/.-]+\.(?:md|py|png|svg)", text)):
        if not (root / page).exists() and name != "CHANGELOG.md":
            faults.append(f"{name}: there is no {page}")

tests = {f"{suite}.{test}" for name, text in texts.items() if name.startswith("tests/")
         for suite, test in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", text, flags=re.M)}
tests |= {f"{pathlib.Path(name).stem}.{suite}" for name, text in texts.items() if name.startswith("tests/python/")
          for suite in re.findall(r"^class (\w+)\(unittest", text, flags=re.M)}
folders = "problem|analytic|meshes|fem|tools|compare|cases|paraview|scripts|tests|docs"
for name in (n for n in texts if n.startswith("docs/")):
    for path in re.findall(rf"`((?:{folders})/[a-z_/.0-9]*)`", texts[name]):
        if not any((root / p).exists() for p in (path, path + ".h", path + ".cc")):
            faults.append(f"{name}: there is no {path}")
    for test in re.findall(r"`([A-Z]\w+\.[A-Z]\w+)…?`", texts[name]):
        if not any(t.startswith(test) for t in tests):
            faults.append(f"{name}: there is no test {test}")

rows = 0
for line in texts["docs/equations.md"].split("\n"):
    cells = re.split(r"(?<!\\)\|", line)
    if len(cells) != 6 or not re.search(r"`[\w/]+\.\w+`", cells[2]):
        continue
    rows += 1
    files, functions, named = (re.findall(r"`([^`]+)`", cell) for cell in cells[2:5])
    where = f"docs/equations.md: {cells[1].strip()}"
    missing = [f for f in files if f not in texts]
    faults += [f"{where}: there is no file {f}" for f in missing]
    held = "\n".join(texts.get(f, "") for f in files)
    if not missing:
        faults += [f"{where}: no {f} in {', '.join(files)}" for f in functions if not re.search(rf"\b{f}\(|\b(?:class|struct) {f}\b|\b{f}::", held)]
    faults += [f"{where}: there is no test {t}" for t in named if t not in tests]
    if not functions or not named:
        faults.append(f"{where}: needs a function and a test")
if rows == 0:
    faults.append("docs/equations.md: no table has been read")

print("\n".join(faults) or f"{len(texts)} files, {rows} equations: the documentation is true to the tree")
sys.exit(1 if faults else 0)
