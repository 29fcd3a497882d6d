#!/bin/sh
# E-23 to E-26 at the command line: the order of the units of a fleet file, what is refused of it,
# and an edit that comes step by step on controllers.
. "$(dirname "$0")/lib.sh"

# project FILE STEP GLOBALS: Main calls A, A calls B.
project() {
  cat >"$1" <<ST
VAR_GLOBAL level : INT; ${3:-} END_VAR
FUNCTION_BLOCK A VAR_OUTPUT n : DINT; END_VAR VAR b : B; END_VAR b(); n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK B VAR_OUTPUT n : DINT; END_VAR n := n + $2; END_FUNCTION_BLOCK
FUNCTION_BLOCK C VAR_OUTPUT n : DINT; END_VAR n := n + 1; END_FUNCTION_BLOCK
PROGRAM Main VAR a1 : A; c1 : C; n : DINT; END_VAR
  a1(); c1(); n := n + $2; ${4:-}
END_PROGRAM
ST
}
project v1.st 1
project v2.st 100 'seen : DINT;' 'seen := n;'

expect 0 stc fleet v1.st v2.st -o each.fleet --start each --order callees-first --show-order
said '^1 table$'
said '^2 B$'
said '^3 A$'
said '^4 Main$'
expect 0 stc fleet v1.st v2.st -o listed.fleet --start each --order list --list Main,B,A \
  --allow-mixture --format json
said '"steps":\["table","Main","B","A"\]'

# E-24: who would run before what it calls, and what cannot come before the table.
expect 7 stc fleet v1.st v2.st -o bad.fleet --start each --order callers-first
said 'R0324.*`Main` before `A`, `A` before `B`.*--allow-mixture'
expect 7 stc fleet v1.st v2.st -o bad.fleet --start each --order table-last --allow-mixture
said 'R0321.*`Main` cannot come before what is left: .*seen'
expect 2 stc fleet v1.st v2.st -o bad.fleet --start each --order list --list A,B
said '`Main` is edited, and not in the list'
expect 2 stc fleet v1.st v2.st -o bad.fleet --start each --order list
expect 2 stc fleet v1.st v2.st -o bad.fleet --order callees-first
said 'is for --start each or auto'
[ ! -e bad.fleet ] || fail 'a refused file was written'

# E-25: a boundary for each, all mixtures told.
serve one v1.st
expect 0 stvm fleet change each.fleet --dir one --yes --allow-overrun
said '^step 2 of 4: B$'
said '^from cycle [0-9]+: table, B new, A, Main as before$'
said '^one +.*done'
expect 0 stvm edits --dir one
said '^E4 '
expect 0 stvm get seen --dir one
expect 0 stvm fleet change each.fleet --dir one --yes --allow-overrun
said 'had it'
expect 0 stvm fleet undo each.fleet --dir one --yes --allow-loss --allow-overrun
expect 7 stvm get seen --dir one

# As JSON.
expect 0 stvm fleet change each.fleet --dir one --yes --allow-overrun --format json
said '"mixtures"'
said '"new": *\["table", *"B"\]'
expect 0 stvm fleet undo each.fleet --dir one --yes --allow-loss --allow-overrun

# E-26: what fails in the middle goes again: the controller has another Main.
project own.st 1
sed -i 's/n := n + 1; END_FUNCTION_BLOCK/n := n + 1; END_FUNCTION_BLOCK/; s/^  a1(); c1(); n := n + 1;/  a1(); c1(); n := n + 7;/' own.st
serve two own.st
expect 7 stvm fleet change each.fleet --dir two --yes --allow-overrun
said 'Main is different'
expect 0 stvm edits --dir two
! grep -q '^E1' out || fail 'a part came to a controller that does not fit'

# Room for all: together, and it is said.
expect 0 stc fleet v1.st v2.st -o auto.fleet --start auto --order auto
expect 0 stvm fleet change auto.fleet --dir one --yes --allow-overrun
said '^all units start together: there is room for them$'
expect 0 stvm fleet undo auto.fleet --dir one --yes --allow-loss --allow-overrun
