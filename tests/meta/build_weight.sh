#!/bin/sh
# R-13: what the compiler of this project's build reads beside headers of the standard library, in
# lines over all units of the product: a figure that no load changes. Parsing is a third of a build.
# usage: build_weight.sh SOURCE_DIR BUILD_DIR
set -eu
source=$1
build=$2
most=565000  # lines; where it comes down, so does this

# Only the build that people make first: others have other units.
[ -f "$build/.ninja_deps" ] && command -v ninja >/dev/null || exit 0
grep -q '^CMAKE_BUILD_TYPE:STRING=Release$' "$build/CMakeCache.txt" || exit 0
grep -q '^STC_BATCH:STRING=16$' "$build/CMakeCache.txt" || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$build"
# OBJECT DEPENDENCY, for objects of the product.
ninja -t deps | awk '/^[^ ].*: #deps/ { object = $1; sub(/:$/, "", object); next }
  NF == 1 && object ~ /^CMakeFiles/ { print object, $1 }' >"$work/deps"
cut -d ' ' -f 2 "$work/deps" | sort -u | grep -vE '^/usr/|\.gch$|cmake_pch' | while read -r file; do
  [ ! -f "$file" ] || echo "$file $(wc -l <"$file")"
done >"$work/lines"
awk -v most="$most" '
  NR == FNR { lines[$1] = $2; next }
  { total += lines[$2]; objects[$1] = 1 }
  /\/usr\/.*\/bits\/stl_vector\.h$/ { std[$1] = 1 }
  END {
    for (object in objects) { count++; alone += std[object] }
    printf "%d units of the product, %d lines of the project; %d parse the standard library\n",
           count, total, alone
    if (count < 60) { print "which units are there?"; exit 1 }
    if (total > most) { printf "more than %d lines: lighter includes, please\n", most; exit 1 }
    if (alone > 5) { print "more than 5 units without precompiled headers"; exit 1 }
  }' "$work/lines" "$work/deps"
