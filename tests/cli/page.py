"""Runs the examples of a page of docs in the current folder.

A block ```st NAME is a file. A block ```console has commands, each behind `$ `, and what they
print, standard error too. Times are not compared.
usage: page.py PAGE
"""
import re
import subprocess
import sys


def blocks(page):
    """(info string, lines, number of the first line) of each fenced block."""
    info, lines, first = None, [], 0
    for number, line in enumerate(page, 1):
        line = line.rstrip("\n")
        if line.startswith("```") and info is None:
            info, lines, first = line[3:], [], number + 1
        elif line == "```":
            yield info, lines, first
            info = None
        elif info is not None:
            lines.append(line)


def commands(lines):
    """(command, expected lines, offset)."""
    found = []
    for offset, line in enumerate(lines):
        if line.startswith("$ "):
            found.append((line[2:], [], offset))
        else:
            found[-1][1].append(line)
    return found


def without_times(line):
    return re.sub(r"\(\d+\.\d{3} s\)", "(0.000 s)", line)


def main(page):
    ran = 0
    with open(page, encoding="utf-8") as text:
        for info, lines, first in blocks(text):
            if info.startswith("st "):
                with open(info[3:], "w", encoding="utf-8") as out:
                    out.write("\n".join(lines) + "\n")
            if info != "console":
                continue
            for command, expected, offset in commands(lines):
                done = subprocess.run(command, shell=True, text=True, stdin=subprocess.DEVNULL,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
                printed = [without_times(line) for line in done.stdout.splitlines()]
                ran += 1
                if printed != expected:
                    print(f"{page}:{first + offset}: $ {command}\n" + done.stdout)
                    return 1
    print(f"{ran} commands print what the page says")
    return 0 if ran else 1


sys.exit(main(sys.argv[1]))
