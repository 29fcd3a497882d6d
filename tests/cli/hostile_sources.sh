#!/bin/sh
# Sources of a few lines or megabytes that describe more than any machine has room for: each is
# built, or refused with the name of a limit, and memory that runs out is a message. No build may
# have more than 3 GB of addresses and a minute of processor time; what is built here fits into far
# less.
. "$(dirname "$0")/lib.sh"

if grep -q '^STC_SANITIZE:STRING=.' "$2/CMakeCache.txt"; then
  echo "left out: sanitizers reserve terabytes of addresses and have a heap of their own"
  exit 77
fi

# within KIB CODE COMMAND...
within() {
  kib=$1
  shift
  expect "$1" sh -c 'ulimit -t 60; ulimit -v "$1"; shift; exec "$@"' sh "$kib" "$bin/stc" "$2" "$3" -o out.img -q
}
builds() { within 3000000 0 build "$1"; }
refuses() {  # refuses FILE REGEX CODE
  within 3000000 "$3" build "$1"
  said "$2"
}
main() { printf 'PROGRAM Main\nVAR\n  %s\nEND_VAR\n  %s\nEND_PROGRAM\n' "$1" "$2"; }
block='FUNCTION_BLOCK F VAR n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK'

# Memory runs out: by kMaxBuildBytes and kMaxBuildBytesPerByte, and by the machine's limit.
{ echo "$block"; main 'a : ARRAY[1..16000000] OF F;' 'a[1]();'; } >instances.st
expect 7 stc build instances.st -o out.img
said 'stc: R0118: memory needed exceeds the limit: more than 2048 MiB for [0-9]+ bytes of input'
said 'help: Make large arrays of function blocks'
said '[(]kMaxBuildBytes, kMaxBuildBytesPerByte[)]'
[ ! -e out.img ] || fail "an image in spite of the limit"
within 200000 7 build instances.st
said 'stc: R0118: memory needed exceeds the limit: the machine gives no more than [0-9]+ MiB'
said 'help: Raise the limit of the shell'

# Many instances, long lists of initial values.
{ echo "$block"; main 'a : ARRAY[1..1000000] OF F;' 'a[1]();'; } >many.st
builds many.st
{ echo "$block"; main 'a : ARRAY[1..8000000] OF F;' 'a[1]();'; } >more.st
within 2100000 0 build more.st
{ echo VAR_GLOBAL; seq 3500000 | sed 's/.*/g& : INT;/'; echo END_VAR; main '' 'g1 := g2;'; } >globals.st
refuses globals.st 'R0118: memory needed exceeds the limit: more than [0-9]+ MiB' 7
rm globals.st
# Ordinary code without comments: 60 bytes of memory for each of its own, beside 40 MiB.
seq 20000 | awk '{ printf "FUNCTION_BLOCK Block_%d\nVAR_INPUT a, b : INT; END_VAR\nVAR_OUTPUT q : BOOL; END_VAR\n", $1
  print "VAR n : DINT; END_VAR\n  IF a > b THEN\n    n := n + a * 2;\n  ELSE\n    n := n - b;\n  END_IF"
  print "  q := n > 100;\nEND_FUNCTION_BLOCK" }' >dense.st
main 'x : Block_1;' 'x(a := 1);' >>dense.st
within $((40 * 1024 + $(wc -c <dense.st) * 60 / 1024)) 0 build dense.st
main 'a : ARRAY[1..5000000] OF INT := [5000000(0)];' 'a[1] := a[2];' >list.st
builds list.st
main 'a : ARRAY[1..5000000] OF INT := [2500000(1, 2)];' 'a[1] := a[2];' >pairs.st
builds pairs.st

# Types that hold the one before twice: 2^30 bytes, whose parts are never looked at one by one.
awk 'BEGIN { print "TYPE s0 : STRUCT a : BYTE; END_STRUCT;"
  for (i = 1; i < 31; ++i) printf "s%d : STRUCT a, b : s%d; END_STRUCT;\n", i, i - 1
  print "END_TYPE" }' >doubling.st
