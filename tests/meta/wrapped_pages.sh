#!/bin/sh
# Prose of pages keeps to 100 columns; scripts/wrap_pages.py wraps it. Pages that
# stc generates are left out; the benchmarks wrap theirs.
set -eu
cd "$1"
find README.md CHANGELOG.md docs bench examples \( -path docs/reference -o -path docs/schemas \) -prune \
  -o -name '*.md' -print |
  xargs python3 scripts/wrap_pages.py --check
