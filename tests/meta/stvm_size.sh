#!/bin/sh
# stvm without adapters and symbols takes 3 MiB at most (docs/performance.md), in a release build
# by g++ for x86-64; others are as large as their compiler makes them. A control: with symbols it
# is larger.
set -eu
cache="$2/CMakeCache.txt"
setting() { sed -n "s/^$1:[A-Z]*=//p" "$cache"; }
limit=$((3 << 20))
[ "$(setting STC_ADAPTERS)" = OFF ] || limit=$((limit + (128 << 10)))
case "$(setting CMAKE_BUILD_TYPE) $(setting STC_SANITIZE) $(setting STC_COVERAGE) $(uname -m)" in
  "Release  OFF x86_64") ;;
  *) echo "left out: not a release build for x86-64"; exit 77 ;;
esac
"$(setting CMAKE_CXX_COMPILER)" --version | grep -q "Free Software" || { echo "left out: not g++"; exit 77; }
[ -z "$(setting CMAKE_TOOLCHAIN_FILE)" ] || { echo "left out: for another machine"; exit 77; }
bare=$(mktemp)
trap 'rm -f "$bare"' EXIT
strip -o "$bare" "$2/bin/stvm"
bytes=$(wc -c < "$bare")
echo "stvm without symbols: $bytes bytes, at most $limit"
[ "$bytes" -le "$limit" ] && [ "$(wc -c < "$2/bin/stvm")" -gt "$bytes" ]
