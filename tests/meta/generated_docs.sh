#!/bin/sh
# docs/reference says what the tables say; `make docs` brings it up to date.
set -eu
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1/scripts/generate_docs.sh" "$2/bin" "$work"
diff -r "$1/docs/reference" "$work" && echo "generated documents are current"
