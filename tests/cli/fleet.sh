#!/bin/sh
# E-07 to E-15, E-27 to E-31, E8: one edit for many controllers, each of which may have a program of its
# own. The worked example of system E.
. "$(dirname "$0")/lib.sh"

# project FILE A B C MORE: what A, B and C do, and what else there is.
project() {
  cat >"$1" <<ST
VAR_GLOBAL ${5:-} level : INT; END_VAR
FUNCTION_BLOCK A VAR_OUTPUT n : INT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : INT; END_VAR n := n + $3; level := n; END_FUNCTION_BLOCK
FUNCTION_BLOCK C VAR_OUTPUT n : INT; END_VAR n := n + $4; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; b1 : B; c1 : C; END_VAR a1(); b1(); c1(); END_PROGRAM
ST
}
project original.st 1 1 1
project new.st 2 20 1
project other_b.st 1 100 1
project other_c.st 1 1 7 'mine : ARRAY[0..50] OF LREAL;'
sed '/FUNCTION_BLOCK B/d; s/b1 : B; //; s/b1(); //' original.st >without_b.st

# E-07, E-08: the same two versions are the same file; nothing edited is refused.
expect 0 stc fleet original.st new.st -o x.fleet --author ann --text 'twice as fast'
said '^unit A +edited +[0-9a-f]{12} +[0-9a-f]{12}$'
said '^unit B +edited '
said '^x.fleet: 2 part.s., [0-9]+ bytes, [0-9a-f]{12}$'
expect 0 stc fleet original.st new.st -o y.fleet --author ann --text 'twice as fast' --format json
json 'len(d["parts"]) == 2 and d["parts"][0]["change"] == "edited"'
expect 0 stc dump x.fleet
said '^fleet file [0-9a-f]{12}, by ann: twice as fast$'
said '^unit A +edited '
expect 0 stc dump --parts new.st
said '^unit A +[0-9a-f]{12} *$'
said '^global level +[0-9a-f]{12} *$'
cmp x.fleet y.fleet || fail "the same edit is another file"
expect 7 stc fleet original.st original.st -o z.fleet
said 'R0308'
[ ! -e z.fleet ] || fail "a file of no edit"
expect 2 stc fleet original.st new.st
expect 2 stvm fleet change x.fleet
said 'name controllers'

serve one original.st
serve two other_b.st
serve three other_c.st
serve four new.st
serve five without_b.st
set -- --dir one --dir two --dir three --dir four --dir five --dir nobody

# E-28: nobody is there to ask, so nothing is sent.
expect 2 stvm fleet change x.fleet "$@"
expect 0 stvm edits --dir one
said 'no edit is on trial'

# E-11, E-12: what each has of every edited unit.
expect 1 stvm fleet status x.fleet "$@"
said '^part +one .1 +two +four +five$'
said '^unit A +ok +ok +has it +ok$'
said '^unit B +ok +different[*] +has it +missing[*]$'
said '^one .1: one, three$'
said '^one +original +possible +2 of 2 *$'
said '^two +other_b +refused +1 of 2 +R0320: B is different$'
said '^four +new +had it +2 of 2 *$'
said '^five +without_b +refused +1 of 2 +R0320: B is missing$'
said '^nobody +unreachable +- '
awk 'length($0) > 80 { exit 1 }' out || fail "wider than 80 columns"

# A dry run changes nothing, and says the same.
expect 1 stvm fleet change x.fleet "$@" --dry-run --allow-overrun
said '^one +original +possible +2 of 2 *$'
expect 0 stvm edits --dir one
said 'no edit is on trial'

expect 1 stvm fleet change x.fleet "$@" --yes --allow-overrun --format json
json '[c["outcome"] for c in d["controllers"]] ==
      ["done", "refused", "done", "had it", "refused", "unreachable"]'
json 'd["controllers"][1]["refused"] == "R0320" and d["controllers"][5]["refused"] == "R0404"'
json '[p["state"] for p in d["controllers"][1]["parts"]] == ["ok", "different"]'

