#!/bin/sh
# stc export --without-sources, then stc import: by the elements alone comes back what went out.
. "$(dirname "$0")/lib.sh"

# --- Attributes in front of a GVL hold for all of its blocks: paths and RETAIN values stay.
mkdir lists
cat >lists/GVL.st <<'S'
{attribute 'qualified_only'}
VAR_GLOBAL a : INT := 1; END_VAR
VAR_GLOBAL CONSTANT b : INT := 2; END_VAR
VAR_GLOBAL RETAIN c : INT := 3; END_VAR
S
cat >lists/Named.st <<'S'
{attribute 'qualified_only'} {attribute 'list' := 'Own'}
VAR_GLOBAL d : INT := 4; END_VAR
VAR_GLOBAL PERSISTENT e : INT := 5; END_VAR
S
cat >lists/Main.st <<'S'
VAR_GLOBAL x : INT; END_VAR
PROGRAM Main x := GVL.a + GVL.b + GVL.c + Own.d + Own.e; END_PROGRAM
S
needs_xml stc export lists -o lists.xml --without-sources
expect 0 stc import lists.xml -o back
[ "$(cat back/*.st | grep -c "attribute 'qualified_only'")" -eq 5 ] || fail "$(cat back/*.st)"
for form in lists back; do
  expect 0 stc build $form -o $form.img
  expect 0 stvm run $form.img --scans 1 --virtual-time --state
  grep -oE '^[A-Za-z.]+=' out | sort >$form.paths
done
grep -qx 'GVL.c=' lists.paths && cmp lists.paths back.paths || fail "other paths: $(cat back.paths)"

# --- Titles of networks go out as CODESYS writes them, and disabled networks as comments that say
# what they are: both come back where they were, with what stands in front of them.
cat >heads.st <<'S'
PROGRAM Lad
VAR a, b, c, d : BOOL; n : INT; t : TON; END_VAR
LADDER
  {network 'First' disabled}
  (* of the first *)
  |--[ a ]--( b )--|

  {network 'Second'}
  (* of the second *)
  |--[ b ]--( c )--|

  {network disabled}
Off:
  |--[ a ]--[ t: TON  IN:=_, PT:=T#1s ]--( d )--|

  {network 'Twice' disabled}
  |--[ nobody ]--[ n := n + unknown ]--|

On:
  |--[ n := n + 1 ]--|

  {network 'Last' disabled}
  (* first *)
  (* then *)
  |--[ a ]--+--( c )--|
  |--[ b ]--+
END_LADDER
END_PROGRAM
PROGRAM Boxes
VAR n, m : INT; END_VAR
FBD
  {network 'Sum'}
  WIRE sum := ADD(n, 1);
  n := sum;

  {network 'Product' disabled}
  WIRE product := MUL(n, unknown);
  m := product;
END_FBD
END_PROGRAM
PROGRAM Idle
VAR a, b : BOOL; END_VAR
LADDER
  {network disabled}
  |--[ a ]--( b )--|

  {network 'Alone' disabled}
  |--[ b ]--( a )--|
END_LADDER
END_PROGRAM
S
expect 0 stc fmt heads.st
sed -i 's/^  //' heads.st
for form in tc6-2.0 tc6-2.01; do
  expect 0 stc export heads.st -o $form.xml --without-sources --as $form
  expect 0 stc import $form.xml -o $form
  for name in Lad Boxes Idle; do
    sed -n "/^PROGRAM $name/,/^END_PROGRAM/p" heads.st >one.st
    for half in one.st $form/$name.st; do
      sed -n '/^LADDER$/,/^END_LADDER/p;/^FBD$/,/^END_FBD/p' $half >$half.body
    done
    diff one.st.body $form/$name.st.body || fail "$form: heads of $name"
  done
done
for n in 1 2; do
  expect 0 stc export tc6-2.01.xml -o next.xml --without-sources --force
  cp next.xml tc6-2.01.xml
done
rm tc6-2.01/*.body
expect 0 stc import next.xml -o next
diff -r tc6-2.01 next || fail "drawings that were not changed"
# Others see titles, and no element of what is disabled.
[ "$(grep -c '<ElementType xmlns="">networktitle</ElementType>' next.xml)" -eq 7 ] || fail titles
[ "$(grep -c '<coil ' next.xml)" -eq 1 ] || fail "what is disabled"
grep -q 'CDATA\[disabled:' next.xml || fail "a comment shows it"
expect 0 stc export heads.st -o ten.xml --without-sources --as 61131-10
[ "$(grep -c 'W0071.*are comments in IEC 61131-10' err)" -eq 3 ] || fail "what becomes a comment"
expect 0 stc export heads.st -o ten.xml --force --as 61131-10
silent_on err
