#!/bin/sh
# X2: rules of an online change go out by PLCopen XML and come in again, each with all that it says;
# rules and attributes of members stay theirs; of conditional text goes out what is compiled.
. "$(dirname "$0")/lib.sh"
cat >a.st <<'S'
TYPE P : STRUCT x : INT; END_STRUCT END_TYPE
TYPE A : STRUCT m : INT; END_STRUCT END_TYPE
{migration of := 'A', from := 'B'}
FUNCTION Move VAR_INPUT {old := 'n'} before : INT; END_VAR VAR_OUTPUT m : INT; END_VAR
  m := before;
END_FUNCTION
{migration of := 'A', inverse}
FUNCTION Back VAR_INPUT m : INT; END_VAR VAR_OUTPUT {old := 'n'} before : INT; END_VAR
  before := m;
END_FUNCTION
{renamed from := 'Drive', 'Engine'}
FUNCTION_BLOCK Motor
VAR {renamed '.x' from := 'low', 'lower'} p : P; END_VAR
  p.x := p.x + 1;
{IF defined(Fast)}
  p.x := p.x + 100; (* { $'IF$' *)
{ELSE}
  p.x := p.x + 10;
{END_IF}
{renamed from := 'Go'}
{attribute 'monitoring' := 'call'}
METHOD Run : INT
  Run := p.x;
END_METHOD
{IF defined(Fast)}
METHOD Sprint : INT
  Sprint := 1;
END_METHOD
{END_IF}
END_FUNCTION_BLOCK
PROGRAM Main
VAR m : Motor; n : INT; END_VAR
  m(); n := m.Run();
END_PROGRAM
S
needs_xml stc export a.st -o first.xml

# rules FILE: what stands in it, on lines of their own.
rules() {
  for line in "{renamed from := 'Drive', 'Engine'}" "{renamed '.x' from := 'low', 'lower'}" \
    "{migration of := 'A', from := 'B'}" "{migration of := 'A', inverse}" \
    "{renamed from := 'Go'}" "{attribute 'monitoring' := 'call'}"; do
    [ "$(grep -cF "$line" "$1")" = 1 ] || fail "not once in $1: $line"
  done
}
for form in tc6-2.0 tc6-2.01; do
  expect 0 stc export a.st --as $form --without-sources -o $form.xml
  said 'note\[W0071\]: what .IF ....  *leaves out is not in the document'
  expect 0 stc import $form.xml -o $form
  cat $form/*.st >all.st
  rules all.st
  grep -q 'p.x := p.x + 10;' all.st || fail "the branch that is compiled is not there"
  grep -q -e 'p.x + 100' -e Sprint -e '{IF' all.st && fail "what is left out went out"
  # A rule in front of a method is no text of the body.
  sed -n '/METHOD Run/,/END_METHOD/p' all.st | grep -q renamed && fail "the rule is in the method"
done

expect 0 stc export a.st --define Fast --without-sources -o fast.xml
expect 0 stc import fast.xml -o fast
cat fast/*.st >all.st
rules all.st
grep -q 'METHOD Sprint' all.st || fail "a method of a condition is not there"
grep -q 'p.x := p.x + 100;' all.st || fail "the other branch is not there"
grep -q 'p.x + 10;' all.st && fail "what is left out went out"

# With the sources in the document everything comes back.
expect 0 stc export a.st -o whole.xml
expect 0 stc import whole.xml -o whole
grep -q '{ELSE}' whole/*.st || fail "the sources did not come back"

# A carriage return within a line would be the end of one in XML, and of the comment.
printf 'PROGRAM P\nVAR n : INT; END_VAR\n  // one\rline\n  n := n + 1;\nEND_PROGRAM\n' >cr.st
expect 0 stc export cr.st -o cr.xml
expect 0 stc import cr.xml -o cr
expect 0 stc check cr/*.st
