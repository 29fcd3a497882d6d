# CLASS METHODS FRIENDS of every class and struct that a header declares at namespace level.
function finish() { if (name != "") print name, methods, friends; name = "" }
/^(class|struct) [A-Za-z_:]+.*\{$/ { finish(); name = $2; methods = friends = 0; next }
/^\}/ { finish(); next }
name == "" { next }
/^  friend / { ++friends; next }
/^  [^ \/#}]/ {
  text = $0
  sub(/\/\/.*/, "", text)
  if (match(text, /(^|[ *&~])(operator[^ a-z]+|[A-Za-z_]+[A-Za-z_0-9]*)\(/) && substr(text, 1, RSTART) !~ /=/ &&
      text !~ /^  (using|static_assert)/) ++methods
}
