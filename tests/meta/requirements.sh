#!/bin/sh
# Every numbered behaviour of the five systems occurs by its number in a test, or
# stands in not_yet_tested.txt; that list may only shrink. Every number that is named anywhere is a
# line of docs/REQUIREMENTS.md.
set -eu
cd "$1"
all=""
many() { for i in $(seq "$2"); do all="$all $1$i"; done; }
many A 19; many B 12; many C 9; many D 8; many E 8; many X 9; many V 20
# What claims to test it: the name of a test or a comment. Elsewhere E4 may be a number, a variable
# or a part of a format.
words=$(mktemp)
trap 'rm -f "$words"' EXIT
sources=$(find tests/unit tests/fuzz tests/golden tests/sim -name '*.cc' -o -name '*.h')
sed -nE 's/^ *TEST(_F|_P)?\((.*)/\2/p; s/.*[ ^]\/\/ (.*)/\1/p; s/^\/\/ (.*)/\1/p' $sources >"$words"
grep -rahE "^//" tests/golden --include='*.st' | grep -avE "^// *(CHECK|>)" >>"$words"
grep -rahE "^ *# " tests/cli --include='*.sh' >>"$words"
status=0
tested=0
for id in $all; do
  grep -qF "**$id**" docs/REQUIREMENTS.md || { echo "$id is not in docs/REQUIREMENTS.md"; status=1; }
  if grep -aqE "(^|[^A-Za-z0-9\$%])${id}([^0-9A-Za-z]|$)" "$words"; then
    tested=$((tested + 1))
    if grep -qw "$id" tests/meta/not_yet_tested.txt; then
      echo "$id has a test now: take it out of tests/meta/not_yet_tested.txt"
      status=1
    fi
  elif ! grep -qw "$id" tests/meta/not_yet_tested.txt; then
    echo "$id: no test names it"
    status=1
  fi
done
# The lines of the command line and of devices have a row with their tests, which name them.
for id in $(seq -f 'R-%02g' 13) V-01; do
  row=$(sed -n "s/^| $id | \(.*\) |\$/\1/p" docs/REQUIREMENTS.md)
  [ -n "$row" ] || { echo "$id has no row in docs/REQUIREMENTS.md"; status=1; }
  for file in $(echo "$row" | grep -oE 'tests/[a-z0-9_/]+\.[a-z]+'); do
    grep -qE "$id|$(echo "$id" | tr -d -)_" "$file" || { echo "$file does not name $id"; status=1; }
    tested=$((tested + 1))
  done
done
# Numbers of two parts (E-07, R-10, X3-04) that anything here names are lines of that page, too.
for id in $(grep -rohE '\b(X3|X6|[DEFGLPRSVY])-[0-9]{2}\b' $sources tests/cli tests/conformance docs \
  base frontend ir linker online_change vm workspace stdlib adapters tools scripts | sort -u); do
  grep -q "\*\*$id\*\*" docs/REQUIREMENTS.md || { echo "$id is not in docs/REQUIREMENTS.md"; status=1; }
done
echo "$tested requirements named by tests"
exit $status
