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
exit 0
