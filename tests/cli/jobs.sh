#!/bin/sh
# An image is the same to the byte on any number of threads (--jobs), optimised or not, with
# functions that take others in, and linked against a base; errors are the same ones.
. "$(dirname "$0")/lib.sh"

# 240 blocks, each with a chain of functions that are small enough to be taken in. $1: a constant.
plant() {
  awk -v gain="$1" 'BEGIN {
    for (i = 0; i < 240; i++) {
      printf "FUNCTION Low%d : INT VAR_INPUT x : INT; END_VAR Low%d := x AND %d; END_FUNCTION\n", i, i, i
      printf "FUNCTION Mid%d : INT VAR_INPUT x : INT; END_VAR Mid%d := Low%d(x) + %d; END_FUNCTION\n", i, i, i, gain
      printf "FUNCTION_BLOCK Block%d VAR_INPUT go : BOOL; END_VAR VAR n : INT; t : TON; a : ARRAY[0..9] OF INT; END_VAR\n", i
      printf "IF go THEN n := Mid%d(n) + Low%d(n); a[n MOD 10] := n; END_IF t(IN := go, PT := T#%dms);\n", i, (i + 7) % 240, i + 1
      print "END_FUNCTION_BLOCK"
    }
    print "PROGRAM Main VAR"
    for (i = 0; i < 240; i++) printf "b%d : Block%d;\n", i, i
    print "END_VAR"
    for (i = 0; i < 240; i++) printf "b%d(go := TRUE);\n", i
    print "END_PROGRAM"
  }'
}
plant 3 >plant.st
plant 5 >edited.st
stc build plant.st -q --jobs 1 -o one.img
stc build plant.st -q --jobs 1 --no-opt -o plain.img
stc build edited.st -q --jobs 1 --name plant --base one.img -o next.img
cmp -s one.img plain.img && fail "the optimiser has nothing to do here"
cmp -s one.img next.img && fail "the edit changes nothing"
for jobs in 2 4 64; do
  for round in 1 2 3; do
    stc build plant.st -q --jobs $jobs -o many.img
    cmp one.img many.img || fail "--jobs $jobs, round $round: another image"
  done
  stc build plant.st -q --no-opt -j $jobs -o many.img
  cmp plain.img many.img || fail "--no-opt --jobs $jobs: another image"
  stc build edited.st -q --jobs $jobs --name plant --base one.img -o many.img
  cmp next.img many.img || fail "--base --jobs $jobs: another image"
done

# All but the first ten functions are too much for the linker; the first of them is named.
awk 'BEGIN {
  for (i = 0; i < 60; i++) {
    printf "FUNCTION F%d : INT VAR_INPUT x : INT; END_VAR VAR big : ARRAY[0..%d] OF INT; s, u : STRING; END_VAR\n", i, i < 10 ? 9 : 70000
    printf "big[x] := x; u := CONCAT(s, s); F%d := LEN(u); END_FUNCTION\n", i
  }
  print "PROGRAM Main VAR n : INT; END_VAR"
  for (i = 0; i < 60; i++) printf "n := F%d(n);\n", i
  print "END_PROGRAM"
}' >far.st
for jobs in 1 2 4 4 4; do
  expect 7 stc build far.st --jobs $jobs -o far.img
  said '^stc: R0204: `F10`: its frame is too large'
done

expect 2 stc build plant.st --jobs 0
said 'R.*--jobs 0 is not 1 to 256'
expect 2 stc build plant.st --jobs 257
said '--jobs 257 is not 1 to 256'
expect 2 stc build plant.st --jobs many
said 'jobs'