# E-09: C of the third is its own, and stays so.
expect 0 stvm get --dir three Main.c1.n
seven=$(sed -n 's/^Main.c1.n=//p' out)
[ $((seven % 7)) -eq 0 ] || fail "another C"
expect 0 stvm edits --dir three
said '^  POUs +A .body., B .body.$'
expect 0 stvm undo --dir three
said 'undone'
expect 0 stvm accept --dir one

# The same run again touches those that are not done (E-31).
expect 1 stvm fleet change x.fleet "$@" --yes --allow-overrun
said '^one +original +had it +2 of 2 *$'
said '^three +other_c +done +2 of 2 +pause [0-9]+ us, missed [0-9]+$'

# E-13: of the second, A alone fits.
expect 0 stvm fleet change x.fleet --dir two --matching --yes --allow-overrun
said '^two +other_b +done +1 of 2 '
expect 0 stvm edits --dir two
said '^  POUs +A .body.$'
expect 0 stvm undo --dir two

# One controller alone takes the file like any other version.
expect 7 stvm change x.fleet --dir two --yes --allow-overrun
said 'R0320.*unit `B` is another one here'
expect 0 stvm change x.fleet --dir two --matching --yes --allow-overrun
expect 0 stvm fleet undo x.fleet --dir two --yes
said '^two +other_b +undone +E[0-9]+ '

expect 2 stvm change new.st --dir two --matching --yes
said 'R0504.*--matching is for a fleet file'

# E-15: what is lost there is said there; the others go on.
project keeps.st 1 1 1 'kept : INT := 3;'
project loses.st 2 1 1
expect 7 stc fleet keeps.st loses.st -o loses.fleet
said 'R0322.*`kept`: removed'
expect 0 stc fleet keeps.st loses.st -o loses.fleet --table free
serve six keeps.st
expect 0 stvm set --dir six kept=9
expect 7 stvm fleet change loses.fleet --dir six --yes --allow-overrun
said 'R0303'
expect 0 stvm fleet change loses.fleet --dir six --yes --allow-overrun --allow-loss

