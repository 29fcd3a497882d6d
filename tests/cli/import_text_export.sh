#!/bin/sh
# Text exports (.EXP) of CODESYS V2.3 and TwinCAT 2: ladder and function block diagrams come in as
# drawings, the rest as text; what is not known is an error with its place. drawn_random.sh compares
# random ones with the same in ST.
. "$(dirname "$0")/lib.sh"

# Lines of a body: words of the form, and `name text` for what has an operand.
contact() { printf '_LD_CONTACT\n%s\n_EXPRESSION\n_%s\n' "$1" "${2:-POSITIV}"; }
operand() { printf '_OPERAND\n_EXPRESSION\n_POSITIV\n%s\n' "$1"; }
value() { printf '_EXPRESSION\n_%s\n' "${1:-POSITIV}"; }
output() { printf '_OUTPUT\n_%s\n_%s\n%s\n' "${2:-POSITIV}" "${3:-NO_SET}" "$1"; }
network() { printf '_NETWORK\n%s\n_COMMENT\n%s\n_END_COMMENT\n' "${2:-}" "${1:-''}"; }
no_boxes() { printf '\n\nENABLELIST : 0\nENABLELIST_END\n'; }
attributes() {
  printf "(* @NESTEDCOMMENTS := 'Yes' *)\n(* @PATH := '%s' *)\n(* @OBJECTFLAGS := '0, 8' *)\n(* @SYMFILEFLAGS := '2048' *)\n" "${1:-}"
}
marker="(* @END_DECLARATION := '0' *)"

{
  attributes '\/Pumps'
  cat <<X
PROGRAM PLC_PRG	(* the only
one *)
VAR
	xStart, xStop: BOOL;	(* buttons *)
	xMotor, xLate, xFull, xLocked: BOOL;
	tDelay: TON;
	fbMean: MEAN;
	wLevel: WORD;
	rLevel: REAL := 12.5;
	tElapsed: TIME;
	iCount, iMean, iN: INT;
END_VAR
$marker
_LD_BODY
_NETWORKS : 5
X
  network "'Start, held by the motor's own contact
and its lock'"
  printf '_LD_ASSIGN\n_LD_AND\n_LD_OPERATOR : 2\n_LD_OR\n_LD_OPERATOR : 2\n'
  contact xStart; contact xMotor; value; contact xStop NEGATIV; value; value; no_boxes
  printf '_OUTPUTS : 2\n'; output xMotor; output xLocked NEGATIV
  network
  printf '_LD_ASSIGN\n_LD_OR\n_LD_OPERATOR : 2\n'
  contact xMotor; contact xStart; value; value; no_boxes
  printf '_OUTPUTS : 2\n'; output xStart POSITIV SET; output xFull POSITIV SET
  network "''" Again
  printf '_LD_ASSIGN\n_FUNCTIONBLOCK\ntDelay\n_BOX_EXPR : 2\n'
  contact xMotor; operand 'T#50ms'; value; printf 'TON\n_OUTPUTS : 1\n'; output tElapsed; value
  no_boxes; printf '_OUTPUTS : 1\n'; output xLate
  network
  printf '_LD_ASSIGN\n'; contact xLate; value
  printf '\n\nENABLELIST : 1\n_ASSIGN\n_OPERATOR\n_BOX_EXPR: 1\n_ENABLED\n'
  operand rLevel; value; printf 'REAL_TO_WORD\n'; value; printf '_OUTPUTS : 1\n'; output wLevel
  printf 'ENABLELIST_END\n_OUTPUTS : 0\n'
  network
  printf '_LD_ASSIGN\n_FUNCTIONBLOCK\nfbMean\n_BOX_EXPR : 2\n'
  contact xLate; operand iCount; value; printf 'MEAN\n_OUTPUTS : 1\n'; output iMean; value
  no_boxes; printf '_OUTPUTS : 0\nEND_PROGRAM\nACTION Count:\n_FBD_BODY\n_NETWORKS : 1\n'
  network
  printf '_ASSIGN\n_OPERATOR\n_BOX_EXPR : 2\n'; operand iCount
  printf '_OPERATOR\n_BOX_EXPR : 2\n'; operand iCount; operand 2; value; printf 'MUL\n'
  value; printf 'ADD\n'; value; printf '_OUTPUTS : 1\n'; output iCount
  printf "END_ACTION\nACTION Text:\n(* @TEXT_IMPLEMENTATION := 'ST' *)\niN := iN + 1;\nEND_ACTION\n\n"
  attributes
  printf "TYPE ST_Pump :\nSTRUCT\n\tspeed: INT;\nEND_STRUCT\nEND_TYPE\n%s\n" "$marker"
  printf "(* @NESTEDCOMMENTS := 'Yes' *)\n(* @GLOBAL_VARIABLE_LIST := 'Plant' *)\n(* @PATH := '' *)\n"
  printf "VAR_GLOBAL\n\tpump: ST_Pump;\n\ttext: STRING := 'END_VAR \200';\nEND_VAR\nVAR_GLOBAL CONSTANT\n\tMAX_N: INT := 3;\nEND_VAR\n"
  printf "(* @OBJECT_END := 'Plant' *)\n(* @CONNECTIONS := Plant\nFILENAME : ''\nFILETIME : 0\nEXPORT : 0\nNUMOFCONNECTIONS : 0\n*)\n"
  printf "LIBRARY\nStandard.lib 5.6.98 12:03:02\n(* @LIBRARYSYMFILEINFO := '0' *)\nNumOfPOUs: 1\nTON: 0\nEND_LIBRARY\n"
  printf "LIBRARY\nPumps.lib 5.6.98 12:03:02\n(* @LIBRARYSYMFILEINFO := '0' *)\nNumOfPOUs: 1\nMEAN: 0\nEND_LIBRARY\n"
  printf "PLC_CONFIGURATION\n_GLOBAL\nPROGRAM\nPLC_END\n"
} | sed 's/$/\r/' >plant.EXP

