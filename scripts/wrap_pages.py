#!/usr/bin/env python3
"""wrap_pages.py [--check] FILE...: prose of pages has lines of at most 100 columns.

A paragraph or an item of a list with a longer line is wrapped anew; all others stay as they are, and
so do tables, code, headings and what has no blank to break at. With --check nothing is written, and
the exit code is 1 when there is something to wrap.
"""
import re
import sys
import textwrap

WIDTH = 100
ITEM = re.compile(r'^(\s*)([-*+]|\d+\.)(\s+)')
KEEP = '\0'  # a blank that no line ends at


def is_prose(line):
    return bool(line.strip()) and not re.match(r'\s*(\||#|<|```|\[[^]]+\]:)', line)


def glued(text):
    """Code stays in one line, and nothing that would begin a list, quote or heading begins one."""
    text = re.sub(r'`[^`]{1,60}`', lambda code: code[0].replace(' ', KEEP), text)
    return re.sub(r' (?=(?:[-*+>#|]|\d+\.)(?: |$))', KEEP, text)


def wrapped(lines):
    item = ITEM.match(lines[0])
    first = item[0] if item else re.match(r'\s*', lines[0])[0]
    indent = ' ' * len(first) if item else first
    text = glued(' '.join([lines[0][len(first):].strip()] + [line.strip() for line in lines[1:]]))
    made = textwrap.wrap(text, WIDTH, initial_indent=first, subsequent_indent=indent,
                         break_long_words=False, break_on_hyphens=False)
    return [line.replace(KEEP, ' ') for line in made]


def page(lines):
    out, block, code = [], [], False

    def end():
        fits = all(len(line) <= WIDTH for line in block) or any(l.endswith('  ') for l in block)
        out.extend(block if fits else wrapped(block))
        block.clear()

    for line in lines:
        if line.lstrip().startswith('```'):
            code = not code
            end()
            out.append(line)
        elif code or not is_prose(line):
            end()
            out.append(line)
        else:
            if ITEM.match(line):
                end()
            block.append(line)
    end()
    return out


def main():
    files = [name for name in sys.argv[1:] if name != '--check']
    bad = 0
    for name in files:
        with open(name, encoding='utf-8') as file:
            lines = file.read().split('\n')
        made = page(lines)
        if made == lines:
            continue
        bad += 1
        if '--check' in sys.argv[1:]:
            longest = [i + 1 for i, line in enumerate(lines) if len(line) > WIDTH]
            print(f'{name}: lines of more than {WIDTH} columns, such as {longest[0]}; '
                  'run scripts/wrap_pages.py')
        else:
            with open(name, 'w', encoding='utf-8') as file:
                file.write('\n'.join(made))
    return 1 if bad and '--check' in sys.argv[1:] else 0


sys.exit(main())
