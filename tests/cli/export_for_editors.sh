#!/bin/sh
# Documents of stc export have what the editors of Beremiz and OpenPLC need and no schema demands
# (tests/cli/for_editors.py): texts in <xhtml:p>, CDATA nowhere else, names of pins, sizes, where pins
# are, and wires from pin to pin. Of every drawing and list of the golden files, with the text of the
# sources and without, and of drawings that are written as they were read.
. "$(dirname "$0")/lib.sh"

printf 'PROGRAM P\nVAR n : INT; END_VAR\n  n := n + 1;\nEND_PROGRAM\n' >p.st
needs_xml stc export p.st -o p.xml
# reads DOCUMENT...
reads() { python3 "$source_dir/tests/cli/for_editors.py" "$@" >said 2>&1 || fail "$(cat said)"; }
reads p.xml
# Documents that miss something would be seen.
# wrong SED
wrong() {
  sed "$1" whole.xml >wrong.xml
  cmp -s whole.xml wrong.xml && fail "$1 changes nothing"
  if python3 "$source_dir/tests/cli/for_editors.py" wrong.xml >said 2>&1; then fail "$1 is not seen"; fi
}
printf 'PROGRAM P\nVAR n : INT; a, b : BOOL; END_VAR\nLADDER\n  // seen\n  |--[ a ]--[ n := ADD(n, 1) ]--( b )--|\nEND_LADDER\nEND_PROGRAM\n' >whole.st
expect 0 stc export whole.st -o whole.xml
reads whole.xml
grep -q '<variable formalParameter="IN2">' whole.xml || fail "names of pins"
# The order of a ladder is that of its places.
grep -q executionOrderId whole.xml && fail "an order in a ladder"
printf 'PROGRAM P\nVAR n : INT; a : BOOL; END_VAR\nFBD\n  n := n + 1;\n  a := n > 3;\nEND_FBD\nEND_PROGRAM\n' >order.st
expect 0 stc export order.st -o order.xml
grep -q 'executionOrderId="2"' order.xml || fail "no order in a function block diagram"
wrong 's/<relPosition x="0" y="7" \/>//'
wrong '/<connection refLocalId="2"/,/<\/connection>/s/<position [^>]*>//'
wrong 's/<position x="108" y="63" \/>/<position x="109" y="63" \/>/'
wrong 's/ height="15" width="21"//'
wrong 's/formalParameter="IN2"/formalParameter=""/'
wrong 's/xhtml:p>/xhtml:div>/g'
wrong 's/<xhtml:p><!\[CDATA\[/<xhtml:p> <![CDATA[/'

mkdir documents
number=0
find "$source_dir/tests/golden/ladder" "$source_dir/tests/golden/fbd" "$source_dir/tests/golden/sfc" \
  "$source_dir/tests/golden/il" "$source_dir/tests/golden/objects" -name '*.st' ! -name 'fail_*' | sort >sources
while read -r source; do
  number=$((number + 1))
  stc export "$source" -o "documents/$number.xml" >out 2>&1 || continue
  stc export "$source" -o "documents/$number.alone.xml" --without-sources >out 2>&1 || true
done <sources
for name in chart ladder blocks declarations; do
  expect 0 stc export "$source_dir/tests/fuzz/corpus/plcopen/$name.xml" -o "documents/$name.xml" --without-sources
done
reads documents/*.xml
cat said
[ "$(ls documents | wc -l)" -gt 150 ] || fail "only $(ls documents | wc -l) documents"
