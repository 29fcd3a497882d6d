#!/bin/sh
# E-27, E-30, E-32: who has what, what differs, an edit taken back or accepted on many
# controllers, and runs that go on where they ended. E-14: somebody is faster than the tool.
. "$(dirname "$0")/lib.sh"

# project FILE A B C MORE
project() {
  cat >"$1" <<ST
VAR_GLOBAL level : INT; ${5:-} END_VAR
FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : INT; END_VAR n := n + $3; level := n; END_FUNCTION_BLOCK
FUNCTION_BLOCK C VAR_OUTPUT n : INT; END_VAR n := n + $4; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; c1 : C; END_VAR a1(); b1(); c1(); END_PROGRAM
ST
}
fits() { awk 'length($0) > 80 { exit 1 }' out || fail "wider than 80 columns"; }
project original.st 1 1 1
project new.st 2 20 1
project own.st 1 1 7 'mine : ARRAY[0..9] OF INT; '
expect 0 stc fleet original.st new.st -o x.fleet
for name in one two three; do serve $name original.st; done
serve four own.st
set -- --dir one --dir two --dir three --dir four

# Without a fleet file: what differs between the controllers, and who is odd.
expect 1 stvm fleet status "$@"
said '^part +one .2 +four$'
said '^unit C +[0-9a-f]{8} +[0-9a-f]{8}[*]$'
said '^global mine +- +[0-9a-f]{8}[*]$'
said '^one .2: one, two, three$'
said '[0-9]+ part.s. are the same on all'
if grep -q '^unit A ' out; then fail "what is the same is shown"; fi
fits
expect 1 stvm fleet status "$@" --all
said '^unit A +[0-9a-f]{8} +[0-9a-f]{8}$'
expect 0 stvm fleet status --dir one --dir two
said '^one +original +reached'
expect 1 stvm fleet status "$@" --format json
json '[(p["name"], [c["odd"] for c in p["controllers"]]) for p in d["parts"] if p["kind"] == "unit"] ==
      [("A", [False] * 4), ("B", [False] * 4), ("C", [False] * 3 + [True]), ("Main", [False] * 4)]'

# Two of them, and each against the file.
expect 1 stvm fleet diff one four
said '^unit C +[0-9a-f]{12} +[0-9a-f]{12}$'
said '^global mine +- +[0-9a-f]{12}$'
said '^mine +- +ARRAY'
expect 0 stvm fleet diff one two
said 'nothing differs'
expect 1 stvm fleet diff x.fleet --dir four --format json
json '[p["name"] for p in d["comparisons"][0]["parts"]] == ["A", "B", "C", "mine"] and
      d["comparisons"][0]["variables"] == [{"name": "mine", "one": "",
        "other": "ARRAY[0..9] OF INT", "initial_value": False}]'
expect 7 stvm fleet diff x.fleet --dir nobody
expect 2 stvm fleet diff
expect 2 stvm fleet diff x.fleet

# E-27, E-30: who is not done is left, and `continue` goes on with them.
kill -STOP "$(cat two.pid)"
expect 7 stvm fleet change x.fleet --dir two --yes --allow-overrun --timeout 1
kill -CONT "$(cat two.pid)"
said '^not done: R0404: .*does not answer'
said '^two +unreachable +R0404: '
expect 0 stvm fleet change x.fleet --dir one --dir three --dir four --yes --allow-overrun
said '^four +own +done '
said '^1 left: .stvm fleet continue x.fleet. goes on with them$'
[ "$(grep -c '^name = "two"$' x.fleet.left)$(grep -c '^\[' x.fleet.left)" = 11 ] || fail "who is left"
expect 2 stvm fleet continue x.fleet --dir two --yes
said 'leave out --dir'
cp x.fleet.left kept.left
mkdir elsewhere
(cd elsewhere && expect 0 stvm fleet continue ../x.fleet --yes --allow-overrun)
[ ! -e x.fleet.left ] || fail "nobody is left"
expect 7 stvm fleet continue x.fleet --yes
said 'R0305.*there is no run to continue'
expect 0 stvm edits --dir two
said '^  POUs +A .body., B .body.$'
sed 's/^# change ./# change 0/; t; s/^# change 0/# change 1/' kept.left >x.fleet.left
expect 7 stvm fleet continue x.fleet --yes
said 'of another fleet file'
rm x.fleet.left

