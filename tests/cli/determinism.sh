#!/bin/sh
# The bottling line has the same state hash in every run and in every hard mode. A third argument
# sets the scans of the slow modes (`make soak`: all of 100,000).
. "$(dirname "$0")/lib.sh"
stc build "$source_dir/examples/bottling_line" -o line.img 2>/dev/null
hash_of() { stvm run "$@" --virtual-time --hash 2>/dev/null | tail -1; }
first=$(hash_of line.img --scans 100000)
[ ${#first} -ge 64 ] || fail "no hash: $first"
[ "$first" = "$(hash_of line.img --scans 100000)" ] || fail "second run differs"
[ "$first" = "$(hash_of line.img --scans 100000 --hard-mode fuel1)" ] || fail "fuel 1 differs"
scans=${3:-3000}
short=$(hash_of line.img --scans "$scans")
[ "$short" != "$first" ] || [ "$scans" -eq 100000 ] || fail "the line does not move"
[ "$short" = "$(hash_of line.img --scans "$scans" --hard-mode identity)" ] || fail "identity changes differ"
# Moving relinks against what runs, so it takes sources.
some=$(hash_of line.img --scans 200)
[ "$some" = "$(hash_of "$source_dir/examples/bottling_line" --scans 200 --hard-mode move)" ] ||
  fail "moving differs"
