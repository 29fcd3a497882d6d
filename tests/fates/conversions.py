"""A14 for a single value: what it becomes when its variable keeps the name and gets another type.

convert() gives (rule, value, exact). rule: 'same' for the same type, 'number' where every value
keeps its number (a wider subrange, an enumeration whose literal has the number that it had),
'converted' where there is a rule, 'none' where there is none: then the value is the new initial
one. exact: nothing is lost. What A14 leaves open is as docs/RUNNING.md says."""

import math

from kinds import (CHARACTERS, Enumeration, INTEGERS, REALS, Scalar, Subrange, Text, bits_of,
                   integer_range, nearest_real, real_of)

REPLACEMENT = ord('?')
LARGEST = {'REAL': 0x7F7FFFFF, 'LREAL': 0x7FEFFFFFFFFFFFFF}
DAYS, INSTANTS = ('DATE', 'LDATE'), ('DT', 'LDT')
NS_OF_A_DAY = 86_400_000_000_000
SAME_TIME = {'TIME': 'LTIME', 'DATE': 'LDATE', 'TOD': 'LTOD', 'DT': 'LDT'}


def convert(old, value, new, initial, renamed_literals):
    """renamed_literals: of two enumerations, which old literal each new one continues."""
    if isinstance(old, Enumeration) and isinstance(new, Enumeration):
        return by_literal(old, value, new, initial, renamed_literals)
    if old == new:
        return 'same', value, True
    if isinstance(old, Text) and isinstance(new, Text):
        return text(old, value, new)
    if isinstance(old, Text) or isinstance(new, Text):
        return 'none', initial, False
    if isinstance(new, Enumeration):
        if not is_integer(old) and old != Scalar('BOOL'):
            return 'none', initial, False
        number = saturated(value, Scalar(new.base))
        known = any(one.value == number for one in new.literals)
        return 'converted', number if known else initial, known and number == value
    if isinstance(old, Enumeration):
        return from_integer(Scalar(old.base), value, new, initial, True)
    if is_integer(old):
        return from_integer(old, value, new, initial)
    return from_scalar(old.name, value, new, initial)


def is_integer(kind):
    return isinstance(kind, Subrange) or (isinstance(kind, Scalar) and kind.name in INTEGERS)


def range_of(kind):
    if isinstance(kind, Subrange):
        return kind.low, kind.high
    return integer_range(kind.name)


def base_of(kind):
    return kind.name if isinstance(kind, Scalar) else kind.base


def saturated(value, kind):
    low, high = range_of(kind)
    return min(max(value, low), high)


def from_integer(old, value, new, initial, literal=False):
    if is_integer(new):
        result = saturated(value, new)
        wider = base_of(old) == base_of(new) and range_of(new)[0] <= range_of(old)[0] and (
            range_of(old)[1] <= range_of(new)[1])
        return 'number' if wider and not literal else 'converted', result, result == value
    if literal and new != Scalar('BOOL'):
        return 'none', initial, False
    if new.name in REALS:
        result = nearest_real(new.name, value)
        return 'converted', result, real_of(new.name, result) == value
    if new.name == 'BOOL':
        return 'converted', int(value != 0), value in (0, 1)
    return 'none', initial, False


def from_scalar(old, value, new, initial):
    if old == 'BOOL' and is_integer(new):
        result = saturated(value, new)
        return 'converted', result, result == value
    if old in REALS:
        number = real_of(old, value)
        if is_integer(new):
            return whole(number, new, initial)
        if new.name in REALS:
            return other_real(number, new.name)
    name = new.name if isinstance(new, Scalar) else ''
    if SAME_TIME.get(old) == name or SAME_TIME.get(name) == old:
        return 'converted', value, True
    if old in DAYS and name in INSTANTS:  # midnight
        return 'converted', value, True
    if old in INSTANTS and name in DAYS:
        day = value - value % NS_OF_A_DAY
        return 'converted', day, day == value
    if old in CHARACTERS and name in CHARACTERS:
        fits = value < 256 or name == 'WCHAR'
        return 'converted', value if fits else REPLACEMENT, fits
    return 'none', initial, False


def whole(number, new, initial):
    if math.isnan(number):
        return 'converted', initial, False
    if math.isinf(number):
        low, high = range_of(new)
        return 'converted', high if number > 0 else low, False
    result = saturated(round(number), new)  # half to even
    return 'converted', result, result == number


def other_real(number, name):
    if math.isnan(number) or math.isinf(number):
        return 'converted', bits_of(name, number), True
    result = bits_of(name, number)
    if math.isinf(real_of(name, result)):  # saturates
        sign = 0x80000000 if number < 0 else 0
        return 'converted', LARGEST[name] | sign, False
    return 'converted', result, real_of(name, result) == number


def text(old, value, new):
    codes = [code if new.wide or code < 256 else REPLACEMENT for code in value]
    kept = tuple(codes[:new.capacity])
    return 'converted', kept, kept == value


def by_literal(old, value, new, initial, renamed):
    """The literal of the same name, whatever number it has. Where the number stays nothing is
    done to the variable, whatever other literals there are: it may be called kept."""
    name = next((one.name for one in old.literals if one.value == value), None)
    if name is None:
        known = any(one.value == value for one in new.literals)
        return 'converted', value if known else initial, known
    for one in new.literals:
        if renamed.get(one.name) == name:
            stays = (old.base, value) == (new.base, one.value)
            return 'number' if stays else 'converted', one.value, True
    return 'converted', initial, False
