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
