#!/bin/sh
# What stc exports is PLCopen XML for a reader that knows nothing of stc, too: random ladders, function
# block diagrams, instructions and charts, read by tests/vendors/read_tc6.py, which goes by the schema
# alone, do what their sources do. second_reader.sh SOURCES BUILD [FIRST COUNT]
. "$(dirname "$0")/lib.sh"
first=${3:-1}
count=${4:-4}
vendors=$source_dir/tests/vendors

state() {  # state SOURCE SCANS
  expect 0 stvm run "$1" --dialect codesys --virtual-time --scans "$2" --name p --print "${of}sum" --print "${of}n"
}
compare() {  # compare WHAT FOLDER OF: the sources in it; OF: what MAIN's variables are parts of
  of=$3
  needs_xml "$bin/stc" export "$2" --dialect codesys --without-sources --force -o made.xml
  python3 "$vendors/read_tc6.py" made.xml >second.st 2>err || fail "seed $seed, $1: $(cat err)"
  for scans in 3 17 64; do
    state "$2" $scans
    cp out mine
    state second.st $scans
    cmp -s mine out || fail "seed $seed, $1, $scans scans: $(paste mine out | tr '\n' ' ')"
  done
  grep -q "^${of}n=[1-9]" out || fail "seed $seed, $1: nothing happens"
}
seed=$first
while [ "$seed" -lt $((first + count)) ]; do
  for view in LD FBD; do
    rm -rf made sources
    python3 "$vendors/random_text_export.py" "$seed" $view made || fail "no export of seed $seed"
    needs_xml "$bin/stc" import made/drawn/main.EXP made/drawn/latch.EXP -o sources
    compare $view sources MAIN.
  done
  rm -rf sources && mkdir sources
  python3 "$vendors/random_chart_text.py" "$seed" >sources/chart.st || fail "no chart of seed $seed"
  compare chart sources MAIN.
  for view in LD FBD IL; do
    rm -rf sources && mkdir sources
    python3 "$vendors/random_drawn_text.py" "$seed" $view >sources/drawn.st || fail "no $view of seed $seed"
    compare "$view as text" sources ""
  done
  seed=$((seed + 1))
done
