#!/bin/sh
# stc export: PLCopen XML of sources, and of documents again. What is imported from it is the same program.
. "$(dirname "$0")/lib.sh"
samples=$source_dir/tests/fuzz/corpus/plcopen
cp "$samples"/ladder.xml "$samples"/blocks.xml "$samples"/objects.xml "$samples"/declarations.xml "$samples"/chart.xml .
printf 'PROGRAM P\nVAR n : INT; END_VAR\n  n := n + 1;\nEND_PROGRAM\n' >p.st
needs_xml stc export p.st -o p.xml
silent_on out
grep -q 'xmlns="http://www.plcopen.org/xml/tc6_0201"' p.xml || fail "namespace"
expect 0 stc export p.st -o old.xml --as tc6-2.0
grep -q 'xmlns="http://www.plcopen.org/xml/tc6_0200"' old.xml || fail "namespace of 2.0"
expect 0 stc export p.st -o again.xml
cmp p.xml again.xml || fail "not the same twice"
expect 2 stc export p.st
expect 2 stc export p.st -o x.xml --as tc6-9
said 'is tc6-2.01, tc6-2.0 or 61131-10, not .tc6-9.'
expect 7 stc export nothing.st -o x.xml
# What is there is only overwritten when it is a document, and never a source.
cp p.st q.st
expect 7 stc export q.st -o ./q.st --force
said 'is a source, or read by this command'
cp p.xml q.xml
expect 7 stc export q.xml -o q.xml
cmp p.st q.st && cmp p.xml q.xml || fail "a source was overwritten"
cp p.st q.txt
expect 7 stc export p.st -o q.txt
said 'is there and no XML; nothing was written. --force overwrites'
expect 0 stc export p.st -o q.xml
expect 0 stc export p.st -o q.txt --force
expect 0 stc export p.st -o q.st --force
printf 'PROGRAM P n := ; END_PROGRAM\n' >bad.st
expect 1 stc export bad.st -o x.xml
said 'bad\.st:1:16: error\[E1005\]'
printf 'NAMESPACE N FUNCTION f : INT f := 1; END_FUNCTION END_NAMESPACE\nPROGRAM P VAR n : INT; END_VAR n := N.f(); END_PROGRAM\n' >space.st
expect 1 stc export space.st -o x.xml --without-sources
said 'space\.st:1:22: error\[E1084\]'
printf 'FUNCTION_BLOCK F VAR_INPUT a : INT; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR_INPUT i : INT; END_VAR END_PROGRAM CONFIGURATION C VAR_GLOBAL g : INT; END_VAR RESOURCE R ON PLC TASK T(INTERVAL := T#1s, PRIORITY := 1); PROGRAM p1 WITH T : P(i := g); END_RESOURCE END_CONFIGURATION' >connected.st
expect 1 stc export connected.st -o x.xml --without-sources
said 'E1084.*connections of a program instance'
[ ! -e x.xml ] || fail "a document was written in spite of errors"

# An edge of an input has no place in TC6, and one in IEC 61131-10.
printf 'FUNCTION_BLOCK F VAR_INPUT up : BOOL R_EDGE; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR f : F; END_VAR f(); END_PROGRAM\n' >edge.st
expect 0 stc export edge.st -o edge.xml
said 'edge\.st:1:28: warning\[W0074\].*no word for R_EDGE'
expect 0 stc export edge.st -o edge10.xml --as 61131-10
if grep -q W0074 err; then fail "IEC 61131-10 has edges"; fi

# What the schema demands, also of drawings that are written as they were read
# (tests/cli/export_schema.sh has the schema itself).
cat >schema.st <<'S'
FUNCTION_BLOCK F VAR t : LTIME; c : CHAR; END_VAR END_FUNCTION_BLOCK
{attribute 'note' := 'x'} PROGRAM P VAR f1 : F; END_VAR f1(); ACTION Go: f1(); END_ACTION END_PROGRAM
S
expect 0 stc export schema.st -o schema.xml
grep -q '<derived name="LTIME" />' schema.xml || fail "an element that TC6 does not have"
expect 0 stc export chart.xml -o chart-again.xml
expect 0 stc export blocks.xml -o blocks-again.xml
python3 - <<'P' || fail "not in the order of the schema"
import xml.etree.ElementTree as tree
def local(node):
    return node.tag.rsplit("}", 1)[-1]
