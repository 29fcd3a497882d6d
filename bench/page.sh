#!/bin/sh
# Puts docs/performance.md together from the sections that the programs of bench/ wrote.
# usage: page.sh FOLDER_OF_SECTIONS SOURCE_DIR MACHINE
set -eu
sections=$1
docs=$2/docs
machine=$3
# A section that was not measured here is named, not left out silently.
section() {  # section FILE TITLE COMMAND
  if [ -e "$sections/$1" ]; then
    cat "$sections/$1"
  else
    printf '## %s\n\nNot measured here: `%s`.\n' "$2" "$3"
  fi
  echo
}
{
  printf '# Performance\n\n'
  printf 'Written by `make bench`. Machine: %s. Compilers: %s.\n' "$machine" "$(cat "$sections/compilers.txt")"
  printf 'Only ratios mean anything on another machine, and absolute figures vary with what else runs on this one.\n'
  printf 'Array bounds, division and fuel checks are on in every figure of ST, and absent in C.\n'
  printf 'How long online changes stop the tasks: [pause.md](pause.md).\n\n'
  section scan.md 'Scan time' 'make bench'
  cat "$2/bench/machines.md"
  echo
  section build.md 'Compiler' 'make bench'
  section build_large.md 'Compiler, a million lines' 'make bench-large'
  section edit_large.md 'An edit in a million lines' 'make bench-large'
  section live_edit_large.md 'From saved file to running, a million lines' 'make bench-large'
  section start.md 'Size and start' 'make bench'
  section force.md 'Forcing' 'make bench'
} | cat -s | sed '$d' >"$docs/performance.md"
python3 "$(dirname "$0")/../scripts/wrap_pages.py" "$docs/performance.md"
cp "$sections/performance.svg" "$docs/performance.svg"
echo "wrote $docs/performance.md and performance.svg"
