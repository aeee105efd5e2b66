"""Functions that a written program brings along where the controller has none, each only where it is used."""

from __future__ import annotations

from textwrap import dedent

_PRINTABLE = "".join(chr(code) for code in range(32, 127) if chr(code) not in '"\\')


def _lines(text: str) -> tuple[str, ...]:
    return tuple(dedent(text).strip("\n").splitlines())


_TEXTS: dict[str, str] = {
    "rpl_trunc": """
        def rpl_trunc(value):
          # the whole part, cut toward zero
          if value < 0:
            return ceil(value)
          end
          return floor(value)
        end
    """,
    "rpl_rounded": """
        def rpl_rounded(value):
          # the nearest whole number, halves away from zero
          if value < 0:
            return ceil(value - 0.5)
          end
          return floor(value + 0.5)
        end
    """,
    "rpl_decimals": """
        def rpl_decimals(value, scale):
          # the value rounded to the decimals that a scale of 10, 100, ... keeps
          return rpl_rounded(value * scale) / scale
        end
    """,
    "rpl_div": """
        def rpl_div(number, divisor):
          # whole division, cut toward zero
          local quotient = 1.0 * number / divisor
          if quotient < 0:
            return ceil(quotient)
          end
          return floor(quotient)
        end
    """,
    "rpl_mod": """
        def rpl_mod(number, divisor):
          # remainder with the sign of the number
          return number - rpl_div(number, divisor) * divisor
        end
    """,
    "rpl_min": """
        def rpl_min(one, other):
          if other < one:
            return other
          end
          return one
        end
    """,
    "rpl_max": """
        def rpl_max(one, other):
          if other > one:
            return other
          end
          return one
        end
    """,
    "rpl_sign": """
        def rpl_sign(value):
          if value > 0:
            return 1
          elif value < 0:
            return -1
          end
          return 0
        end
    """,
    "rpl_bit": """
        def rpl_bit(condition):
          if condition:
            return 1
          end
          return 0
        end
    """,
    "rpl_and": """
        def rpl_and(one, other):
          # bits of two whole numbers; those of a negative one are the opposite of those of -1 - number
          local left = one
          local right = other
          if one < 0:
            left = -1 - one
          end
          if other < 0:
            right = -1 - other
          end
          local result = 0
          if one < 0 and other < 0:
            result = -1 - left - right
          elif one < 0:
            result = other
          elif other < 0:
            result = one
          end
          local bit = 1
          if (one < 0) xor (other < 0):
            bit = -1
          end
          while left > 0 and right > 0:
            if rpl_mod(left, 2) == 1 and rpl_mod(right, 2) == 1:
              result = result + bit
            end
            left = rpl_div(left, 2)
            right = rpl_div(right, 2)
            bit = bit * 2
          end
          return result
        end
    """,
    "rpl_or": """
        def rpl_or(one, other):
          return one + other - rpl_and(one, other)
        end
    """,
    "rpl_xor": """
        def rpl_xor(one, other):
          return one + other - 2 * rpl_and(one, other)
        end
    """,
    "rpl_shift_left": """
        def rpl_shift_left(number, places):
          local result = number
          local at = 0
          while at < places:
            result = result * 2
            at = at + 1
          end
          return result
        end
    """,
    "rpl_shift_right": """
        def rpl_shift_right(number, places):
          local result = number
          local at = 0
          while at < places:
            result = floor(result / 2.0)
            at = at + 1
          end
          return result
        end
    """,
    "rpl_pose": """
        def rpl_pose(x, y, z, a, b, c):
          # a pose of millimetres and ZYX angles in degrees
          local turn = rpy2rotvec([d2r(c), d2r(b), d2r(a)])
          return p[x / 1000.0, y / 1000.0, z / 1000.0, turn[0], turn[1], turn[2]]
        end
    """,
    "rpl_angle": """
        def rpl_angle(place, axis):
          # a ZYX angle of a pose in degrees: 0 about x, 1 about y, 2 about z
          local angles = rotvec2rpy([place[3], place[4], place[5]])
          return r2d(angles[axis])
        end
    """,
    "rpl_turned": """
        def rpl_turned(place, axis, angle):
          # the pose with one of its ZYX angles (degrees) changed
          local angles = rotvec2rpy([place[3], place[4], place[5]])
          angles[axis] = d2r(angle)
          local turn = rpy2rotvec(angles)
          return p[place[0], place[1], place[2], turn[0], turn[1], turn[2]]
        end
    """,
    "rpl_turn": """
        def rpl_turn(one, other):
          # the angle between two poses in degrees
          local way = pose_trans(pose_inv(one), other)
          return r2d(norm([way[3], way[4], way[5]]))
        end
    """,
    "rpl_digital_in": """
        def rpl_digital_in(number):
          # inputs counted from 1: standard, configurable, tool, general purpose registers
          if number <= 8:
            return get_standard_digital_in(number - 1)
          elif number <= 16:
            return get_configurable_digital_in(number - 9)
          elif number <= 18:
            return get_tool_digital_in(number - 17)
          end
          return read_input_boolean_register(number - 19)
        end
    """,
    "rpl_digital_out": """
        def rpl_digital_out(number):
          # outputs counted from 1: standard, configurable, tool, general purpose registers
          if number <= 8:
            return get_standard_digital_out(number - 1)
          elif number <= 16:
            return get_configurable_digital_out(number - 9)
          elif number <= 18:
            return get_tool_digital_out(number - 17)
          end
          return read_output_boolean_register(number - 19)
        end
    """,
    "rpl_set_digital_out": """
        def rpl_set_digital_out(number, level):
          # outputs counted from 1: standard, configurable, tool, general purpose registers
          if number <= 8:
            set_standard_digital_out(number - 1, level)
          elif number <= 16:
            set_configurable_digital_out(number - 9, level)
          elif number <= 18:
            set_tool_digital_out(number - 17, level)
          else:
            write_output_boolean_register(number - 19, level)
          end
        end
    """,
    "rpl_group_in": """
        def rpl_group_in(first, last):
          # the number that the inputs from first (lowest bit) to last show
          local result = 0
          local bit = 1
          local at = first
          while at <= last:
            if rpl_digital_in(at):
              result = result + bit
            end
            bit = bit * 2
            at = at + 1
          end
          return result
        end
    """,
    "rpl_group_out": """
        def rpl_group_out(first, last):
          # the number that the outputs from first (lowest bit) to last show
          local result = 0
          local bit = 1
          local at = first
          while at <= last:
            if rpl_digital_out(at):
              result = result + bit
            end
            bit = bit * 2
            at = at + 1
          end
          return result
        end
    """,
    "rpl_set_group_out": """
        def rpl_set_group_out(first, last, value):
          # the number on the outputs from first (lowest bit) to last
          local rest = value
          local at = first
          while at <= last:
            rpl_set_digital_out(at, rpl_mod(rest, 2) == 1)
            rest = rpl_div(rest, 2)
            at = at + 1
          end
        end
    """,
    "rpl_number_text": """
        def rpl_number_text(value, places):
          # the number with a fixed count of decimals
          local scale = 1
          local at = 0
          while at < places:
            scale = scale * 10
            at = at + 1
          end
          local size = rpl_rounded(norm(value) * scale)
          local text = to_str(rpl_div(size, scale))
          local behind = to_str(rpl_mod(size, scale))
          if places > 0:
            while str_len(behind) < places:
              behind = str_cat("0", behind)
            end
            text = str_cat(str_cat(text, "."), behind)
          end
          if value < 0 and size > 0:
            text = str_cat("-", text)
          end
          return text
        end
    """,
    "rpl_code": f"""
        def rpl_code(text):
          # the ASCII code of the first character; 34 and 92 cannot be told apart from others
          local at = str_find("{_PRINTABLE}", str_at(text, 0))
          if at < 0:
            return 63
          elif at > 57:
            return at + 34
          elif at > 1:
            return at + 33
          end
          return at + 32
        end
    """,
    "rpl_char": f"""
        def rpl_char(code):
          # the character of an ASCII code; a question mark where there is none
          local at = code - 32
          if code == 34 or code == 92 or code < 32 or code > 126:
            return "?"
          elif code > 92:
            at = code - 34
          elif code > 34:
            at = code - 33
          end
          return str_at("{_PRINTABLE}", at)
        end
    """,
    "rpl_upper": """
        def rpl_upper(text):
          return rpl_mapped(text, "abcdefghijklmnopqrstuvwxyz", "ABCDEFGHIJKLMNOPQRSTUVWXYZ")
        end
    """,
    "rpl_lower": """
        def rpl_lower(text):
          return rpl_mapped(text, "ABCDEFGHIJKLMNOPQRSTUVWXYZ", "abcdefghijklmnopqrstuvwxyz")
        end
    """,
    "rpl_find_any": """
        def rpl_find_any(text, first, signs):
          # where one of the signs stands, from 1; one more than the length when none does
          local at = first - 1
          while at < str_len(text):
            if str_find(signs, str_at(text, at)) >= 0:
              return at + 1
            end
            at = at + 1
          end
          return at + 1
        end
    """,
    "rpl_match": """
        def rpl_match(text, first, wanted):
          # where the wanted text begins, from 1; one more than the length when it does not occur
          local at = str_find(text, wanted, first - 1)
          if at < 0:
            return str_len(text) + 1
          end
          return at + 1
        end
    """,
    "rpl_member": """
        def rpl_member(text, place, signs):
          # is the character at a place, from 1, one of the signs?
          return str_find(signs, str_at(text, place - 1)) >= 0
        end
    """,
    "rpl_mapped": """
        def rpl_mapped(text, before, behind):
          local result = ""
          local sign = ""
          local place = 0
          local at = 0
          while at < str_len(text):
            sign = str_at(text, at)
            place = str_find(before, sign)
            if place >= 0:
              sign = str_at(behind, place)
            end
            result = str_cat(result, sign)
            at = at + 1
          end
          return result
        end
    """,
}
HELPERS: dict[str, tuple[str, ...]] = {name: _lines(text) for name, text in _TEXTS.items()}


def with_needed(names: frozenset[str]) -> tuple[str, ...]:
    """The helpers and those that they call, each behind what it calls."""
    done: dict[str, None] = {}

    def add(name: str) -> None:
        if name in done:
            return
        for other in HELPERS:
            if other != name and any(f"{other}(" in line for line in HELPERS[name]):
                add(other)
        done[name] = None

    for name in HELPERS:
        if name in names:
            add(name)
    return tuple(done)
