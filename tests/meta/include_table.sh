#!/bin/sh
# Who may include whom (docs/ARCHITECTURE.md, "Layers"): checked from the #include lines.
# usage: include_table.sh SOURCE_DIR [BUILD_DIR]
set -eu
cd "$1"

# folder-prefix: allowed prefixes. The longest matching folder counts; every
# folder may include itself and base.
table='
base:
ir/types:
stdlib/native: ir/types
stdlib: ir/types
ir/program: ir/types stdlib/native
ir/opt: ir/types ir/program stdlib/native
ir/bytecode: ir/types ir/program/ir.h stdlib/native
ir/lower: ir/types ir/program ir/bytecode
frontend: ir/types ir/program stdlib
frontend/format: ir/types/types.h frontend/lex frontend/network frontend/ladder frontend/fbd frontend/parse/il_operators.h frontend/parse/parse.h
linker: ir/types ir/program ir/bytecode stdlib/native
workspace: ir frontend linker
vm: ir/types ir/program/ir.h ir/bytecode stdlib/native
vm/io: ir/types ir/bytecode vm/runtime
adapters/modbus: ir/types ir/bytecode vm/io vm/runtime
adapters/keys: online_change/package/signed_file.h
adapters/mqtt:
adapters/xml: frontend/lex frontend/network
adapters/codesys: adapters/xml
adapters/text_export: adapters/xml frontend/lex frontend/network stdlib
adapters/twincat: adapters/xml frontend/network
adapters/plcopen: adapters/xml frontend/network frontend/ladder frontend/fbd frontend/lex frontend/parse ir/types stdlib
online_change/diff: ir linker
online_change/plan: ir linker online_change/diff
online_change/package: ir linker online_change/diff online_change/plan
online_change/apply: ir/types ir/program/ir.h ir/bytecode online_change vm
online_change/store: ir/types ir/program/ir.h ir/bytecode online_change/diff online_change/plan online_change/package online_change/apply vm
tools/common: ir online_change/diff online_change/plan online_change/package vm/load
tools/stc: ir frontend linker workspace online_change/diff online_change/plan online_change/package stdlib vm/exec vm/load vm/native tools/common adapters/xml adapters/codesys adapters/plcopen adapters/text_export adapters/twincat adapters/keys
tools/stvm_agent: tools/common tools/stvm adapters/mqtt
tools/stvm_fleet: tools/common tools/stvm adapters/mqtt
tools/stvm: ir/types ir/program/ir.h ir/bytecode vm online_change tools/common adapters
'

find adapters base ir frontend linker workspace vm online_change stdlib tools -name '*.cc' -o -name '*.h' |
  xargs grep -n '^#include "' | sed 's/^\([^:]*\):\([0-9]*\):#include "\([^"]*\)".*/\1 \2 \3/' |
  TABLE="$table" awk '
    BEGIN {
      n = split(ENVIRON["TABLE"], rows, "\n")
      for (i = 1; i <= n; i++) {
        if (rows[i] == "") continue
        colon = index(rows[i], ":")
        allowed[substr(rows[i], 1, colon - 1)] = substr(rows[i], colon + 1)
      }
    }
    function under(path, prefix) {
      return path == prefix || index(path, prefix "/") == 1
    }
    {
      if ($3 !~ /\.h$/) next   # .def tables belong to the header beside them
      folder = ""
      for (f in allowed) if (under($1, f) && length(f) > length(folder)) folder = f
      ok = under($3, "base") || under($3, folder)
      m = split(allowed[folder], list, " ")
      for (i = 1; i <= m; i++) if (under($3, list[i])) ok = 1
      checked++
      if (!ok) { print $1 ":" $2 ": " folder " may not include " $3; bad++ }
    }
    END { print checked " includes checked, " bad + 0 " against the table"; exit bad > 0 || checked == 0 }
  '
