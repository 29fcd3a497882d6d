#!/bin/sh
# The runner of golden files: a file that expects nothing fails, and an update writes no name that
# the program does not have.
. "$(dirname "$0")/lib.sh"

golden() { "$bin/golden" "$@"; }
program='PROGRAM Main VAR n : INT; END_VAR n := n + 1; END_PROGRAM'
file() { printf '%s\n' "// MODE: $1" "$program" "$2" >test.st; }

for mode in "run --scans 2" check ir; do
  file "$mode" ''
  expect 1 golden test.st
  said 'no `// CHECK` line: the file expects nothing'
done
file 'run --scans 2' '// CHECK:SCAN 2: Main.n=2'
expect 0 golden test.st
file check '// CHECK: nothing is wrong'
expect 0 golden test.st
file check '// CHECK: 2:1: warning[W0003]: something'
expect 1 golden test.st

# An update fills in values, and the words of a clean check.
file 'run --scans 2' '// CHECK:SCAN 2: Main.n=9'
expect 0 golden --update test.st
grep -qx '// CHECK:SCAN 2: Main.n=2' test.st || fail "not updated"
file check ''
expect 0 golden --update test.st
grep -qx '// CHECK: nothing is wrong' test.st || fail "not updated"

# A mistyped name stays as it is, in both forms, until its author writes that it is meant.
for line in '// CHECK:SCAN 2: Main.typo=1' '// > show Main.typo'; do
  file 'run --scans 2' "$line"
  cp test.st before
  expect 1 golden --update test.st
  said 'line 3 shows a variable that is not there; if that is meant, write `.no such variable.`'
  cmp -s test.st before || fail "written"
done
file 'run --scans 2' '// CHECK:SCAN 2: Main.typo=(no such variable)'
expect 0 golden --update test.st
expect 0 golden test.st
