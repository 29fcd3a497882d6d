#!/bin/sh
# choose_fusions.sh BUILD [PAIRS TRIPLES MORE]: writes vm/exec/fusions.def anew from what the examples and the
# benchmarks compile to (docs/adr/0023-fused-handlers.md). Needs `bench_fusions` and `bench_images`
# built; afterwards everything that runs code is to be built again. When opcodes have other names,
# empty the table first.
set -eu
cd "$(dirname "$0")/.."
build=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for example in bottling_line crossing_chart heating motor_starter palletiser star_delta \
  traffic_lights; do
  sources=$(find "examples/$example" -name '*.st' ! -name '*_test.st' | sort)
  # shellcheck disable=SC2086
  "$build/bin/stc" build $sources -o "$folder/$example.image" >/dev/null 2>&1
done
for source in examples/small/*.st; do
  "$build/bin/stc" build "$source" -o "$folder/small_$(basename "$source" .st).image" >/dev/null 2>&1
done
"$build/bench/bench_fusions" "${2:-320}" "${3:-110}" "${4:-280}" "$build"/bench/*.image "$folder"/*.image \
  >"$folder/fusions.def"
cp "$folder/fusions.def" vm/exec/fusions.def
