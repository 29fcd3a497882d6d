#!/bin/sh
# What is exported as a drawing runs in the same order when it comes back: contacts are read where
# they stood, branches with coils keep their rows, and alternatives of charts go by the same rule.
. "$(dirname "$0")/lib.sh"

# same NAME SCANS VARIABLE...: from NAME.st and from both forms of XML the values are the same
same() {
  name=$1
  scans=$2
  shift 2
  prints=
  for variable in "$@"; do prints="$prints --print $variable"; done
  expect 0 stvm run "$name.st" --scans "$scans" --virtual-time $prints
  cp out "$name.values"
  for form in $forms; do
    rm -rf "$name-$form"
    needs_xml stc export "$name.st" -o "$name.xml" --force --as "$form" --without-sources
    expect 0 stc import "$name.xml" -o "$name-$form"
    if grep -q W0075 out err; then fail "$form: no ladder: $(cat "$name-$form"/P.st)"; fi
    expect 0 stvm run "$name-$form" --scans "$scans" --virtual-time $prints
    cmp -s "$name.values" out || fail "$form: $(paste "$name.values" out | tr '\n' ' ')"
  done
}

# --- a contact in one branch, a coil of it in the next, and both join
forms='tc6-2.01 61131-10'
cat >contact.st <<'S'
PROGRAM P
VAR a : BOOL := TRUE; b, c, d : BOOL; n : INT; END_VAR
LADDER
  |--[ a ]--+--(/ d )--[ b ]--+--( c )--|
  |         |                 |
  |         +--(S b )--[ d ]--+
END_LADDER
END_PROGRAM
S
same contact 1 P.b P.c P.d
grep -qx P.c=FALSE contact.values || fail "$(cat contact.values)"

# --- branches at the rail with coils in them: each row would look like a rung (E1050)
cat >coils.st <<'S'
PROGRAM P
VAR a, b, c, d, e, f : BOOL; n : INT; END_VAR
LADDER
  |--+--[ n = 2 ]--+--( c )--|
  |  |             |
  |  +--[/ a ]-----+
  |  |             |
  |  +--(/ b )-----+

  |--+--[ a ]------+--+--[ n < 3 ]-------------------+--(P d )--|
  |  |             |  |                              |
  |  +--[ n < 2 ]--+  +--(N e )--[ n := ADD(n, 1) ]--+

  |--+--+--( f )---+--[ n > 0 ]--+--(/ a )--|
  |  |  |          |             |
  |  |  +--(R f )--+             |
  |  |                           |
  |  +--[ n = 7 ]----------------+
END_LADDER
END_PROGRAM
S
same coils 4 P.a P.b P.c P.d P.e P.f P.n

# --- alternatives of which one leaves two steps; the order of the text says which goes
forms=tc6-2.01
cat >chart.st <<'S'
PROGRAM P
VAR n : INT; END_VAR
INITIAL_STEP s0: END_STEP
STEP s1: END_STEP
STEP s2: END_STEP
STEP s3: END_STEP
STEP s4: END_STEP
TRANSITION FROM s0 TO (s1, s2) := TRUE; END_TRANSITION
TRANSITION FROM (s1, s2) TO s3 := TRUE; END_TRANSITION
TRANSITION FROM s1 TO s4 := TRUE; END_TRANSITION
END_PROGRAM
S
same chart 3 P.s3.X P.s4.X
grep -qx P.s3.X=TRUE chart.values || fail "$(cat chart.values)"
