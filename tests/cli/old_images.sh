#!/bin/sh
# Images and stores of older versions (tests/old_images): they are loaded, and do the same.
. "$(dirname "$0")/lib.sh"

for version in "$source_dir"/tests/old_images/*/; do
  while read -r name scans hash; do
    for tier in native interp; do
      expect 0 stvm run "$version$name.image" --virtual-time --scans "$scans" --hash --tier $tier
      said "^$hash\$"
    done
  done <"${version}expected"

  rm -rf plc
  tar xzf "${version}store.tar.gz"
  expect 0 stvm journal --dir plc
  said 'accepted 1a5d23063807 -> 141b71554aff'
  serve plc
  expect 0 stvm status --dir plc
  said '141b71554aff'
  expect 0 stvm get --dir plc pieces shift
  said "^shift='day'"
  pieces=$(sed -n 's/^pieces=//p' out)
  [ "$pieces" -ge 37 ] || fail "retained: $pieces pieces"
  expect 0 stvm stop --dir plc
  rm plc.pid
done
