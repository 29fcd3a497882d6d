"""Types of Structured Text as the oracle of fates knows them: from the standard and from
docs/LANGUAGE.md, not from the compiler. A value is an int (numbers, BOOL, times, enumerations), the
bits of a REAL or LREAL as an int, a tuple of character codes, or the path of a reference's target
(None: NULL)."""

import math
import struct
from dataclasses import dataclass, field

INTEGERS = {  # name: (bits, signed)
    'SINT': (8, True), 'INT': (16, True), 'DINT': (32, True), 'LINT': (64, True),
    'USINT': (8, False), 'UINT': (16, False), 'UDINT': (32, False), 'ULINT': (64, False),
    'BYTE': (8, False), 'WORD': (16, False), 'DWORD': (32, False), 'LWORD': (64, False)}
BIT_STRINGS = ('BYTE', 'WORD', 'DWORD', 'LWORD')
REALS = {'REAL': ('<f', '<I', 4), 'LREAL': ('<d', '<Q', 8)}
TIMES = ('TIME', 'LTIME', 'DATE', 'LDATE', 'TOD', 'LTOD', 'DT', 'LDT')
CHARACTERS = {'CHAR': 1, 'WCHAR': 2}


@dataclass
class Scalar:
    name: str

    def text(self):
        return self.name


@dataclass
class Text:
    wide: bool
    capacity: int

    def text(self):
        return f"{'WSTRING' if self.wide else 'STRING'}[{self.capacity}]"


@dataclass
class Subrange:
    base: str
    low: int
    high: int

    def text(self):
        return f'{self.base}({self.low}..{self.high})'


@dataclass
class Array:
    bounds: list  # of (low, high)
    element: object

    def text(self):
        dims = ', '.join(f'{low}..{high}' for low, high in self.bounds)
        return f'ARRAY[{dims}] OF {self.element.text()}'


@dataclass
class Named:
    """A type that the version declares: see Version.types."""
    name: str

    def text(self):
        return self.name


@dataclass
class Reference:
    target: object

    def text(self):
        return f'REF_TO {self.target.text()}'


@dataclass
class Literal:
    name: str
    value: int
    renamed_from: str = ''


@dataclass
class Enumeration:
    name: str
    base: str
    literals: list
    renamed_from: str = ''


@dataclass
class Variable:
    name: str
    type: object
    initial: object = None     # a value, or a list for an array, a dict for a structure
    renamed_from: str = ''
    section: str = 'VAR'
    retain: bool = False
    constant: bool = False
    address: str = ''
    target: str = ''           # of a reference: what it is bound to at the start
    written: bool = True       # an output: code writes it


@dataclass
class Structure:
    name: str
    members: list
    union: bool = False
    renamed_from: str = ''


@dataclass
class Block:
    """A function block, or a program."""
    name: str
    variables: list
    base: str = ''
    program: bool = False
    renamed_from: str = ''
    statics: list = field(default_factory=list)


def integer_range(name):
    bits, signed = INTEGERS[name]
    return (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)


def real_of(name, bits):
    """The number that the bits of a REAL or LREAL stand for."""
    as_float, as_bits, _ = REALS[name]
    return struct.unpack(as_float, struct.pack(as_bits, bits))[0]


def bits_of(name, number):
    """The nearest REAL or LREAL of a float, as bits; what is too large becomes an infinity."""
    as_float, as_bits, _ = REALS[name]
    try:
        raw = struct.pack(as_float, number)
    except OverflowError:
        raw = struct.pack(as_float, math.copysign(math.inf, number))
    return struct.unpack(as_bits, raw)[0]


def nearest_real(name, whole):
    """The nearest REAL or LREAL of an integer, ties to even: float() of an int rounds so, and a
    second rounding to REAL is avoided."""
    digits = {'REAL': 24, 'LREAL': 53}[name]
    size = abs(whole)
    surplus = size.bit_length() - digits
    if surplus > 0:
        low = size & (1 << surplus) - 1
        size >>= surplus
        half = 1 << surplus - 1
        if low > half or (low == half and size & 1):
            size += 1
        size <<= surplus
    return bits_of(name, float(size if whole >= 0 else -size))


class Layout:
    """How many bytes a value has, and which: what docs/IO.md and docs/LANGUAGE.md promise."""

    @staticmethod
    def encode(version, kind, value):
        kind = version.resolve(kind)
        if isinstance(kind, Text):
            unit = 2 if kind.wide else 1
            codes = list(value) + [0] * (kind.capacity + 1 - len(value))
            return b''.join(code.to_bytes(unit, 'little') for code in codes)
        bits, signed = Layout.shape(kind)
        return (value & (1 << bits) - 1).to_bytes(bits // 8, 'little')

    @staticmethod
    def decode(version, kind, raw):
        kind = version.resolve(kind)
        if isinstance(kind, Text):
            unit = 2 if kind.wide else 1
            codes = [int.from_bytes(raw[i:i + unit], 'little') for i in range(0, len(raw), unit)]
            return tuple(codes[:codes.index(0)] if 0 in codes else codes)
        bits, signed = Layout.shape(kind)
        value = int.from_bytes(raw, 'little')
        return value - (1 << bits) if signed and value >> bits - 1 else value

    @staticmethod
    def shape(kind):
        name = kind.base if isinstance(kind, (Subrange, Enumeration)) else kind.name
        if name == 'BOOL':
            return 8, False
        if name in INTEGERS:
            return INTEGERS[name]
        if name in REALS:
            return REALS[name][2] * 8, False
        if name in CHARACTERS:
            return CHARACTERS[name] * 8, False
        return 64, True  # times and dates: nanoseconds
