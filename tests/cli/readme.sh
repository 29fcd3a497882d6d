#!/bin/sh
# The commands of the README, as they stand there.
. "$(dirname "$0")/lib.sh"
cp -r "$source_dir/examples" .
for command in 'stvm run' 'stc build'; do
  line=$(grep "^$command" "$source_dir/README.md") || fail "README has no '$command'"
  PATH="$bin:$PATH" sh -c "$line" >out 2>err || fail "$line"
  [ "$command" = 'stc build' ] || said 'Blink.Changes=3'
done
serve plc line.img
grep -q '^stvm change examples/bottling_line_v2 --dir plc' "$source_dir/README.md" || fail "README's change"
expect 0 stvm change examples/bottling_line_v2 --dir plc --yes --allow-loss
said 'releases missed'
expect 0 stvm undo --dir plc
expect 0 stvm stop --dir plc

# Those of the examples' page: the line and its change.
set -- $(grep '^stvm serve .*bottling_line$' "$source_dir/examples/README.md")
[ "$3 $4" = '--dir state' ] && [ -d "$source_dir/$5" ] || fail "examples: $*"
serve state "$source_dir/$5"
expect 0 $(grep '^stvm change .*bottling_line_v2$' "$source_dir/examples/README.md")
said 'releases missed'
expect 0 stvm stop --dir state