main 'x : s29; y : s29;' 'x := y; x.a := y.b;' >>doubling.st
builds doubling.st
# The same in a block that looks at the shape of what it holds, as FB_Reinit makes it.
sed '/^PROGRAM/,$d' doubling.st >shapes.st
cat >>shapes.st <<'EOF'
FUNCTION_BLOCK Holder
VAR list : s29; END_VAR
METHOD FB_Init : BOOL
VAR_INPUT bInitRetains : BOOL; bInCopyCode : BOOL; END_VAR
list.a := list.b;
END_METHOD
END_FUNCTION_BLOCK
EOF
main 'x : Holder;' 'x();' >>shapes.st
builds shapes.st
# 2^40 parts of types without a name. What is too large is said, and nothing else is looked for.
awk 'BEGIN { printf "TYPE T : STRUCT "; for (i = 0; i < 40; ++i) printf "a, b : STRUCT "
  printf "x : BIT; "; for (i = 0; i < 40; ++i) printf "END_STRUCT; "; print "END_STRUCT END_TYPE" }' \
  >nameless.st
main 'x : T; y : T;' 'x := y; x.a := y.b;' >>nameless.st
refuses nameless.st 'R0118: `STRUCT a : [^`]* [.][.][.]` needs [0-9]+ bytes; the limit is' 7
[ "$(wc -c <err)" -lt 2000 ] || fail "all of a type without a name in a message"
awk 'BEGIN { print "FUNCTION_BLOCK s0 VAR a : BYTE; END_VAR a := 1; END_FUNCTION_BLOCK"
  for (i = 1; i < 31; ++i) printf "FUNCTION_BLOCK s%d VAR a, b : s%d; END_VAR a(); b(); END_FUNCTION_BLOCK\n", i, i - 1 }' >blocks.st
main 'x : s30;' 'x();' >>blocks.st
refuses blocks.st 'R0204: more than 16777215 instances|R0118' 7

# Depth: 200 levels are as many as an image may have; the program counts as two.
nested() {  # nested LEVELS
  awk -v n="$1" 'BEGIN { print "TYPE s1 : STRUCT a : INT; END_STRUCT;"
    for (i = 2; i <= n; ++i) printf "s%d : STRUCT a : s%d; END_STRUCT;\n", i, i - 1
    print "END_TYPE" }'
  main "x : s$1;" 'x := x;'
}
nested 198 >deep.st
builds deep.st
expect 0 stvm run out.img --virtual-time --scans 1  # the verifier counts in the same way
nested 199 >deep.st
refuses deep.st 'E6001.*`Main` nests structures, arrays and function blocks in more than 200 levels' 1
nested 100000 >deep.st
refuses deep.st 'E6001.*in more than 200 levels' 1
inside() {  # inside BLOCKS
  awk -v n="$1" 'BEGIN { print "FUNCTION_BLOCK f1 VAR n : INT; END_VAR n := 1; END_FUNCTION_BLOCK"
    for (i = 2; i <= n; ++i) printf "FUNCTION_BLOCK f%d VAR a : f%d; END_VAR a(); END_FUNCTION_BLOCK\n", i, i - 1 }'
  main "x : f$1;" 'x();'
}
inside 99 >deep.st
builds deep.st
expect 0 stvm run out.img --virtual-time --scans 1
inside 100 >deep.st
refuses deep.st 'E6001.*`Main` nests .*function blocks in more than 200 levels' 1
inside 30000 >deep.st
refuses deep.st 'E6001.*function blocks in more than 200 levels' 1

# Long lines, brackets, and mistakes without an end.
repeat() { yes "$1" | head -n "$2" | tr -d '\n'; }
main 'x : INT;' "x := $(repeat '(' 100000)1;" >line.st
refuses line.st 'E6001' 1
{ printf 'PROGRAM Main VAR x : INT; END_VAR x := x'; repeat ' + x' 300000; echo '; END_PROGRAM'; } >line.st
refuses line.st 'E6003.*more than 1000 operators' 1
{ echo 'PROGRAM Main VAR x : INT; END_VAR'; yes 'y := 1 $ ;' | head -n 100000; echo END_PROGRAM; } >line.st
refuses line.st 'error' 1

# Every address is looked up by itself, not among all others.
{ echo 'PROGRAM Main VAR x : INT; END_VAR'
  awk 'BEGIN { for (i = 0; i < 40000; ++i) printf "x := %%MW%d;\n", i }'
  echo END_PROGRAM; } >addresses.st
builds addresses.st