# Damaged files: coded answers, and nobody is asked for anything.
expect 7 stvm fleet status original.st --dir one
said 'R0[0-9]+.*no magic'
python3 - <<'PY'
data = bytearray(open("x.fleet", "rb").read())
data[len(data) // 2] ^= 1
open("flipped.fleet", "wb").write(data)
open("cut.fleet", "wb").write(data[:40])
PY
expect 7 stvm fleet status flipped.fleet --dir one
said 'checksum of its versions is wrong'
expect 7 stvm fleet change cut.fleet --dir one --yes
expect 2 stvm fleet forget x.fleet --dir one
said 'none of its verbs'
expect 2 stvm fleet status x.fleet x.fleet --dir one
expect 2 stvm fleet change --dir one

# E-33: the journal names the file.
digest=$(sha256sum x.fleet | cut -c1-12)
expect 0 stvm journal --dir three
said "edit E[0-9]+, fleet file $digest"

# E-05: what a controller has follows undo, redo, a power loss and a start.
state() {  # state WANTED: of unit A of the third controller
  code=0
  stvm fleet status x.fleet --dir three >out 2>err || code=$?
  said "^unit A +$1$"
}
state 'has it'
expect 0 stvm undo --dir three
state ok
expect 0 stvm redo --dir three --yes --allow-overrun
state 'has it'
power_cut three
serve three
state ok
expect 0 stvm change x.fleet --dir three --yes --allow-overrun
expect 0 stvm accept --dir three
power_cut three
serve three
state 'has it'

# E-28, E-29: at a terminal each is asked for. No: on to the next one; quit: the rest is not asked.
project next_round.st 3 20 1
expect 0 stc fleet new.st next_round.st -o round.fleet
serve seven new.st
serve eight new.st
serve nine new.st
cat >ask.py <<'PY'
import os, subprocess, sys, threading
answers, command = sys.argv[1].split(","), sys.argv[2:]
own, terminal = os.openpty()
process = subprocess.Popen(command, stdin=terminal, stdout=terminal, stderr=terminal)
# What is last on a terminal that nobody has open may be lost, so it stays open here until this comes.
end = b"<end of the command>"
threading.Thread(target=lambda: (process.wait(), os.write(terminal, end)), daemon=True).start()
said = b""
while not said.endswith(end):
    said += os.read(own, 4096)
    if said.endswith(b"[y/N/all/quit] "):
        os.write(own, answers.pop(0).encode() + b"\n")
        said += b"\n"
sys.stdout.write(said[: -len(end)].decode().replace("\r", ""))
sys.exit(process.returncode)
PY
by() {  # by ANSWERS [VERB]
  python3 ask.py "$1" "$bin/stvm" fleet "${2:-change}" round.fleet --dir seven --dir eight --dir nine \
    --allow-overrun
}
expect 7 by n,quit
said '^seven +new +cancelled '
said '^eight +new +cancelled '
said '^nine +not asked '
expect 1 by n,all
said '^seven +new +cancelled '
said '^eight +new +done '
said '^nine +new +done '
expect 0 by y
said '^seven +new +done '
said '^nine +new +had it '

# The same dialogue where it is taken back or accepted; what others have on trial below is said.
expect 1 by n,y,quit undo
said '^seven +new +cancelled +- +R0[0-9]+: not taken back'
said '^eight +new +undone +E[0-9]+ '
said '^nine +new +cancelled '
expect 0 stvm change other_b.st --dir eight --yes --allow-overrun --allow-loss
expect 0 stvm change new.st --dir eight --yes --allow-overrun --allow-loss
expect 0 stvm fleet change round.fleet --dir eight --yes --allow-overrun
expect 1 by n,all accept
said '^with it become final: E[0-9]+ by .*, E[0-9]+ by '
said '^seven +new +cancelled +E[0-9]+ +R0[0-9]+: not accepted'
said '^eight +new +accepted '
expect 0 by y accept
said '^eight +new +had it '

# E-27: the controllers of a file, with what is allowed for one of them only.
cat >fleet.toml <<TOML
[controllers.north]
dir = "$work/one"
[controllers.east]
dir = "$work/six"
allow_loss = true
TOML
expect 0 stvm undo --dir six --yes
expect 0 stvm set --dir six kept=9
expect 0 stvm fleet change loses.fleet --fleet fleet.toml --yes --allow-overrun
said '^north +original +had it +1 of 1 *$'
said '^east +keeps +done +1 of 1 '
mistake() {
  printf "$1" >bad.toml
  expect 7 stvm fleet status x.fleet --fleet bad.toml
  said "$2"
}
mistake 'name = "x"\n' 'bad.toml:1:1: .*name. is not known here'
mistake '[controllers.a]\ndir = 3\n' 'bad.toml:2:7: .*a text is wanted'
mistake '[controllers.a]\nallow_loss = "yes"\ndir = "x"\n' 'bad.toml:2:14: .*true or false'
mistake '[controllers.a]\ndir = "x"\nhost = "y"\n' 'has two of dir, host and agent'
mistake '[controllers.a]\nallow_loss = true\n' 'has no .dir., .host. or .agent.'
expect 2 stvm fleet status x.fleet --dir one --dir one
said 'two controllers are called .one.'
mistake '[controllers.a]\nname = 3\ndir = "x"\n' 'bad.toml:2:8: .*a text is wanted'
mistake '[controllers.a]\ngroup = "x"\n' '.group. is not known'

# E-13: --matching takes what fits, and where nothing does, it is refused as `status` says it.
pid() { # pid STEP
  cat <<ST
FUNCTION_BLOCK Pid VAR n : INT; END_VAR n := n + $1; END_FUNCTION_BLOCK
PROGRAM Main VAR p : Pid; END_VAR p(); END_PROGRAM
ST
}
pid 1 >pid_1.st
pid 2 >pid_2.st
pid 5 >pid_5.st
expect 0 stc fleet pid_1.st pid_2.st -o pid.fleet
serve apart pid_5.st
expect 7 stvm fleet status pid.fleet --dir apart
said 'R0320: Pid is different'
expect 7 stvm fleet change pid.fleet --dir apart --matching --yes --allow-overrun
said '^apart +.* refused +0 of 1 +R0320: Pid is different$'
