#!/bin/sh
# Projects as the editors of Beremiz and OpenPLC store them (tests/vendors/beremiz, made by
# tests/vendors/draw_beremiz.py) do what their program in ST does (tests/vendors/drawn_beremiz): as
# they are, as text that comes of the import, when that went to PLCopen XML and back, and when the
# document was written again with its places. In the dialect of the standard, which has the blocks
# that these editors know.
. "$(dirname "$0")/lib.sh"
corpus="$source_dir/tests/vendors"
first=$(ls "$corpus"/beremiz/*.xml | head -1)
needs_xml stvm run "$first" --dialect iec --scans 1 --virtual-time

# What is checked in is what the notation says.
python3 "$corpus/draw_beremiz.py" drawn
diff -r drawn "$corpus/beremiz" >differs || fail "draw_beremiz.py writes something else: $(head -5 differs)"

# runs WHAT SCANS FILE: the state into FILE.
runs() {
  expect 0 stvm run "$1" --dialect iec --virtual-time --scans "$2" --name p --state
  cp out "$3"
}
# same NAME WHAT SCANS: of variables that both have; the text has memories of its own.
same() {
  awk -F= 'NR == FNR { text[$1] = $0; next }
    ($1 in text) { same++; if (text[$1] != $0) { print text[$1] " | " $0; bad = 1 } }
    END { if (same < 5) print "only " same + 0 " variables"; exit bad || same < 5 }' \
    "meaning_$3" state >differs || fail "$1, $2, after $3 scans: $(cat differs)"
}
refused=
seen=0
for project in "$corpus"/beremiz/*.xml; do
  name=$(basename "$project" .xml)
  for scans in 1 7 18 43; do
    runs "$corpus/drawn_beremiz/$name.st" $scans meaning_$scans
    runs "$project" $scans state
    same "$name" "as it is" $scans
  done
  expect 0 stc import "$project" -o text
  runs text 43 state
  same "$name" "as text" 43
  code=0
  stc export text --dialect iec --without-sources -o back.xml --force >out 2>err || code=$?
  if [ $code -ne 0 ]; then
    said E1084
    refused="$refused $name"
  else
    expect 0 stc import back.xml -o back
    runs back 43 state
    same "$name" "from XML" 43
  fi
  # The document itself goes out and in with its places.
  expect 0 stc export "$project" --dialect iec --without-sources -o again.xml --force
  runs again.xml 43 state
  same "$name" "written again" 43
  rm -rf text back
  seen=$((seen + 1))
done
[ "$refused" = "" ] || fail "without elements:$refused"
[ "$seen" -ge 50 ] || fail "only $seen projects"
echo "$seen projects"
