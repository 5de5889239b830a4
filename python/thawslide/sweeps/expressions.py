"""Expressions of history columns, evaluated without access to anything else."""

from __future__ import annotations

import ast
import difflib
import operator
from collections.abc import Callable, Collection, Mapping
from typing import Any

import numpy as np

from thawslide.arrays import Numbers
from thawslide.errors import ReportError, nearest, quoted

_OPERATORS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
}
_LONGEST = 1000  # characters
_LONGEST_NAME = 60  # characters
_MOST_NEAR, _LEAST_LIKENESS = 4, 0.4  # of names in a message


# These return numbers of NumPy, whose division by zero gives inf.
def _at(columns: Mapping[str, Numbers], time: float, values: Numbers) -> np.float64:
    return np.float64(np.interp(time, columns["time_s"], values, left=np.nan, right=np.nan))


def _first_time(columns: Mapping[str, Numbers], condition: Numbers) -> np.float64:
    rows = np.flatnonzero(condition)
    return np.float64(columns["time_s"][rows[0]] if rows.size else np.nan)


def _integral(columns: Mapping[str, Numbers], values: Numbers) -> np.float64:
    return np.float64(np.trapezoid(values, columns["time_s"]))


# Functions of arrays, and those that also need the time.
_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "abs": np.abs,
    "sqrt": np.sqrt,
    "log": np.log,
    "exp": np.exp,
    "min": lambda *values: np.nanmin(values),
    "max": lambda *values: np.nanmax(values),
    "mean": np.nanmean,
    "first": lambda values: values[0],
    "last": lambda values: values[-1],
}
_TIMED: dict[str, Callable[..., Any]] = {"at": _at, "first_time": _first_time, "integral": _integral}
FUNCTIONS = (*_FUNCTIONS, *_TIMED)


class _KeysAsNames(ast.NodeTransformer):
    """Replace attributes such as `basal.cohesion` by names."""

    def visit_Attribute(self, node: ast.Attribute) -> ast.AST:
        """Return the name of a key."""
        return ast.Name(ast.unparse(node))


class Expression:
    """An expression such as `max(mean_velocity_m_s)`, or, of keys, `0.5 * basal.cohesion`."""

    def __init__(self, name: str, text: str, option: str = "--column") -> None:
        """Parse an expression; ReportError if it is invalid. `option`: that of the command line, --column or --tie."""
        self.name, self.text, self._option = name, text, option
        self._names = "column" if option == "--column" else "varied or set key"
        if option == "--column" and not name.isidentifier():
            raise ReportError(f"--column: invalid name (found {quoted(name)}). Use letters, digits and underscores.")
        try:
            if len(text) > _LONGEST:
                raise SyntaxError("too long")
            tree = ast.parse(text, mode="eval").body
            self._tree = tree if option == "--column" else _KeysAsNames().visit(tree)
        except (SyntaxError, ValueError, RecursionError) as error:
            raise ReportError(f"{option} {name}: not an expression (found {quoted(text)}). Correct it.") from error
        self._check(self._tree)

    @classmethod
    def parse(cls, text: str, option: str = "--column") -> Expression:
        """Read NAME=EXPRESSION."""
        name, equals, expression = text.partition("=")
        if not equals or not name.strip():
            raise ReportError(f"{option}: invalid (found {quoted(text)}). Specify NAME=EXPRESSION.")
        return cls(name.strip(), expression.strip(), option)

    def require_columns(self, known: Collection[str]) -> None:
        """Raise ReportError for a column that no history has."""
        for node in ast.walk(self._tree):
            if isinstance(node, ast.Name) and node.id not in (*known, *FUNCTIONS):
                raise ReportError(f"{self._option} {self.name}: {self._no_name(node.id, known)}")

    def value(self, columns: Mapping[str, Numbers]) -> float:
        """Return the value for the columns of a history; ReportError for an unknown column or no single real value."""
        try:
            with np.errstate(all="ignore"):
                value = np.asarray(self._value(self._tree, columns))
        except ArithmeticError as error:
            raise ReportError(f"{self._option} {self.name}: cannot be computed ({error}). Correct it.") from error
        if value.ndim:
            raise ReportError(
                f"{self._option} {self.name}: not a single value, but one per row (found {quoted(self.text)}). Use "
                f"max, last or another function."
            )
        if np.iscomplexobj(value):
            raise ReportError(f"{self._option} {self.name}: not a real number (found {value}). Correct it.")
        return float(value)

    def _no_name(self, found: str, known: Collection[str]) -> str:
        near = difflib.get_close_matches(found[:_LONGEST_NAME], known, _MOST_NEAR, _LEAST_LIKENESS)
        allowed = f"allowed, for example: {', '.join(near or sorted(known)[:_MOST_NEAR])}"
        place = " in the history" if self._option == "--column" else ""
        return f"no {self._names} {quoted(found)}{place} ({allowed}). Correct the name."

    def _check(self, node: ast.AST) -> None:
        """Raise ReportError for anything but numbers, names, arithmetic, comparisons and known functions."""
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            if node.func.id not in FUNCTIONS:
                raise ReportError(
                    f"{self._option} {self.name}: no function {quoted(node.func.id)}{nearest(node.func.id, FUNCTIONS)} "
                    f"Allowed: {', '.join(FUNCTIONS)}."
                )
            parts: list[ast.AST] = list(node.args)
        elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
            parts = [node.left, node.right]
        elif isinstance(node, ast.UnaryOp) and type(node.op) in _OPERATORS:
            parts = [node.operand]
        elif isinstance(node, ast.Compare) and len(node.ops) == 1 and type(node.ops[0]) in _OPERATORS:
            parts = [node.left, node.comparators[0]]
        elif isinstance(node, ast.Name) or (isinstance(node, ast.Constant) and type(node.value) in (int, float)):
            parts = []
        else:
            raise ReportError(
                f"{self._option} {self.name}: not allowed (found {quoted(ast.unparse(node))}). Use {self._names}s, "
                f"numbers, arithmetic and functions."
            )
        for part in parts:
            self._check(part)

    def _value(self, node: ast.AST, columns: Mapping[str, Numbers]) -> Any:
        if isinstance(node, ast.Constant):
            return np.float64(node.value)  # type: ignore[arg-type]  # a number, after _check
        if isinstance(node, ast.Name):
            if node.id not in columns:
                raise ReportError(f"{self._option} {self.name}: {self._no_name(node.id, columns)}")
            return columns[node.id]
        if isinstance(node, ast.BinOp):
            return _OPERATORS[type(node.op)](self._value(node.left, columns), self._value(node.right, columns))
        if isinstance(node, ast.UnaryOp):
            return _OPERATORS[type(node.op)](self._value(node.operand, columns))
        if isinstance(node, ast.Compare):
            return _OPERATORS[type(node.ops[0])](
                self._value(node.left, columns), self._value(node.comparators[0], columns)
            )
        assert isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
        values = [self._value(part, columns) for part in node.args]
        try:
            if node.func.id in _TIMED:
                return _TIMED[node.func.id](columns, *values)
            return _FUNCTIONS[node.func.id](*values)
        except (TypeError, ValueError, IndexError) as error:
            raise ReportError(
                f"{self._option} {self.name}: {node.func.id} cannot be applied ({error}). Correct its arguments."
            ) from error
