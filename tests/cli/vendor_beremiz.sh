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

# runs WHAT FILE: the values after each scan into FILE; `a[1,2]` is one column.
runs() {
  expect 0 stvm run "$1" --dialect iec --virtual-time --scans 60 --name p --trace trace.csv
  sed '1s/"\([^",]*\),\([^"]*\)"/\1;\2/g' trace.csv >"$2"
}
# same NAME WHAT FORM: of variables that both have; the text has memories of its own.
same() {
  runs "$2" values.csv
  awk -F, 'FNR == 1 && NR == 1 { for (i = 2; i <= NF; i++) place[$i] = i; next }
    FNR == 1 { for (i = 2; i <= NF; i++) if ($i in place) { name[i] = $i; both++ } next }
    NR == FNR { meant[FNR] = $0; last = FNR; next }
    { split(meant[FNR], cell, ",")
      for (i in name) if (cell[place[name[i]]] != $i) {
        print "scan " $1 ": " name[i] " is " $i " instead of " cell[place[name[i]]]; bad = 1 }
      rows = FNR }
    END {
      if (both < 5) { print "only " both + 0 " variables"; bad = 1 }
      if (rows != last || rows != 61) { print rows " of " last " rows"; bad = 1 }
      exit bad }' meaning.csv values.csv >differs || fail "$1, $3: $(head -5 differs)"
}
refused=
seen=0
for project in "$corpus"/beremiz/*.xml; do
  name=$(basename "$project" .xml)
  runs "$corpus/drawn_beremiz/$name.st" meaning.csv
  same "$name" "$project" "as it is"
  expect 0 stc import "$project" -o text
  same "$name" text "as text"
  code=0
  stc export text --dialect iec --without-sources -o back.xml --force >out 2>err || code=$?
  if [ $code -ne 0 ]; then
    said E1084
    refused="$refused $name"
  else
    expect 0 stc import back.xml -o back
    same "$name" back "from XML"
  fi
  # The document itself goes out and in with its places.
  expect 0 stc export "$project" --dialect iec --without-sources -o again.xml --force
  same "$name" again.xml "written again"
  rm -rf text back
  seen=$((seen + 1))
done
[ "$refused" = "" ] || fail "without elements:$refused"
[ "$seen" -ge 50 ] || fail "only $seen projects"
echo "$seen projects"
