#!/bin/sh
# Where there are fewer addresses than data memory reserves (7 GiB), a controller says so and what to do; a change that needs
# more than are left is refused and the program runs on; the compiler needs none of it.
. "$(dirname "$0")/lib.sh"
if grep -qE '^STC_SANITIZE:[A-Z]*=.+' "$2/CMakeCache.txt"; then
  echo "left out: a sanitizer needs terabytes of addresses"
  exit 77
fi
mkdir p
echo 'PROGRAM Main VAR n : DINT; END_VAR n := n + 1; END_PROGRAM' >p/main.st
limited() {  # limited GIB COMMAND...
  (ulimit -v $(($1 << 20)) && shift && exec "$@")
}
expect 0 limited 1 "$bin/stc" build p -o p.img
expect 7 limited 6 "$bin/stvm" run p.img --scans 1
said 'cannot reserve 7 GiB of address space for data memory: Cannot allocate memory; raise .ulimit -v.'
expect 7 limited 6 "$bin/stvm" serve --dir none p.img
said 'cannot reserve 7 GiB'
expect 0 limited 8 "$bin/stvm" run p.img --scans 3 --print Main.n
(ulimit -d $((1 << 20)) && stvm run p.img --scans 1) >out 2>err && fail '4 GiB of data where 1 is permitted'
said 'raise .*.ulimit -d.'

(
  ulimit -v $((16 << 20))  # a second range for what a change reports, none for standby
  serve plc p.img
)
sed -i 's/n : DINT;/n : DINT; m : INT;/' p/main.st
expect 7 stvm change p --dir plc --yes --strategy standby
said 'cannot reserve 7 GiB'
expect 0 stvm status --dir plc
said 'running'
expect 0 stvm change p --dir plc --yes
expect 0 stvm stop --dir plc
echo "few addresses: refused with the way out, and what runs goes on"
