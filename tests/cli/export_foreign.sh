#!/bin/sh
# A document of another tool that was not changed goes out as its own: who made it and with what, how
# its drawings are scaled, ids of objects and the tree of the project, each where it stood.
. "$(dirname "$0")/lib.sh"
sample=$source_dir/tests/fuzz/corpus/plcopen/foreign.xml
needs_xml stc check "$sample"
cat >same.py <<'P'
# same.py FIRST SECOND: prints what of the first document is not in the second.
import sys
import xml.etree.ElementTree as tree

KINDS = {"project", "contentHeader", "dataType", "pou", "Method", "Property", "GetAccessor", "action",
         "resource", "task", "globalVars", "Interface"}
def name(node): return node.tag.rpartition("}")[2]
def whole(node):
    words = [name(node), node.tag.rpartition("}")[0]] + sorted(node.attrib.items())
    return (str(words), (node.text or "").strip(), [whole(each) for each in node])
def marks(node, path, out):
    if name(node) in KINDS: path = path + [node.get("name", name(node))]
    if node.get("ObjectId") and name(node) in KINDS: out.append(("/".join(path[-2:]), "ObjectId", node.get("ObjectId")))
    for add in node:
        if name(add) != "addData": continue
        for data in add:
            kind = data.get("name").rpartition("/")[2]
            if kind in ("application", "interface", "method", "property", "globalvars"): continue
            if "stc" in data.get("name"): continue
            out.append(("/".join(path[-2:]), kind, whole(data)))
    for each in node: marks(each, path, out)
    return out

first, second = (tree.parse(each).getroot() for each in sys.argv[1:3])
wrong = [] if first.tag == second.tag else [second.tag]
for header in ("fileHeader", "contentHeader"):
    one, two = (next(each for each in root if name(each) == header) for root in (first, second))
    if one.attrib != two.attrib: wrong.append((header, two.attrib))
    rest = [[whole(each) for each in node if name(each) != "addData"] for node in (one, two)]
    if rest[0] != rest[1]: wrong.append((header, rest[1]))
known = sorted(marks(first, [], []))
found = sorted(marks(second, [], []))
wrong += [("missing", each) for each in known if known.count(each) > found.count(each)]
wrong += [("new", each) for each in found if found.count(each) > known.count(each)]
assert len(known) == 18, len(known)
print("\n".join(map(str, wrong)))
sys.exit(bool(wrong))
P
for more in '' --without-sources; do
  # shellcheck disable=SC2086
  expect 0 stc export "$sample" -o out.xml --force $more
  expect 0 python3 same.py "$sample" out.xml
  # There and back, twice.
  # shellcheck disable=SC2086
  expect 0 stc export out.xml -o again.xml --force $more
  expect 0 python3 same.py "$sample" again.xml
  expect 0 stc check again.xml
done
# The form can be another one all the same; what editors of TC6 keep stays out of IEC 61131-10.
expect 0 stc export "$sample" -o new.xml --as tc6-2.01
grep -q 'xmlns="http://www.plcopen.org/xml/tc6_0201"' new.xml || fail "the form that was asked for"
grep -q 'productName="CODESYS"' new.xml || fail "the header in another form"
expect 0 stc export "$sample" -o ten.xml --as 61131-10 --force
grep W0074 err | grep -q 'objectid\|projectstructure' && fail "ids of objects are missed in IEC 61131-10"
grep -q 'ObjectId' ten.xml && fail "ids of objects in IEC 61131-10"

# What the schema demands and another tool has left out is added.
sed -e 's/ companyName="[^"]*"//' -e 's/ creationDateTime="[^"]*"//' -e '/<coordinateInfo>/,/<\/coordinateInfo>/d' \
  "$sample" >bare.xml
