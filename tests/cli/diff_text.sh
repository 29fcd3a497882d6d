#!/bin/sh
# X9: `stc diff --text` says in words what differs, POU by POU: variables, lines, rungs, boxes, steps and
# transitions, tasks, settings; comments and layout are told from the program. Between folders, between
# images that have their sources, and against a controller.
. "$(dirname "$0")/lib.sh"
mkdir -p v1/src
cat >v1/stc.toml <<'ST'
name = "plant"
embed_sources = true
ST
cat >v1/src/types.st <<'ST'
TYPE
  Mode : (Off, Manual, Auto);
  Recipe : STRUCT
    level : REAL := 1.0;
    name : STRING[20];
  END_STRUCT;
  Speed : INT(0..100);
END_TYPE
VAR_GLOBAL
  start AT %IX0.0 : BOOL;
  lamp AT %QX0.0 : BOOL;
  total : INT;
END_VAR
ST
cat >v1/src/motor.st <<'ST'
FUNCTION_BLOCK Motor
VAR_INPUT on : BOOL; speed : INT := 10; END_VAR
VAR_OUTPUT runs : BOOL; END_VAR
VAR count : INT; limit : INT := 3; END_VAR
  (* counts starts *)
  IF on AND NOT runs THEN
    count := count + 1;
  END_IF
  runs := on;
  IF count > limit THEN
    runs := FALSE;
  END_IF
METHOD Reset : BOOL
  count := 0;
END_METHOD
END_FUNCTION_BLOCK

FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
  Twice := x * 2;  (* twice *)
END_FUNCTION

FUNCTION Same : INT
VAR_INPUT x : INT; END_VAR
  Same := x;
