#!/bin/sh
# Intermediate results of 32 bits (docs/LANGUAGE.md, "Width of intermediate results") cost next to
# nothing: all programs of the bench together have less than 1 % more instructions with codesys than
# with iec, where an operation stays in its type, and none has over three more.
. "$(dirname "$0")/lib.sh"

mkdir programs
for source in "$source_dir"/bench/programs/*.st; do
  # What the standard has in another form; the operations are the same.
  sed 's/OR_ELSE/OR/g; s/AND_THEN/AND/g; s/METHOD Travel/METHOD PUBLIC Travel/' \
    "$source" >"programs/$(basename "$source")"
done
# The last `Load` is one of a block with a base.
awk '{ line[NR] = $0; if (/METHOD Load/) last = NR }
     END { sub(/METHOD/, "METHOD OVERRIDE", line[last]); for (i = 1; i <= NR; ++i) print line[i] }' \
  programs/interfaces.st >mended && mv mended programs/interfaces.st

# rows FILE DIALECT: how many instructions the program has
rows() {
  stc build -q "$1" --dialect "$2" -o x.img 2>err || fail "$1 with $2: $(cat err)"
  stc dump x.img --code | grep -cE '^[0-9]+ '
}
count=0 all_standard=0 all_wide=0
for source in programs/*.st; do
  standard=$(rows "$source" iec)
  wide=$(rows "$source" codesys)
  [ "$wide" -le $((standard + 3)) ] ||
    fail "$source: $wide instructions with codesys, $standard with iec"
  all_standard=$((all_standard + standard)) all_wide=$((all_wide + wide))
  count=$((count + 1))
done
[ $((all_wide * 100)) -lt $((all_standard * 101)) ] ||
  fail "$all_wide instructions with codesys, $all_standard with iec"
[ "$count" -ge 25 ] || fail "only $count programs"
