#!/usr/bin/env bash
# Builds the site of docs/ in FOLDER/html: Sphinx for the pages, the gallery and Python, Doxygen for C++ (without it, no C++ reference).
# SPDX-License-Identifier: LGPL-2.1-or-later
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
[ $# -eq 2 ] || { echo "usage: scripts/site.sh BUILD FOLDER   (such as build/release build/site)" >&2; exit 2; }
build=$(realpath "$1")
mkdir -p "$2"
site=$(realpath "$2")

# A copy, for the gallery's scripts and pages write beside themselves. Two pages above docs/ move into it.
rm -rf "$site/source" "$site/html"
mkdir -p "$site/source"
cp -r docs CITATION.cff tests/consumer/consumer.cc "$site/source"
for page in CHANGELOG.md CONTRIBUTING.md; do
  sed 's#](docs/#](#g' "$page" > "$site/source/docs/$page"
done
sed -i 's#](../../CONTRIBUTING.md)#](../CONTRIBUTING.md)#' "$site/source/docs/developer/README.md"
export PYTHONPATH="$build/python" CILIAVAL_PROGRAM="$build/ciliaval"
"${PYTHON:-python3}" -m sphinx -q -W --keep-going -b html "$site/source/docs" "$site/html"
if command -v doxygen >/dev/null; then
  SITE=$site doxygen "$build/docs/Doxyfile"
fi
echo "$site/html/index.html"