# The library is in ST, and its pins are known all the same.
mkdir lib
{
  attributes
  printf 'FUNCTION_BLOCK MEAN\nVAR_INPUT\n\tenable: BOOL;\n\tx: INT;\nEND_VAR\nVAR_OUTPUT\n\tready: BOOL;\n\ty: INT;\nEND_VAR\n%s\nready := enable;\nIF enable THEN y := (y + x) / 2; END_IF\nEND_FUNCTION_BLOCK\n' "$marker"
} >lib/mean.exp

needs_xml "$bin/stc" import plant.EXP lib/mean.exp -o made
said 'plant.EXP -> made/PLC_PRG.st'
said "W0071.*the library \`Standard.lib\` is part of stc"
said "W0070.*the library \`Pumps.lib\` is used, and its text is not in the export"
said "W0070.*\`PLC_CONFIGURATION\` begins a part that is not read"
said '4 source.s., 0 error.s., 2 warning.s., 1 note.s.'
grep -q 'WIRE mul1 := MUL(iCount, 2);' made/PLC_PRG.st || fail "no function block diagram"
for row in "(\* Start, held by the motor's own contact" \
  '|--\[ xStart \]--+--\[/ xStop \]--+--*( xMotor )--|' \
  '|--\[ xMotor \]--+              +--*(/ xLocked )--|' \
  '|--\[ xMotor \]--+----+--*(S xStart )--|' \
  '|--\[ xStart \]--+    +--*(S xFull )--|' \
  'Again:' \
  'tDelay: TON  IN:=_, PT:=T#50ms, ET=>tElapsed \]' \
  '|--\[ xLate \]--\[ wLevel := REAL_TO_WORD(rLevel) \]--*|' \
  'fbMean: MEAN  enable:=_, x:=iCount, y=>iMean \]'; do
  grep -q -- "$row" made/PLC_PRG.st || fail "not so: $row; $(cat made/PLC_PRG.st)"
done
grep -q "text: STRING := 'END_VAR €';" made/Plant.st || fail "windows-1252: $(cat made/Plant.st)"
grep -q 'MAX_N: INT := 3;' made/Plant.st || fail "the second part of the list: $(cat made/Plant.st)"

