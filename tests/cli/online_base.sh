#!/bin/sh
# E-16, E-17, E-19 to E-21: what may not be edited online is said while somebody edits, with
# place, code and way out.
. "$(dirname "$0")/lib.sh"

cat >old.st <<'ST'
TYPE Recipe : STRUCT a, b : INT; END_STRUCT; END_TYPE
VAR_GLOBAL
  first : INT;
  kept : INT := 3;
  recipe : Recipe;
  last : REAL;
END_VAR
FUNCTION_BLOCK Motor VAR_INPUT run : BOOL; END_VAR VAR_OUTPUT n : INT; END_VAR n := n + 1; END_FUNCTION_BLOCK
FUNCTION Gone : INT Gone := 1; END_FUNCTION
PROGRAM Main
VAR m : Motor; speed : INT; END_VAR
  m(run := TRUE); speed := m.n + Gone();
END_PROGRAM
ST
stc build -q old.st -o old.img

# E-19: what is added, and a body, are fine; one line says which limits were used (E-20).
sed 's/first : INT;/first : INT; more : LREAL;/; s/n + 1/n + 2/; s/speed : INT;/speed : INT; extra : INT;/; s/n + Gone();/n + Gone(); extra := 1; speed := extra;/' old.st >good.st
for original in old.st old.img; do
  expect 0 stc check good.st --online-base $original
  said 'note.W0083.: limits are the strictest of all versions; no --target says which'
  done
version=$(stvm version | sed -n '1s/stvm //p')
expect 0 stc check good.st --online-base old.img --target "$version"
said "limits are those of stvm $version"
expect 0 stc check good.st --online-base old.img --target 99.7 --target "$version"
said 'limits are the strictest of all versions: stvm 99.7 has no row'
expect 0 stc check good.st --online-base old.img --target . # of this machine
said "limits are those of stvm $version"
cat >fake_ssh <<'SH'
#!/bin/sh
[ "$2" = old ] && echo 'stvm 0.0.7' && exit
[ "$2" = silent ] && exit 255
[ "$3" = 'stvm version' ] && exec stvm version
SH
chmod +x fake_ssh
PATH=$bin:$PATH STVM_SSH=$work/fake_ssh
export PATH STVM_SSH
expect 0 stc check good.st --online-base old.img --target plc@line2
said "limits are those of stvm $version"
expect 0 stc check good.st --online-base old.img --target old
said 'stvm 0.0.7 has no row'
expect 0 stc check good.st --online-base old.img --target silent
said 'stvm of an unknown version has no row'

# The restricted table: each has its place, its code and the way out.
bad() {  # bad SED REGEX [OPTION...]: an edit that is refused, and what is said of it
  sed "$1" old.st >bad.st
  wanted=$2
  shift 2
  expect 1 stc check bad.st --online-base old.img "$@"
  said "$wanted"
}
bad '/kept : INT/d' 'bad.st:3:3: error.E9001.: `kept`: removed'
said 'help: keep what was there and put new variables beside it, or lift the rule: --table free'
bad '/first : INT/d; /kept : INT/d' 'error.E9001.: `first`: removed; `kept`: removed'
bad 's/last : REAL/last : LREAL/' 'bad.st:6:3: error.E9003.: `last`: type REAL -> LREAL'
bad 's/a, b : INT/a, b, c : INT/' 'bad.st:5:3: error.E9003.: `recipe`: its type is another one inside'
bad 's/kept : INT := 3/kept : INT := 4/' 'bad.st:4:3: error.E9003.: `kept`: initial value 3 -> 4'
bad 's/^VAR_GLOBAL/VAR_GLOBAL RETAIN/' 'bad.st:4:3: error.E9003.: `kept`: RETAIN no -> yes'
bad 's/  first : INT;/  last : REAL;/; t; s/  last : REAL;/  first : INT;/' 'bad.st:4:3: error.E9002.: `kept`: it stood after `first`'
bad 's/speed/quick/g' 'bad.st:11:5: error.E9001.: `Main.speed`: removed'
bad 's/speed : INT/speed : DINT/' 'bad.st:11:16: error.E9003.: `Main.speed`: type INT -> DINT'
bad 's/last : REAL/last AT %MD8 : REAL/' 'E9003.: `last`: address none -> %MD8'
expect 0 stc check bad.st --online-base old.img --table free
expect 1 stc check bad.st --online-base old.img --format json
json 'd["diagnostics"][0]["code"] == "E9003" and d["diagnostics"][0]["line"] == 6'
json 'd["diagnostics"][1]["code"] == "W0083" and "line" not in d["diagnostics"][1]'

# Interfaces and units: legal online, so they are notes; a project can make errors of them.
sed 's/run : BOOL/run : BOOL; more : INT/; /FUNCTION Gone/d; s/ + Gone()//' old.st >units.st
printf 'FUNCTION Fresh : INT Fresh := 1; END_FUNCTION\n' >>units.st
expect 0 stc check units.st --online-base old.img
said 'units.st:8:16: note.W0082.: `Motor`: input `more` in the place of output'
said 'units.st:[0-9]+:10: note.W0080.: `Fresh`: the running program does not have it'
said 'note.W0081.: `Gone`: it is deleted'
expect 1 stc check units.st --online-base old.img --restricted
said 'units.st:8:16: error.E9004.: `Motor`: input `more` in the place of output'
mkdir strict
cp units.st strict
printf '[change]\nrestricted = true\n' >strict/stc.toml
expect 1 stc check strict --online-base old.img
said 'error.E9004.: `Motor`'
(cd strict && expect 1 stc check --online-base ../old.img)
expect 1 stc check units.st --online-base old.img --warn W0080=error --warn W0081=error
said 'error.W0080'
said 'error.W0081'

