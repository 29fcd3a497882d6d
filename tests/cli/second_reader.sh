#!/bin/sh
# What stc exports is PLCopen XML for a reader that knows nothing of stc, too: random ladders, function
# block diagrams and charts, read by tests/vendors/read_tc6.py, which goes by the schema alone, do what
# their sources do. second_reader.sh SOURCES BUILD [FIRST COUNT]
. "$(dirname "$0")/lib.sh"
first=${3:-1}
count=${4:-6}
vendors=$source_dir/tests/vendors

state() {  # state SOURCE SCANS
  expect 0 stvm run "$1" --dialect codesys --virtual-time --scans "$2" --name p --print MAIN.sum --print MAIN.n
}
compare() {  # compare WHAT FOLDER: the sources in it
  needs_xml "$bin/stc" export "$2" --dialect codesys --without-sources --force -o made.xml
  python3 "$vendors/read_tc6.py" made.xml >second.st 2>err || fail "seed $seed, $1: $(cat err)"
  for scans in 3 17 64; do
    state "$2" $scans
    cp out mine
    state second.st $scans
    cmp -s mine out || fail "seed $seed, $1, $scans scans: $(paste mine out | tr '\n' ' ')"
  done
  grep -q '^MAIN.n=[1-9]' out || fail "seed $seed, $1: nothing happens"
}
seed=$first
while [ "$seed" -lt $((first + count)) ]; do
  for view in LD FBD; do
    rm -rf made sources
    python3 "$vendors/random_text_export.py" "$seed" $view made || fail "no export of seed $seed"
    needs_xml "$bin/stc" import made/drawn/main.EXP made/drawn/latch.EXP -o sources
    compare $view sources
  done
  rm -rf sources && mkdir sources
  python3 "$vendors/random_chart_text.py" "$seed" >sources/chart.st || fail "no chart of seed $seed"
  compare chart sources
  seed=$((seed + 1))
done
