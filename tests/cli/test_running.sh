#!/bin/sh
# R-11: how tests run: in a drawn order that can be had again, stopped by a count and not by a
# clock, again on every save; the same in every form.
. "$(dirname "$0")/lib.sh"
for i in $(seq 9); do
  printf "TEST 'number %s' ASSERT_TRUE(TRUE); END_TEST\n" "$i"
done >nine_test.st

# A test has a text for its name, in every dialect.
printf "TEST 'with  blanks, a__b' ASSERT_TRUE(TRUE); END_TEST\n" >iec_test.st
expect 0 stc test iec_test.st --dialect iec
said '^PASS .*a__b'
rm iec_test.st

# The seed is said, and gives the same order again, on any machine.
expect 0 stc test nine_test.st --shuffle
seed=$(sed -n 's/^this order again: --seed //p' out)
[ -n "$seed" ] || fail 'no seed'
grep PASS out >first
expect 0 stc test nine_test.st --seed "$seed"
grep PASS out | cmp -s - first || fail 'another order'
expect 0 stc test nine_test.st --seed 7
grep -o 'number [0-9]' out | tr -d '\nnumber ' >order
[ "$(cat order)" = 584679231 ] || fail "order of seed 7: $(cat order)"
[ "$(grep -c PASS out)" = 9 ] || fail 'not all of them'
expect 0 stc test nine_test.st --seed 7 --filter 'number ?'
expect 0 stc test nine_test.st --seed 7 --format json
json 'd["seed"] == 7 and d["passed"] == 9 and d["tests"][0]["name"] == "number 5"'
expect 0 stc test nine_test.st --seed 7 --format junit
said '<property name="seed" value="7"/>'
expect 0 stc test nine_test.st --seed 7 --format tap
said '^# seed 7$'
expect 0 stc test nine_test.st --seed 7 --list --format json
json 'd["tests"][0]["name"] == "number 5"'
expect 2 stc test nine_test.st --seed x
said 'seed needs a whole number'

# A test that takes too long fails at its line; the others run. No clock decides.
cat >long_test.st <<'ST'
TEST 'long'
VAR i : DINT; END_VAR
  FOR i := 1 TO 5000 DO
    ;
  END_FOR;
END_TEST
TEST 'short' ASSERT_TRUE(TRUE); END_TEST
ST
expect 0 stc test long_test.st
expect 0 stc test long_test.st --timeout 5010
expect 1 stc test long_test.st --timeout 4990
said '1 passed, 0 failed, 1 stopped by a trap'
said 'long_test.st:[35]: the task ran.*\(4990 calls and loop rounds, --timeout\)'
cp out again
expect 1 stc test long_test.st --timeout 4990
sed 's/(0.*//' out >one
sed 's/(0.*//' again | cmp -s - one || fail 'another line'
expect 1 stc test long_test.st --timeout 4990 --format junit
said 'errors="1"'
said 'error type="fuel"'
expect 2 stc test long_test.st --timeout 0
said 'no test could run; the least is 1'
expect 2 stc test long_test.st --timeout soon

# --watch: again at each save, what failed first.
mkdir plant
cat >plant/pump.st <<'ST'
FUNCTION_BLOCK Pump
VAR_OUTPUT n : INT; END_VAR
  n := n + 1;
END_FUNCTION_BLOCK
PROGRAM Main
VAR p : Pump; END_VAR
  p();
END_PROGRAM
ST
cat >plant/pump_test.st <<'ST'
TEST 'always' ASSERT_TRUE(TRUE); END_TEST
TEST 'counts' VAR p : Pump; END_VAR p(); ASSERT_EQ(p.n, 1); END_TEST
ST
save() { cat >"$1.new" && mv "$1.new" "$1"; }
"$bin/stc" test plant --watch >watch.out 2>watch.err </dev/null &
echo $! >watch.pid
wait_for '2 passed, 0 failed' cat watch.out
sed 's/n + 1/n + 2/' plant/pump.st | save plant/pump.st
wait_for '1 passed, 1 failed' cat watch.out
grep -q '^built 1 POU in' watch.err || fail 'not on the resident compiler'
grep -q 'expected 1, got 2' watch.out || fail 'no reason'
sed 's/n + 2/n + x/' plant/pump.st | save plant/pump.st
wait_for 'E2001' cat watch.err
: >watch.out
sed 's/n + x/n + 1/' plant/pump.st | save plant/pump.st
wait_for '2 passed, 0 failed' cat watch.out
grep -a PASS watch.out | head -1 | grep -q counts || fail 'what failed is not the first'
# Statements of tests, and lines that move in front of them.
(printf '\n\n' && sed 's/p.n, 1/p.n, 3/' plant/pump_test.st) | save plant/pump_test.st
wait_for 'counts  .plant/pump_test.st:4.' cat watch.out
wait_for 'pump_test.st:4: expected 3, got 1' cat watch.out
sed 's/p.n, 3/p.n, 1/' plant/pump_test.st | save plant/pump_test.st
# New tests are found, too.
printf "TEST 'third' ASSERT_TRUE(FALSE); END_TEST\n" | save plant/third_test.st
wait_for '2 passed, 1 failed' cat watch.out
kill "$(cat watch.pid)"
expect 2 stc test --watch
said 'watch needs PATHS'
expect 2 stc test plant --watch --list
expect 2 stc test plant --watch --format json
said 'shows text'

