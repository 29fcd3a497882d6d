#!/bin/sh
# Prose of pages keeps to 100 columns; scripts/wrap_pages.py wraps it. Generated pages are left out.
set -eu
cd "$1"
find README.md CHANGELOG.md docs bench examples \( -path docs/reference -o -path docs/schemas \) -prune \
  -o -name '*.md' ! -path docs/performance.md ! -path docs/pause.md -print |
  xargs python3 scripts/wrap_pages.py --check
