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

# --- expressions of wires are boxes of functions for other editors
forms='tc6-2.01 61131-10'
cat >expression.st <<'S'
PROGRAM P
VAR n, sum, high : INT; r : REAL; low, off : BOOL; t : TIME; END_VAR
FBD
  WIRE e := ADD(n, 1);
  n := e;
  r := (e - n - 1) * 2.0 / 4.0;
  WIRE some := MUL(EN := e > 1, e MOD 2 + 1, 10 - e);
  sum := sum + some;
  low := NOT (e < 2 OR e >= 3) & (some.ENO XOR off);
  high := SEL(e = 2, MAX(e, n, 3 * n), IN1 := e * e);
  WIRE long := MUL(T#1s, e);
  t := long + T#1ms * n;
  RETURN IF e <> 2;
  off := e > 1 AND NOT off;
END_FBD
END_PROGRAM
S
same expression 4 P.n P.sum P.high P.r P.low P.off P.t
grep -qx P.t=T#4s4ms expression.values || fail "$(cat expression.values)"
needs_xml stc export expression.st -o expression.xml --force --as tc6-2.01 --without-sources
grep -q '<block .*typeName="GE"' expression.xml || fail "no box of a comparison"

# What no box of a function says goes out as text, and is said.
printf 'PROGRAM P\nVAR n : INT; a : ARRAY[0..9] OF INT; END_VAR\nFBD\n  WIRE e := ADD(n, 1);\n  n := a[e];\nEND_FBD\nEND_PROGRAM\n' >index.st
expect 0 stc export index.st -o index.xml
grep -q W0074 err || fail "an index is not said: $(cat err)"
expect 0 stc import index.xml -o index
cmp index.st index/index.st || fail "the index of a wire is lost"
expect 1 stc export index.st -o index2.xml --without-sources

# --- outputs of functions in rungs: variables behind `=>`, and power
forms='tc6-2.01 61131-10'
cat >outputs.st <<'S'
FUNCTION Split : INT
VAR_INPUT value : INT; END_VAR
VAR_OUTPUT rest : INT; big : BOOL; END_VAR
  rest := value MOD 10;
  big := value > 100;
  Split := value / 10;
END_FUNCTION

FUNCTION Tell
VAR_INPUT value : INT; END_VAR
VAR_OUTPUT half : INT; END_VAR
  half := value / 2;
END_FUNCTION

PROGRAM P
VAR n : INT := 71; v, r, w, h : INT; b, d, e, f : BOOL; END_VAR
  LADDER
    |--[ n := n + 10 ]--[ v := Split(value:=n, rest=>r, big=>b) ]--( d )--|

    |--[ Split(EN:=_, value:=n, =>w, rest=>r, big=>_) ]------------( e )--|

    |--[ n > 81 ]--[ Tell(EN:=_, value:=n, half=>h) ]--------------( f )--|
  END_LADDER
END_PROGRAM
S
cp outputs.st outputs.kept
expect 0 stc fmt outputs.st
cmp outputs.st outputs.kept || fail "stc fmt changes outputs of functions: $(cat outputs.st)"
same outputs 3 P.v P.r P.w P.h P.b P.d P.e P.f
grep -qx P.h=50 outputs.values || fail "$(cat outputs.values)"
sed -n '/|--/p' outputs.st | sed 's/^ *//' >rungs
for form in $forms; do
  sed -n '/|--/p' outputs-$form/P.st | sed 's/^ *//' | cmp - rungs || fail "$form: $(cat outputs-$form/P.st)"
done
# Other tools write no pin for the result that a function has not.
needs_xml stc export outputs.st -o outputs.xml --force --as tc6-2.01 --without-sources
python3 - <<'P'
import re
text = open("outputs.xml").read()
whole = re.search('<block [^>]*typeName="Tell".*?</block>', text, re.S).group(0)
less = re.sub('<variable formalParameter="OUT">.*?</variable>', "", whole, flags=re.S)
assert less != whole
open("no_result.xml", "w").write(text.replace(whole, less))
P
expect 0 stc import no_result.xml -o no_result
cmp no_result/P.st outputs-tc6-2.01/P.st || fail "an output is taken for a result: $(cat no_result/P.st)"
