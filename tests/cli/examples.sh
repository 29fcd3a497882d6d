#!/bin/sh
# Every example compiles without error or warning, and runs.
. "$(dirname "$0")/lib.sh"
for example in "$source_dir"/examples/small/*.st "$source_dir"/examples/crossing_chart "$source_dir"/examples/shared_memory/plc "$source_dir"/examples/motor_starter "$source_dir"/examples/star_delta "$source_dir"/examples/traffic_lights "$source_dir"/examples/heating "$source_dir"/examples/palletiser "$source_dir"/examples/bottling_line "$source_dir"/examples/bottling_line_v2 "$source_dir"/examples/two_resources; do
  expect 0 stc check "$example"
  if grep -qE '(error|warning)\[' err; then fail "diagnostics for $example"; fi
  expect 0 stvm run "$example" --virtual-time --scans 1000 --hash
done
expect 0 stc test "$source_dir"/examples/crossing_chart
# Ten minutes of the palletiser: eight pallets, and nothing went wrong.
expect 0 stvm run "$source_dir"/examples/palletiser --virtual-time --scans 60000 --set Reset=TRUE --set Start=TRUE \
  --print BoxesTotal,PalletsTotal,AlarmCode
[ "$(tr '\n' ' ' < out)" = "BoxesTotal=480 PalletsTotal=8 AlarmCode=0 " ] || fail "the palletiser: $(cat out)"
# Twenty seconds of two resources: a batch of ten in each 30 ms, and none is torn.
expect 0 stvm run "$source_dir"/examples/two_resources --virtual-time --scans 10000 --print Pack.p.Packed,Line.p.Waits,Pack.p.Torn
[ "$(tr '\n' ' ' < out)" = "Pack.p.Packed=6660 Line.p.Waits=2655 Pack.p.Torn=0 " ] || fail "two resources: $(cat out)"
# Examples are laid out as `stc fmt` lays them out.
for example in motor_starter star_delta traffic_lights heating palletiser two_resources; do
  expect 0 stc fmt --check "$source_dir"/examples/$example
done