# E-32: an edit of somebody else on top of it stays; the same again touches only those not done.
sed 's/n := n + 1; END_FUNCTION_BLOCK/n := n + 9; END_FUNCTION_BLOCK/' new.st >nines.st
expect 0 stvm change nines.st --dir three --yes --allow-overrun
expect 2 stvm fleet undo x.fleet "$@"
said 'cannot ask for confirmation: stdin is not a terminal'
expect 0 stvm fleet undo x.fleet "$@" --dry-run --allow-overrun
said '^one +original +possible +E1 *$'
expect 0 stvm fleet undo x.fleet "$@" --yes --allow-overrun
said '^one +original +undone +E1 +pause [0-9]+ us, missed [0-9]+$'
said '^three +nines +undone +E1 '
fits
expect 0 stvm edits --dir three
said '^E3 '
expect 0 stvm fleet status x.fleet "$@"
said '^unit A +ok$'
expect 0 stvm fleet undo x.fleet "$@" --yes --format json
json '[c["outcome"] for c in d["controllers"]] == ["had it not"] * 4'
expect 0 stvm undo --dir three --yes
expect 0 stvm undo --dir three --yes
expect 0 stvm undo --dir three --yes

expect 0 stvm fleet change x.fleet --dir one --dir two --yes --allow-overrun --jobs 2
said '^(one|two): done$'
expect 2 stvm fleet change x.fleet "$@" --jobs 2
said 'jobs cannot ask about each controller; pass --yes'
expect 2 stvm fleet change x.fleet "$@" --jobs 2 --one-by-one --yes
expect 2 stvm fleet change x.fleet "$@" --jobs 0 --yes
expect 0 stvm fleet accept x.fleet "$@" --yes
said '^one +original +accepted +E2 *$'
said '^three +original +had it not +- *$'
expect 0 stvm fleet accept x.fleet "$@" --yes
said '^one +original +had it$|^one +original +had it +$'

# E-27: one by one, each when it answers. A file of those left is written before the first of them.
stvm fleet change x.fleet --dir three --dir "$work/late" --one-by-one --yes --allow-overrun >walk.out \
  2>walk.err &
echo $! >walk.pid
mkdir late
wait_for '^waiting for: .*late$' cat walk.err
[ "$(grep -c '^\[' x.fleet.left)" = 1 ] || fail "three is done"
serve late original.st
code=0
wait "$(cat walk.pid)" || code=$?
rm walk.pid
cp walk.out out
[ "$code" -eq 0 ] || fail "exit code $code one by one"
said '^three +original +done '
said 'late +original +done '

# --wait: until somebody else has accepted or undone his edit; what he leaves is checked anew.
serve waits original.st
expect 0 stvm change own.st --dir waits --yes --allow-overrun
"$bin/stvm" fleet change x.fleet --dir waits --wait --yes --allow-overrun >waits.out 2>&1 &
echo $! >fleet.pid
expect 0 stvm undo --dir waits --yes
code=0
wait "$(cat fleet.pid)" || code=$?
rm fleet.pid
cp waits.out out
[ "$code" -eq 0 ] || fail "exit code $code of a run that waits"
said '^waits +original +done '

# Where only stvm is, it says which package has what a command needs.
mkdir alone
cp "$bin/stvm" alone
expect 7 alone/stvm run original.st --scans 1 --virtual-time
said 'R0501: .*alone/stc: .*; it comes with the package stc$'
expect 7 alone/stvm fleet list x.fleet
said 'stvm-fleet: .*; it comes with the package stc$'

# E-14: between the check and the package somebody else has changed it. The compiler is slow here.
mkdir slow
cp "$bin/stvm" "$bin/stvm-fleet" slow
cat >slow/stc <<SH
#!/bin/sh
if [ ! -e $work/faster ]; then
  touch $work/faster
  "$bin/stvm" change $work/hers.st --dir $work/five --yes --allow-overrun >/dev/null || exit 1
fi
exec "$bin/stc" "\$@"
SH
chmod +x slow/stc
project hers.st 1 1 5
serve five original.st
serve six original.st
expect 1 slow/stvm fleet change x.fleet --dir five --dir six --yes --allow-overrun
said '^five +original +refused +2 of 2 +R0301: '
said '^six +original +done '
expect 0 stvm edits --dir five
said '^  POUs +C .body.$'
[ "$(grep -c '^E' out)" = 1 ] || fail "something else was switched"
expect 0 slow/stvm fleet continue x.fleet --yes --allow-overrun
said '^five +hers +done '
