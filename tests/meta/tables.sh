#!/bin/sh
# Every row of the tables occurs in a test: diagnostics and refusals by code or identifier, traps by
# name, native functions and limits by identifier. Rows without a test stand in tables_not_yet.txt,
# which may only shrink. Instructions are run by golden files and random programs, on every tier.
set -eu
cd "$1"
corpus=$(mktemp)
trap 'rm -f "$corpus"' EXIT
find tests/unit tests/golden tests/cli tests/fuzz -name '*.cc' -o -name '*.st' -o -name '*.sh' | xargs cat >"$corpus"
status=0
rows=0
# row NAME [OTHER_NAME]: is one of them in the corpus?
row() {
  rows=$((rows + 1))
  if grep -qwF -e "$1" ${2:+-e "$2"} "$corpus"; then
    if grep -qxF "$1" tests/meta/tables_not_yet.txt; then
      echo "$1 has a test now: take it out of tests/meta/tables_not_yet.txt"
      status=1
    fi
  elif ! grep -qxF "$1" tests/meta/tables_not_yet.txt; then
    echo "$1: no test"
    status=1
  fi
}
pairs() { sed -n "s/^$1(\([A-Za-z0-9_]*\), *\"\([^\"]*\)\".*/\1 \2/p" "$2"; }
pairs DIAGNOSTIC base/diagnostics.def >"$corpus.rows"
pairs REFUSAL base/refusals.def >>"$corpus.rows"
pairs TRAP ir/program/traps.def >>"$corpus.rows"
sed -n 's/^LIMIT(\([A-Za-z0-9_]*\),.*/\1/p' base/limits.def base/tool_limits.def >>"$corpus.rows"
sed -n 's/^NATIVE(\([A-Za-z0-9_]*\), *"\([^"]*\)".*/\1 \2/p' stdlib/native/natives.def >>"$corpus.rows"
while read -r name other; do row "$name" "$other"; done <"$corpus.rows"
rm -f "$corpus.rows"
echo "$rows rows checked"
exit $status
