#!/bin/sh
# Random ladders and function block diagrams as TwinCAT stores them do what the same trees mean in ST
# (tests/vendors/random_twincat.py). drawn_random.sh SOURCES BUILD [FIRST COUNT]
. "$(dirname "$0")/lib.sh"
first=${3:-1}
count=${4:-8}

state() { expect 0 stvm run "$1" --dialect twincat --virtual-time --scans 128 --name p --print MAIN.all --print MAIN.sum; }
for view in Ld Fbd; do
  seed=$first
  while [ "$seed" -lt $((first + count)) ]; do
    python3 "$source_dir/tests/vendors/random_twincat.py" "$seed" $view made || fail "no program of seed $seed"
    if ! "$bin/stvm" run made/drawn --dialect twincat --virtual-time --scans 1 >out 2>err &&
      grep -q 'built without pugixml' err; then
      echo "built without pugixml: no objects of TwinCAT"
      exit 0
    fi
    state made/text
    cp out text
    state made/drawn
    grep -q '^MAIN.all=[1-9]' out || fail "seed $seed, $view: nothing happens"
    cmp -s text out || fail "seed $seed, $view: $(paste text out | tr '\n' ' ')"
    seed=$((seed + 1))
  done
done
