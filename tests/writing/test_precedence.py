"""What the expression printer prints binds as the tree says, for any operator table: checked by reading it back."""

import re

from hypothesis import example, given
from hypothesis import strategies as st

from rpl import ir
from rpl.writing.precedence import ATOM, ExpressionPrinter, Operator, OperatorTable, Printed

# Three languages that bind differently: signs loose or tight, `not` looser or tighter than comparisons.
TABLES = {
    "signs tight": OperatorTable(
        {
            "or": Operator("OR", 1),
            "and": Operator("AND", 2),
            "=": Operator("=", 3, "none"),
            "+": Operator("+", 4),
            "-": Operator("-", 4),
            "*": Operator("*", 5),
            "mod": Operator("MOD", 5),
            "**": Operator("**", 6, "right"),
        },
        {"-": Operator("-", 7), "not": Operator("NOT", 7)},
    ),
    "not loose": OperatorTable(
        {
            "or": Operator("||", 1),
            "and": Operator("&&", 2),
            "=": Operator("==", 4, "none"),
            "+": Operator("+", 5, spaced=False),
            "-": Operator("-", 5, spaced=False),
            "*": Operator("*", 6, spaced=False),
            "mod": Operator("%", 6, spaced=False),
            "**": Operator("^", 8),
        },
        {"-": Operator("-", 7), "not": Operator("!", 3)},
        mixed=(frozenset(("and", "or")),),
    ),
    "all one level": OperatorTable(
        {op: Operator(op.upper(), 1) for op in ("or", "and", "=", "+", "-", "*", "mod", "**")},
        {"-": Operator("-", 1), "not": Operator("NOT", 1)},
        always=True,
    ),
}


def atoms(expression: ir.Expression, printer: ExpressionPrinter) -> "str | Printed":
    match expression:
        case ir.Name(id=name):
            return name
        case ir.IntLiteral(value=value):
            return str(value)
        case ir.Builtin(function="abs", arguments=(value,)):
            return f"abs({printer.text(value)})"
    raise AssertionError(expression)


TOKENS = re.compile(r"\s*(?:(\d+)|([A-Za-z_]\w*)|(\*\*|\|\||&&|==|[-+*%^!=()]))")


class Reader:
    """Precedence climbing by the table itself: a prefix operator takes what binds tighter than itself, and another
    prefix operator that does not."""

    def __init__(self, text: str, table: OperatorTable) -> None:
        self.tokens = [match.group().strip() for match in TOKENS.finditer(text)]
        assert "".join(self.tokens) == re.sub(r"\s+", "", text)
        self.at, self.table = 0, table
        self.binary = {operator.symbol: (op, operator) for op, operator in table.binary.items()}
        self.unary = {operator.symbol: (op, operator) for op, operator in table.unary.items()}

    def peek(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def take(self) -> str:
        self.at += 1
        return self.tokens[self.at - 1]

    def expression(self, least: int) -> ir.Expression:
        left, ceiling = self.prefix(), ATOM
        while self.peek() in self.binary:
            op, operator = self.binary[self.peek()]
            if operator.level < least or operator.level > ceiling:
                break
            self.take()
            right = self.expression(operator.level if operator.side == "right" else operator.level + 1)
            left = ir.Binary(op, left, right)
            ceiling = operator.level if operator.side == "left" else operator.level - 1
        return left

    def prefix(self) -> ir.Expression:
        if self.peek() in self.unary:
            op, operator = self.unary[self.take()]
            further = self.unary.get(self.peek())
            loose = further is not None and further[1].level <= operator.level
            operand = self.prefix() if loose else self.expression(operator.level + 1)
            if op == "-" and isinstance(operand, ir.IntLiteral):
                return ir.IntLiteral(-operand.value)
            return ir.Unary(op, operand)
        return self.primary()

    def primary(self) -> ir.Expression:
        token = self.take()
        if token == "(":
            inner = self.expression(0)
            assert self.take() == ")"
            return inner
        if token == "abs":
            return ir.Builtin("abs", (self.primary(),))
        return ir.IntLiteral(int(token)) if token.isdigit() else ir.Name(token)


leaves = st.one_of(st.sampled_from("abc").map(ir.Name), st.integers(-9, 9).map(ir.IntLiteral))
expressions = st.recursive(
    leaves,
    lambda inner: st.one_of(
        st.builds(ir.Binary, st.sampled_from(sorted(TABLES["not loose"].binary)), inner, inner),
        st.builds(ir.Unary, st.just("not"), inner),
        st.builds(ir.Unary, st.just("-"), inner.filter(lambda node: not isinstance(node, ir.IntLiteral))),
        st.builds(lambda value: ir.Builtin("abs", (value,)), inner),
    ),
    max_leaves=12,
)


@given(expressions, st.sampled_from(sorted(TABLES)))
@example(ir.Unary("not", ir.Binary("-", ir.Binary("+", ir.IntLiteral(-1), ir.Name("c")), ir.Name("a"))), "not loose")
def test_reading_back_gives_the_same_tree(expression: ir.Expression, name: str) -> None:
    table = TABLES[name]
    text = ExpressionPrinter(table, atoms).text(expression)
    reader = Reader(text, table)
    assert reader.expression(0) == expression, text
    assert reader.at == len(reader.tokens)


def printed(expression: ir.Expression, name: str = "signs tight") -> str:
    return ExpressionPrinter(TABLES[name], atoms).text(expression)


A, B, C, TWO, MINUS = ir.Name("a"), ir.Name("b"), ir.Name("c"), ir.IntLiteral(2), ir.IntLiteral(-2)


def test_no_bracket_too_many_and_none_too_few() -> None:
    assert printed(ir.Binary("+", A, ir.Binary("*", B, C))) == "a + b * c"
    assert printed(ir.Binary("*", ir.Binary("+", A, B), C)) == "(a + b) * c"
    assert printed(ir.Binary("-", A, ir.Binary("-", B, C))) == "a - (b - c)"
    assert printed(ir.Binary("-", ir.Binary("-", A, B), C)) == "a - b - c"
    assert printed(ir.Binary("**", A, ir.Binary("**", B, C))) == "a ** b ** c"
    assert printed(ir.Unary("not", ir.Binary("=", A, B))) == "NOT (a = b)"
    assert printed(ir.Unary("not", ir.Binary("=", A, B)), "not loose") == "!a == b"


def test_signed_operands_are_bracketed_where_a_sign_would_follow_an_operator() -> None:
    assert printed(ir.Binary("-", A, MINUS)) == "a - (-2)"
    assert printed(ir.Binary("-", MINUS, A)) == "-2 - a"
    assert printed(ir.Binary("**", MINUS, TWO), "not loose") == "(-2) ^ 2"
    assert printed(ir.Unary("-", MINUS)) == "-(-2)"


def test_mixed_groups_are_bracketed_for_the_reader() -> None:
    both = ir.Binary("or", ir.Binary("and", A, B), C)
    assert printed(both) == "a AND b OR c"
    assert printed(both, "not loose") == "(a && b) || c"
    assert printed(ir.Binary("+", ir.Binary("+", A, B), C), "all one level") == "(a + b) + c"
