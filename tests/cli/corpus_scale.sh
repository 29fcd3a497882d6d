#!/bin/sh
# The corpus, copied until it has the size of the largest libraries people use (30,000 lines, 550
# POUs, 14 types): it compiles as it is, in a bounded time, and every copy still gives the known answers. Prints
# what it measured (docs/TESTING.md has the figures).
. "$(dirname "$0")/lib.sh"
copies=${3:-4}
"$bin/scale" "$copies" big "$source_dir"/tests/corpus/*/*.st "$source_dir"/tests/golden/corpus/*.st

lines=$(cat big/*.st | wc -l)
pous=$(cat big/*.st | LC_ALL=C grep -ciE '^(FUNCTION|FUNCTION_BLOCK|PROGRAM)[[:space:]]')
types=$(cat big/*.st | LC_ALL=C grep -ciE '^TYPE[[:space:]]')
[ "$lines" -ge 30000 ] || fail "only $lines lines"
[ "$pous" -ge 550 ] || fail "only $pous POUs"
[ "$types" -ge 14 ] || fail "only $types types"

# cpu_of COMMAND...: processor time of it, in milliseconds
cpu_of() {
  ( "$@" >out 2>err || echo "exit code $?" >>failed; times ) |
    awk 'NR == 2 { n = split($0, part, /[ms ]+/); print int(1000 * (60 * part[1] + part[2] + 60 * part[3] + part[4])) }'
}
begin=$(date +%s%N)
check_ms=$(cpu_of "$bin/stc" check big)
wall_ms=$((($(date +%s%N) - begin) / 1000000))
short_messages() { grep -E 'error' err >out || true; head -n 5 out >err; : >out; }
[ ! -e failed ] || { short_messages; fail "stc check: $(cat failed)"; }
build_ms=$(cpu_of "$bin/stc" build big -o big.img)
[ ! -e failed ] || { short_messages; fail "stc build: $(cat failed)"; }
echo "$lines lines, $pous POUs, $types types: check $check_ms ms of processor time ($wall_ms ms wall), build $build_ms ms," \
  "$((lines * 1000 / (build_ms + 1))) lines per second"
# Generous: slow machines and builds with sanitizers must hold it too.
budget=5000
[ $sanitized = no ] || budget=60000
[ "$build_ms" -lt "${STC_SCALE_BUDGET_MS:-$budget}" ] || fail "build took $build_ms ms of processor time"

names=checks,wrong
for copy in $(seq $((copies - 1))); do names=$names,k${copy}_checks,k${copy}_wrong; done
expect 0 stvm run big.img --scans 400 --virtual-time --print "$names"
[ "$(grep -cE "wrong ?= ?''" out)" -eq "$copies" ] || fail "an answer is wrong"
[ "$(grep -E 'checks' out | sed 's/.*= *//' | sort -u | wc -l)" -eq 1 ] || fail "the copies differ"