# Directly: the same program, whatever is a source of its own beside it.
mkdir p && cp -r plant.EXP lib p/
expect 0 stc build p --dialect codesys -o a.img
expect 0 stc build made --dialect codesys -o b.img
for image in a b; do
  expect 0 stvm run $image.img --virtual-time --scans 30 --state
  cp out $image
done
cmp -s a b || fail "imported, it is another program"
[ "$(wc -l <a)" -ge 20 ] || fail "no state: $(cat a)"
# What is text alone stays a source: messages have its own rows.
sed 's/enable THEN/enabled THEN/' lib/mean.exp >wrong.exp
expect 1 stc check wrong.exp --dialect codesys
said '^wrong.exp:16:4: error'

# --- what is not known
body() { printf 'PROGRAM P\nVAR\n\ta, b: BOOL; f: FB; t: TON;\nEND_VAR\n%s\n%s\n_NETWORKS : %s\n' "$marker" "$1" "$2"; cat; printf 'END_PROGRAM\n'; }
refused() {  # refused ROW REGEX: of bad.exp
  expect 1 stc import bad.exp -o bad --force
  said "^bad.exp:$1:[0-9]*: error.E1083.: POU P.*the body of P: $2"
  grep -q "{error 'the body of P was not imported'}" bad/P.st || fail "it is taken for empty"
  expect 1 stc check bad.exp --dialect codesys
}
rung() { network; printf '_LD_ASSIGN\n'; cat; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; }
contact a | rung | body _LD_BODY 2 >bad.exp
refused 7 'it says that it has 2 networks, and has 1'
printf '_JUMP\n' | rung | body _LD_BODY 1 >bad.exp
refused 14 'an element `_JUMP` is not known here'
printf '_LD_STUFF\n_LD_OPERATOR : 1\n' | body _SFC_BODY 1 >bad.exp
refused 6 '`_SFC_BODY` begins a language that is not read here'
contact a | sed 's/_POSITIV/_SOMETIMES/' | rung | body _LD_BODY 1 >bad.exp
refused 17 '`_SOMETIMES` stands where `_NEGATIV` is expected'
contact 'a; b' | rung | body _LD_BODY 1 >bad.exp
refused 14 'a contact is `a; b`, which is no expression'
contact '???' | rung | body _LD_BODY 1 >bad.exp
refused 14 'a contact has no variable; give its name'
box() { printf '_FUNCTIONBLOCK\n%s\n_BOX_EXPR : 1\n' "$1"; contact a; value; printf '%s\n_OUTPUTS : %s\n' "$2" "${3:-0}"; }
box f FB | rung | body _LD_BODY 1 >bad.exp
refused 14 'the pins of `FB` have no names in an export, .*; import the export of its library'
box t TON | rung | body _LD_BODY 1 >bad.exp
refused 14 'the box `t` has 1 inputs, and TON declares 2'
{
  box f FB | rung | body _LD_BODY 1
  printf 'FUNCTION_BLOCK FB\nVAR_IN_OUT\n\tx: BOOL;\nEND_VAR\nVAR_INPUT\n\ty: BOOL;\nEND_VAR\n%s\nEND_FUNCTION_BLOCK\n' "$marker"
} >bad.exp
refused 14 'in which order the pins of `FB` stand is not known: it declares VAR_IN_OUT in front of VAR_INPUT'
contact a | body _FBD_BODY 1 >bad.exp
refused 8 '`_LD_CONTACT` stands where `_NETWORK` is expected'
{ network "''" 'no name'; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } |
  body _LD_BODY 1 >bad.exp
refused 8 'the label `no name` is no name'
# What is negated and is no contact, and a rung in another language.
branch() { printf '_LD_AND\n_LD_OPERATOR : 2\n'; contact a; contact b; value NEGATIV; }
branch | rung | body _LD_BODY 1 >bad.exp
refused 14 'a branch is negated, which is not known here'
{ network; printf '_LD_ASSIGN\n'; contact a; value NEGATIV; no_boxes; printf '_OUTPUTS : 1\n'; output b; } |
  body _LD_BODY 1 >bad.exp
