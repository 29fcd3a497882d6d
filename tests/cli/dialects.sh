#!/bin/sh
# --dialect and `dialect` in stc.toml mean the same in every command that reads sources.
. "$(dirname "$0")/lib.sh"

mkdir p
printf 'PROGRAM Main VAR i : INT; d : DINT; END_VAR i := d; d := i; END_PROGRAM\n' >p/a.st

for dialect in codesys twincat; do
  expect 0 stc check --dialect $dialect p
  said 'warning\[W0001\]'
  expect 0 stc build --dialect $dialect p -o $dialect.img
done
expect 0 stc check p
said 'warning\[W0001\]'
cmp codesys.img twincat.img || fail "twincat is another program"
for command in 'check' 'build -o x.img' 'dump --ir'; do
  expect 1 stc $command --dialect iec p
  said 'error\[E3001\]'
done
[ ! -e x.img ] || fail "an image in spite of errors"
expect 0 stc diff --dialect codesys codesys.img p
expect 1 stc diff --dialect iec codesys.img p
expect 1 stc package --dialect iec --base codesys.img p -o x.pkg
expect 1 stc check --dialect=iec p

printf 'dialect = "iec"\n' >p/stc.toml
expect 1 stc check p
said 'error\[E3001\]'
expect 0 stc check --dialect codesys p
printf 'dialect = "pascal"\n' >p/stc.toml
expect 7 stc check p
said 'stc.toml:1:11: error.R0506.: `dialect` must be "iec", "codesys" or "twincat", not "pascal"'
printf 'strict_strings = 1\n' >p/stc.toml
expect 7 stc check p
said 'stc.toml:1:18: .*strict_strings'
printf 'strict_strings = true\n' >p/stc.toml
expect 0 stc check --dialect codesys p
rm p/stc.toml
expect 2 stc check --dialect pascal p
said 'is iec, codesys or twincat, not .pascal.'

expect 0 stc --help
for dialect in iec codesys twincat; do said "^  $dialect "; done
expect 0 stc explain dialects
said 'conversion that can lose'
