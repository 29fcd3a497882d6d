#!/bin/sh
# A1, A15: a drawing that gets networks, or loses them, goes on as if nothing had happened: what edges,
# timers, counters and jumps of the others remember stays theirs. Random ladders, function block
# diagrams and instruction lists are changed while they run, there and back, and compared with the
# same ones that nobody changes. drawn_changes.sh SOURCES BUILD [FIRST COUNT]
. "$(dirname "$0")/lib.sh"
first=${3:-1}
count=${4:-3}
make=$source_dir/tests/vendors/random_drawn_text.py
mkdir plain changed
# program FOLDER/NAME V1 V2 STEP...: a golden file that shows `sum` at the end.
program() {
  file=$1.st
  { printf '// MODE: change\n'; cat "$2"; printf '// --- v2\n'; cat "$3"; } >"$file"
  shift 3
  for step in "$@"; do printf '// > %s\n' "$step"; done >>"$file"
  printf '// > show sum\n// CHECK: unknown\n' >>"$file"
}
for view in LD FBD IL; do
  for seed in $(seq "$first" $((first + count - 1))); do
    python3 "$make" "$seed" $view >small.st
    python3 "$make" "$seed" $view "$seed" >large.st
    cmp -s small.st large.st && fail "seed $seed, $view: nothing was added"
    program plain/$view$seed small.st large.st 'run 45'
    program changed/$view$seed small.st large.st 'run 20' 'change 2' 'run 20' 'undo' 'run 5'
    program changed/$view${seed}_back large.st small.st 'run 20' 'change 2 --allow-loss' 'run 20' 'undo' 'run 5'
  done
done
# The runner of golden files makes each run on every tier, and with other changes in between.
for folder in plain changed; do
  "$bin/golden" --update $folder >out 2>err || fail "$folder"
done
for file in changed/*.st; do
  name=$(basename "$file" .st)
  wanted=$(grep '^// CHECK: sum=' "plain/${name%_back}.st") || fail "$name: no sum"
  made=$(grep '^// CHECK: sum=' "$file") || fail "$name: no sum"
  [ "$made" = "$wanted" ] || fail "$name: $made, unchanged: $wanted"
  grep -q '^// CHECK: kept' "$file" || fail "$name: was it changed?"
done