refused 8 'the power of a rung is negated, which is not known here'
contact a | rung | body _FBD_BODY 1 >bad.exp
refused 8 'a rung stands in a function block diagram'
# What stands beside coils, power that is none, operands that are none.
beside() { network; printf '_LD_ASSIGN\n'; contact a; value; printf 'ENABLELIST : 1\n_ASSIGN\n_OPERATOR\n_BOX_EXPR : 2\n'; cat; operand 1; operand 2; value; printf 'ADD\n'; value; printf '_OUTPUTS : 1\n'; output b; printf 'ENABLELIST_END\n_OUTPUTS : 0\n'; }
: | beside | body _LD_BODY 1 >bad.exp
refused 21 'what stands beside the coils is no box with EN'
{ network; printf '_ASSIGN\n_OPERATOR\n_BOX_EXPR : 2\n_ENABLED\n'; operand a; operand b; value; printf 'AND\n'; value; printf '_OUTPUTS : 1\n'; output b; } |
  body _FBD_BODY 1 >bad.exp
refused 14 'a box has EN where no power arrives'
{ network; printf '_ASSIGN\n'; contact a; value; printf '_OUTPUTS : 1\n'; output b; } | body _FBD_BODY 1 >bad.exp
refused 14 'a contact stands in a network that is no ladder'
{ network; printf '_ASSIGN\n_EMPTY\n'; value; printf '_OUTPUTS : 1\n'; output b; } | body _FBD_BODY 1 >bad.exp
refused 13 'nothing is connected to a coil or output'
{ network; printf '_ASSIGN\n'; operand a; value NEGATIV; printf '_OUTPUTS : 1\n'; output b; } | body _FBD_BODY 1 >bad.exp
refused 13 'an assignment is negated, which is not known here'
# 1,100 contacts side by side and 1,100 coils: 1,210,000 pairs.
{ network; printf '_LD_ASSIGN\n_LD_OR\n_LD_OPERATOR : 1100\n'
  awk 'BEGIN { for (i = 0; i < 1100; ++i) print "_LD_CONTACT\na\n_EXPRESSION\n_POSITIV" }'
  value; value; no_boxes; printf '_OUTPUTS : 1100\n'
  awk 'BEGIN { for (i = 0; i < 1100; ++i) print "_OUTPUT\n_POSITIV\n_NO_SET\nb" }'; } | body _LD_BODY 1 >bad.exp
