#!/bin/sh
# Every function and block of the libraries (stdlib/registry.def, docs/reference/functions.md) is used
# by a test: called, or the type of a variable, in a golden file, a corpus, a test of the command line
# or of a unit.
set -eu
cd "$1"
used=$(mktemp)
trap 'rm -f "$used" "$used.names"' EXIT
find tests/golden tests/corpus tests/cli tests/unit -name '*.st' -o -name '*.sh' -o -name '*.cc' |
  xargs sed '/^\/\/ \(CHECK\|MODE\|Library\)/d' |
  grep -oE '[A-Za-z_][A-Za-z0-9_]* *\(|(:|OF|EXTENDS) *([A-Za-z0-9_]+\.)*[A-Za-z_][A-Za-z0-9_]*' |
  sed "s/ *($//; s/^\\(:\\|OF\\|EXTENDS\\) *//; s/.*[.]//" | tr "[:lower:]" "[:upper:]" | sort -u >"$used"
sed -n 's/^FUNCTION([A-Za-z0-9_]*, *"\([^"]*\)".*/\1/p; s/^LIBRARY("\([^"]*\)".*/\1/p; s/^LIBRARY_OF([A-Za-z0-9_]*, *"\([^"]*\)".*/\1/p' \
  stdlib/registry.def | tr '[:lower:]' '[:upper:]' | sort -u >"$used.names"
rows=$(wc -l <"$used.names")
[ "$rows" -ge 240 ] || { echo "only $rows names are read from stdlib/registry.def"; exit 1; }
missing=$(comm -23 "$used.names" "$used")
[ -z "$missing" ] || { echo "no test uses:"; echo "$missing"; exit 1; }
echo "$rows functions and blocks are used by tests"
