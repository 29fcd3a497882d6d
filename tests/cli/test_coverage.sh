#!/bin/sh
# R-11: what tests reach, as a table, lcov, Cobertura and a page; --fail-under.
. "$(dirname "$0")/lib.sh"
mkdir src
cat >src/logic.st <<'ST'
FUNCTION_BLOCK Logic
VAR_INPUT n : INT; a, b : BOOL; END_VAR
VAR_OUTPUT r : INT; END_VAR
  CASE n OF
    1: r := 1;
    2, 4..6: r := 2;
  END_CASE;
  IF a AND_THEN b THEN
    r := 0;
  ELSIF n = 3 THEN
    r := 9;
  END_IF;
END_FUNCTION_BLOCK
FUNCTION Never : INT
  Never := 1;
END_FUNCTION
ST
cat >src/starter.st <<'ST'
FUNCTION_BLOCK Starter
VAR_INPUT start, stop : BOOL; END_VAR
VAR_OUTPUT run, both : BOOL; END_VAR
LADDER
|--+--[ start ]--+--[/ stop ]----( run )--|
   |             |
   +--[ run   ]--+
|--[ run ]--[ stop ]----( both )--|
END_LADDER
END_FUNCTION_BLOCK
FUNCTION_BLOCK Chart
VAR_INPUT go, back : BOOL; END_VAR
  INITIAL_STEP Rest: END_STEP
  TRANSITION FROM Rest TO Work := go; END_TRANSITION
  STEP Work: END_STEP
  TRANSITION FROM Work TO Rest := back; END_TRANSITION
END_FUNCTION_BLOCK
ST
cat >some_test.st <<'ST'
TEST 'logic' VAR l : Logic; END_VAR
  l(n := 1);
  l(n := 3);
END_TEST
TEST 'starter' VAR s : Starter; END_VAR
  s(start := TRUE);
  s(start := FALSE, stop := TRUE);
END_TEST
TEST 'chart' VAR c : Chart; END_VAR
  c();
  c(go := TRUE);
  ASSERT_TRUE(c.Work.X);
END_TEST
ST

expect 0 stc test src some_test.st --coverage cov
said '^src/logic.st +4/7 +6/9 +- +- +- +62.5 %$'
said '^src/starter.st +- +3/4 +2/2 +2/2 +1/2 +80.0 %$'
said '^all files +4/7 +9/13 +2/2 +2/2 +1/2 +69.2 %$'
awk 'length($0) > 80 {exit 1}' out || fail 'wider than a terminal'
ls cov >files
printf 'cobertura.xml\nindex.html\nlcov.info\n' | cmp -s - files || fail "files: $(cat files)"

# The same whatever the optimiser does, and tests end as without.
cp cov/lcov.info first.info
expect 0 stc test src some_test.st --coverage cov --no-opt
cmp -s cov/lcov.info first.info || fail 'the optimiser changes counts'
expect 0 stc test src some_test.st --coverage cov --seed 3
cmp -s cov/lcov.info first.info || fail 'the order changes counts'

# lcov, line by line.
cat >wanted <<'INFO'
TN:
SF:src/logic.st
FN:1,Logic
FN:14,Never
FNDA:2,Logic
FNDA:0,Never
FNF:2
FNH:1
BRDA:4,0,0,1
BRDA:4,0,1,0
BRDA:4,0,2,1
BRDA:8,1,0,0
BRDA:8,1,1,2
BRDA:8,2,0,0
BRDA:8,2,1,2
BRDA:10,3,0,1
BRDA:10,3,1,1
BRF:9
BRH:6
DA:4,2
DA:5,1
DA:6,0
DA:8,2
DA:9,0
DA:10,2
DA:11,1
DA:15,0
LF:8
LH:5
end_of_record
INFO
sed '/^end_of_record/q' cov/lcov.info | diff wanted - || fail 'lcov'
grep -q '^DA:16,0$' cov/lcov.info || fail 'a transition that never fired'
if command -v genhtml >/dev/null; then
  expect 0 genhtml --config-file /dev/null --branch-coverage -o gen cov/lcov.info
  said 'branches'
  [ -e gen/index.html ] || fail 'genhtml wrote nothing'
else
  echo 'genhtml (Debian package lcov) is not installed: its part is skipped'
fi

