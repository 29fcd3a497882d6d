#!/bin/sh
# House rules with a ratchet: a count may only go down. When it does, write the
# smaller number into house_rules.txt.
set -eu
cd "$1"
sources=$(find adapters base ir frontend linker workspace vm online_change stdlib tools -name '*.cc' -o -name '*.h')
status=0

limit_of() { awk -v rule="$1" '$1 == rule {print $2}' tests/meta/house_rules.txt; }
rule() {  # rule NAME COUNT
  limit=$(limit_of "$1")
  if [ "$2" -gt "$limit" ]; then
    echo "$1: $2, allowed are $limit"
    status=1
  elif [ "$2" -lt "$limit" ]; then
    echo "$1: $2 is better than $limit; lower it in tests/meta/house_rules.txt"
    status=1
  fi
}
lines_matching() { cat $sources | grep -cE "$1" || true; }

rule long_lines "$(lines_matching '^.{101,}$')"
rule unfinished_marks "$(lines_matching '\b(TODO|FIXME|XXX|HACK)\b')"
rule exceptions "$(lines_matching '^[^/]*\b(throw|catch) ')"
rule using_namespace "$(lines_matching '^ *using namespace')"
rule naked_new "$(lines_matching '^[^/"]*[=(] *new [A-Z]')"
rule long_files "$(wc -l $sources | awk '$2 != "total" && $1 > 400' | wc -l)"
rule headers_without_contract "$(for f in $(echo "$sources" | grep '\.h$'); do head -1 "$f" | grep -q '^//' || echo "$f"; done | wc -l)"

# Who touches a member of a class, may touch every other: methods and friends of each class that a
# header declares. The classes named here are to shrink; the last rules are for all others.
sizes=$(awk -f tests/meta/class_sizes.awk $(echo "$sources" | grep '\.h$'))
most_of() {  # most_of COLUMN [CLASS...]: the most that a class has, apart from the named ones
  column=$1
  shift
  echo "$sizes" | awk -v column="$column" -v apart=" $* " \
    'index(apart, " " $1 " ") == 0 && $column > most {most = $column} END {print most + 0}'
}
size_of() {  # size_of COLUMN CLASS
  echo "$sizes" | awk -v column="$1" -v class="$2" \
    '$1 == class && $column > most {most = $column} END {print most + 0}'
}
large="Parser Sema"
for class in $large; do rule "methods_of_$class" "$(size_of 2 "$class")"; done
rule methods_of_another_class "$(most_of 2 $large)"
rule methods_of_a_class_that_lowers "$(awk -f tests/meta/class_sizes.awk frontend/lower/*.h |
  awk '$2 > most {most = $2} END {print most + 0}')"
rule friends_of_a_class "$(most_of 3)"
[ $status -eq 0 ] && echo "all rules hold"
exit $status
