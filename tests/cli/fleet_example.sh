#!/bin/sh
# E-32, E-06: examples/fleet does what its README says.
. "$(dirname "$0")/lib.sh"

example=$source_dir/examples/fleet
for version in "" faster line2 line3; do
  set -- "$example/main.st"
  for part in filler capper; do
    own=$example/$version/$part.st
    [ -e "$own" ] || own=$example/$part.st
    set -- "$@" "$own"
  done
  expect 0 stc check "$@"
  if grep -qE '(error|warning)\[' err; then fail "diagnostics for $version"; fi
  expect 0 stc fmt --check "$@"
done
PATH=$bin:$PATH
export PATH
expect 0 "$example/run.sh" demo
said '^faster.fleet: 1 part.s., '
said '^unit Filler +[0-9a-f]{8} +[0-9a-f]{8} +[0-9a-f]{8}[*]$'
said '^unit Filler +ok +different[*]$'
said '^line1 +line +done +1 of 1 '
said '^line2 +line +done +1 of 1 '
said '^line3 +line +refused +0 of 1 +R0320: '
said '^1 left: '
said '^Filler +FB +[0-9a-f]{12}[*] +B +before '
said '^Capper +FB +[0-9a-f]{12} +A +- '
said '^controller  stvm [0-9.]+(-dev)?, images [0-9]+ to [0-9]+, protocol [0-9]+$'
said '^Capper.turns +- +DINT$'
said '^line1 +line +undone +E1 '
said '^line3 +line +had it not +-'