# Cobertura: elements, their order and attributes as its DTD (coverage-04) has them.
python3 - <<'PY' || fail 'Cobertura'
import xml.etree.ElementTree as tree
rates = {"line-rate", "branch-rate", "complexity"}
dtd = {
    "coverage": (["sources", "packages"], rates | {"version", "timestamp", "lines-covered",
                 "lines-valid", "branches-covered", "branches-valid"}),
    "sources": (["source*"], set()), "source": ([], set()),
    "packages": (["package*"], set()), "package": (["classes"], rates | {"name"}),
    "classes": (["class*"], set()),
    "class": (["methods", "lines"], rates | {"name", "filename"}),
    "methods": (["method*"], set()), "lines": (["line*"], set()),
    "line": (["conditions*"], {"number", "hits", "branch", "condition-coverage"}),
    "conditions": (["condition*"], set()), "condition": ([], {"number", "type", "coverage"}),
}
def check(element):
    children, attributes = dtd[element.tag]
    optional = {"condition-coverage"} if element.get("branch") == "false" else set()
    assert attributes - optional <= set(element.attrib) <= attributes, (element.tag, element.attrib)
    tags = [child.tag for child in element]
    if children and children[0].endswith("*"):
        assert set(tags) <= {children[0][:-1]}, tags
    else:
        assert tags == children, (element.tag, tags)
    for child in element:
        check(child)
text = open("cov/cobertura.xml").read()
assert 'SYSTEM "http://cobertura.sourceforge.net/xml/coverage-04.dtd"' in text
root = tree.fromstring(text)
check(root)
assert root.get("lines-valid") == str(len(root.findall(".//line"))), root.attrib
hit = [line for line in root.findall(".//line") if line.get("hits") != "0"]
assert root.get("lines-covered") == str(len(hit))
lines = root.findall(".//class[@filename='src/logic.st']//line")
line = [each for each in lines if each.get("number") == "8"][0]
assert line.get("condition-coverage") == "50% (2/4)" and len(line.findall(".//condition")) == 2
PY

# The page: one file, well formed, nothing fetched, the most missing first.
python3 - <<'PY' || fail 'page'
import html.parser
class Page(html.parser.HTMLParser):
    def __init__(self):
        super().__init__()
        self.open, self.links, self.ids = [], [], []
    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        assert tag not in ("script", "link", "img", "iframe"), tag
        self.links += [attributes["href"]] if "href" in attributes else []
        self.ids += [attributes["id"]] if "id" in attributes else []
        if tag != "meta":
            self.open.append(tag)
    def handle_endtag(self, tag):
        assert self.open.pop() == tag, tag
text = open("cov/index.html").read()
page = Page()
page.feed(text)
assert page.open == [] and page.links == ["#" + i for i in page.ids] and len(page.ids) == 2
assert "http" not in text and "url(" not in text and "prefers-color-scheme: dark" in text
assert text.index("src/logic.st") < text.index("src/starter.st")
for missing in ("never CASE: line 6", "never IF: TRUE", "never transition Work to Rest",
                "never left of AND_THEN: TRUE", "never power: TRUE"):
    assert missing in text, missing
PY

# One form only; the sums in JSON; a share that is wanted.
expect 0 stc test src some_test.st --coverage one --coverage-format lcov
[ "$(ls one)" = lcov.info ] || fail 'more than lcov'
expect 0 stc test src some_test.st --coverage one --format json
json 'd["coverage"]["branches"] == {"reached": 9, "all": 13} and d["coverage"]["percent"] == 69.2'
expect 0 stc test src some_test.st --fail-under 69.2
expect 1 stc test src some_test.st --fail-under 69.3
said 'the tests reach 69.2 % of the places, less than --fail-under 69.3'
expect 1 stc test src some_test.st --fail-under 100 --format junit
for percent in 101 1e3 nan x; do
  expect 2 stc test src some_test.st --fail-under "$percent"
  said 'needs a number from 0 to 100'
done
expect 2 stc test src some_test.st --coverage-format lcov
said 'name a folder, too'
expect 2 stc test src some_test.st --coverage one --coverage-format pdf
: >file
expect 7 stc test src some_test.st --coverage file/x
said 'R0503: file.x: no folder can be made'

# Of a long path the end is shown.
mkdir -p a_folder_with_a_name/another_folder
cp src/logic.st a_folder_with_a_name/another_folder/station.st
expect 0 stc test a_folder_with_a_name/another_folder/station.st src/starter.st some_test.st \
  --coverage one
said '^\.\.er_folder/station.st +4/7 +6/9'
awk 'length($0) > 80 {exit 1}' out || fail 'wider than a terminal'

# A file with a TEST is not counted, and it is said when that leaves nothing.
cat src/logic.st some_test.st src/starter.st >both.st
expect 0 stc test both.st --coverage one
said 'nothing is counted: each file has a TEST'
expect 1 stc test both.st --fail-under 0
said 'nothing is counted: each file has a TEST'
# Code that tests replace did not run.
printf "TEST 'm' VAR l : Logic; END_VAR MOCK l; l(n := 1); END_TEST\n" >mock_test.st
expect 0 stc test src/logic.st mock_test.st --coverage one
said '0.0 %'
