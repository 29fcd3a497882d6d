#!/bin/sh
# docs/reference and share say what the tables say; `make docs` brings them up to date.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1/scripts/generate_docs.sh" "$2/bin" "$work/reference" "$work/share"
diff -r "$1/docs/reference" "$work/reference"
diff -r "$1/share" "$work/share" && echo "generated documents are current"
