#!/bin/sh
# Images and stores of older versions (tests/old_images): they are loaded, and do the same; they are
# changed to what this version builds, and what this version builds is changed to them.
. "$(dirname "$0")/lib.sh"

# format IMAGE: the number in its header.
format() { od -A n -t u4 -j 8 -N 4 "$1" | tr -d ' '; }

formats=" "
for version in "$source_dir"/tests/old_images/*/; do
  while read -r name scans hash; do
    for tier in native interp; do
      expect 0 stvm run "$version$name.image" --virtual-time --scans "$scans" --hash --tier $tier
      said "^$hash\$"
    done
    formats="$formats$(format "$version$name.image") "
  done <"${version}expected"

  rm -rf plc
  tar xzf "${version}store.tar.gz"
  accepted=$(cat "${version}accepted")
  expect 0 stvm journal --dir plc
  said "accepted $accepted"
  serve plc
  expect 0 stvm status --dir plc
  said "${accepted##* }"
  expect 0 stvm get --dir plc pieces shift
  said "^shift='day'"
  pieces=$(sed -n 's/^pieces=//p' out)
  [ "$pieces" -ge 37 ] || fail "retained: $pieces pieces"
  # What it ran before is still one command away, where that version kept it.
  if [ -e plc/before ]; then
    expect 0 stvm revert --dir plc --yes --allow-loss --allow-overrun
    expect 0 stvm undo --dir plc --yes
  fi
  expect 0 stvm journal --dir plc
  said "accepted $accepted"
  expect 0 stvm stop --dir plc
  rm plc.pid
done
for wanted in 7 8 9 10 11 12 13 14 15 16; do
  case $formats in *" $wanted "*) ;; *) fail "no image of format $wanted" ;; esac
done

# From each to the same sources as this version builds them, and back; then the other way round.
# sources IMAGE-NAME: what it was made of.
sources() {
  case $1 in
    press*) echo "$source_dir/tests/old_images/press_1.st" ;;
    run_first) echo "$source_dir/tests/old_images/run_first.st" ;;
    own*) echo "$source_dir/tests/old_images/own_exchange.st" ;;
    methods) echo "$source_dir"/tests/golden/objects/methods.st ;;
    crossing) echo "$source_dir"/examples/crossing_chart/crossing.st ;;
    *) echo "$source_dir/examples/$1/$1.st" ;;
  esac
}
for version in "$source_dir"/tests/old_images/*/; do
  while read -r name scans hash; do
    case $name in methods) continue ;; esac  # a golden file with two programs
    sed '0,/^PROGRAM/s/^PROGRAM/VAR_GLOBAL more_of_it : DINT := 4711; END_VAR\nPROGRAM/' \
      "$(sources "$name")" >next.st
    rm -rf from
    serve from "$version$name.image"
    expect 0 stvm change next.st --dir from --yes --allow-loss --allow-overrun
    expect 0 stvm get more_of_it --dir from
    said '^more_of_it=4711$'
    expect 0 stvm undo --dir from --yes
    expect 7 stvm get more_of_it --dir from
    expect 0 stvm change next.st --dir from --yes --allow-loss --allow-overrun --permanent
    expect 0 stvm change "$version$name.image" --dir from --yes --allow-loss --allow-overrun
    expect 7 stvm get more_of_it --dir from
    expect 0 stvm stop --dir from
    rm from.pid
  done <"${version}expected"
done
