#!/bin/sh
# stc fmt: exit codes, what is written and what is not.
. "$(dirname "$0")/lib.sh"

loose() { printf 'program p var n:int;end_var\nn:=1;end_program\n'; }
tidy() { printf 'PROGRAM p\nVAR n : int; END_VAR\n  n := 1;\nEND_PROGRAM\n'; }
loose >a.st
tidy >want.st
printf 'PROGRAM p n := ; END_PROGRAM\n' >bad.st
cp bad.st bad.orig

expect 1 stc fmt --check a.st
said '^a\.st$'
expect 1 stc fmt --diff a.st
said '^-n:=1;end_program$'
said '^\+  n := 1;$'
patch -s -o patched.st a.st out && cmp patched.st want.st || fail "--diff is no patch"
expect 1 stc fmt --check --format json a.st want.st
said '"file":"a.st","status":"changed"'
said '"file":"want.st","status":"unchanged"'
said '"changed":1,"errors":0'
loose | cmp - a.st || fail "--check wrote"

chmod 640 a.st
expect 0 stc fmt a.st
silent_on out
cmp a.st want.st || fail "not formatted"
[ "$(stat -c %a a.st)" = 640 ] || fail "permissions changed"
expect 0 stc fmt --check a.st

# R-02: what `stc check` is given may be given here; the layout is the same, a mistake is one.
cp a.st same.st
expect 0 stc fmt --dialect iec --define A=1 --resource R --name n -j2 -Werror same.st
cmp same.st want.st || fail "options of the compiler changed the layout"
expect 2 stc fmt --dialect pascal same.st
said 'pascal'
expect 2 stc fmt --jobs 0 same.st
said '--jobs 0 is not 1 to'
expect 2 stc fmt --define =1 same.st
expect 2 stc fmt -W W9999=off same.st

expect 1 stc fmt bad.st
said 'bad\.st:1:16: error\[E1005\]'
cmp bad.st bad.orig || fail "a file with errors was changed"
loose >c.st
expect 1 stc fmt bad.st c.st
cmp c.st want.st || fail "the good file beside the bad one was left"
expect 1 stc fmt --check --format json bad.st
said '"status":"error"'

mkdir -p project/sub
loose >project/sub/a.st
ln -s sub/a.st project/link.st
printf '[format]\nindent = 4\nkeyword_case = "keep"\n' >project/stc.toml
expect 0 stc fmt project
grep -q '^    n := 1;$' project/sub/a.st || fail "stc.toml not used"
[ -L project/link.st ] || fail "a link was replaced"
loose >project/sub/a.st
expect 0 stc fmt project/sub/a.st
grep -q '^    n := 1;$' project/sub/a.st || fail "stc.toml above the file not used"
expect 0 stc check project/sub/a.st
printf '[format]\nwidth = 5\n' >project/stc.toml
expect 7 stc fmt project
said 'format.width. must be a whole number between 40 and 1000'
expect 7 stc check project
printf '[format]\ncolour = 5\n' >project/stc.toml
expect 7 stc fmt project
said 'known in \[format\] are indent'

loose | { "$bin/stc" fmt --stdin >out 2>err || fail "--stdin"; }
cmp out want.st || fail "--stdin"
if "$bin/stc" fmt --stdin <bad.st >out 2>err; then fail "--stdin with errors"; fi
silent_on out
expect 2 stc fmt
expect 2 stc fmt --stdin a.st
expect 2 stc fmt --format sarif a.st
expect 7 stc fmt nothing.st
if ls -R | grep -q tmp; then fail "temporary files left"; fi

# Line ends and other bytes.
printf '\357\273\277program p\r\n(* \344 *)\r\nend_program\r\n' >dos.st
expect 0 stc fmt dos.st
printf '\357\273\277PROGRAM p\r\n  (* \344 *)\r\nEND_PROGRAM\r\n' | cmp - dos.st || fail "bytes"

# What is no sound text in a branch that does not count is an error with its place, and no internal one.
printf 'PROGRAM P VAR n : INT; END_VAR\n{IF defined(FAST)}\nLD (1\n{ELSE}\nLD 2\nADD 1\n{END_IF}\nST n\nEND_PROGRAM\n' >branch.st
cp branch.st kept.st
expect 1 stc fmt branch.st
said '^branch.st:3:4: error.E1011.: the branches of conditional compilation differ'
cmp branch.st kept.st || fail "it was laid out"
printf 'PROGRAM P VAR n : INT; END_VAR\n{IF defined(FAST)}\nLD PROGRAM\n{ELSE}\nLD 2\nADD 1\n{END_IF}\nST n\nEND_PROGRAM\n' >branch.st
cp branch.st kept.st
expect 1 stc fmt branch.st
said '^branch.st:5:1: error.E1003.: the branches of conditional compilation in front of this cannot be laid'
cmp branch.st kept.st || fail "it was laid out"
