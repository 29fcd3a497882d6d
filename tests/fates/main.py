#!/usr/bin/env python3
"""main.py HOST FIRST COUNT: random changes of declarations, seeds FIRST.., each judged by
the oracle of fates and made by the product (host.cc); where the two disagree it is said in what,
and the exit code is 1. A seed is the same pair everywhere."""

import argparse
import concurrent.futures
import json
import random
import subprocess
import sys

import values
from compare import compare, snapshot
from edits import Editor
from generate import Generator
from kinds import Layout, Reference
from oracle import Oracle


SAME_PROGRAM = 'R0308'


class Pair:
    def __init__(self, seed):
        self.seed = seed
        self.random = random.Random(seed)
        generator = Generator(self.random)
        self.old = generator.version()
        self.new = Editor(generator, self.old.copy()).edited(self.random.randint(1, 6))
        self.standby = self.random.random() < 0.3
        self.before = self.values()
        self.written = self.writes()

    def values(self):
        """Live values before the change: bytes by path."""
        out, unions = {}, set()
        for path, leaf in self.old.leaves().items():
            fixed = leaf.constant or isinstance(leaf.type, Reference) or leaf.union in unions
            if fixed or leaf.address.startswith('%I') or self.random.random() < 0.1:
                continue
            if leaf.union:
                unions.add(leaf.union)
            value = values.live(self.random, self.old, leaf.type)
            out[path] = Layout.encode(self.old, leaf.type, value)
        return out

    def writes(self):
        """What new variables get behind the switch, before undo: values by path."""
        out = {}
        for path, leaf in self.new.leaves().items():
            fixed = leaf.constant or leaf.union or isinstance(leaf.type, Reference)
            if not fixed and '%I' not in leaf.address and self.random.random() < 0.2:
                out[path] = values.live(self.random, self.new, leaf.type)
        return out

    def message(self):
        lines = [f'PAIR {self.seed}' + (' standby' if self.standby else '')]
        for word, version in (('OLD', self.old), ('NEW', self.new)):
            text = version.text()
            lines.append(f'{word} {len(text.encode())}\n{text}')
            for bit, (bits, value) in sorted(version.safe_rows().items()):
                lines.append(f'SAFE {word.lower()} {bit} {bits} {value}')
        lines += [f'SET {path} {raw.hex()}' for path, raw in self.before.items()]
        leaves = self.new.leaves()
        for path, value in self.written.items():
            raw = Layout.encode(self.new, leaves[path].type, value)
            lines.append(f'WRITE {path} {raw.hex()}')
        return '\n'.join(lines + ['GO', ''])


def nothing_to_do(pair, answer):
    """The product says that both versions are one program: the oracle knows of no difference."""
    oracle = Oracle(pair.old, pair.new, snapshot(pair.old, pair.old.leaves(), answer['before']))
    return [f'`{fate.path}` is {fate.fates[0]}, the product sees no change'
            for fate in oracle.fates if 'kept' not in fate.fates] + [
                f'{row.kind} `{row.name}`, the product sees no change' for row in oracle.rows]


def judge(host, pair, raw):
    """What differs: none of these pairs may be refused, with leave to lose."""
    host.stdin.write(pair.message())
    host.stdin.flush()
    line = host.stdout.readline()
    if not line:
        return [f'the product ended with {host.wait()}']
    answer = json.loads(line)
    if raw:
        print(json.dumps(answer, indent=1))
    if answer.get('error', '').startswith(SAME_PROGRAM):
        return nothing_to_do(pair, answer)
    if 'error' in answer:
        return [f"refused: {answer['error']}"]
    return compare(pair.old, pair.new, pair.written, answer)


def start(path):
    return subprocess.Popen([path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                            encoding='utf-8')


def judge_all(options, seeds):
    """(passed, failed); one process of the product for many pairs."""
    host = start(options.host)
    failed = 0
    for seed in seeds:
        findings = judge(host, Pair(seed), options.raw)
        if host.poll() is not None:
            host = start(options.host)
        failed += bool(findings)
        for text in findings[:options.most]:
            print(f'seed {seed}: {text}', flush=True)
    return len(seeds) - failed, failed


def in_parallel(options, seeds):
    with concurrent.futures.ThreadPoolExecutor() as pool:
        parts = [seeds[number::options.jobs] for number in range(options.jobs)]
        commands = [[sys.executable, __file__, options.host, str(part[0]), str(len(part)),
                     '--step', str(options.jobs)] for part in parts if part]
        done = list(pool.map(lambda one: subprocess.run(one, stdout=subprocess.PIPE, text=True),
                             commands))
    totals = [0, 0]
    for one in done:
        lines = one.stdout.splitlines()
        for line in lines[:-1]:
            print(line)
        counts = [int(word) for word in lines[-1].split() if word.isdigit()]
        totals = [sum(both) for both in zip(totals, counts)]
    return totals


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('host')
    parser.add_argument('first', type=int)
    parser.add_argument('count', type=int)
    parser.add_argument('--print', action='store_true', help='the two versions, nothing else')
    parser.add_argument('--raw', action='store_true', help='what the product says, as JSON')
    parser.add_argument('--most', type=int, default=8, help='lines for each pair')
    parser.add_argument('--jobs', type=int, default=1)
    parser.add_argument('--step', type=int, default=1, help='from one seed to the next')
    options = parser.parse_args()
    last = options.first + options.count * options.step
    seeds = list(range(options.first, last, options.step))
    if options.print:
        for seed in seeds:
            print(Pair(seed).message())
        return 0
    run = in_parallel if options.jobs > 1 else judge_all
    passed, failed = run(options, seeds)
    print(f'{passed} passed, {failed} failed')
    return 1 if failed or not passed else 0


if __name__ == '__main__':
    sys.exit(main())