# What cannot be planned is said, too: a migration whose parameter was no variable.
cp good.st plan.st
cat >>plan.st <<'ST'
{migration of := 'Main'}
FUNCTION Main_from VAR_INPUT lost : INT; END_VAR VAR_OUTPUT extra : INT; END_VAR extra := lost; END_FUNCTION
ST
expect 1 stc check plan.st --online-base old.img
said 'error.E9005.: `R0311`: '
expect 2 stc check good.st --target "$version"
said 'R0504.*--target.*--online-base'
expect 7 stc check good.st --online-base missing.img
said 'R0501'

# Of lists, namespaces, CONFIGURATION, RESOURCE and VAR_CONFIG, where they are declared; of
# several resources the one that runs.
cat >places.st <<'ST'
{attribute 'list' := 'Lot'}
VAR_GLOBAL lot : INT; END_VAR
NAMESPACE Deep.Er
VAR_GLOBAL spaced : INT; END_VAR
END_NAMESPACE
PROGRAM Main VAR x AT %I* : BOOL; n : INT; END_VAR IF x THEN n := n + 1; END_IF END_PROGRAM
CONFIGURATION c
VAR_GLOBAL common : INT; END_VAR
RESOURCE one ON cpu
VAR_GLOBAL own : INT; END_VAR
TASK t (INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM p WITH t : Main;
VAR_CONFIG p.x AT %IX0.0 : BOOL; END_VAR
END_RESOURCE
RESOURCE two ON cpu
TASK t (INTERVAL := T#10ms, PRIORITY := 1);
PROGRAM q WITH t : Main;
VAR_CONFIG q.x AT %IX0.1 : BOOL; END_VAR
END_RESOURCE
END_CONFIGURATION
ST
expect 0 stc build places.st -o places.img
sed 's/\(lot\|spaced\|common\|own\) : INT/\1 : DINT/; s/%IX0.0/%IX0.3/' places.st >placed.st
expect 1 stc check placed.st --online-base places.one.img
said 'placed.st:2:12: error.E9003.: `lot`: '
said 'placed.st:4:12: error.E9003.: `Deep.Er.spaced`: '
said 'placed.st:8:12: error.E9003.: `common`: '
said 'placed.st:10:12: error.E9003.: `own`: '
said 'placed.st:13:12: error.E9003.: `p.x`: address %IX0.0 -> %IX0.3'
sed 's/%IX0.0/%IX0.3/' places.st >placed.st
expect 0 stc check placed.st --online-base places.two.img
expect 1 stc build placed.st --online-base places.one.img
expect 0 stc build placed.st --online-base places.two.img

# stc build refuses as well, and writes nothing; with --watch each save is looked at.
expect 1 stc build bad.st -o bad.img --online-base old.st
said 'E9003'
[ ! -e bad.img ] || fail "a refused image was written"
expect 0 stc build good.st -o good.img --online-base old.st
stc build -q good.st -o plain.img
cmp good.img plain.img || fail "the check has made another image"
mkdir saved
cp good.st saved/a.st
"$bin/stc" build saved -o saved.img --watch --online-base old.img >>watched 2>&1 &
echo $! >watch.pid
wait_for 'built' cat watched
said 'W0083'
[ -e saved.img ] || fail "no image"
cp saved.img before.img
sed 's/last : REAL/last : LREAL/' good.st >saved/b
mv saved/b saved/a.st
wait_for 'a.st:6:3: error.E9003' cat watched
cmp saved.img before.img || fail "a refused image was written"
sed 's/n + 1/n + 9/' old.st >saved/b
: >watched
mv saved/b saved/a.st
wait_for 'built' cat watched
kill "$(cat watch.pid)"
rm watch.pid

# ORIGINAL is a controller.
serve plc old.img
expect 0 stc check good.st --online-base plc --target plc
said "limits are those of stvm $version"
expect 1 stc check bad.st --online-base plc
said 'E9003'
expect 0 stc fleet plc good.st -o from_plc.fleet

# E-21: what is possible, for people and for editors.
expect 0 stc explain online-edits --target "$version"
said "^limits are those of stvm $version; formats of images from 7 to [0-9]+$"
said '^unit.added +yes +a new function'
said '^table.removed +with --table free +a global'
said '^unit.interface +without --restricted '
expect 0 stc explain online-edits
said '^limits are the strictest of all versions'
expect 0 stc explain online-edits --format json
json 'all(e["online"] for e in d["edits"])'
json '[e["rule"] for e in d["edits"] if e["edit"] == "table.order"] == ["table"]'
expect 2 stc explain refusals --format json
expect 2 stc explain R0322 --target 0.1.0
expect 0 stc explain R0322