for name in ("schema.xml", "chart-again.xml", "blocks-again.xml"):
    for node in tree.parse(name).iter():
        kinds = [local(child) for child in node]
        if "addData" in kinds:
            assert kinds.index("addData") == len(kinds) - 1 - ("documentation" in kinds), (name, kinds)
        if local(node) == "actionBlock":
            for action in node.findall("{*}action"):
                assert local(action[0]) == "relPosition", name
        if local(node) == "block":
            pins = [kind for kind in kinds if kind.endswith("Variables")]
            assert pins == ["inputVariables", "inOutVariables", "outputVariables"], (name, pins)
P

# Attributes of members, of enumerators and instances, and words that have no element, stay.
cat >words.st <<'S'
TYPE Mode : ({attribute 'shown' := 'off'} Off, On); END_TYPE
TYPE Box : STRUCT {attribute 'unit' := 'mm'} size : INT; END_STRUCT END_TYPE
INTERFACE Moves METHOD Go END_METHOD END_INTERFACE
FUNCTION_BLOCK Base METHOD PUBLIC Go END_METHOD END_FUNCTION_BLOCK
FUNCTION_BLOCK Part EXTENDS Base IMPLEMENTS Moves METHOD PUBLIC OVERRIDE Go END_METHOD END_FUNCTION_BLOCK
PROGRAM P VAR m : Mode; b : Box; p : Part; END_VAR p.Go(); END_PROGRAM
CONFIGURATION C
  {attribute 'schedule' := 'run_first'}
  RESOURCE R ON PLC {attribute 'overrun' := 'lengthen'} TASK T(INTERVAL := T#10ms, PRIORITY := 1); PROGRAM p1 WITH T : P; END_RESOURCE
END_CONFIGURATION
TEST 'nothing' ASSERT_TRUE(TRUE); END_TEST
S
expect 0 stc export words.st -o words.xml --without-sources
said 'words\.st:11:[0-9]+: note\[W0071\]: tests are left out'
rm -rf first
expect 0 stc import words.xml -o first
grep -q "{attribute 'shown' := 'off'} Off" first/Mode.st || fail "attributes of enumerators"
grep -q "^  {attribute 'unit' := 'mm'}$" first/Box.st || fail "attributes of members"
grep -q 'METHOD PUBLIC OVERRIDE Go' first/Part.st || fail OVERRIDE
grep -A1 "^  {attribute 'schedule' := 'run_first'}$" first/C.st | grep -q 'RESOURCE R' || fail "attributes of resources"
expect 0 stc check first

# Documents again: the same sources, with places, ids and addData of the first.
again() {  # again NAME DIFFERENT_FILES
  rm -rf first second
  expect 0 stc import "$1.xml" -o first
  expect 0 stc export "$1.xml" -o "$1.new.xml" --without-sources
  expect 0 stc import "$1.new.xml" -o second
  if diff -rq first second >differs; then :; fi
  [ "$(wc -l <differs)" -le "$2" ] || fail "$1 is another program: $(cat differs)"
}
again declarations 0
again ladder 0
again blocks 0
again objects 0
again chart 0
expect 0 stc build blocks.new.xml -o blocks.img
expect 0 stvm run blocks.img --scans 6 --virtual-time --print M.total --print M.seen --print M.pulses --print M.c
said '^M.total=30$'
said '^M.seen=30$'
said '^M.pulses=2$'
said '^M.c=6$'
grep -q '<contact localId="4" ' ladder.new.xml || fail "ids are lost"
grep -A1 '<contact localId="4" ' ladder.new.xml | grep -q '<position x="200" y="20" />' || fail "places are lost"
grep -q '<data name="http://vendor.example/xml/trend" handleUnknown="implementation">' objects.new.xml || fail "addData is lost"
# Diagrams are written as they were drawn, with comments, connectors, variables that are read and written, data of vendors.
elements() { sed -n '/<\(LD\|FBD\)>/,/<\/\(LD\|FBD\)>/p' "$1" | grep -o '<[a-zA-Z]*[^>]*localId="[0-9]*"' | sed 's/^<[a-z0-9]*:/</' | sort; }
for name in ladder blocks; do
  elements $name.xml >drawn
  [ -s drawn ] || fail "$name has no elements"
  elements $name.new.xml | cmp - drawn || fail "$name lost elements"
done
sed 's/<contact localId="4"[^>]*>/&<addData><data name="http:\/\/vendor.example\/xml\/contact" handleUnknown="implementation"><lamp\/><\/data><\/addData>/' ladder.xml >vendor.xml
expect 0 stc export vendor.xml -o vendor.new.xml --without-sources
expect 0 stc export vendor.new.xml -o vendor.third.xml --without-sources --name vendor
[ "$(grep -c 'vendor.example/xml/contact' vendor.third.xml)" -eq 1 ] || fail "data of a vendor in a contact"
# A chart is written as it was drawn: ids, places, divergences, actions in steps, transitions of their own, names, data of vendors.
for part in '<step localId="5" name="Fill left" ' '<simultaneousDivergence localId="4" height="1" width="100">' '<transition name="Both">' '<relPosition x="0" y="0" />' '<xhtml:p><!.CDATA.left := 0;'; do
  grep -q "$part" chart.new.xml || fail "a chart lost $part"
done
grep -A1 '<step localId="5"' chart.new.xml | grep -q '<position x="50" y="200" />' || fail "places of a chart are lost"
grep -q 'Fill_left_action' chart.new.xml && fail "an action in a step is there twice"
sed 's/<ns1:step localId="6" name="FillRight">/&<ns1:addData><ns1:data name="http:\/\/vendor.example\/xml\/step" handleUnknown="implementation"><v:time xmlns:v="urn:v" v:max="3">7<\/v:time><\/ns1:data><\/ns1:addData>/' chart.xml >vendor.xml
expect 0 stc export vendor.xml -o vendor.new.xml --without-sources
grep -q '<time xmlns="urn:v" xmlns:v="urn:v" v:max="3">7</time>' vendor.new.xml || fail "data of a vendor in a step"
[ "$(grep -c 'vendor.example/xml/step' vendor.new.xml)" -eq 1 ] || fail "data of a vendor is there twice"
# What was written once is written the same again.
for name in declarations ladder blocks objects chart; do
  expect 0 stc export $name.new.xml --name $name -o $name.third.xml --without-sources
  expect 0 stc export $name.third.xml --name $name -o $name.fourth.xml --without-sources
  cmp $name.third.xml $name.fourth.xml || fail "$name changes with every export"
done

# Comments that XML has no place for are named; others are not.
cat >comments.st <<'S'
(* what it is *)
PROGRAM P
VAR
  // in front of a variable
  n : INT;  // behind a variable
END_VAR
  n := n + 1;  (* in a body *) // twice
END_PROGRAM
// at the end
(* nested (* and *) more *)
TEST 'nothing' ASSERT_TRUE(TRUE); (* of a test *) END_TEST
S
expect 0 stc export comments.st -o comments.xml --without-sources
said 'comments\.st:4:3: note\[W0071\]: 3 comment\(s\) are left out, in line\(s\) 4, 9, 10: XML has no place'
for form in tc6-2.01 61131-10; do
  rm -rf first
  expect 0 stc export "$source_dir/examples/heating" -o heating.xml --as $form --without-sources
  said 'note\[W0071\]: 1 comment\(s\) are left out, in line\(s\) 1:'
  expect 0 stc import heating.xml -o first
  grep -rqF 'frost: whatever is switched and open' first || fail "comment of an element by $form"
done

# Types and variables in files of their own: initial values of the one in the other.
mkdir files
printf 'TYPE Link : STRUCT at : POINTER TO INT := ADR(shared); n : INT := 4; END_STRUCT END_TYPE\n' >files/a.st
printf 'VAR_GLOBAL\n  shared : INT := 7;\n  links : ARRAY[1..2] OF Link := [(n := 1), (at := ADR(other))];\n  other : INT := 8;\nEND_VAR\nPROGRAM P VAR x : INT; END_VAR x := links[1].at^ + links[2].at^; END_PROGRAM\n' >files/b.st
expect 0 stc export files -o files.xml
expect 0 stc build files.xml -o files.img
expect 0 stvm run files.img --scans 1 --virtual-time --print P.x
said '^P.x=15$'

# IEC 61131-10, and what is not known of it.
expect 0 stc export p.st -o ten.xml --as 61131-10
grep -q '<Project xmlns="www.iec.ch/public/TC65SC65BWG7TF10"' ten.xml || fail "namespace of 61131-10"
expect 1 stc export chart.xml -o x.xml --as 61131-10 --without-sources
said 'E1084.*`Batch`: charts have no known elements'
printf 'TYPE Percent : INT (0..100); END_TYPE PROGRAM P VAR p : Percent; q : POINTER TO INT; END_VAR END_PROGRAM' >types.st
expect 1 stc export types.st -o x.xml --as 61131-10 --without-sources
said 'E1084.*`Percent`: types other than'
said 'types\.st:1:[0-9]+: error\[E1084\]: `P`: `q`: the type <pointer> has no known element'
printf 'PROGRAM P VAR a, b : BOOL; END_VAR\nFBD\n  a S= b;\nEND_FBD\nEND_PROGRAM\n' >set.st
expect 1 stc export set.st -o x.xml --as 61131-10 --without-sources
said 'E1084.*a DataSink has no modifiers'
printf "{attribute 'qualified_only'}\n{attribute 'list' := 'Keys'}\nVAR_GLOBAL a : BOOL; END_VAR\n" >list.st
cat p.st >>list.st
expect 1 stc export list.st -o x.xml --as 61131-10 --without-sources
said 'E1084.*attributes of lists of variables have no element'
cp "$samples"/iec10.xml .
expect 0 stc export ladder.xml -o ladder10.xml --as 61131-10 --without-sources
rm -rf first second
expect 0 stc import ladder.xml -o first
expect 0 stc import ladder10.xml -o second
diff -r first second || fail "61131-10: another program"

# there FORM FILE...: programs of the golden files by their elements; what comes back does the same.
there() {
  form=$1
  shift
  count=0
  for file; do
    name=$(basename "$file" .st)
    [ "$name" != latin1 ] || continue  # its strings have other bytes in UTF-8
    cp "$file" one.st
    stc build one.st -o one.img >out 2>err || continue
    code=0
    stc export one.st -o one.xml --as "$form" --without-sources >out 2>err || code=$?
    if [ "$code" -ne 0 ]; then
      grep -q E1084 err || fail "$name: export"
      continue
    fi
    mkdir -p back
    stc build one.xml -o back/one.img >out 2>err || fail "$name: what was exported does not build"
    # What edges remember has the names of wires, and XML has none.
    stvm run one.img --scans 20 --virtual-time --state 2>/dev/null | grep -v '#' | sort >state || true
    stvm run back/one.img --scans 20 --virtual-time --state 2>/dev/null | grep -v '#' | sort | cmp -s - state || fail "$name: another state"
    count=$((count + 1))
  done
}
golden=$source_dir/tests/golden
there tc6-2.01 "$golden"/sfc/*.st "$golden"/il/*.st "$golden"/ladder/*.st "$golden"/fbd/*.st "$golden"/run/*.st
[ "$count" -ge 90 ] || fail "only $count programs were compared"
echo "$count programs went there and back by TC6"
there 61131-10 "$golden"/il/*.st "$golden"/ladder/*.st "$golden"/fbd/*.st "$golden"/timing/*.st "$golden"/run/*.st
[ "$count" -ge 70 ] || fail "only $count programs were compared by 61131-10"
echo "$count programs went there and back by 61131-10"

# GET and SET with an access of their own keep it, and a packed structure stays packed.
cat >own.st <<'X'
FUNCTION_BLOCK F
VAR n : INT; END_VAR
  PROPERTY P : INT
    GET PROTECTED
      P := n;
    END_GET
    SET PRIVATE
    VAR k : INT; END_VAR
      k := P;
      n := k;
    END_SET
  END_PROPERTY
END_FUNCTION_BLOCK
{attribute 'pack_mode' := '1'}
TYPE T : STRUCT a : BYTE; d : DINT; END_STRUCT END_TYPE
X
expect 0 stc export own.st -o own.xml --without-sources
expect 0 stc import own.xml -o own
[ "$(grep -c 'GET PROTECTED\|SET PRIVATE' own/F.st)" -eq 2 ] || fail "the access of an accessor"
grep -q "pack_mode' := '1'" own/*.st || fail "pack_mode"
