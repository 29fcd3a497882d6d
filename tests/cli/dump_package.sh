#!/bin/sh
# A3, C3: `stc dump --package BASE CHANGE` shows the update records of a change package: what is
# initialised, copied and converted, from where to where, before the switch or at it; and back.
. "$(dirname "$0")/lib.sh"
cat >v1.st <<'ST'
PROGRAM Main VAR n : INT; level : INT := 300; gone : INT := 5; END_VAR n := n + 1; level := n; gone := n; END_PROGRAM
ST
sed 's/ gone : INT := 5;/ more : DINT := 7;/; s/level : INT/level : DINT/; s/gone := n/more := n/' v1.st >v2.st
expect 0 stc build v1.st -o v1.img
expect 0 stc package --base v1.img v2.st -o change.pkg
expect 0 stc dump --package v1.img change.pkg
said '^change package for [0-9a-f]{12}, to [0-9a-f]{12}'
said '^forward: [0-9]+ update records, [0-9]+ bytes at the boundary'
said '^convert +[0-9]+ +[0-9]+ +4 +1 +boundary +Main.level : INT -> DINT'
said '^initialise +[0-9]+ +4 +1 +(before|boundary) +Main.more'
said '^back: '
said '^convert +[0-9]+ +[0-9]+ +2 +1 +boundary +Main.level : DINT -> INT'
said '^initialise +[0-9]+ +2 +1 +[a-z]+ +Main.gone'
# Addresses are those of the images.
from=$(sed -n 's/^convert *\([0-9]*\) .*INT -> DINT.*/\1/p' out)
expect 0 stc dump --symbols v1.img
said "^Main.level : INT @ $from\$"
# Of another base.
expect 0 stc build v2.st -o v2.img
expect 7 stc dump --package v2.img change.pkg
said 'R0301'
expect 7 stc dump --package v1.img v1.img
said 'R0101'
