#!/bin/sh
# What is shipped is hardened (docs/SECURITY.md): position-independent, its tables of addresses
# read-only before main(), no memory that is writable and executable, calls of the C library with
# the sizes that are known, and stacks whose overflow is a trap. The kernel reads the first four in
# the ELF file, so this does too. Nor do they ask for CET, which would end the native tier: its code
# has no ENDBR64, and drops return addresses.
set -eu
cache="$2/CMakeCache.txt"
setting() { sed -n "s/^$1:[A-Z]*=//p" "$cache"; }
[ "$(setting CMAKE_BUILD_TYPE) $(setting STC_SANITIZE) $(setting STC_COVERAGE)" = "Release  OFF" ] ||
  { echo "left out: not a release build"; exit 77; }
status=0
# must WHERE WHAT PATTERN TEXT; must_not likewise
must() { echo "$4" | grep -qE "$3" || { echo "$1: $2"; status=1; }; }
must_not() { ! echo "$4" | grep -qE "$3" || { echo "$1: $2"; status=1; }; }

for name in stc stvm stvm-agent stvm-fleet; do
  header=$(readelf -hW "$2/bin/$name")
  segments=$(readelf -lW "$2/bin/$name")
  dynamic=$(readelf -dW "$2/bin/$name")
  symbols=$(readelf --dyn-syms -W "$2/bin/$name")
  notes=$(readelf -nW "$2/bin/$name")
  must "$name" "not position-independent" 'Type: +DYN' "$header"
  must "$name" "its tables of addresses stay writable" 'GNU_RELRO' "$segments"
  must "$name" "addresses are looked up late" 'FLAGS_1.* NOW' "$dynamic"
  must "$name" "not said whether the stack is executable" 'GNU_STACK' "$segments"
  must_not "$name" "a segment is writable and executable" 'RWE' "$segments"
  must_not "$name" "code is written at the start" 'TEXTREL' "$dynamic"
  must_not "$name" "marked for CET; compile with -fcf-protection=none" 'IBT|SHSTK' "$notes"
  must_not "$name" "libraries are searched in a path of the build" 'R(UN)?PATH' "$dynamic"
  must "$name" "no stack protector" '__stack_chk_fail' "$symbols"
  must "$name" "no sizes are checked" '__(memcpy|memmove|memset|snprintf|read|recv)_chk' "$symbols"
done

# The compiler leaves no mark of these that could be told from those of libraries.
for flag in -fstack-clash-protection -D_FORTIFY_SOURCE=3 -fstack-protector-strong; do
  without=$(grep '"command".* -std=c++20 ' "$2/compile_commands.json" | grep -cv -e " $flag " || true)
  [ "$without" -eq 0 ] || { echo "$without sources are compiled without $flag"; status=1; }
done
exit $status
