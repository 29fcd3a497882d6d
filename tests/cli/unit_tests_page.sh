#!/bin/sh
# R-11: the examples of docs/UNIT-TESTS.md, as they stand there; `stc explain test`.
. "$(dirname "$0")/lib.sh"
PATH="$bin:$PATH" python3 "$source_dir/tests/cli/page.py" "$source_dir/docs/UNIT-TESTS.md" ||
  fail 'the page shows something else'
expect 0 stc explain test
for word in TEST SETUP TEARDOWN MOCK MOCK_FUNCTION; do said "^  $word "; done
# Every call that a test may make is on both.
table=$source_dir/frontend/sema/tests/test_calls.def
for call in $(sed -n 's/^TEST_CALL([^"]*"\([A-Z_]*\)".*/\1/p' "$table"); do
  said "$call"
  grep -q "$call" "$source_dir/docs/UNIT-TESTS.md" || fail "$call is not on the page"
done
awk 'length($0) > 80 {exit 1}' out || fail 'wider than a terminal'
expect 2 stc explain tests
said 'did you mean .test.'