expect 0 stc export bare.xml -o out.xml --force
grep -q '<fileHeader .*companyName=""' out.xml || fail "a company"
grep -q '<fileHeader .*creationDateTime="1970-01-01T00:00:00"' out.xml || fail "a date"
grep -A8 '<coordinateInfo>' out.xml | grep -c '<scaling x="1" y="1"' | grep -qx 3 || fail "scaling"

# Of two documents neither header is right, and a source has none.
sed 's/name="\(Pump\|PLC_PRG\|Mode\|G\|ITank\|Application\)"/name="Other\1"/; s/"Pump"/"OtherPump"/; s/"Mode"/"OtherMode"/; s/G\.total/OtherG.total/' \
  "$sample" >second.xml
expect 0 stc export "$sample" second.xml -o out.xml --force
grep -q 'productName="stc"' out.xml || fail "the header of two documents"
printf 'PROGRAM P\nVAR n : INT; END_VAR\n  n := 1;\nEND_PROGRAM\n' >p.st
expect 0 stc export p.st -o own.xml
grep -q 'productName="stc"' own.xml || fail "a header of its own"
sed 's/productVersion="[^"]*"/productVersion="0.0.1"/' own.xml >older.xml
expect 0 stc export older.xml -o own.xml
grep -q 'productVersion="0.0.1"' own.xml && fail "a header of an older stc was kept"

# Declarations as text, and texts in <xhtml>, go out where they came in.
cat >texts.xml <<'X'
<?xml version="1.0" encoding="utf-8"?>
<project xmlns="http://www.plcopen.org/xml/tc6_0200">
  <fileHeader companyName="" productName="CODESYS" productVersion="CODESYS V3.5" creationDateTime="2021-03-04T10:11:12" />
  <contentHeader name="texts"><coordinateInfo><fbd><scaling x="1" y="1" /></fbd><ld><scaling x="1" y="1" /></ld><sfc><scaling x="1" y="1" /></sfc></coordinateInfo></contentHeader>
  <types><dataTypes /><pous><pou name="Count" pouType="functionBlock">
    <interface><localVars><variable name="n"><type><INT /></type></variable></localVars></interface>
    <body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">n := n + 1;</xhtml></ST></body>
    <addData>
      <data name="http://www.3s-software.com/plcopenxml/interfaceasplaintext" handleUnknown="implementation"><InterfaceAsPlainText><xhtml xmlns="http://www.w3.org/1999/xhtml">FUNCTION_BLOCK Count
VAR
	n : INT; // pieces &amp; more
END_VAR
</xhtml></InterfaceAsPlainText></data>
      <data name="http://www.3s-software.com/plcopenxml/method" handleUnknown="implementation"><Method name="Clear"><interface /><body><ST><xhtml xmlns="http://www.w3.org/1999/xhtml">n := 0;</xhtml></ST></body>
        <addData><data name="http://www.3s-software.com/plcopenxml/interfaceasplaintext" handleUnknown="implementation"><InterfaceAsPlainText><xhtml xmlns="http://www.w3.org/1999/xhtml">METHOD Clear</xhtml></InterfaceAsPlainText></data></addData></Method></data>
    </addData>
  </pou></pous></types>
  <instances><configurations /></instances>
</project>
X
expect 0 stc export texts.xml -o back.xml
cat >texts.py <<'P'
import sys
import xml.etree.ElementTree as tree

def said(path):
    root = tree.parse(path).getroot()
    name = lambda node: node.tag.rpartition("}")[2]
    texts = [" ".join("".join(each.itertext()).split()) for each in root.iter() if name(each) == "InterfaceAsPlainText"]
    bodies = [[name(each) for each in node] for node in root.iter() if name(node) == "ST"]
    return texts, bodies

first, second = said("texts.xml"), said(sys.argv[1])
assert first == second, second
P
python3 texts.py back.xml || fail "texts of declarations"
expect 0 stc export back.xml -o again.xml
python3 texts.py again.xml || fail "texts of declarations, the second time"
cmp -s back.xml again.xml || fail "not the same the second time"
exit 0
