#!/bin/sh
# Sources in the style of each vendor compile, run, and run the same after `stc fmt`; objects of
# TwinCAT are imported, and the text that comes of them does the same, too. So does what comes back
# from PLCopen XML. Bodies that were drawn
# there (drawn_*, by tests/vendors/draw_twincat.py) do what their program in ST does
# (tests/vendors/drawn).
. "$(dirname "$0")/lib.sh"
corpus="$source_dir/tests/vendors"

# runs DIALECT WHAT FILE: the state after 40 cycles into FILE.
runs() {
  expect 0 stvm run "$2" --dialect "$1" --virtual-time --scans 40 --name p --state
  cp out "$3"
  [ -s "$3" ] || fail "no state of $2"
}
same_laid_out() {  # DIALECT FOLDER: of sources, whose state is in `before`
  expect 0 stc fmt "$2"
  expect 0 stc fmt --check "$2"
  runs "$1" "$2" after
  cmp -s before after || fail "$2 does something else when it is laid out"
}
# What its elements in XML say, without its text, does the same. What they cannot say is refused,
# and the documents name it.
refused=
round_trip() {  # DIALECT FOLDER, whose state is in `before`
  rm -rf back
  code=0
  stc export "$2" --dialect "$1" --without-sources -o back.xml --force >out 2>err || code=$?
  if [ $code -ne 0 ]; then
    said 'E1084'
    refused="$refused $(basename "$2")"
    return
  fi
  expect 0 stc import back.xml -o back
  runs "$1" back after
  sort before >sorted  # steps come back in another order
  sort after | cmp -s sorted - || fail "$2 does something else when it comes back from XML"
}

seen=0
xml=yes
if stc export "$corpus"/codesys/"$(ls "$corpus"/codesys | head -1)" -o probe.xml 2>&1 | grep -q pugixml; then xml=; fi
for one in "$corpus"/codesys/*.st "$corpus"/openplc/*.st; do
  name=$(basename "$one" .st)
  mkdir -p "text/$name"
  cp "$one" "text/$name/"
  runs codesys "text/$name" before
  if [ -n "$xml" ]; then round_trip codesys "text/$name"; fi
  same_laid_out codesys "text/$name"
  seen=$((seen + 1))
done
# Objects of TwinCAT are XML.
needs_xml "$bin/stvm" run "$corpus/twincat/actions" --dialect twincat --scans 1 --virtual-time
same_as_text() {  # NAME: of variables that both have; edges of pins and steps have a memory of their own
  for scans in 3 8 14 25 40; do
    for one in "$corpus/drawn/$1.st" "$corpus/twincat/$1"; do
      expect 0 stvm run "$one" --dialect twincat --virtual-time --scans $scans --name p --state
      cp out "state_$(basename "$one" .st)_$(basename "$(dirname "$one")")"
    done
    awk -F= 'NR == FNR { text[$1] = $0; next }
      ($1 in text) { same++; if (text[$1] != $0) { print text[$1] " | " $0; bad = 1 } }
      END { exit bad || same < 5 }' "state_$1_drawn" "state_$1_twincat" >differs ||
      fail "$1 after $scans scans: $(cat differs)"
  done
}
drawn=0
for one in "$corpus"/twincat/*; do
  name=$(basename "$one")
  case $name in drawn_*) same_as_text "$name"; drawn=$((drawn + 1)) ;; esac
  runs twincat "$one" before
  expect 0 stc import "$one" -o "imported/$name"
  runs twincat "imported/$name" after
  cmp -s before after || fail "$one does something else when it is imported"
  round_trip twincat "imported/$name"
  same_laid_out twincat "imported/$name"
  seen=$((seen + 1))
done
[ "$refused" = " mixed_instances program_connections drawn_ladder" ] || fail "without elements:$refused"
[ "$drawn" -ge 10 ] || fail "only $drawn drawings"
[ "$seen" -ge 130 ] || fail "only $seen sources"
