#!/bin/sh
# Every file that a comment or a page names is there: from the root, from the folder of who names
# it, or anywhere by its last parts. What a program writes, and names that stand for others, are in
# the list below.
set -eu
cd "$1"
# Written by bench/ into its own folder; parts of names; of Linux.
not_ours=" force.md scan.md start.md linux/magic.h cli/x.sh targets.txt "
files=$(mktemp)
trap 'rm -f "$files"' EXIT
find . \( -path ./build -o -path ./.git -o -name node_modules -o -path ./.library \) -prune -o \
  -type f -print | sed 's|^\./||' >"$files"
grep -E '\.(cc|h|def|sh|md|txt|cmake|st)$|Makefile$' "$files" |
  xargs awk -v list="$files" -v not_ours="$not_ours" '
  BEGIN {
    while ((getline file <list) > 0) {
      known[file] = 1
      while ((at = index(file, "/")) > 0) {
        file = substr(file, at + 1)
        known[file] = 1
      }
    }
  }
  function comment(line) {
    if (FILENAME ~ /\.md$/) return line
    if (FILENAME ~ /\.(cc|h|def)$/) {
      if (line ~ /^ *#include/) return ""
      return match(line, /\/\/.*/) ? substr(line, RSTART) : ""
    }
    if (FILENAME ~ /\.st$/) return line ~ /^\/\/ *(CHECK|>)/ || line !~ /^\/\// ? "" : line
    return match(line, /#.*/) ? substr(line, RSTART) : ""
  }
  # As it is written there: a link of a page begins in the folder of the page.
  function from(folder, name) {
    while (name ~ /^\.\.\//) {
      name = substr(name, 4)
      sub(/[^\/]*\/$/, "", folder)
    }
    return folder name
  }
  {
    text = comment($0)
    while (match(text, /[A-Za-z0-9_.\/<*$-]+\.(md|cc|h|def|sh|txt|cmake)/)) {
      name = substr(text, RSTART, RLENGTH)
      behind = substr(text, RSTART + RLENGTH, 1)
      text = substr(text, RSTART + RLENGTH)
      if (behind ~ /[A-Za-z0-9_*]/ || name ~ /[<*$]|^[-\/]|[A-Z]*NAME|^FILE\./) continue
      folder = FILENAME
      sub(/[^\/]*$/, "", folder)
      if (name in known || from(folder, name) in known || index(not_ours, " " name " ")) continue
      print FILENAME ":" FNR ": " name " is not there"
      bad = 1
    }
  }
  END { exit bad }'

# "ADR 0009" is a file of docs/adr.
status=0
for number in $(grep -E '\.(cc|h|def|sh|md|st)$' "$files" | xargs grep -ohE 'ADR [0-9]{4}' | sort -u |
  sed 's/ADR //'); do
  grep -q "^docs/adr/$number-" "$files" || { echo "ADR $number is not there"; status=1; }
done
exit $status
