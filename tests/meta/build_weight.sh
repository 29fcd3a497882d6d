#!/bin/sh
# R-13: the lines of this project's headers that the units of the product read, for each line of
# their sources: a figure that no load and no new source changes, only heavier includes. Parsing is a
# third of a build.
# usage: build_weight.sh SOURCE_DIR BUILD_DIR
set -eu
source=$1
build=$2
most=3.25  # lines of headers for each line of a source; where it comes down, so does this

# Only the build that people make first: others have other units.
left_out() { echo "left out: $1"; exit 77; }
setting() { sed -n "s/^$1:[A-Z]*=//p" "$build/CMakeCache.txt"; }
[ -f "$build/.ninja_deps" ] && command -v ninja >/dev/null || left_out "not built by ninja"
kind="$(setting CMAKE_BUILD_TYPE) $(setting STC_BATCH) $(setting STC_ADAPTERS)"
[ "$kind" = "Release 16 ON" ] || left_out "other units"
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
  { objects[$1] = 1 }
  $2 ~ /\.cc$/ && $2 !~ /generated/ { sources += lines[$2]; next }
  { headers += lines[$2] }
  /\/usr\/.*\/bits\/stl_vector\.h$/ { std[$1] = 1 }
  END {
    for (object in objects) { count++; alone += std[object] }
    ratio = headers / sources
    printf "%d units, %d lines of sources, %d of headers (%.2f); %d parse the standard library\n",
           count, sources, headers, ratio, alone
    if (count < 60) { print "which units are there?"; exit 1 }
    if (ratio > most) {
      printf "more than %s lines of headers for each of a source: lighter includes, please\n", most
      exit 1
    }
    if (alone > 6) { print "more than 6 units without precompiled headers"; exit 1 }
  }' "$work/lines" "$work/deps"
