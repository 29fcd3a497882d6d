#!/bin/sh
# The optimiser as people meet it: on by default, off with --no-opt, chosen with --passes. Whatever is chosen, a program
# does the same. It never becomes longer, but for bodies of functions in place of calls. The same source is the same image.
. "$(dirname "$0")/lib.sh"
hash_of() { stvm run "$1" --scans 500 --virtual-time --hash 2>/dev/null | tail -1; }
units_of() { stc dump --code "$@" 2>/dev/null | grep -c '^[0-9]'; }

passes=$(stc explain passes | awk 'NR > 2 && $1 != "inline" { print $1 }')
all_but_inline=$(echo $passes | tr ' ' ',')
for project in "$source_dir"/examples/*/ "$source_dir"/bench/programs/*.st; do
  [ -e "$project" ] && stc build "$project" -q -o project.img 2>/dev/null || continue
  plain=$(units_of --no-opt "$project")
  for pass in $passes $all_but_inline; do
    one=$(units_of --passes "$pass" "$project")
    [ "$one" -le "$plain" ] || fail "$project: $one units with pass $pass, without $plain"
  done
done

line=$source_dir/examples/bottling_line
stc build "$line" -o best.img 2>/dev/null
stc build "$line" -o again.img 2>/dev/null
stc build "$line" -o plain.img --no-opt 2>/dev/null
stc build "$line" -o some.img --passes fold,branches 2>/dev/null
cmp -s best.img again.img || fail "the same source gave two images"
cmp -s best.img plain.img && fail "--no-opt changes nothing"
[ "$(hash_of best.img)" = "$(hash_of plain.img)" ] || fail "the optimised line does something else"
[ "$(hash_of best.img)" = "$(hash_of some.img)" ] || fail "with some passes the line does something else"

# A caller holds the body of a small function: who changes that one changes the caller (E1).
cat >before.st <<'END'
FUNCTION Twice : INT VAR_INPUT x : INT; END_VAR Twice := x * 2; END_FUNCTION
PROGRAM Main VAR n : INT; END_VAR n := Twice(n) + 1; END_PROGRAM
END
sed 's/x \* 2/x * 3/' before.st >after.st
stc build before.st -o before.img 2>/dev/null
stc diff before.img after.st >diff.txt 2>/dev/null
grep -q Main diff.txt || fail "the caller of a changed function stays: $(cat diff.txt)"

expect 2 stc build "$line" -o x.img --passes fold,magic
said 'unknown pass `magic`; known are all, none, .*fold'
expect 2 stc build "$line" -o x.img --no-opt --passes fold
said '--no-opt and --passes contradict each other'
printf "TEST 'sum' ASSERT(1 + 1 = 2); END_TEST\n" >sum.st
expect 0 stc test --no-opt sum.st
expect 0 stc test sum.st