refused '[0-9]*' 'its wires connect more than 1048576 pairs'
# The name of an action, and more than 64 MiB.
{ contact a | rung | body _LD_BODY 1; printf 'ACTION 1x:\na := b;\nEND_ACTION\n'; } >bad.exp
expect 1 stc import bad.exp -o bad --force
said 'E1074.*an action is called `1x`, which is no name'
truncate -s 67108865 large.exp
expect 1 stc import large.exp -o bad --force
said 'larger than 67108864 bytes'
# A million levels, a million promised elements.
{ network; printf '_ASSIGN\n'; awk 'BEGIN { for (i = 0; i < 1000000; ++i) print "_ASSIGN" }'; } | body _FBD_BODY 1 >bad.exp
refused 269 'its elements are nested deeper than 256 levels'
{ network; printf '_ASSIGN\n_OPERATOR\n_BOX_EXPR : 4000000000\n'; } | body _FBD_BODY 1 >bad.exp
refused 15 '`_BOX_EXPR : 4000000000` has no number'
# A block without outputs has no value; called for itself it needs none.
{
  box f FB | rung | body _LD_BODY 1
  printf 'FUNCTION_BLOCK FB\nVAR_INPUT\n\ty: BOOL;\nEND_VAR\n%s\nEND_FUNCTION_BLOCK\n' "$marker"
} >bad.exp
refused 14 'the value of `f` is used, and FB has no output'
{
  { network; box f FB; } | body _FBD_BODY 1 | sed 's/_LD_CONTACT/_OPERAND/; /^_OPERAND$/{n;d}' | sed '/^_OPERAND$/{n;n;s/$/\na/}'
  printf 'FUNCTION_BLOCK FB\nVAR_INPUT\n\ty: BOOL;\nEND_VAR\n%s\nEND_FUNCTION_BLOCK\n' "$marker"
} >good.exp
expect 0 stc import good.exp -o good --force
grep -q 'f : FB(y := a);' good/P.st || fail "$(cat good.exp good/P.st)"
# A box inside of a box with EN would run without; a pin at the rail may have power or none.
enabled() { network; printf '_LD_ASSIGN\n'; contact a; value; printf 'ENABLELIST : 1\n_ASSIGN\n_OPERATOR\n_BOX_EXPR : 2\n_ENABLED\n'; operand 1; cat; value; printf 'ADD\n'; value; printf '_OUTPUTS : 1\n'; output b; printf 'ENABLELIST_END\n_OUTPUTS : 0\n'; }
{ printf '_OPERATOR\n_BOX_EXPR : 1\n'; operand 2; value; printf 'ABS\n'; } | enabled | body _LD_BODY 1 >bad.exp
refused 29 'a box stands inside of a box with EN, which is not known here'
{ printf '_FUNCTIONBLOCK\nt\n_BOX_EXPR : 2\n_EMPTY\n'; operand T#1s; value; printf 'TON\n_OUTPUTS : 1\n'; output _EMPTY; } |
  rung | body _LD_BODY 1 >bad.exp
refused 17 'a pin of the box `t` is _EMPTY in a ladder'
# Names and comments that look like the form.
contact a | rung | body _LD_BODY 1 | sed 's/a, b: BOOL;/a, _EMPTY: BOOL;/' >bad.exp
refused 6 'a variable is called `_EMPTY`, which is a word of the form'
{ network "'one
_END_COMMENT
END_PROGRAM
two'"; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } | body _LD_BODY 1 >good.exp
expect 0 stc import good.exp -o good --force
grep -q 'END_PROGRAM$' good/P.st && grep -q '( b )' good/P.st || fail "a comment cuts the body: $(cat good/P.st)"
{ network; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } |
  body _LD_BODY 1 | sed 's/^_LD_BODY$/(* drawn *)\n_LD_BODY (* too *)/' >good.exp
expect 0 stc import good.exp -o good --force
grep -q '( b )' good/P.st || fail "a comment hides the drawing: $(cat good/P.st)"
# Two blocks of one name, and those of other kinds of declaration.
pins() { printf 'FUNCTION_BLOCK FB\nVAR_INPUT\n\t%s: BOOL;\nEND_VAR\nVAR_OUTPUT\n\tq: BOOL;\nEND_VAR\n%s\nEND_FUNCTION_BLOCK\n' "$1" "$marker"; }
{ box f FB | rung | body _LD_BODY 1; pins x; pins y; } >bad.exp
refused 14 '.*it is declared twice, with other pins'
{ box f FB | rung | body _LD_BODY 1; pins x | sed '1s/$/ EXTENDS Base/'; } >bad.exp
refused 14 '.*it extends another block'
mkdir beside
box f FB | rung | body _LD_BODY 1 >beside/main.exp
{ printf 'NAMESPACE N\n'; pins other; printf 'END_NAMESPACE\n'; pins own | sed 's/^END_FUNCTION_BLOCK/METHOD M VAR_INPUT z: INT; END_VAR END_METHOD\nEND_FUNCTION_BLOCK/'; } >beside/blocks.st
expect 0 stc import beside -o good --force
grep -q 'FB  own:=_' good/P.st || fail "the pins of a source beside it: $(cat good/P.st)"
expect 0 stc check beside --dialect codesys
expect 0 stc import beside/main.exp beside/blocks.st -o good --force
# Laying out leaves what is drawn alone.
expect 0 stc fmt beside
expect 0 stc fmt --check beside
expect 2 stc fmt beside/main.exp

# --- what is text alone is a source, whatever it holds
text_only() {  # from standard input: built as it stands, and the same as an .st
  cat >only.exp
  cp only.exp only.st
  expect 0 stvm run only.exp --dialect codesys --virtual-time --scans 3 --name p --state
  cp out as_export
  expect 0 stvm run only.st --dialect codesys --virtual-time --scans 3 --name p --state
  cmp -s as_export out || fail "as an export it is another program: $(cat as_export)"
}
printf 'PROGRAM P\nVAR\n\tn: INT;\nEND_VAR\n%s\nn := n + 1; // it is END_PROGRAM (* yet\nn := n + 10;\nEND_PROGRAM\n' "$marker" | text_only
grep -q 'P.n=33' out || fail "a row is lost: $(cat out)"
printf 'PROGRAM P\nVAR\n\tn: INT;\nEND_VAR\nn := n + 1;\nEND_PROGRAM\nCONFIGURATION C\nRESOURCE R ON PLC\nTASK T(INTERVAL := T#100ms, PRIORITY := 1);\nPROGRAM Q WITH T : P;\nEND_RESOURCE\nEND_CONFIGURATION\n' | text_only
printf '\357\273\277PROGRAM P\nVAR\n\tn: INT;\nEND_VAR\nm := n + 1;\nEND_PROGRAM\n' >wrong.exp
expect 1 stc check wrong.exp --dialect codesys
said '^wrong.exp:5:1: error'
# Comments that do not nest.
printf "(* @NESTEDCOMMENTS := 'No' *)\nPROGRAM P\nVAR\n\tn: INT;\nEND_VAR\n%s\n(* a (* b *)\nn := n + 1;\nEND_PROGRAM\n(* old (* was *)\nPROGRAM Two\nVAR\n\tn: INT;\nEND_VAR\n%s\nn := n + 2;\nEND_PROGRAM\n" "$marker" "$marker" >flat.exp
expect 0 stvm run flat.exp --dialect codesys --virtual-time --scans 3 --name p --state
said 'P.n=3'
said 'Two.n=6'
# What begins nothing is an error beside a drawing, and what stands behind it comes in.
lost() {
  { { network; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } | body _LD_BODY 1; cat; } >bad.exp
  expect 1 stc import bad.exp -o bad --force
  said "E1074.*$1"
}
printf "{attribute 'x'}\nPROGRAM Lost\nVAR\nEND_VAR\nEND_PROGRAM\n" | lost 'begins nothing that an export holds'
[ -e bad/Lost.st ] || fail "the POU behind it is lost"
{ { network; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } | body _LD_BODY 1 | sed 's/^END_PROGRAM$/END_PROGRAM;/'; printf 'ACTION Act:\na := b;\nEND_ACTION\n'; } >good.exp
expect 0 stc import good.exp -o good --force
grep -q 'ACTION Act' good/P.st || fail "the action behind it is lost: $(cat good/P.st)"
contact a | rung | body _LD_BODY 1 | sed '1i (* open' >bad.exp
expect 1 stc import bad.exp -o bad --force
said 'E1073.*a comment does not end'
# A list of a library without its end, and no attributes of what follows.
{ { network; printf '_LD_ASSIGN\n'; contact a; value; no_boxes; printf '_OUTPUTS : 1\n'; output b; } | body _LD_BODY 1
  printf 'LIBRARY\nPumps.lib 5.6.98 12:03:02\nNumOfPOUs: 1\nFUNCTION: 0\nPROGRAM Behind\nVAR\nEND_VAR\nEND_PROGRAM\n'; } >good.exp
expect 0 stc import good.exp -o good --force
[ -e good/Behind.st ] || fail "the POU behind a list of a library is lost"
# Many POUs whose variables do not end take no longer than one after the other.
awk 'BEGIN { for (i = 0; i < 50000; ++i) print "PROGRAM P" i "\nVAR\nEND_PROGRAM" }' >open.exp
expect 1 stc check open.exp --dialect codesys
# A name of a megabyte takes no longer than one byte after the other.
awk 'BEGIN { printf "PROGRAM P\n"; for (i = 0; i < 1000000; ++i) printf "a"; print " := 1;\n_LD_BODY\nEND_PROGRAM" }' >long.exp
expect 1 stc check long.exp --dialect codesys

# Cut off: an error outside of what is drawn, and nothing is taken for whole.
contact a | rung | body _LD_BODY 1 | head -n 20 >bad.exp
expect 1 stc import bad.exp -o bad --force
said 'E1073.*PROGRAM P has no END_PROGRAM; the export was cut off'
printf '\n(* nothing *)\n' >bad.exp
expect 1 stc import bad.exp -o bad --force
said 'E1071.*there is no PROGRAM, FUNCTION_BLOCK, FUNCTION, TYPE or VAR_GLOBAL in this export'
