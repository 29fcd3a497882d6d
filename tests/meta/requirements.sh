#!/bin/sh
# Every numbered behaviour of the five systems occurs by its number in a test, or
# stands in not_yet_tested.txt; that list may only shrink.
set -eu
cd "$1"
all=""
for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19; do all="$all A$i"; done
for i in 1 2 3 4 5 6 7 8 9 10; do all="$all B$i"; done
for i in 1 2 3 4 5 6 7; do all="$all C$i D$i"; done
for i in 1 2 3 4 5 6 7 8; do all="$all E$i"; done
for i in 1 2 3 4 5 6; do all="$all X$i"; done
for i in $(seq 20); do all="$all V$i"; done
# Of golden files only the comments: B6 may also be the name of a variable there.
words=$(mktemp)
trap 'rm -f "$words"' EXIT
grep -rahE "" tests/unit tests/golden tests/fuzz --include='*.cc' --include='*.h' >"$words"
grep -rahE "^//" tests/golden --include='*.st' | grep -avE "^// *(CHECK|>)" >>"$words"
status=0
tested=0
for id in $all; do
  if grep -aqE "(^|[^A-Za-z0-9])${id}([^0-9]|$)" "$words"; then
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
echo "$tested requirements named by tests"
exit $status
