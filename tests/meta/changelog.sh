#!/bin/sh
# CHANGELOG.md begins with the version that is built, names the tag of each version that is released,
# is grouped as Added, Changed and Fixed, and says nothing twice.
set -eu
cd "$1"
awk -v version="$(cat VERSION)" '
  function bad(what) { print "CHANGELOG.md:" FNR ": " what; status = 1 }
  function entry_ends() {
    if (text != "" && text in seen) bad("said twice: " text)
    if (text != "") seen[text] = 1
    text = ""
  }
  /^## / {
    entry_ends()
    if (!versions++ && $2 != version) bad("the first version is not " version)
    if (versions > 1) released = $2
    group = ""
    delete groups
  }
  /^Tag `v/ { if (index($0, "`v" released "`")) released = "" }
  /^### / {
    entry_ends()
    if ($2 !~ /^(Added|Changed|Fixed)$/ || NF != 2) bad("a group that is not Added, Changed or Fixed")
    if ($2 in groups) bad($2 " twice in one version")
    groups[$2] = 1
    if (released != "") bad(released " has no tag")
    group = $2
  }
  /^- / { entry_ends(); text = $0; if (group == "") bad("outside every group"); next }
  /^  / { text = text $0; next }
  { entry_ends() }
  END { entry_ends(); exit status }' CHANGELOG.md
