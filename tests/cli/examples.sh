#!/bin/sh
# Every example compiles without error or warning, and runs.
. "$(dirname "$0")/lib.sh"
for example in "$source_dir"/examples/small/*.st "$source_dir"/examples/crossing_chart "$source_dir"/examples/shared_memory/plc "$source_dir"/examples/bottling_line "$source_dir"/examples/bottling_line_v2; do
  expect 0 stc check "$example"
  if grep -qE '(error|warning)\[' err; then fail "diagnostics for $example"; fi
  expect 0 stvm run "$example" --virtual-time --scans 1000 --hash
done
expect 0 stc test "$source_dir"/examples/crossing_chart