# What catches traps catches no assertion, and TEARDOWN hides no reason.
mkdir caught
cat >caught/code.st <<'ST'
FUNCTION Check : INT
VAR_INPUT x : INT; END_VAR
  Check := 10 / x;
END_FUNCTION
FUNCTION Careful : INT
VAR_INPUT x : INT; END_VAR
  __TRY Careful := Check(x); __CATCH Careful := -1; __ENDTRY
END_FUNCTION
ST
cat >caught/a_test.st <<'ST'
TEST 'in __TRY'
VAR e : DINT; END_VAR
  __TRY ASSERT_EQ(1, 2); __CATCH(e) __ENDTRY
END_TEST
TEST 'in a mock, by the code that calls it'
MOCK_FUNCTION Check : INT
VAR_INPUT x : INT; END_VAR
  ASSERT_EQ(x, 2);
  Check := x;
END_MOCK_FUNCTION
  ASSERT_EQ(Careful(1), 1);
END_TEST
TEST 'behind ENO'
VAR ok : BOOL; r : INT; END_VAR
MOCK_FUNCTION Check : INT
VAR_INPUT x : INT; END_VAR
  ASSERT_EQ(x, 2);
  Check := x;
END_MOCK_FUNCTION
  r := Check(EN := TRUE, x := 1, ENO => ok);
END_TEST
TEST 'other traps are caught'
  ASSERT_EQ(Careful(0), -1);
END_TEST
ST
expect 1 stc test caught
for name in 'in __TRY' 'in a mock, by the code that calls it' 'behind ENO'; do
  grep -q "^FAIL   $name" out || fail "$name passes: $(cat out)"
done
grep -q '^PASS   other traps are caught' out || fail "$(cat out)"
mkdir behind
cat >behind/b_test.st <<'ST'
SETUP
VAR s, n : INT; t : TIME; END_VAR
  s := 7;
END_SETUP
TEARDOWN
  ASSERT_EQ(n, 0, 'left behind');
  ASSERT_EQ(TIME() - t, T#0s, 'time goes on');
END_TEARDOWN
TEST 'own reason'
  n := 1;
  ASSERT_EQ(s, 42, 'the reason');
END_TEST
TEST 'trap'
  n := 1;
  s := s / (s - 7);
END_TEST
TEST 'too long'
  n := 1;
  WHILE TRUE DO s := 1; END_WHILE;
END_TEST
TEST 'behind alone'
  n := 2;
END_TEST
TEST 'time'
  ADVANCE_TIME(T#5s);
  t := TIME();
END_TEST
TEST 'good'
  RETURN;
END_TEST
ST
expect 1 stc test behind --timeout 1000
for line in 'b_test.st:11: the reason: expected 42, got 7; then TEARDOWN, line 6: left behind: expected 0, got 1' \
  'b_test.st:15: division or MOD by zero; then TEARDOWN, line 6: left behind' \
  'b_test.st:19: .* --timeout); then TEARDOWN, line 6: left behind' \
  'b_test.st:6: left behind: expected 0, got 2' '2 passed, 2 failed, 2 stopped by a trap'; do
  grep -q "$line" out || fail "not \`$line\`: $(cat out)"
done
sed -i 's/s := 7;/s := 7 \/ n;/; s/ASSERT_EQ(n, 0/ASSERT_EQ(n, 9/' behind/b_test.st
expect 1 stc test behind
if grep -q TEARDOWN out; then fail "a TEARDOWN without its SETUP: $(cat out)"; fi