END_FUNCTION
ST
cat >v1/src/ladder.st <<'ST'
PROGRAM Rungs
VAR a, b, c, run : BOOL; t : TON; END_VAR
LADDER
  (* seal-in *)
  |--[ a ]----+--[/ b ]---( run )--|
  |--[ run ]--+
  |--[ run ]--[ t: TON  IN:=_, PT:=T#1s ]--( c )--|
  |--[ c ]--( lamp )--|
END_LADDER
END_PROGRAM
ST
cat >v1/src/boxes.st <<'ST'
PROGRAM Boxes
VAR go, done : BOOL; n : INT; t : TON; c : CTU; END_VAR
FBD
  t : TON(IN := go, PT := T#30ms);
  c : CTU(CU := t.Q, R := FALSE, PV := 5);
  WIRE next := ADD(n, 1);
  n := next;
  done := c.Q;
END_FBD
END_PROGRAM
ST
cat >v1/src/chart.st <<'ST'
PROGRAM Chart
VAR full, warm, valve : BOOL; temp : INT; END_VAR
INITIAL_STEP Idle: END_STEP
STEP Fill: valve(N); END_STEP
STEP Heat: warm(L, T#5s); Work(N); END_STEP
TRANSITION FROM Idle TO Fill := start; END_TRANSITION
TRANSITION FROM Fill TO Heat := full; END_TRANSITION
TRANSITION FROM Heat TO Idle := temp > 50; END_TRANSITION
ACTION Work:
  temp := temp + 1;
END_ACTION
END_PROGRAM
ST
cat >v1/src/config.st <<'ST'
CONFIGURATION Plant
RESOURCE Line ON PLC
  TASK Fast (INTERVAL := T#10ms, PRIORITY := 1);
  PROGRAM rungs WITH Fast : Rungs;
  PROGRAM boxes WITH Fast : Boxes;
  PROGRAM chart WITH Fast : Chart;
END_RESOURCE
END_CONFIGURATION
ST
cp -r v1 v2
cd v2/src
cat >../stc.toml <<'ST'
name = "plant"
embed_sources = true
[slack]
globals_bytes = 512
ST
cat >../src/types.st <<'ST'
TYPE
  Mode : (Off, Manual, Auto, Remote);
  Recipe : STRUCT
    level : LREAL := 1.5;
    name : STRING[20];
  END_STRUCT;
  Speed : INT(0..200);
END_TYPE
VAR_GLOBAL
  start AT %IX0.3 : BOOL;
  lamp AT %QX0.0 : BOOL;
  total : DINT; spare : INT;
END_VAR
ST
cat >../src/motor.st <<'ST'
FUNCTION_BLOCK Motor
VAR_INPUT speed : INT := 20; on : BOOL; END_VAR
VAR_OUTPUT runs : BOOL; END_VAR
VAR count : INT; limit : INT := 3; END_VAR
  (* counts starts *)
  IF on AND NOT runs THEN
    count := count + 1;
  END_IF
  runs := on;
  IF count > limit OR speed > 90 THEN
    runs := FALSE;
  END_IF
METHOD Reset : BOOL
  count := 0; Reset := TRUE;
END_METHOD
END_FUNCTION_BLOCK

FUNCTION Twice : INT
VAR_INPUT x : INT; END_VAR
  Twice := x * 2;  (* two times *)
END_FUNCTION

FUNCTION Same : INT
VAR_INPUT x : INT; END_VAR
  Same:=X;
END_FUNCTION
ST
cat >../src/ladder.st <<'ST'
PROGRAM Rungs
VAR a, b, c, run : BOOL; t : TON; total_reached : BOOL; END_VAR
LADDER
  (* seal-in *)
  |--[ a ]----+--[ b ]---( run )--|
  |--[ run ]--+
  |--[ run ]--[ t: TON  IN:=_, PT:=T#1s ]--( c )--|
  |--[ a ]--[ b ]--(S total_reached )--|
  (* shows it *)
  |--[ c ]--( lamp )--|
END_LADDER
END_PROGRAM
ST
cat >../src/boxes.st <<'ST'
PROGRAM Boxes
VAR go, done : BOOL; n : INT; t : TON; c : CTU; END_VAR
FBD
  done := c.Q;
  t : TON(IN := go, PT := T#40ms);
  c : CTU(CU := t.Q, R := done, PV := 5);
  WIRE next := ADD(n, 10);
  n := next;
END_FBD
END_PROGRAM
ST
cat >../src/chart.st <<'ST'
PROGRAM Chart
VAR full, warm, valve : BOOL; temp : INT; END_VAR
INITIAL_STEP Idle: END_STEP
STEP Fill: valve(N); END_STEP
STEP Stir: END_STEP
STEP Heat: warm(L, T#6s); Work(N); END_STEP
TRANSITION FROM Idle TO Fill := start; END_TRANSITION
TRANSITION FROM Fill TO Stir := full; END_TRANSITION
TRANSITION FROM Stir TO Heat := full; END_TRANSITION
TRANSITION FROM Heat TO Idle := temp > 60; END_TRANSITION
ACTION Work:
  temp := temp + 2;
END_ACTION
END_PROGRAM
ST
cat >../src/config.st <<'ST'
CONFIGURATION Plant
RESOURCE Line ON PLC
  TASK Fast (INTERVAL := T#20ms, PRIORITY := 1);
  PROGRAM rungs WITH Fast : Rungs;
  PROGRAM boxes WITH Fast : Boxes;
  TASK Slow (INTERVAL := T#100ms, PRIORITY := 2);
  PROGRAM chart WITH Slow : Chart;
END_RESOURCE
END_CONFIGURATION
ST
cd "$work"
cat >expected <<'TEXT'
TYPE Mode (src/types.st:2)
  value Remote is new
TYPE Recipe (src/types.st:3)
  field level: level : REAL := 1.0 -> level : LREAL := 1.5
TYPE Speed (src/types.st:7)
  declaration: INT(0..100) -> INT(0..200)
PROGRAM Boxes (src/boxes.st:1)
  block t: PT: T#30ms -> T#40ms
  block c: R: FALSE -> done
  block next: input 2: 1 -> 10
  outputs in another order: n, done -> done, n
PROGRAM Chart (src/chart.st:1)
  step Stir is new
  action Heat: warm: warm(L, T#5s) -> warm(L, T#6s)
  transition Fill -> Stir is new: full
  transition Stir -> Heat is new: full
  transition Heat -> Idle: temp > 50 -> temp > 60
  transition Fill -> Heat is gone: full
  action Work, line 12:
    -   temp := temp + 1;
    +   temp := temp + 2;
PROGRAM Rungs (src/ladder.st:1)
  variable total_reached is new: VAR total_reached : BOOL
  rung 1:
    - (* seal-in *)
    - |--[ a ]----+--[/ b ]-----------------------------( run )--|
    - |--[ run ]--+
    + (* seal-in *)
    + |--[ a ]----+--[ b ]------------------------------( run )--|
    + |--[ run ]--+
  rung 3 is new:
    + |--[ a ]--[ b ]------------------------(S total_reached )--|
  rung 4, only comments:
    - |--[ c ]-----------------------------------------( lamp )--|
    + (* shows it *)
    + |--[ c ]-----------------------------------------( lamp )--|
FUNCTION_BLOCK Motor (src/motor.st:1)
  variable speed: VAR_INPUT speed : INT := 10 -> VAR_INPUT speed : INT := 20
  variables in another order:
    - on, speed, runs, count, limit
    + speed, on, runs, count, limit
  line 10:
        END_IF
        runs := on;
    -   IF count > limit THEN
    +   IF count > limit OR speed > 90 THEN
          runs := FALSE;
        END_IF
METHOD Motor.Reset (src/motor.st:13)
  line 14:
    -   count := 0;
    +   count := 0; Reset := TRUE;
FUNCTION Twice (src/motor.st:18): only comments differ
  line 20, only comments:
    -   Twice := x * 2;  (* twice *)
    +   Twice := x * 2;  (* two times *)
FUNCTION Same (src/motor.st:23): only the layout differs
VAR_GLOBAL src/types.st
  variable start:
    - VAR_GLOBAL start AT %IX0.0 : BOOL
    + VAR_GLOBAL start AT %IX0.3 : BOOL
  variable total: VAR_GLOBAL total : INT -> VAR_GLOBAL total : DINT
  variable spare is new: VAR_GLOBAL spare : INT
CONFIGURATION Plant (src/config.st:1)
  task Line.Fast:
    - TASK Fast (INTERVAL := T#10ms, PRIORITY := 1)
    + TASK Fast (INTERVAL := T#20ms, PRIORITY := 1)
  task Line.Slow is new: TASK Slow (INTERVAL := T#100ms, PRIORITY := 2)
  program Line.chart:
    - PROGRAM chart WITH Fast : Chart
    + PROGRAM chart WITH Slow : Chart
settings stc.toml
  lines 3 to 4:
      name = "plant"
      embed_sources = true
    + [slack]
    + globals_bytes = 512

TEXT

# as_expected: the words, and behind them the report of fates.
as_expected() {
  sed '/^fate  /,$d' out >words
  diff expected words || fail "other words"
  grep -q '^source  *src/boxes.st' out || [ "$1" = folders ] || fail "no report behind the words"
  said '^converted  *total : INT -> DINT'
}
expect 0 stc diff v1 v2 --text
as_expected folders
expect 0 stc build v1 -o v1.img
expect 0 stc build v2 -o v2.img
expect 0 stc diff v1.img v2.img --text
as_expected images
expect 0 stc diff v1 v2.img --text
as_expected folders
serve plc v1.img
expect 0 stc diff --against plc v2 --text
as_expected controller
expect 0 stc diff --against plc v2 --text --format json
said '"kind": *"rung","name": *"1","change": *"edited"'
said '"kind": *"block","name": *"t","change": *"edited".*"what": *"PT: T#30ms -> T#40ms"'
said '"kind": *"FUNCTION","name": *"Same","file": *"src/motor.st","line": *23,"change": *"layout"'
said '"fates": *\['
expect 0 stc diff --against plc v1 --text
said '^the sources are the same$'

# Only comments: in a POU, in a ladder, in front of a POU.
cp -r v1 v3
sed -i 's/counts starts/counts all starts/' v3/src/motor.st
sed -i 's/seal-in/seals itself in/' v3/src/ladder.st
sed -i '1i (* all boxes *)' v3/src/boxes.st
expect 0 stc diff --against plc v3 --text
said '^FUNCTION_BLOCK Motor \(src/motor.st:1\): only comments differ$'
said '^PROGRAM Rungs \(src/ladder.st:1\): only comments differ$'
said '^  rung 1, only comments:$'
said '^source src/boxes.st: only comments differ$'
said '^only comments and layout differ: the program is the same$'

# Units that come and go; a body in another language.
cp -r v1 v4
sed -i '/^FUNCTION Twice/,/^END_FUNCTION/d' v4/src/motor.st
echo 'FUNCTION Thrice : INT VAR_INPUT x : INT; END_VAR Thrice := x * 3; END_FUNCTION' >v4/src/new.st
cat >v4/src/ladder.st <<'ST'
PROGRAM Rungs
VAR a, b, c, run : BOOL; t : TON; END_VAR
  run := (a OR run) AND NOT b;
END_PROGRAM
ST
expect 0 stc diff v1 v4 --text
said '^FUNCTION Thrice \(src/new.st:1\): new$'
said '^FUNCTION Twice \(src/motor.st:18\): removed$'
said '^  body: ladder -> text$'
grep -q '^source src' out && fail "a file is told beside its units"

# Without sources there are no words.
sed -i '/embed_sources/d' v2/stc.toml
expect 0 stc build v2 -o plain.img
expect 7 stc diff v1.img plain.img --text
said 'R0509: no sources travel with Plant'
expect 0 stc diff v1.img plain.img
said '^source +7 files  \(travel with the program no longer\)$'
