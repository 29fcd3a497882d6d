#!/bin/sh
# stvm links without frontend and linker (docs/ARCHITECTURE.md): no symbol of
# theirs is in the binary. A control: the same search finds them in stc.
set -eu
bin="$2/bin"
count() { nm -C "$1" 2>/dev/null | grep -cE ' [TtWw] (frontend|linker|ir::lower)::?' || true; }
in_stvm=$(count "$bin/stvm")
in_stc=$(count "$bin/stc")
echo "compiler symbols: stvm $in_stvm, stc $in_stc"
[ "$in_stvm" -eq 0 ] && [ "$in_stc" -gt 100 ]
