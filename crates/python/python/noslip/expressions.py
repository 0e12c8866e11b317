"""Texts of scenes from SymPy expressions."""

from __future__ import annotations

import re
from collections.abc import Iterable
from numbers import Integral, Real
from typing import Any

from ._noslip import RequestError


def text(expression: Any) -> str:
    """The text of an expression: a string as it stands, a number with all of its digits, a SymPy expression by its tree.

    A function of the time, as `dynamicsymbols("x")` makes, is the coordinate of its name, its derivative the rate `x'`, and
    every symbol a parameter, or the time `t`.
    """
    if isinstance(expression, str):
        return expression
    if isinstance(expression, Real):
        return repr(int(expression) if isinstance(expression, Integral) else float(expression))
    import sympy as sp

    try:
        checked = sp.sympify(expression)
    except sp.SympifyError:
        raise RequestError(f"{expression!r}: accepted are texts, numbers and SymPy expressions") from None
    if isinstance(checked, sp.MatrixBase) and checked.shape == (1, 1):
        checked = checked[0]
    _check(checked)
    return str(_printer().doprint(checked))


def name(symbol: Any) -> str:
    """The name of a coordinate: a string, a symbol, a function of the time, or the rate of one."""
    if isinstance(symbol, str):
        return spelled(symbol) if LATEX.search(symbol) else symbol
    import sympy as sp

    if isinstance(symbol, sp.Derivative):
        symbol = symbol.args[0]
    return spelled(_own_name(symbol))


LATEX = re.compile(r"[{}\\]")


def _own_name(symbol: Any) -> str:
    """The name that SymPy has for a symbol or a function."""
    return str(symbol.func.__name__ if symbol.args else symbol)


def spelled(own: str) -> str:
    """A name as scenes have them: of `k_{1}` it is `k_1`, of `\\theta` it is `theta`."""
    if re.fullmatch(r"\w+'*", own):
        return own
    return re.sub(r"\W+", "_", LATEX.sub("", own)).strip("_") or own


def refuse_twins(expressions: Iterable[Any]) -> None:
    """Refuses symbols that a scene would have under one name."""
    found: dict[str, tuple[str, bool]] = {}
    for expression in expressions:
        if not hasattr(expression, "atoms"):
            continue
        import sympy as sp
        from sympy.core.function import AppliedUndef

        for symbol in expression.atoms(sp.Symbol, AppliedUndef):
            own = (_own_name(symbol), bool(symbol.args))
            other = found.setdefault(spelled(own[0]), own)
            if other != own:
                function = {True: "a function of the time", False: "a symbol"}
                told = " and ".join(f"{one} ({function[moves]})" for one, moves in (other, own))
                raise RequestError(f"{told} would have one name, {spelled(own[0])}: rename one of them")


KNOWN = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "sign", "floor"}
RENAMED = {"Abs": "abs", "Max": "max", "Min": "min", "Mod": "mod"}


def _check(expression: Any) -> None:
    """Refuses what has no text in a scene."""
    import sympy as sp
    from sympy.core.function import AppliedUndef

    if isinstance(expression, AppliedUndef):
        return
    if isinstance(expression, sp.Derivative):
        function, *variables = expression.args
        if isinstance(function, AppliedUndef) and len(variables) == 1 and variables[0][1] == 1:
            return
        raise RequestError(f"{expression}: accepted are first derivatives of coordinates by the time")
    if isinstance(expression, sp.Piecewise):
        *branches, (last, condition) = expression.args
        if condition != sp.true:
            raise RequestError(f"{expression}: the last piece is the one for all other cases, `(value, True)`")
        for value, condition in branches:
            if not isinstance(condition, (sp.StrictLessThan, sp.LessThan, sp.StrictGreaterThan, sp.GreaterThan)):
                raise RequestError(f"{expression}: conditions are comparisons, such as x < 1")
            for part in (value, *condition.args):
                _check(part)
        _check(last)
        return
    if isinstance(expression, sp.Heaviside):
        _check(expression.args[0])
        return
    if isinstance(expression, sp.Equality):
        raise RequestError(f"{expression}: an equation is a constraint or a position; all else are expressions")
    if isinstance(expression, (sp.Function, sp.Max, sp.Min, sp.Abs)):
        called = expression.func.__name__
        if called not in KNOWN | set(RENAMED):
            known = ", ".join(sorted(KNOWN | set(RENAMED.values())))
            raise RequestError(f"{expression}: no function `{called}` is known in a scene; the functions are {known}")
    elif not isinstance(expression, (sp.Symbol, sp.Number, sp.Add, sp.Mul, sp.Pow, type(sp.pi), type(sp.E))):
        raise RequestError(f"{expression}: a scene has no text for {type(expression).__name__}")
    elif isinstance(expression, sp.Number) and not expression.is_finite:
        raise RequestError(f"{expression} is not a finite number")
    for argument in expression.args:
        _check(argument)


def _printer() -> Any:
    from sympy.core.function import AppliedUndef
    from sympy.printing.str import StrPrinter

    class Printer(StrPrinter):  # type: ignore[misc]
        """SymPy's own text, with the names that scenes have."""

        def _print_Derivative(self, expression: Any) -> str:
            return f"{name(expression.args[0])}'"

        def _print_Function(self, expression: Any) -> str:
            if isinstance(expression, AppliedUndef):
                return name(expression)
            called = expression.func.__name__
            arguments = ", ".join(self.doprint(argument) for argument in expression.args)
            return f"{RENAMED.get(called, called)}({arguments})"

        _print_Abs = _print_Max = _print_Min = _print_Mod = _print_floor = _print_Function

        def _print_Piecewise(self, expression: Any) -> str:
            *branches, (last, _) = expression.args
            chosen: str = self.doprint(last)
            for value, condition in reversed(branches):
                left, right = (self.doprint(side) for side in condition.args)
                chosen = f"if({left} {condition.rel_op} {right}, {self.doprint(value)}, {chosen})"
            return chosen

        def _print_Heaviside(self, expression: Any) -> str:
            return f"step({self.doprint(expression.args[0])})"

        def _print_Symbol(self, expression: Any) -> str:
            return name(expression)

        def _print_Float(self, expression: Any) -> str:
            return repr(float(expression))

        def _print_Exp1(self, expression: Any) -> str:
            return "exp(1)"

    return Printer()
