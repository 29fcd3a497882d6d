#!/bin/sh
# Random ladders, function block diagrams and charts as TwinCAT stores them, and ladders and diagrams
# as CODESYS V2.3 exports them, do what the same trees and graphs mean in ST
# (tests/vendors/random_twincat.py, random_charts.py, random_text_export.py).
# drawn_random.sh SOURCES BUILD [FIRST COUNT]
. "$(dirname "$0")/lib.sh"
first=${3:-1}
count=${4:-8}

state() {  # state FOLDER SCANS: what the program has summed up
  expect 0 stvm run "$1" --dialect twincat --virtual-time --scans "$2" --name p --print MAIN.sum --print MAIN.n $all
}
compare() {  # compare WHAT SCANS
  needs_xml "$bin/stvm" run made/drawn --dialect twincat --virtual-time --scans 1
  state made/text "$2"
  cp out text
  state made/drawn "$2"
  cmp -s text out || fail "seed $seed, $1: $(paste text out | tr '\n' ' ')"
  rm -rf made
}
seed=$first
while [ "$seed" -lt $((first + count)) ]; do
  all='--print MAIN.all'
  for view in Ld Fbd; do
    python3 "$source_dir/tests/vendors/random_twincat.py" "$seed" $view made || fail "no program of seed $seed"
    compare $view 128
    grep -q '^MAIN.all=[1-9]' out || fail "seed $seed, $view: nothing happens"
  done
  for view in LD FBD; do
    python3 "$source_dir/tests/vendors/random_text_export.py" "$seed" $view made || fail "no export of seed $seed"
    compare $view 128
    grep -q '^MAIN.all=[1-9]' out || fail "seed $seed, $view: nothing happens"
  done
  all=
  python3 "$source_dir/tests/vendors/random_charts.py" "$seed" made || fail "no chart of seed $seed"
  compare chart 60
  seed=$((seed + 1))
done
