#!/bin/sh
# Two comments at one network of a drawing in PLCopen XML are two comments wherever they go, and the
# body stays a drawing: exported at once it is the one that was read.
. "$(dirname "$0")/lib.sh"

# document LANGUAGE ELEMENTS
document() {
  printf '<project xmlns="http://www.plcopen.org/xml/tc6_0201" xmlns:xhtml="http://www.w3.org/1999/xhtml"><types><pous><pou name="P" pouType="program"><interface><localVars>'
  for one in a b c; do printf '<variable name="%s"><type><BOOL/></type></variable>' $one; done
  printf '</localVars></interface><body><%s>%s</%s></body></pou></pous></types></project>' "$1" "$2" "$1"
}
at() { printf 'localId="%s"><position x="%s" y="%s"/>' "$1" "$2" "$3"; }
comment() { printf '<comment height="20" width="100" %s<content><xhtml:p><![CDATA[%s]]></xhtml:p></content></comment>' "$(at "$1" "$2" "$3")" "$4"; }
from() { printf '<connectionPointIn><connection refLocalId="%s"/></connectionPointIn>' "$1"; }
comments() {
  comment 91 10 7 'first words'
  comment 92 300 7 'second words'
  comment 93 10 107 "$1"
  comment 94 300 107 'fourth words'
}
# The output of the second network has a documentation of two paragraphs.
fbd() {
  comments "$1"
  for n in 1 2; do
    printf '<inVariable %s<connectionPointOut/><expression>a</expression></inVariable>' "$(at ${n}1 10 $((n * 100 - 70)))"
  done
  printf '<outVariable %s%s<expression>b</expression></outVariable>' "$(at 12 100 30)" "$(from 11)"
  printf '<outVariable %s%s<expression>c</expression><documentation><xhtml:p>of c\n\nand more of c</xhtml:p></documentation></outVariable>' "$(at 22 100 130)" "$(from 21)"
}
ld() {
  comments "$1"
  printf '<leftPowerRail %s<connectionPointOut formalParameter=""/></leftPowerRail>' "$(at 9 0 0)"
  for n in 1 2; do
    printf '<contact %s%s<connectionPointOut/><variable>a</variable></contact>' "$(at ${n}1 30 $((n * 100 - 70)))" "$(from 9)"
  done
  printf '<coil %s%s<connectionPointOut/><variable>b</variable></coil>' "$(at 12 100 30)" "$(from 11)"
  printf '<coil %s%s<connectionPointOut/><variable>c</variable></coil>' "$(at 22 100 130)" "$(from 21)"
}
# words FILE: comments without their marks
words() { sed 's/^ *(\* *\(.*\) \*)$/  \1/; s/^ *\/\/ */  /' "$1"; }
document FBD "$(fbd 'third words')" >first.xml
needs_xml stc check first.xml
for language in FBD LD; do
  # The third one ends no comment of text, and has two lines.
  for third in 'third words' 'third *) words
of two lines'; do
    if [ $language = LD ]; then made=$(ld "$third"); else made=$(fbd "$third"); fi
    document $language "$made" >in.xml
    rm -rf text again
    expect 0 stc import in.xml -o text
    for words in first second third fourth; do
      grep -qE "^ *(//|\(\*) $words .*words" text/P.st || fail "$language: the $words comment as text"
    done
    # Exported at once: the drawing that was read.
    for more in '' --without-sources; do
      # shellcheck disable=SC2086
      expect 0 stc export in.xml -o out.xml --force $more
      grep -q 'W0071' out err && fail "$language: a comment is said to be lost"
      for place in '91 10 7' '92 300 7' '93 10 107' '94 300 107'; do
        # shellcheck disable=SC2086
        set -- $place
        grep -A1 "<comment .*localId=\"$1\"" out.xml | grep -q "x=\"$2\" y=\"$3\"" ||
          fail "$language: the comment $1 of a drawing that was not changed"
      done
      expect 0 stc import out.xml -o again --force
      cmp again/P.st text/P.st || fail "$language: there and back"
    done
    # From the text, and without it beside the elements: as many comments with the same words.
    expect 0 stc export text -o out.xml --force --without-sources
    grep -q 'W0071' out err && fail "$language: a comment of the text is said to be lost"
    grep -q "<$language>" out.xml || fail "$language: the drawing of the text"
    expect 0 stc import out.xml -o again --force
    words text/P.st >wanted
    words again/P.st | cmp - wanted || fail "$language: text, there and back"
  done
done
