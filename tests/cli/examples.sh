#!/bin/sh
# Every example compiles without a diagnostic and runs.
. "$(dirname "$0")/lib.sh"
for example in "$source_dir"/examples/small/*.st "$source_dir"/examples/bottling_line "$source_dir"/examples/bottling_line_v2; do
  expect 0 stc check "$example"
  silent_on err
  expect 0 stvm run "$example" --virtual-time --scans 1000 --hash
done
